// Small parts that are used here and there: bars of the samples, knobs, a text to copy, signs on buttons.
(window.castrayParts ||= []).push((castray) => {
  const { inject, onBeforeUnmount, onMounted, ref, watch } = window.Vue;
  const { fitted, short, clamp } = castray;

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
        g.clearRect(0, 0, box.width + 1, box.height + 1); // its height may be a broken number
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
    template: `<label class="knob" :class="{noted: knob.note}" :title="knob.title"><span class="name">{{ knob.label }}</span>
      <select v-if="knob.kind === 'choice'" :value="now()" :aria-label="knob.label" :data-testid="call + '-' + knob.key" @change="turn($event.target.value)">
        <option v-for="choice in knob.choices" :key="choice.value" :value="choice.value">{{ choice.text }}</option></select>
      <template v-else-if="knob.kind === 'range'"><i v-if="knob.colour" class="swatch" :style="{background: knob.colour}"></i>
        <input type="range" :min="knob.low" :max="knob.high" :step="knob.step" :value="now()" :aria-label="knob.label"
          :data-testid="call + '-' + knob.key" @input="turn(Number($event.target.value))"><output>{{ short(Number(now())) }}</output></template>
      <input v-else :type="knob.kind" :value="now()" :aria-label="knob.label" :data-testid="call + '-' + knob.key" @change="turn($event.target.value)">
      <span v-if="knob.note" class="dim">{{ knob.note }}</span>
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

  // a command, whose words are not broken at their hyphens
  const Command = {
    props: ["text"],
    template: `<code class="command"><template v-for="(word, k) in text.split(' ')" :key="k">{{ k ? " " : "" }}<span>{{ word }}</span></template></code>`,
  };

  const Symbol = {
    props: ["text"],
    setup: () => ({ symbol: castray.symbol }),
    template: `<span>{{ symbol(text).base }}<sub v-if="symbol(text).index">{{ symbol(text).index }}</sub></span>`,
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

  return { CastrayBars: Bars, CastrayKnob: Knob, CastrayCopy: Copy, CastrayCommand: Command, CastraySymbol: Symbol, CastrayIcon: Icon };
});
