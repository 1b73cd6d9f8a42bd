"use strict";

// See it: a scene whose normals go through the codecs' own targets on this GPU, one codec left of a line and one right of it. Drawn
// when something changes, and at every frame while something moves by itself.
const TURN_S = 24, WOBBLE_S = 5, WOBBLE_DEGREES = 1, MOST_PIXELS = 4e6;
// A picture that takes longer is drawn in fewer pixels while something moves, and whole after a pause.
const SLOW_MS = 45, PAUSE_MS = 150, COARSEST = 4;
const CAMERA = ["around", "over", "away"];

class See {
  constructor(root) {
    this.root = root;
    this.device = live.device;
    this.canvas = this.device.canvas;
    this.stage = root.querySelector(".live-stage");
    this.control = Object.fromEntries(Array.from(root.querySelectorAll("[data-see]"), (one) => [one.dataset.see, one]));
    this.out = Object.fromEntries(Array.from(root.querySelectorAll("[data-see-out]"), (one) => [one.dataset.seeOut, one]));
    this.presets = Array.from(root.querySelectorAll("[data-preset]"));
    this.scenes = new Map(Object.entries(SCENES));
    this.sides = { left: {}, right: {} };
    // Called with what is drawn whole, and with what was changed.
    this.listeners = [];
    this.followers = [];
    this.around = null;
    // Milliseconds that a pixel takes.
    this.cost = 0;
    this.fill();
    this.listen();
    this.preset(FIRST_SCENE);
    this.device.on("restored", () => this.restore());
    this.restore();
    this.resize();
  }

  // A stands to the left, and B or the exact normals to the right, where the laboratory has them.
  sidesOf({ a, b }) {
    const has = (name) => live.data.codecs.some(({ label }) => label === name);
    if (!has(a)) return { left: EXACT, right: (live.byLabel.get("octahedral rgba8") ?? live.data.codecs[0])?.label ?? EXACT };
    return { left: a, right: has(b) ? b : EXACT };
  }

  take(state) {
    const sides = this.sidesOf(state), lacks = CODECS.filter((side) => state[side] && !Object.values(sides).includes(state[side]));
    for (const [side, name] of Object.entries(sides)) this.control[side].value = name;
    this.root.querySelector("[data-live=lacks]").textContent = lacks.map((side) => `${side.toUpperCase()}, ${state[side]}, is not in this laboratory.`).join(" ");
    this.change();
  }

  fill() {
    for (const side of ["left", "right"]) this.control[side].append(new Option(EXACT), ...grouped(live.data.codecs.map(({ label }) => [label, label])));
    for (const [at, scene] of live.data.scenes.entries()) this.add(String(at), { ...scene, normals: async () => unfolded(scene, await pixelsOf(scene.pixels, scene.width, scene.height)) });
    fillColours(live.data.colours);
    const strip = this.control.strip, pen = penOf(strip);
    [strip.width, strip.height] = [256, 1];
    this.scale = new Uint8ClampedArray(256 * 4);
    for (let i = 0; i < 256; i++) this.scale.set([...colours.table.slice(3 * i, 3 * i + 3), 255], 4 * i);
    pen.putImageData(new ImageData(this.scale, 256), 0, 0);
  }

  // A picture of normals to choose, in place of the one of that name.
  add(name, picture) {
    const { subject } = this.control, there = Array.from(subject.options).find(({ value }) => value === name);
    this.scenes.set(name, sceneOf(picture));
    if (there) there.textContent = picture.title;
    else subject.append(element("option", { value: name }, picture.title));
    this.device.release(this.pictures?.get(name));
    this.pictures?.delete(name);
    if (this.seen) this.seen.key = "";
  }

  remove(name) {
    Array.from(this.control.subject.options).find(({ value }) => value === name)?.remove();
    this.scenes.delete(name);
  }

  // Shows a scene as it is at first.
  go(name) {
    this.control.subject.value = name;
    this.aim(this.scene.camera);
  }

  // What is mirrored all around: { width, height, pixels, brightness }, or null for the scene's own lights.
  surround(picture) {
    this.surroundings = picture;
    this.device.release(this.environment);
    this.environment = null;
    this.change();
  }

  listen() {
    for (const [name, one] of Object.entries(this.control)) {
      if (one.matches("button[aria-pressed]")) one.addEventListener("click", () => this.move(name, one.getAttribute("aria-pressed") !== "true"));
      else if (one.matches("input, select")) one.addEventListener("input", () => this.change());
    }
    this.control.subject.addEventListener("input", () => this.aim(this.scene.camera));
    for (const one of this.presets) one.addEventListener("click", () => this.preset(one.dataset.preset));
    new ResizeObserver(() => this.resize()).observe(this.stage);
    shows.push((state, before) => (state.a !== before.a || state.b !== before.b) && this.take(state));
    this.take(state);
  }

