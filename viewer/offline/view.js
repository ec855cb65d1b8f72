// A picture and the paths of one of its pixels in 3D, drawn by the page alone: it asks nobody for anything.
// castrayView(element, data) gives {show(place)}; viewer/offline/view.py says what data holds.
window.castrayView = (element, data) => {
  const LINE = `attribute vec3 a, b; attribute vec2 corner, width; attribute vec3 colour; attribute float dash;
    uniform mat4 m; uniform vec2 size; varying vec3 tint; varying vec2 along; const float NEAR = 0.001;
    void main() {
      vec4 p = m * vec4(a, 1.0), q = m * vec4(b, 1.0);
      if (p.w < NEAR) p = mix(p, q, (NEAR - p.w) / (q.w - p.w)); else if (q.w < NEAR) q = mix(q, p, (NEAR - q.w) / (p.w - q.w));
      vec2 way = (q.xy / q.w - p.xy / p.w) * size, side = length(way) > 0.0 ? normalize(vec2(-way.y, way.x)) : vec2(0.0);
      vec4 at = mix(p, q, corner.x);
      at.xy += side * corner.y * mix(width.x, width.y, corner.x) / size * at.w;
      at.z += 0.00001 * at.w / width.x; // the thin ones do not cut the thick ones up
      gl_Position = at; tint = colour; along = vec2(distance(a, b) * corner.x, dash);
    }`;
  const STROKE = `precision mediump float; varying vec3 tint; varying vec2 along;
    void main() { if (along.y > 0.0 && fract(along.x / along.y) > 0.5) discard; gl_FragColor = vec4(tint, 1.0); }`;
  const POINT = `attribute vec3 a, colour; attribute vec2 look; uniform mat4 m; varying vec3 tint; varying float cross;
    void main() { gl_Position = m * vec4(a, 1.0); gl_PointSize = look.x; tint = colour; cross = look.y; }`;
  const DOT = `precision mediump float; varying vec3 tint; varying float cross;
    void main() { vec2 c = gl_PointCoord * 2.0 - 1.0; if (cross > 0.5 ? abs(abs(c.x) - abs(c.y)) > 0.3 : dot(c, c) > 1.0) discard; gl_FragColor = vec4(tint, 1.0); }`;
  const FACE = `attribute vec3 a, n; uniform mat4 m; uniform vec3 eye; varying float bright;
    void main() { gl_Position = m * vec4(a, 1.0); bright = abs(dot(normalize(eye - a), n)); }`;
  const SKIN = `precision mediump float; uniform vec4 colour; uniform float lit; varying float bright;
    void main() { gl_FragColor = vec4(colour.rgb * mix(1.0, 0.62 + 0.45 * bright, lit), colour.a); }`;
  const WIDE = { walked: 5, ahead: 2, others: 1, lit: 2.4, blocked: 2.4, idle: 1.4, arrow: 5 };

  const sub = (a, b) => a.map((v, k) => v - b[k]), add = (a, b, s) => a.map((v, k) => v + s * b[k]), dot = (a, b) => a.reduce((s, v, k) => s + v * b[k], 0);
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = (a) => add([0, 0, 0], a, 1 / (Math.hypot(...a) || 1));
  const clamp = (v, low, high) => Math.min(Math.max(v, low), high);
  const make = (tag, name, parent, text) => { const e = document.createElement(tag); if (name) e.className = name; if (text) e.textContent = text; parent.append(e); return e; };

  const photo = make("div", "photo", element), image = make("img", "", photo), mark = make("i", "here", photo);
  const stage = make("div", "stage", element), canvas = make("canvas", "", stage), labels = make("div", "labels", stage);
  image.alt = data.words.picture;
  canvas.tabIndex = 0;
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", data.words.stage);
  const home = button(stage, "⌂", data.words.home, () => { aim(); draw(); });
  home.classList.add("home");
  const bar = make("div", "bar", element), told = make("div", "told", element);
  told.setAttribute("aria-live", "polite");
  button(bar, "«", data.words.first, () => step(-1e9));
  button(bar, "◀", data.words.previous, () => step(-1));
  const count = make("span", "count", bar);
  button(bar, "▶", data.words.next, () => step(1));
  button(bar, "»", data.words.last, () => step(1e9));
  const other = make("span", "other", bar);
  const up = button(other, "▲", data.words.up, () => turn(-1)), number = make("span", "count", other), down = button(other, "▼", data.words.down, () => turn(1));
  const head = make("b", "", told), text = make("p", "", told);
  // a symbol as it is printed: what stands behind its _ is an index
  function named(text) {
    const [, base, index] = /^(\w)_(\w)$/.exec(text) || [null, text, ""], made = make("span", "label", labels, base);
    if (index) make("sub", "", made, index);
    return made;
  }
  function button(parent, sign, name, act) {
    const made = make("button", "", parent, sign);
    Object.assign(made, { type: "button", title: name, onclick: act });
    made.setAttribute("aria-label", name);
    return made;
  }

  const gl = canvas.getContext("webgl", { antialias: true });
  if (!gl) make("p", "none", stage, data.words.no_webgl);
  function program(vertex, fragment) {
    const made = gl.createProgram();
    [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]].forEach(([kind, source]) => {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source); gl.compileShader(shader); gl.attachShader(made, shader);
    });
    gl.linkProgram(made);
    return made;
  }
  const programs = gl && { line: program(LINE, STROKE), point: program(POINT, DOT), face: program(FACE, SKIN) };
  const place = { eye: [0, 0, 1], to: [0, 0, 0], up: [0, 1, 0] };
  let now = { place: 0, path: 0, event: 0 }, solids = [], over = [], strokes = null, dots = null, scene = -1, drag = null;

  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
  const here = () => data.places[now.place], room = () => data.scenes[here().scene], path = () => here().paths[now.path];
  function buffer(values) {
    const made = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, made);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(values), gl.STATIC_DRAW);
    return made;
  }
  const places = (mesh) => new Float32Array(bytes(mesh.points));
  // corners of every face, each with the normal of its face
  function solid(surface) {
    const points = places(surface), faces = new Uint32Array(bytes(surface.faces)), packed = [];
    for (let f = 0; f < faces.length; f += 3) {
      const [a, b, c] = [0, 1, 2].map((k) => [...points.subarray(3 * faces[f + k], 3 * faces[f + k] + 3)]);
      const n = unit(cross(sub(b, a), sub(c, a)));
      packed.push(...a, ...n, ...b, ...n, ...c, ...n);
    }
    return { ...surface, buffer: buffer(packed), count: faces.length };
  }
  function furnish() {
    if (scene === here().scene) return;
    scene = here().scene;
    if (gl) { solids.forEach((s) => gl.deleteBuffer(s.buffer)); solids = room().surfaces.map(solid); }
    aim();
  }
  // over the event at which the page opens, if it has one
  const hemisphere = () => { const there = here().over; return there && there.path === now.path && there.event === now.event ? there : null; };
  function aim() { const { position, focalPoint, viewUp } = (hemisphere() || room()).camera; Object.assign(place, { eye: [...position], to: [...focalPoint], up: [...viewUp] }); }

  function line(into, a, b, width, colour, dash = 0, tip = width) {
    const corner = [[0, -1], [1, -1], [1, 1], [0, -1], [1, 1], [0, 1]];
    for (const c of corner) into.push(...a, ...b, ...c, width, tip, ...colour, dash);
  }
  function build() {
    const lines = [], points = [], many = window.devicePixelRatio || 1, size = room().size, colours = data.colours;
    const dotted = (at, wide, colour, crossed = 0) => points.push(...at, ...colour, wide * many, crossed);
    // of two at the same depth the first is seen
    const shown = path(), event = shown.events[now.event];
    for (const [name, start, way, length] of event.arrows) {
      const neck = add(start, way, 0.78 * length);
      line(lines, start, neck, WIDE.arrow * many, colours[name]);
      line(lines, neck, add(start, way, length), 3 * WIDE.arrow * many, colours[name], 0, 0);
    }
    if (event.here) dotted(event.here, 14, colours.here);
    shown.line.slice(1).forEach((b, k) => {
      const name = k < event.reached ? "walked" : "ahead";
      line(lines, shown.line[k], b, WIDE[name] * many, colours[name]);
      if (name === "walked") dotted(b, 8, colours.walked);
    });
    for (const [outcome, p, q] of shown.lights) {
      line(lines, p, q, WIDE[outcome] * many, colours[outcome], outcome === "lit" ? 0 : 0.02 * size);
      if (outcome !== "idle") dotted(q, outcome === "lit" ? 9 : 15, colours[outcome], outcome === "blocked" ? 1 : 0);
    }
    here().paths.forEach((other, k) => { if (k !== now.path) other.line.slice(1).forEach((b, j) => line(lines, other.line[j], b, WIDE.others * many, colours.others)); });
    const lobes = hemisphere() || { meshes: [], labels: [] };
    for (const mesh of lobes.meshes.filter((m) => m.width === 2)) {
      const at = places(mesh), ends = new Uint32Array(bytes(mesh.faces)), corner = (k) => [...at.subarray(3 * ends[k], 3 * ends[k] + 3)];
      for (let k = 0; k < ends.length; k += 2) line(lines, corner(k), corner(k + 1), WIDE.others * many, mesh.colour);
    }
    over.forEach((s) => gl.deleteBuffer(s.buffer));
    over = lobes.meshes.filter((m) => m.width === 3).map(solid);
    if (strokes) [strokes, dots].forEach((s) => gl.deleteBuffer(s.buffer));
    strokes = { buffer: buffer(lines), count: lines.length / 14 };
    dots = { buffer: buffer(points), count: points.length / 8 };
    labels.replaceChildren();
    for (const [name, start, way, length] of event.arrows) Object.assign(named(data.names[name]), { at: add(start, way, 1.15 * length) }).style.color = `rgb(${colours[name].map((c) => 255 * c)})`;
    for (const { text: words, at } of lobes.labels) Object.assign(named(words), { at });
  }

  const ahead = () => unit(sub(place.to, place.eye)), aside = () => unit(cross(ahead(), place.up));
  function matrix() {
    const z = ahead(), x = aside(), y = cross(x, z), f = 1 / Math.tan((room().camera.viewAngle * Math.PI) / 360);
    const far = 4 * room().size + Math.hypot(...sub(place.eye, place.to)), near = far / 4000, ratio = canvas.width / canvas.height;
    const row = (a, s) => [...a.map((v) => v * s), -dot(a, place.eye) * s], w = row(z, 1);
    const depth = w.map((v, k) => (v * (far + near)) / (far - near) - (k === 3 ? (2 * far * near) / (far - near) : 0));
    const rows = [row(x, ratio > 1 ? f / ratio : f), row(y, ratio > 1 ? f : f * ratio), depth, w];
    return [0, 1, 2, 3].flatMap((c) => rows.map((r) => r[c]));
  }
  function attributes(used, parts, stride) {
    let offset = 0;
    for (let k = 0; k < 8; k++) gl.disableVertexAttribArray(k); // those of the program before
    for (const [name, size] of parts) {
      const at = gl.getAttribLocation(used, name);
      if (at >= 0) { gl.enableVertexAttribArray(at); gl.vertexAttribPointer(at, size, gl.FLOAT, false, 4 * stride, 4 * offset); }
      offset += size;
    }
  }
  function draw() {
    if (!gl || !stage.clientWidth) return;
    const many = window.devicePixelRatio || 1, width = Math.round(stage.clientWidth * many), height = Math.round(stage.clientHeight * many);
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    gl.viewport(0, 0, width, height);
    gl.clearColor(...data.background, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST); gl.enable(gl.BLEND); gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.enable(gl.POLYGON_OFFSET_FILL); gl.polygonOffset(1, 2);
    const m = matrix(), uniform = (used, name) => gl.getUniformLocation(used, name);
    const use = (used, made, parts, stride) => {
      gl.useProgram(used); gl.bindBuffer(gl.ARRAY_BUFFER, made.buffer); attributes(used, parts, stride);
      gl.uniformMatrix4fv(uniform(used, "m"), false, m);
    };
    gl.disable(gl.CULL_FACE);
    use(programs.point, dots, [["a", 3], ["colour", 3], ["look", 2]], 8);
    gl.drawArrays(gl.POINTS, 0, dots.count);
    use(programs.line, strokes, [["a", 3], ["b", 3], ["corner", 2], ["width", 2], ["colour", 3], ["dash", 1]], 14);
    gl.uniform2f(uniform(programs.line, "size"), width, height);
    gl.drawArrays(gl.TRIANGLES, 0, strokes.count);
    for (const s of [...over, ...solids]) { // the lobes first: nothing that is seen through hides them
      (s.culled ? gl.enable : gl.disable).call(gl, gl.CULL_FACE);
      use(programs.face, s, [["a", 3], ["n", 3]], 6);
      gl.uniform3f(uniform(programs.face, "eye"), ...place.eye);
      gl.uniform4f(uniform(programs.face, "colour"), ...s.colour, s.opacity);
      gl.uniform1f(uniform(programs.face, "lit"), s.lit ? 1 : 0);
      gl.drawArrays(gl.TRIANGLES, 0, s.count);
    }
    const taken = []; // by names further up in the list: the next ones keep off them
    for (const label of labels.children) {
      const [x, y, , w] = [0, 1, 2, 3].map((r) => m[r] * label.at[0] + m[r + 4] * label.at[1] + m[r + 8] * label.at[2] + m[r + 12]);
      label.hidden = w <= 0 || Math.max(Math.abs(x), Math.abs(y)) > 1.1 * w; // behind the eye, or what it names is out of sight
      if (label.hidden) continue;
      const tall = stage.clientHeight, wide = label.offsetWidth, left = clamp((0.5 + x / w / 2) * stage.clientWidth, 12, stage.clientWidth - 12);
      const ideal = clamp((0.5 - y / w / 2) * tall, 14, tall - 14), full = (at) => taken.some(([l, t, width]) => Math.abs(left - l) < (wide + width) / 2 && Math.abs(at - t) < 22);
      let top = ideal; // else the nearest free place below or above
      for (let k = 1; k < 100 && full(top); k++) top = clamp(ideal + (k % 2 ? 4 : -4) * Math.ceil(k / 2), 14, tall - 14);
      taken.push([left, top, wide]);
      label.style.transform = `translate(${left}px, ${top}px) translate(-50%, -50%)`;
    }
  }

  function say() {
    const event = path().events[now.event];
    head.textContent = event.head;
    text.textContent = event.text;
    count.textContent = `${now.event} / ${path().events.length - 1}`;
    number.textContent = path().head;
    up.hidden = down.hidden = here().paths.length < 2;
    photo.hidden = !here().picture;
    if (here().picture) {
      const { source, width, height } = data.pictures[here().picture - 1];
      if (image.getAttribute("src") !== source) image.src = source;
      Object.assign(mark.style, { left: `${(100 * (here().x + 0.5)) / width}%`, top: `${(100 * (here().y + 0.5)) / height}%` });
    }
    Object.assign(element.dataset, { place: here().name, path: path().index, event: now.event });
  }
  function refresh() { furnish(); say(); if (gl) { build(); draw(); } }
  function step(by) { now.event = clamp(now.event + by, 0, path().events.length - 1); refresh(); }
  function turn(by) { now.path = clamp(now.path + by, 0, here().paths.length - 1); now.event = 0; refresh(); }
  function show(k) { now = { place: k, path: data.places[k].path, event: data.places[k].event }; refresh(); }

  function orbit(dx, dy) {
    const turned = (v, axis, angle) => add(add(add([0, 0, 0], v, Math.cos(angle)), cross(axis, v), Math.sin(angle)), axis, dot(axis, v) * (1 - Math.cos(angle)));
    let arm = turned(sub(place.eye, place.to), unit(place.up), -dx / 150);
    const side = unit(cross(arm, place.up)), lean = turned(arm, side, dy / 150);
    if (Math.abs(dot(unit(lean), unit(place.up))) < 0.98) arm = lean;
    place.eye = add(place.to, arm, 1);
  }
  function pan(dx, dy) {
    const far = Math.hypot(...sub(place.eye, place.to)) / stage.clientHeight / 2, x = aside(), y = cross(x, ahead());
    for (const name of ["eye", "to"]) place[name] = add(add(place[name], x, -dx * far), y, dy * far);
  }
  function zoom(factor) { place.eye = add(place.to, sub(place.eye, place.to), factor); draw(); }
  canvas.onpointerdown = (event) => { canvas.setPointerCapture(event.pointerId); drag = [event.clientX, event.clientY]; };
  canvas.onpointermove = (event) => {
    if (!drag) return;
    (event.shiftKey || event.buttons & 6 ? pan : orbit)(event.clientX - drag[0], event.clientY - drag[1]);
    drag = [event.clientX, event.clientY];
    draw();
  };
  canvas.onpointerup = canvas.onpointercancel = () => { drag = null; };
  canvas.oncontextmenu = (event) => event.preventDefault();
  canvas.addEventListener("wheel", (event) => { event.preventDefault(); zoom(1.15 ** Math.sign(event.deltaY)); }, { passive: false });
  const KEYS = { ArrowLeft: () => step(-1), ArrowRight: () => step(1), Home: () => step(-1e9), End: () => step(1e9), ArrowUp: () => turn(-1), ArrowDown: () => turn(1), "+": () => zoom(1 / 1.15), "-": () => zoom(1.15) };
  element.addEventListener("keydown", (event) => { const act = !event.ctrlKey && !event.altKey && KEYS[event.key]; if (act) { event.preventDefault(); act(); } });
  new ResizeObserver(draw).observe(stage);
  show(data.start || 0);
  return { show };
};
