// What the scripts of the page share, and how their parts come into it.
(() => {
  const clamp = (v, low, high) => Math.min(Math.max(v, low), high);
  const short = (v) => (Number.isFinite(v) ? String(Number(v.toPrecision(5))) : Number.isNaN(v) ? "–" : v > 0 ? "∞" : "-∞");

  function fitted(canvas) {
    const box = canvas.getBoundingClientRect(), dots = window.devicePixelRatio || 1;
    const width = Math.max(1, Math.round(box.width * dots)), height = Math.max(1, Math.round(box.height * dots));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    return { box, dots, g: canvas.getContext("2d") };
  }

  // bytes of the server as numbers; they lie anywhere in its message
  const numbers = (Type, bytes) => new Type(bytes.slice().buffer);

  // a symbol as it is printed: what stands behind its _ is an index
  const symbol = (text) => { const [, base, index] = /^(\w)_(\w)$/.exec(text) || [null, text, ""]; return { base, index }; };

  window.castray = {
    fitted, short, clamp, numbers, symbol,
    install(app) {
      // scripts arrive in any order: each left word of how its parts are made
      for (const make of window.castrayParts || []) {
        for (const [name, part] of Object.entries(make(this))) app.component(name, part);
      }
    },
  };
})();
