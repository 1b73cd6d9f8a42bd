"use strict";

// See it: a scene whose normals go through the codecs' own targets on this GPU, one codec left of a line and one right of
// it. Drawn when something changes, and at every frame of the turntable.
const FULL_DEGREES = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 45, 90, 180];
const SHOWN = { lit: 0, error: 1, normals: 2, code: 3 };
const SLOPE = 0.62, SCENE = "scene", TURN_S = 24, AS_STORED = 17, RADIANS = Math.PI / 180;
const LOOKED_AT = [0, 0.75, 0];
// A picture that takes longer is drawn in a quarter of the pixels while something is moved, and whole after a pause.
const SLOW_MS = 45, PAUSE_MS = 200;

class See {
  constructor(root) {
    this.root = root;
    this.device = live.device;
    this.canvas = this.device.canvas;
    this.stage = root.querySelector(".live-stage");
    this.control = Object.fromEntries(Array.from(root.querySelectorAll("[data-see]"), (one) => [one.dataset.see, one]));
    this.out = Object.fromEntries(Array.from(root.querySelectorAll("[data-see-out]"), (one) => [one.dataset.seeOut, one]));
    this.sides = { left: {}, right: {} };
    this.listeners = [];
    this.size = [this.canvas.width, this.canvas.height];
    this.fill();
    this.listen();
    this.device.on("restored", () => this.restore());
    this.restore();
  }

  // A stands to the left, and B or the exact normals to the right, where the laboratory has them.
  take({ a, b }) {
    const has = (name) => Array.from(this.control.left.options).some((option) => option.value === name);
    if (!has(a)) return;
    this.control.left.value = a;
    this.control.right.value = has(b) ? b : EXACT;
    this.change();
  }

  fill() {
    const names = [EXACT, ...live.data.codecs.map(({ label }) => label)];
    for (const side of ["left", "right"]) this.control[side].append(...names.map((name) => element("option", {}, name)));
    this.control.subject.append(element("option", { value: SCENE }, "spheres and walls"));
    for (const [at, { title }] of live.data.scenes.entries()) this.control.subject.append(element("option", { value: at }, title));
    const first = live.data.codecs.find(({ label }) => label === "octahedral rgba8") ?? live.data.codecs[0];
    this.control.left.value = EXACT;
    this.control.right.value = first?.label ?? EXACT;
    fillColours(live.data.colours);
    const strip = this.control.strip, pen = penOf(strip);
    [strip.width, strip.height] = [256, 1];
    this.scale = new Uint8ClampedArray(256 * 4);
    for (let i = 0; i < 256; i++) this.scale.set([...colours.table.slice(3 * i, 3 * i + 3), 255], 4 * i);
    pen.putImageData(new ImageData(this.scale, 256), 0, 0);
  }

