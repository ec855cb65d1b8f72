// The hemisphere over a vertex, the plane of incidence, and a ray's start to the scale of an ulp.
(window.castrayParts ||= []).push((castray) => {
  const { onBeforeUnmount, onMounted, ref, watch } = window.Vue;
  const { fitted, symbol } = castray;
  const COLOURS = { n: "#8ff5a8", ng: "#9a62ea", wo: "#66b8ff", wi: "#f07f2c", h: "#d93678", f: "#ffd257", p: "#5fc7d8" };
  const DOTS = { bounce: "#f07f2c", lit: "#ffd92e", blocked: "#f0406a", idle: "#a9b2c2" };

  // a canvas that is drawn again when it is resized or told something else
  function drawing(paint, told) {
    const canvas = ref(null);
    function draw() {
      if (!canvas.value) return;
      const { box, dots, g } = fitted(canvas.value);
      g.setTransform(dots, 0, 0, dots, 0, 0);
      g.clearRect(0, 0, box.width, box.height);
      paint(g, box.width, box.height);
    }
    const sizes = new ResizeObserver(draw);
    onMounted(() => { sizes.observe(canvas.value); draw(); });
    onBeforeUnmount(() => sizes.disconnect());
    watch(told, draw);
    return canvas;
  }

  function shade(values, ramp) {
    const side = Math.sqrt(values.length), sheet = document.createElement("canvas"), image = new ImageData(side, side);
    values.forEach((v, i) => image.data.set([...ramp.map((c) => 22 + ((c - 22) * v) / 255), 255], 4 * i));
    Object.assign(sheet, { width: side, height: side });
    sheet.getContext("2d").putImageData(image, 0, 0);
    return sheet;
  }
  function disc(g, x, y, r, paint) {
    g.save();
    g.beginPath(); g.arc(x, y, r, 0, 7); g.clip();
    paint();
    g.restore();
    g.strokeStyle = "#667286"; g.lineWidth = 1;
    for (const degrees of [30, 60, 90]) { g.beginPath(); g.arc(x, y, r * Math.sqrt(1 - Math.cos((degrees * Math.PI) / 180)), 0, 7); g.globalAlpha = degrees === 90 ? 1 : 0.35; g.stroke(); }
    g.globalAlpha = 1;
  }
  function spot(g, x, y, size, colour, hollow) {
    g.beginPath(); g.arc(x, y, size, 0, 7);
    if (hollow) { g.strokeStyle = colour; g.lineWidth = 1.4; g.stroke(); return; }
    g.fillStyle = colour; g.fill(); g.strokeStyle = "#0b0d11"; g.lineWidth = 0.7; g.stroke();
  }
  const FONT = 'px "STIX Two Math", serif', TALL = 13, APART = 12;
  // a name beside its point, or where another stands already left of it or below
  function name(g, text, x, y, colour, width, taken = []) {
    const { base, index } = symbol(text);
    g.font = TALL + FONT; g.textAlign = "left";
    const wide = g.measureText(base).width, all = wide + (index ? 6 : 0), left = x > width - 24;
    const near = left ? x - all : x, far = x - all - 10, places = [[near, y], [far, y], [near, y + 17], [far, y + 17]];
    const free = ([a, b]) => taken.every(([c, d, w]) => Math.abs(b - d) >= APART || a + all < c || c + w < a);
    const [a, b] = places.find(free) || places[0];
    taken.push([a, b, all]);
    const put = (words, at, low) => { g.lineWidth = 3; g.strokeStyle = "#0b0d11"; g.strokeText(words, at, low); g.fillStyle = colour; g.fillText(words, at, low); };
    put(base, a, b);
    if (index) { g.font = 10 + FONT; put(index, a + wide, b + 3); }
  }

  const Lens = {
    props: ["lens", "label"],
    emits: ["go"],
    setup(props, { emit }) {
      const title = ref("");
      let spots = []; // where each direction that was tried is drawn
      const place = (width, height) => { const step = width / 2, r = Math.min(step, height / props.lens.discs.length - 18) / 2 - 4; return { step, r, row: height / props.lens.discs.length }; };
      function paint(g, width, height) {
        const { step, r, row } = place(width, height);
        spots = [];
        props.lens.discs.forEach((one, k) => {
          const y = k * row + r + 4;
          one.sheets.forEach((sheet, j) => {
            const x = (j + 0.5) * step;
            disc(g, x, y, r, () => g.drawImage(shade(sheet.values, j ? [95, 199, 216] : [255, 210, 87]), x - r, y - r, 2 * r, 2 * r));
            for (const dot of one.dots) {
              const at = [x + r * dot.at[0], y + r * dot.at[1]];
              spot(g, ...at, 2.6, DOTS[dot.kind], dot.kind !== "bounce" && dot.kind !== "lit");
              spots.push({ at, dot });
            }
            const taken = [];
            for (const mark of one.marks) {
              const mx = x + r * mark.at[0], my = y + r * mark.at[1];
              spot(g, mx, my, 3.4, COLOURS[mark.name], false);
              if (!j) name(g, mark.symbol, mx + 5, my - 4, COLOURS[mark.name], width, taken);
            }
          });
          g.font = "11px system-ui, sans-serif"; g.fillStyle = "#9aa4b5"; g.textAlign = "center";
          one.sheets.forEach((sheet, j) => g.fillText(sheet.title, (j + 0.5) * step, k * row + 2 * r + 20, step - 4));
        });
      }
      const canvas = drawing(paint, () => props.lens);
      function near(event) {
        const box = canvas.value.getBoundingClientRect(), x = event.clientX - box.left, y = event.clientY - box.top;
        const far = ({ at }) => Math.hypot(at[0] - x, at[1] - y);
        const best = spots.reduce((a, b) => (a && far(a) <= far(b) ? a : b), null);
        return best && far(best) < 8 ? best.dot : null;
      }
      const click = (event) => { const dot = near(event); if (dot) emit("go", dot.place); };
      const move = (event) => { const dot = near(event); title.value = dot ? `${dot.place[0]} · ${dot.place[1]}` : ""; };
      return { canvas, click, move, title };
    },
    template: `<canvas ref="canvas" class="lens" role="img" :class="{both: lens.discs.length > 1}" :aria-label="label" :title="title" data-testid="lens" @click="click" @pointermove="move"></canvas>`,
  };

  // cells of equal solid angle: red where more bounces went than p says, blue where fewer
  const Cells = {
    props: ["lens", "label"],
    setup(props) {
      function paint(g, width, height) {
        const [rings, sectors] = props.lens.cells, row = height / props.lens.discs.length, r = Math.min(width, row) / 2 - 3, x = width / 2;
        props.lens.discs.forEach((one, k) => disc(g, x, (k + 0.5) * row, r, () => {
          const y = (k + 0.5) * row;
          one.off.forEach((off, i) => {
            const ring = Math.floor(i / sectors), turn = (2 * Math.PI) / sectors, from = (i % sectors) * turn;
            const share = Math.min(Math.abs(off) / props.lens.strange, 1) ** 2, colour = off > 0 ? [255, 122, 112] : [102, 140, 255];
            g.beginPath(); g.arc(x, y, r * Math.sqrt((ring + 1) / rings), from, from + turn); g.arc(x, y, r * Math.sqrt(ring / rings), from + turn, from, true); g.closePath();
            g.fillStyle = `rgb(${colour.map((c) => 30 + (c - 30) * share).join(",")})`; g.fill(); g.strokeStyle = "#39414f"; g.lineWidth = 0.6; g.stroke();
          });
          g.fillStyle = "#e8ebf0"; g.globalAlpha = 0.75;
          for (const [a, b] of one.drawn) g.fillRect(x + r * a - 0.6, y + r * b - 0.6, 1.2, 1.2);
          g.globalAlpha = 1;
        }));
      }
      return { canvas: drawing(paint, () => props.lens) };
    },
    template: `<canvas ref="canvas" class="cells" role="img" :class="{both: lens.discs.length > 1}" :aria-label="label" data-testid="cells"></canvas>`,
  };

  const Plane = {
    props: ["plane", "label"],
    setup(props) {
      function paint(g, width, height) {
        const { angles, curves, vectors, up } = props.plane, all = angles[0] < -90;
        const r = all ? height / 2 - 12 : Math.min(width / 2 - 30, height - 26), x = width / 2, y = all ? height / 2 : height - 8;
        const at = (a, share) => [x + r * share * Math.sin((a * Math.PI) / 180), y - r * share * Math.cos((a * Math.PI) / 180)];
        g.strokeStyle = "#39414f"; g.lineWidth = 1;
        g.beginPath(); g.moveTo(x - r - 14, y); g.lineTo(x + r + 14, y); g.strokeStyle = "#9aa4b5"; g.stroke(); g.strokeStyle = "#39414f";
        g.beginPath(); g.arc(x, y, r, all ? 0 : Math.PI, all ? 7 : 0); g.stroke();
        for (const a of all ? [-150, -120, -60, -30, 30, 60, 120, 150] : [-60, -30, 0, 30, 60]) { g.beginPath(); g.moveTo(x, y); g.lineTo(...at(a, 1)); g.stroke(); }
        curves.forEach((curve, k) => {
          g.beginPath();
          curve.forEach((v, i) => g[i ? "lineTo" : "moveTo"](...at(angles[i], v)));
          if (all) g.closePath();
          g.strokeStyle = k ? COLOURS.p : COLOURS.f; g.fillStyle = g.strokeStyle; g.lineWidth = 1.8; g.setLineDash(k ? [5, 4] : []); g.stroke(); g.setLineDash([]);
          g.globalAlpha = 0.1; g.fill(); g.globalAlpha = 1;
        });
        const taken = [];
        for (const v of vectors) {
          const end = [x + r * v.at[0], y - r * v.at[1] * up];
          g.strokeStyle = COLOURS[v.name]; g.lineWidth = 2; g.beginPath(); g.moveTo(x, y); g.lineTo(...end); g.stroke();
          spot(g, ...end, 3, COLOURS[v.name], false);
          name(g, v.symbol, end[0] + 5, Math.max(end[1] - 4, 12), COLOURS[v.name], width, taken);
        }
      }
      return { canvas: drawing(paint, () => props.plane) };
    },
    template: `<canvas ref="canvas" class="plane" role="img" :class="{both: plane.angles[0] < -90}" :aria-label="label" data-testid="plane"></canvas>`,
  };

  const Ruler = {
    props: ["ruler", "label"],
    setup(props) {
      function scale(g, low, high, y, width) {
        const to = (v) => 12 + ((v - low) / (high - low)) * (width - 24), step = [1, 2, 5, 10, 20, 50, 100, 1000, 1e4, 1e5].find((s) => (high - low) / s <= 60) || high - low;
        g.strokeStyle = "#667286"; g.lineWidth = 1; g.fillStyle = "#9aa4b5"; g.font = "10px system-ui, sans-serif"; g.textAlign = "center";
        g.beginPath(); g.moveTo(8, y); g.lineTo(width - 8, y); g.stroke();
        for (let v = Math.ceil(low / step) * step, k = 0; v <= high; v += step, k++) {
          const long = v === 0 || Math.round(v / step) % 10 === 0;
          g.beginPath(); g.moveTo(to(v), y - (long ? 6 : 3)); g.lineTo(to(v), y + (long ? 6 : 3)); g.stroke();
          if (long) g.fillText(`${v} ulp`, to(v), y + 17);
        }
        return to;
      }
      function paint(g, width) {
        const { point, offset, start, beyond } = props.ruler, high = Math.max(start, point + offset, 4) * 1.08, low = Math.min(point, 0, -high / 12) * 1.1;
        const to = scale(g, low, high, 34, width);
        g.fillStyle = "#66b8ff40"; g.fillRect(to(point), 26, to(point + offset) - to(point), 16);
        g.fillStyle = "#e8ebf0"; g.fillRect(to(0) - 1.5, 22, 3, 19);
        spot(g, to(point), 34, 4, "#8ff5a8", false);
        spot(g, to(start), 34, 4, "#f07f2c", false);
        name(g, "p", to(point) + 4, 14, "#8ff5a8", width);
        name(g, "o", to(start) - 4, 14, "#f07f2c", width);
        if (beyond === null) return;
        const most = Math.max(4, Math.abs(beyond) * 1.3), end = scale(g, -most, most, 84, width);
        g.fillStyle = "#ffd92e"; g.fillRect(end(0) - 1.5, 72, 3, 19);
        spot(g, end(beyond), 84, 4, beyond < 0 ? "#ff6b5e" : "#ffd92e", false);
        const taken = [];
        name(g, "q", end(0) + 5, 70, "#ffd92e", width, taken);
        name(g, "t", end(beyond) + (beyond < 0 ? -10 : 6), 78, "#ff6b5e", width, taken);
      }
      return { canvas: drawing(paint, () => props.ruler) };
    },
    template: `<canvas ref="canvas" class="ruler" role="img" :class="{two: ruler.beyond !== null}" :aria-label="label" data-testid="ruler"></canvas>`,
  };

  return { CastrayLens: Lens, CastrayCells: Cells, CastrayPlane: Plane, CastrayRuler: Ruler };
});
