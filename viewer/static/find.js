// What is laid over the picture, its legend, and the histogram with a brush.
(window.castrayParts ||= []).push((castray) => {
  const { onBeforeUnmount, onMounted, ref, watch } = window.Vue;
  const { fitted, short, clamp } = castray;
  const DIMMED = [8, 10, 14, 190], NOTHING = [70, 74, 84, 255];
  const channels = (stop) => [1, 3, 5].map((k) => parseInt(stop.slice(k, k + 2), 16));

  // where a value lies between the ends of a scale, 0 to 1
  function place(value, { low, high, log }) {
    if (log) return value > 0 ? clamp(Math.log(value / low) / Math.log(high / low), 0, 1) : 0;
    return clamp((value - low) / (high - low), 0, 1);
  }
  function colour(share, stops) {
    const at = share * (stops.length - 1), k = Math.min(Math.floor(at), stops.length - 2);
    return stops[k].map((c, i) => c + (at - k) * (stops[k + 1][i] - c));
  }
  function coloured(values, width, height, overlay) {
    const image = new ImageData(width, height), stops = overlay.stops.map(channels);
    const nothing = overlay.kind === "mask" ? DIMMED : NOTHING;
    values.forEach((value, i) => {
      const rgba = Number.isNaN(value) ? nothing : [...colour(place(value, overlay), stops), 255];
      image.data.set(rgba, 4 * i);
    });
    return image;
  }

  const Legend = {
    props: ["overlay", "words"],
    emits: ["close"],
    template: `<div class="legend-bar" role="group" :aria-label="words.overlay" data-testid="legend">
      <div class="name"><b data-testid="legend-title">{{ overlay.title }}</b>
        <button class="small" :aria-label="words.uncover" :title="words.uncover" data-testid="uncover" @click="$emit('close')">✕</button></div>
      <i class="scale" :style="{background: 'linear-gradient(to right, ' + overlay.stops.join(', ') + ')'}" aria-hidden="true"></i>
      <div class="ends number"><span data-testid="legend-low">{{ overlay.ends[0] }}</span><span class="dim">{{ overlay.log ? words.scale_log : "" }}</span>
        <span data-testid="legend-high">{{ overlay.ends[1] }}</span></div></div>`,
  };

  const Histogram = {
    props: ["bins", "low", "high", "words"],
    emits: ["brush"],
    setup(props, { emit }) {
      const canvas = ref(null), title = ref(""), from = ref(-1), to = ref(-1);
      let dragging = false;
      const most = () => Math.max(1, ...props.bins.map((b) => b.count));
      const tall = (count) => (count ? Math.log1p(count) / Math.log1p(most()) : 0); // rare ones are what is looked for
      function draw() {
        if (!canvas.value) return;
        const { box, dots, g } = fitted(canvas.value), step = box.width / props.bins.length, room = box.height - 4;
        g.setTransform(dots, 0, 0, dots, 0, 0);
        g.clearRect(0, 0, box.width, box.height);
        props.bins.forEach((bin, k) => {
          const inside = k >= from.value && k <= to.value, high = bin.count ? Math.max(2, tall(bin.count) * room) : 0;
          if (inside) { g.fillStyle = "#3a4354"; g.fillRect(k * step, 0, step, box.height); }
          g.fillStyle = inside ? "#ffd257" : "#7f95b8";
          g.fillRect(k * step + 0.5, box.height - high, Math.max(step - 1, 1), high);
        });
      }
      function follow() { [from.value, to.value] = props.low < 0 ? [-1, -1] : [props.low, props.high]; draw(); }
      const at = (event) => { const box = canvas.value.getBoundingClientRect(); return clamp(Math.floor(((event.clientX - box.left) / box.width) * props.bins.length), 0, props.bins.length - 1); };
      let anchor = 0;
      function down(event) { canvas.value.setPointerCapture(event.pointerId); dragging = true; anchor = from.value = to.value = at(event); draw(); }
      function move(event) {
        const k = at(event), bin = props.bins[k];
        title.value = `${short(bin.low)} – ${short(bin.high)}: ${bin.count}`;
        if (dragging) { [from.value, to.value] = [Math.min(anchor, k), Math.max(anchor, k)]; draw(); }
      }
      function up() { if (dragging) { dragging = false; send(); } }
      const send = () => emit("brush", [from.value, to.value]);
      function slide(which, value) {
        const last = props.bins.length - 1, k = Number(value);
        if (from.value < 0) { from.value = 0; to.value = last; }
        if (which === "low") { from.value = k; to.value = Math.max(to.value, k); } else { to.value = k; from.value = Math.min(from.value, k); }
        draw();
      }
      const sizes = new ResizeObserver(draw);
      onMounted(() => { sizes.observe(canvas.value); follow(); });
      onBeforeUnmount(() => sizes.disconnect());
      watch(() => [props.bins, props.low, props.high], follow);
      const ends = () => [from.value < 0 ? 0 : from.value, to.value < 0 ? props.bins.length - 1 : to.value];
      return { canvas, title, down, move, up, slide, send, ends, short };
    },
    template: `<div class="histogram" data-testid="histogram"><canvas ref="canvas" role="img" :aria-label="words.histogram_label" :title="title"
        data-testid="histogram-bars" @pointerdown="down" @pointermove="move" @pointerup="up"></canvas>
      <div class="ends number"><span>{{ short(bins[0].low) }}</span><span>{{ short(bins[bins.length - 1].high) }}</span></div>
      <div class="sliders"><label>{{ words.histogram_from }} <input type="range" min="0" :max="bins.length - 1" :value="ends()[0]" data-testid="brush-low"
          :aria-valuetext="short(bins[ends()[0]].low)" @input="slide('low', $event.target.value)" @change="send()"></label>
        <label>{{ words.histogram_to }} <input type="range" min="0" :max="bins.length - 1" :value="ends()[1]" data-testid="brush-high"
          :aria-valuetext="short(bins[ends()[1]].high)" @input="slide('high', $event.target.value)" @change="send()"></label></div></div>`,
  };

  const Query = {
    props: ["text", "examples", "invalid", "words"],
    emits: ["ask"],
    setup(props, { emit }) {
      const typed = ref(props.text), open = ref(false);
      let typing = false;  // an answer to what was asked before must not replace what is being typed
      watch(() => props.text, (text) => { if (!typing) typed.value = text; });
      function send() { typing = open.value = false; emit("ask", typed.value); }
      function take(example) { typed.value = example; send(); }
      const type = (is) => { typing = is; };
      return { typed, open, send, take, type };
    },
    template: `<form role="search" class="ask" :aria-label="words.find_go" @submit.prevent="send"><input v-model="typed" type="search" spellcheck="false" autocomplete="off" maxlength="2000"
        :aria-label="words.find_query" :placeholder="examples[0]" :aria-invalid="invalid" data-testid="query" @input="type(true)" @blur="type(false)">
      <button data-testid="find-go">{{ words.find_go }}</button>
      <button type="button" :aria-expanded="open" data-testid="find-examples" @click="open = !open">{{ words.find_examples }}</button></form>
      <ul v-if="open" class="examples"><li v-for="(e, k) in examples" :key="e"><button type="button" :data-testid="'example-' + k" @click="take(e)"><code>{{ e }}</code></button></li></ul>`,
  };

  castray.coloured = coloured;
  return { CastrayLegend: Legend, CastrayHistogram: Histogram, CastrayQuery: Query };
});