  listen() {
    for (const [name, one] of Object.entries(this.control)) {
      if (name === "turn") one.addEventListener("click", () => this.turn(one.getAttribute("aria-pressed") !== "true"));
      else if (one.matches("input, select")) one.addEventListener("input", () => this.change());
    }
    this.control.subject.addEventListener("input", () => this.resize());
    const { line } = this.control;
    line.addEventListener("pointerdown", (event) => {
      line.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    line.addEventListener("pointermove", (event) => {
      if (!line.hasPointerCapture(event.pointerId)) return;
      const box = this.canvas.getBoundingClientRect();
      this.control.divider.value = Math.round((100 * (event.clientX - box.left)) / box.width);
      this.change();
    });
    new ResizeObserver(() => this.resize()).observe(this.stage);
    shows.push((state) => this.take(state));
    this.take(state);
  }

  // Everything that was on the GPU is gone, or was never there.
  restore() {
    this.colours = this.device.texture("RGBA8", 256, 1, this.scale, true);
    this.pictures = new Map();
    this.sides = { left: {}, right: {} };
    this.half();
    this.change();
  }

  // What half precision is on this device.
  half() {
    const [half, full] = ["mediump", "highp"].map((precision) => this.device.mantissa(precision));
    const isThere = half < full;
    this.control.half.disabled = !isThere;
    if (!isThere) this.control.half.checked = false;
    this.out.half.textContent = isThere
      ? `mediump keeps ${half} bits of a mantissa here, highp ${full}`
      : `this device computes mediump with ${half} bits of a mantissa, as highp`;
  }

  // As many pixels as the screen has there, within limits, in the proportions of what is shown.
  resize() {
    const ratio = Math.min(window.devicePixelRatio || 1, 3), width = Math.max(160, Math.min(960, Math.round(this.stage.clientWidth * ratio)));
    const scene = live.data.scenes[this.control.subject.value] ?? { width: 4, height: 3 };
    const height = Math.max(1, Math.min(1280, Math.round((width * scene.height) / scene.width)));
    if (Math.abs(width - this.size[0]) < 8 && Math.abs(height - this.size[1]) < 8) return;
    this.size = [width, height];
    this.change();
  }

  // One pixel for `coarse` x `coarse` of them.
  fit(coarse) {
    const [width, height] = this.size.map((pixels) => Math.max(1, Math.round(pixels / coarse)));
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
  }

  turn(isOn) {
    this.control.turn.setAttribute("aria-pressed", isOn);
    this.since = null;
    this.change();
  }

  value(name) {
    return Number(this.control[name].value);
  }

  codec(side) {
    const name = this.control[side].value;
    return name === EXACT ? null : live.byLabel.get(name);
  }

  get levels() {
    return this.value("bits") === AS_STORED ? 0 : 2 ** this.value("bits") - 1;
  }

  say() {
    const scene = this.control.subject.value === SCENE, { out } = this;
    const degrees = (name) => `${this.value(name)}°`;
    out.power.textContent = digits(2 ** this.value("power"), 4);
    out.bits.textContent = this.levels ? this.value("bits") : "as stored";
    out.full.textContent = out.most.textContent = `${FULL_DEGREES[this.value("full")]}°`;
    out.gain.textContent = `${this.value("gain")} %`;
    out.away.textContent = (this.value("away") / 10).toFixed(2);
    out.divider.textContent = `${this.value("divider")} %`;
    for (const name of ["side", "above", "around", "over"]) out[name].textContent = degrees(name);
    for (const name of ["around", "over", "away", "turn"]) this.control[name].disabled = !scene;
    this.stage.style.setProperty("--at", `${this.value("divider")}%`);
    for (const side of ["left", "right"]) this.stage.querySelector(`[data-name=${side}]`).textContent = this.control[side].value;
  }

  // Draw at the next frame. While the tab is hidden there is none.
  change() {
    this.say();
    this.waiting ||= requestAnimationFrame((now) => {
      this.waiting = 0;
      this.step(now);
      this.answer();
      if (this.isTurning) this.change();
    });
  }

  answer() {
    clearTimeout(this.pause);
    this.pause = 0;
    if (!this.isSlow) this.whole();
    else {
      this.fit(2);
      this.draw();
      this.pause = setTimeout(() => this.whole(), PAUSE_MS);
    }
  }

  // Every pixel, and what is said of one of them.
  whole() {
    this.pause = 0;
    const began = performance.now();
    this.fit(1);
    this.draw();
    if (this.device.isLost) return;
    // What is said of a pixel waits until the turntable stops, because it is read out.
    if (!this.isTurning) this.guarded(() => this.listeners.forEach((listener) => listener()));
    // The device is done when a pixel is read back.
    this.device.finish();
    this.isSlow = performance.now() - began > SLOW_MS;
  }

  get isDone() {
    return !this.pause && !this.waiting;
  }

  get isTurning() {
    return this.control.turn.getAttribute("aria-pressed") === "true" && !this.control.turn.disabled;
  }

  step(now) {
    if (!this.isTurning) return;
    const moved = (360 * Math.min(now - (this.since ?? now), 250)) / 1000 / TURN_S;
    this.since = now;
    this.around = ((this.around ?? this.value("around")) + moved + 540) % 360 - 180;
    this.control.around.value = this.around;
  }

  // The camera's axes and place, and the light, as uniforms.
  uniforms() {
    const around = (this.isTurning ? this.around : this.value("around")) * RADIANS, over = this.value("over") * RADIANS;
    this.around = around / RADIANS;
    const back = [Math.sin(around) * Math.cos(over), Math.sin(over), Math.cos(around) * Math.cos(over)];
    const right = unit3(cross3([0, 1, 0], back)), up = cross3(back, right), away = this.value("away") / 10;
    const [side, above] = [this.value("side") * RADIANS, this.value("above") * RADIANS];
    const scene = live.data.scenes[this.control.subject.value];
    return {
      size: { ints: [this.canvas.width, this.canvas.height] },
      slope: scene?.slope ?? [SLOPE, (SLOPE * this.canvas.height) / this.canvas.width],
      // In columns: what each axis of the world is to the camera.
      to_view: [0, 1, 2].flatMap((axis) => [right[axis], up[axis], back[axis]]),
      eye: LOOKED_AT.map((at, axis) => at + back[axis] * away),
      light: [Math.sin(side) * Math.cos(above), Math.sin(above), Math.cos(side) * Math.cos(above)],
      levels: this.levels, power: 2 ** this.value("power"), full: FULL_DEGREES[this.value("full")],
      gain: this.value("gain") / 100, shown: { int: SHOWN[this.control.shown.value] },
    };
  }

  // Where normals come from: the shader's file, and its textures.
  get surface() {
    const name = this.control.subject.value;
    if (name === SCENE) return ["scene.frag", {}];
    if (!this.pictures.has(name)) this.pictures.set(name, pictureOf(this.device, live.data.scenes[name]));
    return ["pixels.frag", { normals: this.pictures.get(name) }];
  }

  draw() {
    if (this.device.isLost) return;
    this.guarded(() => this.drawSides());
  }

  // A reader's encoder may not compile with one of the page's shaders. Then it is withdrawn, and all is done without it.
  guarded(work) {
    try {
      work();
    } catch (error) {
      if (["left", "right"].every((side) => this.codec(side)?.label !== OWN)) throw error;
      this.failed(error);
      this.say();
      this.drawSides();
      work();
    }
  }

  drawSides() {
    const uniforms = this.uniforms(), at = Math.round((this.canvas.width * this.value("divider")) / 100);
    const parts = { left: [0, at], right: [at, this.canvas.width - at] };
    for (const [side, [from, width]] of Object.entries(parts)) if (width > 0) this.drawSide(side, uniforms, [from, 0, width, this.canvas.height]);
  }

  drawSide(side, uniforms, scissor) {
    const codec = this.codec(side), [surface, textures] = this.surface, shown = { ...textures, colours: this.colours };
    if (!codec) {
      const program = this.device.program(null, [surface, "angle.frag", "light.frag"], { defines: ["EXACT"] });
      this.device.draw(program, null, uniforms, shown, scissor);
      return;
    }
    const made = this.encode(side, codec, uniforms, scissor);
    const program = this.device.program(codec, [surface, "decode.frag", "angle.frag", "light.frag"], this.options(codec, made));
    this.device.draw(program, null, uniforms, { ...shown, ...this.texels(codec, made) }, scissor);
  }

  options(codec, made, ...more) {
    return { defines: [...(made.isPacked ? ["PACKED"] : []), ...more], precision: this.control.half.checked ? "mediump" : "highp" };
  }

  texels(codec, made) {
    return { ...this.device.tablesOf(codec), code_texels: made.code, ...(codec.sign_bits ? { sign_texels: made.sign } : {}) };
  }

  // The codes of a side in a target: the codec's own where this device renders to it, else one of integers.
  encode(side, codec, uniforms, scissor) {
    const { device } = this, [surface, textures] = this.surface, made = this.targets(side, codec);
    const given = { ...textures, ...device.tablesOf(codec) };
    device.draw(device.program(codec, [surface, "encode.frag"], this.options(codec, made)), made.code, uniforms, given, scissor);
    if (made.sign) device.draw(device.program(codec, [surface, "encode.frag"], this.options(codec, { isPacked: false }, "SIGNS")), made.sign, uniforms, given, scissor);
    return made;
  }

  targets(side, codec) {
    const { width, height } = this.canvas, { gl } = this.device, kept = this.sides[side];
    const key = [codec.label, codec.format, width, height, this.levels > 0].join();
    if (kept.key === key) return kept;
    for (const one of [kept.code, kept.sign]) this.device.release(one);
    const own = this.levels > 0 ? null : this.device.target(codec.format, width, height);
    const code = own ?? this.device.target(gl.RGBA32UI, width, height);
    const sign = codec.sign_bits ? this.device.target(gl.R8, width, height) : null;
    return (this.sides[side] = { key, code, sign, isPacked: !own });
  }
}

// A picture's normals as a texture, the lowest row first.
function pictureOf(device, { width, height, normals }) {
  return device.texture("RGBA32F", width, height, normals);
}

// The normals of a scene's pixels: two numbers of 12 bits, an octahedron's, and turned back.
function unfolded({ width, height }, bytes) {
  const { levels, back } = live.data.unpacking, normals = new Float32Array(4 * width * height);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const from = 4 * (y * width + x), [a, b, c, there] = bytes.subarray(from, from + 4);
      if (!there) continue;
      const e = [(a << 4) | (b >> 4), ((b & 15) << 8) | c].map((number) => (number / levels) * 2 - 1);
      const z = 1 - Math.abs(e[0]) - Math.abs(e[1]), p = e.map((number) => number - (number < 0 ? -1 : 1) * Math.max(-z, 0));
      const n = unit3([...p, z]);
      normals.set([...back.map((row) => dot3(row, n)), 1], 4 * ((height - 1 - y) * width + x));
    }
  }
  return normals;
}

live.parts.push(async (root) => {
  for (const scene of live.data.scenes) scene.normals = unfolded(scene, await pixelsOf(scene.pixels, scene.width, scene.height));
  live.see = new See(root);
});
