// The parts of the page that are more than words and boxes: the picture, the bars, the labels over the 3D view, keys.
(() => {
  const { inject, onBeforeUnmount, onMounted, ref, watch } = window.Vue;
  const self = Math.random().toString(36).slice(2) + Date.now().toString(36);
  const clamp = (v, low, high) => Math.min(Math.max(v, low), high);
  const short = (v) => (Number.isFinite(v) ? String(Number(v.toPrecision(5))) : Number.isNaN(v) ? "–" : v > 0 ? "∞" : "-∞");

  // linear radiance (float32 bytes from the server) as an image the canvas can draw
  function develop(bytes, width, height, exposure) {
    const linear = new Float32Array(bytes.slice().buffer);
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

  function fitted(canvas) {
    const box = canvas.getBoundingClientRect(), dots = window.devicePixelRatio || 1;
    const width = Math.max(1, Math.round(box.width * dots)), height = Math.max(1, Math.round(box.height * dots));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    return { box, dots, g: canvas.getContext("2d") };
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
        covering = there ? new Float32Array(bytes.slice().buffer) : null;
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

  const Bars = {
    props: ["bars", "colours", "mean", "selected", "label"],
    emits: ["select"],
    setup(props, { emit }) {
      const canvas = ref(null), title = ref("");
      function draw() {
        if (!canvas.value) return;
        const { box, dots, g } = fitted(canvas.value), n = props.bars.length, most = Math.max(...props.bars, 1e-30);
        const step = box.width / n, gap = step > 5 ? 1.5 : 0, room = box.height - 12;
        g.setTransform(dots, 0, 0, dots, 0, 0);
        g.clearRect(0, 0, box.width, box.height);
        props.bars.forEach((bar, k) => {
          const left = k * step, tall = bar > 0 ? Math.max(1.5, (bar / most) * room) : 0;
          if (k === props.selected) { g.fillStyle = "#3a4354"; g.fillRect(left, 0, Math.max(step, 2), box.height); }
          g.fillStyle = props.colours[k];
          g.fillRect(left + gap / 2, box.height - 8 - tall, Math.max(step - gap, 0.5), tall);
          g.strokeStyle = "#8a93a5";
          if (tall && step > 5) g.strokeRect(left + gap / 2 + 0.5, box.height - 8 - tall, step - gap - 1, tall);
          if (!tall && step > 5) { g.fillStyle = "#8a93a5"; g.font = "9px sans-serif"; g.textAlign = "center"; g.fillText("∅", left + step / 2, box.height - 10); }
          if (k === props.selected) { g.fillStyle = "#fff"; g.beginPath(); const c = left + step / 2; g.moveTo(c, box.height - 6); g.lineTo(c - 4, box.height); g.lineTo(c + 4, box.height); g.fill(); }
        });
        g.strokeStyle = "#ffd257"; g.setLineDash([4, 3]); g.beginPath();
        const level = box.height - 8 - (props.mean / most) * room; g.moveTo(0, level); g.lineTo(box.width, level); g.stroke(); g.setLineDash([]);
      }
      const at = (event) => { const box = canvas.value.getBoundingClientRect(); return clamp(Math.floor(((event.clientX - box.left) / box.width) * props.bars.length), 0, props.bars.length - 1); };
      const move = (event) => { const k = at(event); title.value = `${k}: ${short(props.bars[k])}`; };
      const click = (event) => emit("select", at(event));
      const sizes = new ResizeObserver(draw);
      onMounted(() => sizes.observe(canvas.value));
      onBeforeUnmount(() => sizes.disconnect());
      watch(() => [props.bars, props.selected, props.colours], draw);
      return { canvas, title, move, click };
    },
    template: `<canvas ref="canvas" class="bars" role="slider" :aria-label="label" aria-valuemin="0" :aria-valuemax="bars.length - 1"
      :aria-valuenow="selected" :title="title" data-testid="bars" @click="click" @pointermove="move"></canvas>`,
  };

  // Words over the 3D view: projected by the browser's own camera whenever that has moved.
  const Labels = {
    props: ["labels", "camera", "view"],
    setup(props) {
      const trame = inject("trame"), box = ref(null);
      let frame = 0, last = "", aimed = null;
      function project(eye, at, width, height) {
        const sub = (a, b) => a.map((v, k) => v - b[k]), dot = (a, b) => a.reduce((s, v, k) => s + v * b[k], 0);
        const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        const unit = (a) => a.map((v) => v / Math.hypot(...a));
        const ahead = unit(sub(eye.focalPoint, eye.position)), side = unit(cross(ahead, eye.viewUp)), up = cross(side, ahead);
        const ray = sub(at, eye.position), depth = dot(ray, ahead), f = height / 2 / Math.tan((eye.viewAngle * Math.PI) / 360);
        return depth > 0 ? [width / 2 + (f * dot(ray, side)) / depth, height / 2 - (f * dot(ray, up)) / depth] : null;
      }
      function watchCamera() {
        frame = requestAnimationFrame(watchCamera);
        place();
      }
      function place() {
        const view = trame.refs[props.view];
        if (!view || !box.value) return;
        let eye;
        try { eye = view.getCamera(); } catch { return; } // the first scene is still on its way
        if (!eye.position) return;
        if (aimed !== props.camera) { aimed = props.camera; view.setCamera(props.camera); return; }
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
          element.hidden = !there; // behind the eye
          if (!there) return;
          let [x, y] = [clamp(there[0], 14, width - 14), Math.min(there[1], low)];
          while (taken.some(([a, b, wide]) => Math.abs(x - a) < wide / 2 + element.offsetWidth / 2 && Math.abs(y - b) < 22)) y += 4;
          taken.push([x, y, element.offsetWidth]);
          element.style.transform = `translate(${x}px, ${clamp(y, 12, height - 12)}px) translate(-50%, -50%)`;
        });
      }
      onMounted(watchCamera);
      watch(() => props.labels, place, { flush: "post" }); // with the words, in one and the same picture
      onBeforeUnmount(() => cancelAnimationFrame(frame));
      const home = () => { aimed = null; };
      return { box, home };
    },
    template: `<div class="labels"><div ref="box"><span v-for="label in labels" :key="label.text" class="label" :class="label.layer">{{ label.text }}</span></div>
      <slot :home="home"></slot></div>`,
  };

  const CHOSEN = "castray-language"; // where the browser keeps it

  // One tab at a time: this one asks to lead, follows the link in its address, and hears the keys.
  const Tab = {
    props: ["owner", "link", "x", "y", "keys", "language", "languages"], // keys: {key: [call, arguments...]}
    setup(props) {
      const trame = inject("trame"), mine = () => props.owner === self;
      const take = () => trame.trigger("take", [self, "", wanted()]);
      // the language that was chosen in this browser before, or the first of its own that is known here
      function wanted() {
        const known = props.languages.map((l) => l.tag);
        const tags = [localStorage.getItem(CHOSEN), ...navigator.languages].filter(Boolean);
        return tags.map((tag) => tag.toLowerCase().split("-")[0]).find((tag) => known.includes(tag)) || props.language;
      }
      function speak(tag) { localStorage.setItem(CHOSEN, tag); trame.trigger("speak", [tag]); }
      const typing = (event) => /^(INPUT|TEXTAREA|SELECT)$/.test(event.target.tagName);
      function key(event) {
        if (!mine() || typing(event) || event.ctrlKey || event.altKey || event.metaKey) return;
        const named = (event.shiftKey && props.keys["Shift+" + event.key]) || props.keys[event.key];
        const asking = !!document.querySelector("dialog[open]"), help = named && named[0] === "help";
        const pressed = event.key === " " && /^(BUTTON|SUMMARY)$/.test(event.target.tagName);
        if (!named || (asking && !help) || pressed) return;
        const [name, ...given] = named;
        let call = [name, given];
        if (name === "beside") call = ["pick", [props.x + given[0], props.y + given[1]]];
        if (name === "look") trame.state.set("tab", given[0]);
        event.preventDefault();
        event.stopPropagation();
        if (help) trame.state.set("helped", !asking);
        else trame.trigger(...call);
      }
      const hush = (event) => { if (!typing(event)) event.stopPropagation(); }; // vtk.js binds w, s and r
      const follow = () => { const hash = window.location.hash.slice(1); if (mine() && hash && hash !== props.link) trame.trigger("open", [hash]); };
      const write = () => { if (mine()) window.history.replaceState(null, "", "#" + props.link); };
      // a new address and a scroll cost the browser a picture each: the first can wait, the second is rarely needed
      let writing = 0;
      const writeSoon = () => { clearTimeout(writing); writing = setTimeout(write, 150); };
      function reveal(element) {
        const box = element.getBoundingClientRect(), frame = element.closest(".events, .track").getBoundingClientRect();
        const hidden = box.top < frame.top + (element.tagName === "TR" ? 24 : 0) || box.bottom > frame.bottom || box.left < frame.left || box.right > frame.right + 1;
        if (hidden) element.scrollIntoView({ block: "nearest", inline: "nearest" });
      }
      const show = () => { document.querySelectorAll(".events [aria-current], .track [aria-current]").forEach(reveal); };
      onMounted(async () => {
        window.addEventListener("keydown", key, true);
        for (const kind of ["keypress", "keyup"]) window.addEventListener(kind, hush, true);
        window.addEventListener("hashchange", follow);
        const asked = window.location.hash.slice(1);
        await trame.trigger("take", [self, asked, wanted()]);
        document.documentElement.dataset.ready = "true";
      });
      watch(() => [props.link, props.owner], () => { writeSoon(); show(); }, { flush: "post" });
      watch(() => props.language, (tag) => { document.documentElement.lang = tag; }, { immediate: true });
      return { mine, take, speak };
    },
    template: `<slot :mine="mine()" :take="take" :speak="speak"></slot>`,
  };

  // One thing that is turned: while it moves only the newest value waits to be sent.
  const Knob = {
    props: ["knob", "call"],
    setup(props) {
      const trame = inject("trame"), held = ref(null);
      let sending = false, waiting = null;
      async function turn(value) {
        held.value = waiting = value;
        if (sending) return;
        sending = true;
        while (waiting !== null) {
          const next = waiting;
          waiting = null;
          await trame.trigger(props.call, [props.knob.key, next]);
        }
        sending = false;
        held.value = null;
      }
      const now = () => (held.value === null ? props.knob.value : held.value);
      return { turn, now, short, held };
    },
    template: `<label class="knob" :title="knob.title"><span class="name">{{ knob.label }}</span>
      <select v-if="knob.kind === 'choice'" :value="now()" :aria-label="knob.label" :data-testid="call + '-' + knob.key" @change="turn($event.target.value)">
        <option v-for="choice in knob.choices" :key="choice.value" :value="choice.value">{{ choice.text }}</option></select>
      <template v-else-if="knob.kind === 'range'"><i v-if="knob.colour" class="swatch" :style="{background: knob.colour}"></i>
        <input type="range" :min="knob.low" :max="knob.high" :step="knob.step" :value="now()" :aria-label="knob.label"
          :data-testid="call + '-' + knob.key" @input="turn(Number($event.target.value))"><output>{{ short(Number(now())) }}</output></template>
      <input v-else :type="knob.kind" :value="now()" :aria-label="knob.label" :data-testid="call + '-' + knob.key" @change="turn($event.target.value)">
    </label>`,
  };

  // A text to be copied: by the button, or selected by hand where the browser does not let us.
  const Copy = {
    props: ["text", "words"],
    setup(props) {
      const field = ref(null), done = ref(false);
      async function copy() {
        field.value.select();
        try { await navigator.clipboard.writeText(props.text); done.value = true; setTimeout(() => { done.value = false; }, 1500); } catch { done.value = false; }
      }
      return { field, done, copy };
    },
    template: `<div class="copy"><input ref="field" type="text" readonly :value="text" :aria-label="words.share_link" data-testid="share-link" @focus="field.select()">
      <button data-testid="share-copy" @click="copy()">{{ done ? words.share_copied : words.share_copy }}</button></div>`,
  };

  const SHAPES = {
    back: "M15 5l-7 7 7 7", forward: "M9 5l7 7-7 7", close: "M6 6l12 12M18 6 6 18",
    first: "M6 5v14M19 5 9 12l10 7z", previous: "M17 5 7 12l10 7z", play: "M7 5l12 7-12 7z", pause: "M8 5v14M16 5v14",
    next: "M7 5l10 7-10 7z", last: "M18 5v14M5 5l10 7-10 7z", up: "M5 15l7-7 7 7", down: "M5 9l7 7 7-7", home: "M4 11l8-7 8 7v9h-5v-6h-6v6H4z",
    link: "M10 14a4 4 0 0 0 6 0l3-3a4 4 0 0 0-6-6l-1 1M14 10a4 4 0 0 0-6 0l-3 3a4 4 0 0 0 6 6l1-1",
  };
  const Icon = {
    props: ["name"],
    setup: () => ({ SHAPES }),
    template: `<svg viewBox="0 0 24 24" aria-hidden="true"><path :d="SHAPES[name]"/></svg>`,
  };

  window.castray = {
    fitted, short, clamp,
    install(app) {
      const parts = { CastrayPicture: Picture, CastrayBars: Bars, CastrayLabels: Labels, CastrayTab: Tab, CastrayIcon: Icon, CastrayKnob: Knob, CastrayCopy: Copy };
      // scripts arrive in any order: the others left word of how their parts are made
      for (const make of window.castrayParts || []) Object.assign(parts, make(this));
      for (const [name, part] of Object.entries(parts)) app.component(name, part);
    },
  };
})();