  // Everything that was on the GPU is gone, or was never there.
  restore() {
    this.colours = this.device.texture("RGBA8", 256, 1, this.scale, true);
    this.pictures = new Map();
    this.sides = { left: {}, right: {} };
    this.seen = this.back = null;
    this.environment = null;
    this.change();
  }

  // What half precision is on this device.
  async half() {
    const [half, full] = [await this.device.mantissa("mediump"), await this.device.mantissa("highp")], isThere = half < full;
    this.control.half.disabled = !isThere;
    if (!isThere) this.control.half.checked = false;
    this.out.half.textContent = isThere
      ? `mediump keeps ${half} bits of a mantissa here, highp ${full}`
      : `this device computes mediump with ${half} bits of a mantissa, as highp`;
  }

  // As many pixels as the screen has there, within a limit.
  resize() {
    const { clientWidth: width, clientHeight: height } = this.stage;
    if (!width || !height) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 3, Math.sqrt(MOST_PIXELS / (width * height)));
    const size = [width, height].map((pixels) => Math.max(1, Math.round(pixels * ratio)));
    if (this.size && size.every((pixels, axis) => pixels === this.size[axis])) return;
    this.size = size;
    this.change();
  }

  // One pixel for `coarse` x `coarse` of them.
  fit(coarse) {
    const [width, height] = this.size.map((pixels) => Math.max(1, Math.round(pixels / coarse)));
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
  }

  get scene() {
    return this.scenes.get(this.control.subject.value);
  }

  preset(name) {
    const { preset } = this.scenes.get(name);
    this.control.shown.value = preset.shown;
    this.control.roughness.value = preset.roughness;
    this.go(name);
  }

  // Where the camera is, in degrees and distance; what is not named stays.
  aim(camera) {
    const { around = this.value("around"), over = this.value("over"), away = this.value("away") } = camera;
    this.around = null;
    this.control.around.value = ((around + 540) % 360) - 180;
    this.control.over.value = over;
    this.control.away.value = away;
    this.change();
  }

  // Lets the camera turn or wobble, or stops it. Where the reader wants little motion, it wobbles once.
  move(name, isOn) {
    this.control[name].setAttribute("aria-pressed", isOn);
    this.since = null;
    if (name === "wobble") this.wobbled = 0;
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
    const { out } = this, degrees = (name) => `${Math.round(this.value(name) * 10) / 10}°`;
    out.power.textContent = digits(2 ** this.value("power"), 4);
    out.bits.textContent = this.levels ? this.value("bits") : "as stored";
    out.full.textContent = out.most.textContent = `${FULL_DEGREES[this.value("full")]}°`;
    out.gain.textContent = `${this.value("gain")} %`;
    out.roughness.textContent = this.value("roughness").toFixed(2);
    out.away.textContent = this.value("away").toFixed(2);
    out.divider.textContent = `${this.value("divider")} %`;
    for (const name of ["side", "above", "around", "over"]) out[name].textContent = degrees(name);
    for (const one of this.presets) one.setAttribute("aria-pressed", String(one.dataset.preset === this.control.subject.value));
    this.stage.style.setProperty("--at", `${this.value("divider")}%`);
    for (const side of ["left", "right"]) this.stage.querySelector(`[data-name=${side}]`).textContent = this.control[side].value;
    for (const follower of this.followers) follower();
  }

  // Draw at the next frame. While the tab is hidden there is none.
  change() {
    this.say();
    this.ask();
  }

  ask() {
    this.waiting ||= requestAnimationFrame((now) => {
      this.waiting = 0;
      if (this.isBusy) this.again = true;
      else this.draw(now);
    });
  }

  // A frame: in fewer pixels where all of them take too long, and then whole after a pause.
  async draw(now) {
    clearTimeout(this.pause);
    this.pause = 0;
    this.step(now);
    const coarse = this.coarse;
    await this.exclusively(() => this.drawn(coarse));
    if (coarse > 1 && !this.waiting) this.pause = setTimeout(() => this.rest(), PAUSE_MS);
  }

  async rest() {
    this.pause = 0;
    if (this.isBusy) this.again = true;
    else await this.exclusively(() => this.drawn(1));
  }

  // One at a time: what is asked for meanwhile is drawn next.
  async exclusively(work) {
    this.isBusy = true;
    this.again = false;
    try {
      await work();
    } finally {
      this.isBusy = false;
    }
    if (this.again || this.moves) this.ask();
  }

  get coarse() {
    const [width, height] = this.size ?? [1, 1], all = this.cost * width * height;
    return all > SLOW_MS ? Math.min(COARSEST, Math.max(2, Math.ceil(Math.sqrt(all / SLOW_MS)))) : 1;
  }

  async drawn(coarse) {
    if (!this.size || this.device.isLost) return;
    const { scene } = this;
    await this.device.compiled(...this.programs(scene));
    if (scene.isPicture && !this.pictures.has(this.control.subject.value)) await this.hang(this.control.subject.value, scene);
    // Meanwhile it may have been taken away, or another one asked for.
    if (this.device.isLost || scene !== this.scene) return;
    const began = performance.now();
    this.fit(coarse);
    this.guarded(() => this.drawAll());
    await this.device.done();
    if (this.device.isLost) return;
    if (performance.now() - began > 1) this.cost = (performance.now() - began) / (this.canvas.width * this.canvas.height);
    this.first ||= performance.now();
    // What is said of a pixel waits until nothing moves, because it is read out.
    if (coarse === 1 && !this.moves && this.listeners.length) {
      await this.device.compiled(...["left", "right"].map((side) => this.inspected(side)));
      if (!this.device.isLost) this.guarded(() => this.listeners.forEach((listener) => listener()));
    }
  }

  async hang(name, scene) {
    const { width, height } = scene, normals = await scene.normals();
    if (!this.device.isLost) this.pictures.set(name, this.device.texture("RGBA32F", width, height, normals));
  }

  get isDone() {
    return !this.pause && !this.waiting && !this.isBusy;
  }

  isOn(name) {
    return this.control[name].getAttribute("aria-pressed") === "true";
  }

  get moves() {
    return this.isOn("turn") || this.isOn("wobble");
  }

  step(now) {
    const passed = Math.min(now - (this.since ?? now), 250) / 1000;
    this.since = this.moves ? now : null;
    if (this.isOn("turn")) {
      this.around = (((this.around ?? this.value("around")) + (360 * passed) / TURN_S + 540) % 360) - 180;
      this.control.around.value = this.around;
    } else this.around = null;
    if (!this.isOn("wobble")) return;
    this.wobbled += passed / WOBBLE_S;
    if (this.wobbled > 1 && matchMedia("(prefers-reduced-motion: reduce)").matches) this.move("wobble", false);
  }

  // The camera, the light and what is shown, as uniforms.
  uniforms() {
    const { scene } = this, size = [this.canvas.width, this.canvas.height], away = this.value("away"), phase = 2 * Math.PI * (this.isOn("wobble") ? this.wobbled : 0);
    const rocked = WOBBLE_DEGREES * Math.sin(phase), nodded = 0.5 * WOBBLE_DEGREES * Math.sin(2 * phase);
    const [side, above] = [this.value("side") * RADIANS, this.value("above") * RADIANS];
    return {
      size: { ints: size }, ...slopesOf(scene, size, away),
      ...cameraOf(scene, { around: (this.around ?? this.value("around")) + rocked, over: this.value("over") + nodded, away }),
      light: [Math.sin(side) * Math.cos(above), Math.sin(above), Math.cos(side) * Math.cos(above)],
      levels: this.levels, power: 2 ** this.value("power"), roughness: this.value("roughness"), full: FULL_DEGREES[this.value("full")],
      gain: this.value("gain") / 100,
      studio: { int: this.surroundings ? -1 : scene.studio }, brightness: this.surroundings?.brightness ?? 1, backdrop: scene.backdrop ?? 0.7,
    };
  }

  // A reader's encoder may not compile with one of the page's shaders. Then it is withdrawn, and all is done without it.
  guarded(work) {
    try {
      work();
    } catch (error) {
      if (["left", "right"].every((side) => this.codec(side)?.label !== OWN)) throw error;
      this.failed(error);
      this.say();
      this.drawAll();
      work();
    }
  }

  // What a picture takes: the scene's program, those of each side, and the one that lights it. As `program` takes them.
  programs(scene) {
    return [this.scenery(scene), ...["left", "right"].flatMap((side) => this.sided(side)), this.lighting()];
  }

  scenery(scene) {
    return [null, scene.isPicture ? ["ray.frag", "pixels.frag"] : ["ray.frag", "camera.frag", scene.shader, "leave.frag"]];
  }

  lighting() {
    return [null, [...SURFACE, "angle.frag", "reflections.frag", "light.frag"], { defines: [`SHOWN ${SHOWN[this.control.shown.value]}`] }];
  }

  sided(side) {
    const codec = this.codec(side);
    if (!codec) return [[null, [...SURFACE, "decoded.frag"], { defines: ["EXACT"] }]];
    const isPacked = this.isPacked(codec), sign = codec.sign_bits ? [[codec, [...SURFACE, "encode.frag"], this.options({ isPacked: false }, "SIGNS")]] : [];
    return [[codec, [...SURFACE, "decode.frag", "decoded.frag"], this.options({ isPacked })], [codec, [...SURFACE, "encode.frag"], this.options({ isPacked })], ...sign];
  }

  // What reads one pixel of a side.
  inspected(side) {
    const codec = this.codec(side);
    return codec ? [codec, [...SURFACE, "decode.frag", "inspect.frag"], this.options({ isPacked: this.isPacked(codec) })] : [null, [...SURFACE, "inspect.frag"], { defines: ["EXACT"] }];
  }

  drawAll() {
    const uniforms = this.uniforms(), { width, height } = this.canvas, at = Math.round((width * this.value("divider")) / 100), { device } = this;
    this.surface(uniforms);
    this.back = this.sized(this.back, width, height);
    for (const [side, from, wide] of [["left", 0, at], ["right", at, width - at]]) if (wide > 0) this.drawSide(side, uniforms, [from, 0, wide, height]);
    if (this.surroundings) this.environment ??= device.panorama(this.surroundings);
    const given = { surfaces: this.seen, decoded: this.back, colours: this.colours, around: this.environment ?? this.colours };
    device.draw(device.program(...this.lighting()), null, uniforms, given);
  }

  // A target of integers of that size, the one that is there where it is.
  sized(target, width, height) {
    if (target?.width === width && target.height === height) return target;
    this.device.release(target);
    return this.device.target(this.device.gl.RGBA32UI, width, height);
  }

  // What is seen at each pixel, drawn anew only where the camera or the scene is another one.
  surface(uniforms) {
    const { device } = this, { size, slope, reach, to_view: axes, eye } = uniforms, name = this.control.subject.value;
    const key = [name, size.ints, slope, reach, axes, eye].join();
    if (this.seen?.key === key) return;
    this.seen = this.sized(this.seen, ...size.ints);
    this.seen.key = key;
    const textures = this.scene.isPicture ? { normals: this.pictures.get(name) } : {};
    device.draw(device.program(...this.scenery(this.scene)), this.seen, uniforms, textures);
  }

  drawSide(side, uniforms, scissor) {
    const codec = this.codec(side), { device } = this, made = codec ? this.encode(side, codec, uniforms, scissor) : null;
    device.draw(device.program(...this.sided(side)[0]), this.back, uniforms, codec ? this.texels(codec, made) : { surfaces: this.seen }, scissor);
  }

  options({ isPacked }, ...more) {
    return { defines: [...(isPacked ? ["PACKED"] : []), ...more], precision: this.control.half.checked ? "mediump" : "highp" };
  }

  texels(codec, made) {
    return { surfaces: this.seen, ...this.device.tablesOf(codec), code_texels: made.code, ...(codec.sign_bits ? { sign_texels: made.sign } : {}) };
  }

  // The codes of a side in a target: the codec's own where this device renders to it, else one of integers.
  encode(side, codec, uniforms, scissor) {
    const { device } = this, made = this.targets(side, codec), given = { surfaces: this.seen, ...device.tablesOf(codec) }, [, ...encoders] = this.sided(side);
    for (const [at, one] of encoders.entries()) device.draw(device.program(...one), at ? made.sign : made.code, uniforms, given, scissor);
    return made;
  }

  isPacked(codec) {
    return this.levels > 0 || !this.device.renders(codec.format);
  }

  targets(side, codec) {
    const { width, height } = this.canvas, { gl } = this.device, kept = this.sides[side], isPacked = this.isPacked(codec);
    const key = [codec.label, codec.format, width, height, isPacked].join();
    if (kept.key === key) return kept;
    for (const one of [kept.code, kept.sign]) this.device.release(one);
    const code = this.device.target(isPacked ? gl.RGBA32UI : codec.format, width, height);
    const sign = codec.sign_bits ? this.device.target(gl.R8, width, height) : null;
    return (this.sides[side] = { key, code, sign, isPacked });
  }
}

const SURFACE = ["ray.frag", "surface.frag"];

live.parts.push(async (root) => {
  live.see = new See(root);
  // The first picture is there before anything else is begun.
  while (!live.see.first && live.see.size && !live.device.isLost) await paused(4);
  await live.see.half();
});
