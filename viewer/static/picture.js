// The picture: developed from linear radiance, zoomed, picked from; what lies over it, and the wipe.
(window.castrayParts ||= []).push((castray) => {
  const { onBeforeUnmount, onMounted, ref, watch } = window.Vue;
  const { fitted, short, clamp, numbers } = castray;

  // linear radiance (float32 bytes from the server) as an image the canvas can draw
  function develop(bytes, width, height, exposure) {
    const linear = numbers(Float32Array, bytes);
    const image = new ImageData(width, height);
    const gain = 2 ** exposure;
    for (let i = 0, o = 0; i < linear.length; i += 3, o += 4) {
      for (let k = 0; k < 3; k++) {
        const c = linear[i + k] * gain;
        image.data[o + k] = c <= 0.0031308 ? 3294.6 * c : 255 * (1.055 * c ** (1 / 2.4) - 0.055);
      }
      image.data[o + 3] = 255;
    }
    return { linear, image };
  }

  const Picture = {
    props: ["rgb", "width", "height", "x", "y", "exposure", "label", "words", "overlay", "overlayValues", "rival", "wipe"],
    emits: ["pick", "wipe"],
    setup(props, { emit }) {
      const canvas = ref(null), hover = ref("");
      const view = { scale: 1, left: 0, top: 0 };
      let linear = null, drag = null;
      const sheet = document.createElement("canvas"), cover = document.createElement("canvas");
      let covering = null; // the numbers laid over the picture
      const beside = document.createElement("canvas"); // the picture compared with, seen right of the wipe
      let wiping = false;

      const unit = (box) => Math.min(box.width / props.width, box.height / props.height) * view.scale;
      const origin = (box) => [
        box.width / 2 - unit(box) * (props.width / 2 + view.left), box.height / 2 - unit(box) * (props.height / 2 + view.top)];
      function pixelAt(event) {
        const box = canvas.value.getBoundingClientRect(), [left, top] = origin(box), u = unit(box);
        const x = Math.floor((event.clientX - box.left - left) / u), y = Math.floor((event.clientY - box.top - top) / u);
        return x >= 0 && y >= 0 && x < props.width && y < props.height ? [x, y] : null;
      }
      function draw() {
        if (!canvas.value) return;
        const { box, dots, g } = fitted(canvas.value), [left, top] = origin(box), u = unit(box);
        g.setTransform(dots, 0, 0, dots, 0, 0);
        g.clearRect(0, 0, box.width, box.height);
        g.imageSmoothingEnabled = u < 1;
        const put = (layer) => g.drawImage(layer, left, top, u * props.width, u * props.height);
        for (const layer of [linear && sheet, covering && cover]) if (layer) put(layer);
        if (wiping && !covering) {
          const edge = left + props.wipe * u * props.width;
          g.save(); g.beginPath(); g.rect(edge, 0, box.width, box.height); g.clip(); put(beside); g.restore();
          for (const [style, wide] of [["#000", 3], ["#ffd257", 1.5]]) { g.fillStyle = style; g.fillRect(edge - wide / 2, top, wide, u * props.height); }
        }
        const size = Math.max(u, 7), cx = left + u * (props.x + 0.5), cy = top + u * (props.y + 0.5);
        for (const [style, wide] of [["#000", 3.5], ["#fff", 1.5]]) {
          Object.assign(g, { strokeStyle: style, lineWidth: wide });
          g.strokeRect(cx - size / 2, cy - size / 2, size, size);
          g.beginPath();
          for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
            g.moveTo(cx + dx * size, cy + dy * size);
            g.lineTo(cx + dx * (size + 7), cy + dy * (size + 7));
          }
          g.stroke();
        }
      }
      function redevelop() {
        if (!props.rgb || props.rgb.byteLength !== 12 * props.width * props.height) return;
        const { linear: values, image } = develop(props.rgb, props.width, props.height, props.exposure);
        linear = values;
        Object.assign(sheet, { width: props.width, height: props.height });
        sheet.getContext("2d").putImageData(image, 0, 0);
        draw();
      }
      function bring() {
        wiping = !!props.rival && props.rival.byteLength === 12 * props.width * props.height;
        if (wiping) {
          Object.assign(beside, { width: props.width, height: props.height });
          beside.getContext("2d").putImageData(develop(props.rival, props.width, props.height, props.exposure).image, 0, 0);
        }
        draw();
      }
      function recover() {
        const bytes = props.overlayValues, there = props.overlay && bytes && bytes.byteLength === 4 * props.width * props.height;
        covering = there ? numbers(Float32Array, bytes) : null;
        if (covering) {
          Object.assign(cover, { width: props.width, height: props.height });
          cover.getContext("2d").putImageData(window.castray.coloured(covering, props.width, props.height, props.overlay), 0, 0);
        }
        draw();
      }
      function zoom(factor, event) {
        const box = canvas.value.getBoundingClientRect(), before = unit(box);
        const scale = clamp(view.scale * factor, 1, 64), ratio = scale / view.scale;
        const px = event ? event.clientX - box.left - box.width / 2 : 0, py = event ? event.clientY - box.top - box.height / 2 : 0;
        view.left += (px / before) * (1 - 1 / ratio);
        view.top += (py / before) * (1 - 1 / ratio);
        view.scale = scale;
        if (scale === 1) view.left = view.top = 0;
        settle();
      }
      function settle() {
        view.left = clamp(view.left, -props.width / 2, props.width / 2);
        view.top = clamp(view.top, -props.height / 2, props.height / 2);
        draw();
      }
      // where on the picture the pointer is, 0 at its left edge and 1 at its right one
      function across(event) {
        const box = canvas.value.getBoundingClientRect();
        return (event.clientX - box.left - origin(box)[0]) / (unit(box) * props.width);
      }
      const onWipe = (event) => wiping && !covering && Math.abs(across(event) - props.wipe) * unit(canvas.value.getBoundingClientRect()) * props.width < 5;
      function down(event) {
        canvas.value.setPointerCapture(event.pointerId);
        drag = onWipe(event) ? { wipe: true, moved: false } : { x: event.clientX, y: event.clientY, left: view.left, top: view.top, moved: false };
      }
      function move(event) {
        canvas.value.style.cursor = (drag && drag.wipe) || onWipe(event) ? "ew-resize" : "";
        if (drag && drag.wipe) {
          drag.moved = true;
          emit("wipe", clamp(across(event), 0, 1));
        } else if (drag) {
          const u = unit(canvas.value.getBoundingClientRect()), dx = event.clientX - drag.x, dy = event.clientY - drag.y;
          drag.moved ||= Math.hypot(dx, dy) > 4;
          if (drag.moved && view.scale > 1) { view.left = drag.left - dx / u; view.top = drag.top - dy / u; settle(); }
        }
        const at = pixelAt(event);
        if (!at || !linear) { hover.value = ""; return; }
        const i = 3 * (at[1] * props.width + at[0]);
        hover.value = covering ? `(${at[0]}, ${at[1]})  ${props.overlay.title}: ${short(covering[i / 3])}`
          : `(${at[0]}, ${at[1]})  ${[0, 1, 2].map((k) => short(linear[i + k])).join("  ")}`;
      }
      function up(event) {
        const at = drag && !drag.moved && event.button === 0 && pixelAt(event);
        drag = null;
        if (at) emit("pick", at);
      }
      const sizes = new ResizeObserver(draw);
      onMounted(() => { sizes.observe(canvas.value); redevelop(); recover(); bring(); });
      onBeforeUnmount(() => sizes.disconnect());
      watch(() => [props.rgb, props.width, props.height, props.exposure], redevelop);
      watch(() => [props.overlay && JSON.stringify(props.overlay), props.overlayValues], recover);
      watch(() => [props.rival, props.width, props.height, props.exposure], bring);
      watch(() => [props.x, props.y, props.wipe], draw);
      const leave = () => { hover.value = ""; };
      const wheel = (event) => zoom(1.25 ** (event.deltaY < 0 ? 1 : -1), event);
      return { canvas, hover, zoom, down, move, up, leave, wheel };
    },
    template: `<div class="photo"><canvas ref="canvas" role="img" :aria-label="label" data-testid="picture"
        @pointerdown="down" @pointermove="move" @pointerup="up" @pointerleave="leave" @wheel.prevent="wheel"></canvas>
      <div class="zoom"><button :aria-label="words.zoom_in" :title="words.zoom_in" data-testid="zoom-in" @click="zoom(1.6)">+</button>
        <button :aria-label="words.zoom_out" :title="words.zoom_out" data-testid="zoom-out" @click="zoom(1 / 1.6)">−</button>
        <button :aria-label="words.zoom_fit" :title="words.zoom_fit" data-testid="zoom-fit" @click="zoom(1e-9)">⤢</button></div>
      <output class="hover" data-testid="hover" :class="{empty: !hover}">{{ hover || words.hover_hint }}</output></div>`,
  };

  return { CastrayPicture: Picture };
});
