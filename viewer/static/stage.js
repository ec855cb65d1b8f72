// The 3D view: what the paths are drawn with, and words beside it. vtk.js would draw whenever a part of the scene has
// come; here all that changed, page included, is drawn at once: on a software GL each picture of the page is dear.
(window.castrayParts ||= []).push((castray) => {
  const { inject, onBeforeUnmount, onMounted, ref, watch } = window.Vue;
  const { clamp, numbers } = castray;
  const NOTHING = new Uint32Array(0);

  const sub = (a, b) => a.map((v, k) => v - b[k]), dot = (a, b) => a.reduce((s, v, k) => s + v * b[k], 0);
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = (a) => a.map((v) => v / Math.hypot(...a));
  // where a point of the scene is seen in a view of that size; null behind the eye
  function project(eye, at, width, height) {
    const ahead = unit(sub(eye.focalPoint, eye.position)), side = unit(cross(ahead, eye.viewUp)), up = cross(side, ahead);
    const ray = sub(at, eye.position), depth = dot(ray, ahead), f = height / 2 / Math.tan((eye.viewAngle * Math.PI) / 360);
    return depth > 0 ? [width / 2 + (f * dot(ray, side)) / depth, height / 2 - (f * dot(ray, up)) / depth] : null;
  }

  const beyond = (v, size) => Math.abs(v - size / 2) > 0.55 * size; // a little outside, a label stands at the edge

  // Gives the actors of viewer/stage.py, which vtk.js has made already, what the server says they show.
  function drawer(renderer) {
    const kept = []; // what was said of each, and the numbers made of it
    return (strokes) => {
      const actors = renderer().getActors();
      let changed = false;
      for (const said of strokes) {
        const [k, points, cells] = said, mesh = actors[k].getMapper().getInputData();
        if (!kept[k] || kept[k].said !== said) kept[k] = { said, points: numbers(Float32Array, points), cells: numbers(Uint32Array, cells) };
        const now = kept[k];
        if (mesh.getPoints().getData() === now.points) continue; // a scene that came anew brought its own
        mesh.getPoints().setData(now.points, 3);
        mesh.getLines().setData(now.cells[0] === 2 ? now.cells : NOTHING);
        mesh.getPolys().setData(now.cells[0] === 3 ? now.cells : NOTHING);
        mesh.modified();
        actors[k].setVisibility(now.cells.length > 0);
        changed = true;
      }
      return changed;
    };
  }

  const Stage = {
    props: ["labels", "camera", "strokes"],
    setup(props) {
      const trame = inject("trame"), view = inject("view"), box = ref(null), put = drawer(() => view.renderer);
      let frame = 0, wanted = true, last = "", aimed = null, named = false;
      // a page in which nothing happens costs nothing: a look at every frame took a tenth of a processor
      const lookSoon = () => { frame ||= requestAnimationFrame(() => { frame = 0; show(); }); };
      const sizes = new ResizeObserver(show);
      const asked = new Map(), session = trame.client.getConnection().getSession();
      view.ctx.setFetchArrayFunction((hash) => { // each array once, however many layers have it
        if (!asked.has(hash)) asked.set(hash, session.call("viewport.geometry.array.get", [hash, true]).finally(() => asked.delete(hash)));
        return asked.get(hash).then((bytes) => bytes.slice().buffer);
      });
      const canvas = view.openglRenderWindow.getCanvas(), context = canvas.getContext.bind(canvas);
      canvas.getContext = (kind, options) => context(kind, { ...options, alpha: false }); // nothing to blend with the page
      view.render = Object.assign(() => { wanted = true; lookSoon(); }, { cancel() {} });
      function show() {
        if (!view.renderer || !view.interactor.getEnableRender()) { lookSoon(); return; } // the scene is still on its way
        if (!named) named = name(canvas.closest("[tabindex]"));
        if (aimed !== props.camera) { aimed = props.camera; view.setCamera(aimed); wanted = true; }
        if (put(props.strokes)) wanted = true;
        if (wanted) draw();
        place(view.getCamera());
      }
      function draw() {
        wanted = false;
        view.renderer.resetCameraClippingRange();
        view.renderWindow.render();
        view.openglRenderWindow.getContext().flush(); // else it begins only with the page's picture
      }
      // no key does anything in what vtk.js draws into: it is no stop of the focus, and named as what is around it
      function name(drawn) {
        if (!drawn) return false;
        drawn.tabIndex = -1;
        drawn.setAttribute("role", "img");
        drawn.setAttribute("aria-labelledby", "stage");
        return true;
      }
      function place(eye) {
        const { clientWidth: width, clientHeight: height } = box.value;
        const legend = box.value.closest(".stage").querySelector(".marks"), low = height - 12 - (legend ? legend.offsetHeight + 10 : 0);
        const now = JSON.stringify([eye, props.labels, width, height, low]);
        if (now === last) return;
        last = now;
        const taken = [];
        props.labels.forEach((label, k) => {
          const element = box.value.children[k];
          if (!element) return;
          const there = project(eye, label.at, width, height);
          element.hidden = !there || beyond(there[0], width) || beyond(there[1], height); // what it names is not seen
          if (element.hidden) return;
          const x = clamp(there[0], 14, width - 14), ideal = clamp(there[1], 12, low);
          const full = (y) => taken.some(([a, b, wide]) => Math.abs(x - a) < wide / 2 + element.offsetWidth / 2 && Math.abs(y - b) < 22);
          let y = ideal; // else the nearest free place below or above
          for (let k = 1; k < 100 && full(y); k++) y = clamp(ideal + (k % 2 ? 4 : -4) * Math.ceil(k / 2), 12, low);
          taken.push([x, y, element.offsetWidth]);
          element.style.transform = `translate(${x}px, ${y}px) translate(-50%, -50%)`;
        });
      }
      onMounted(() => {
        sizes.observe(box.value);
        sizes.observe(box.value.closest(".stage").querySelector(".marks"));
        lookSoon();
      });
      watch(() => [props.strokes, props.labels, props.camera], show, { flush: "post" }); // the GPU is at it while the rest of the page is laid out
      onBeforeUnmount(() => { cancelAnimationFrame(frame); sizes.disconnect(); });
      const home = () => { aimed = null; lookSoon(); };
      return { box, home };
    },
    template: `<div class="labels"><div ref="box"><span v-for="label in labels" :key="label.text" class="label" :class="label.layer"><castray-symbol :text="label.text"/></span></div>
      <slot :home="home"></slot></div>`,
  };

  return { CastrayStage: Stage };
});
