"use strict";

// See it: what is drawn as the laboratory's controls say.
const TURN_S = 24, WOBBLE_S = 5, WOBBLE_DEGREES = 1, MOST_PIXELS = 4e6;
const CAMERA = ["around", "over", "away"];

class See extends Renderer {
  constructor(root) {
    super(live.device);
    this.root = root;
    this.stage = root.querySelector(".live-stage");
    this.control = Object.fromEntries(Array.from(root.querySelectorAll("[data-see]"), (one) => [one.dataset.see, one]));
    this.out = Object.fromEntries(Array.from(root.querySelectorAll("[data-see-out]"), (one) => [one.dataset.seeOut, one]));
    this.presets = Array.from(root.querySelectorAll("[data-preset]"));
    // Called with what was changed.
    this.followers = [];
    this.around = null;
    this.fill();
    this.listen();
    this.preset(FIRST_SCENE);
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
    this.root.querySelector("[data-live=lacks]").textContent = lacks.map((side) => `${side.toUpperCase()}, ${state[side]}, is not available in this laboratory.`).join(" ");
    this.change();
  }

  fill() {
    for (const side of ["left", "right"]) this.control[side].append(new Option(EXACT), ...grouped(live.data.codecs.map(({ label }) => [label, label])));
    for (const [at, scene] of live.data.scenes.entries()) this.add(String(at), sceneOf({ ...scene, normals: async () => unfolded(scene, await pixelsOf(scene.pixels, scene.width, scene.height)) }));
    const strip = this.control.strip, pen = penOf(strip);
    [strip.width, strip.height] = [256, 1];
    pen.putImageData(new ImageData(this.scale, 256), 0, 0);
  }

  // A scene to choose, in place of the one of that name.
  add(name, scene) {
    const { subject } = this.control, there = Array.from(subject.options).find(({ value }) => value === name);
    this.letGo(name);
    this.scenes.set(name, scene);
    if (there) there.textContent = scene.title;
    else subject.append(element("option", { value: name }, scene.title));
    if (this.seen) this.seen.key = "";
  }

  // Frees what the GPU has of a scene.
  letGo(name) {
    const { corners } = this.scenes.get(name) ?? {};
    if (corners) this.device.releaseCorners(corners);
    this.device.release(this.pictures?.get(name));
    this.pictures?.delete(name);
  }

  remove(name) {
    Array.from(this.control.subject.options).find(({ value }) => value === name)?.remove();
    this.letGo(name);
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
    const { line, flip } = this.control;
    flip.addEventListener("click", () => this.flip());
    document.addEventListener("keydown", (event) => {
      if (event.key !== " " || !this.stage.checkVisibility() || event.target.closest?.("input, select, textarea, button, summary, a")) return;
      event.preventDefault();
      this.flip();
    });
    line.addEventListener("pointerdown", (event) => {
      line.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    line.addEventListener("pointermove", (event) => line.hasPointerCapture(event.pointerId) && this.divide(event));
    new ResizeObserver(() => this.resize()).observe(this.stage);
    shows.push((state, before) => (state.a !== before.a || state.b !== before.b) && this.take(state));
    this.take(state);
  }

  // What half precision is on this device.
  async half() {
    const [half, full] = [await this.device.mantissa("mediump"), await this.device.mantissa("highp")], isThere = half < full;
    this.control.half.disabled = !isThere;
    if (!isThere) this.control.half.checked = false;
    this.out.half.textContent = isThere
      ? `mediump has ${half} mantissa bits here, highp ${full}`
      : `this device computes mediump with ${half} mantissa bits, like highp`;
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

  say() {
    const { out } = this, degrees = (name) => `${Math.round(this.value(name) * 10) / 10}°`;
    out.power.textContent = digits(2 ** this.value("power"), 4);
    out.bits.textContent = this.levels ? this.value("bits") : "as stored";
    const shown = this.control.shown.value, isDifference = shown === "difference";
    out.full.textContent = `${FULL_DEGREES[this.value("full")]}°`;
    out.most.textContent = isDifference ? `${DIFFERENCE} of 255` : `${out.full.textContent} and more`;
    // The bar of colours and the roughness are there where what is shown depends on them.
    this.control.legend.hidden = !isDifference && shown !== "error" && !(this.value("gain") && !["normals", "code"].includes(shown));
    this.control.roughness.disabled = !isDifference && shown !== "studio";
    out.gain.textContent = `${this.value("gain")}%`;
    out.roughness.textContent = this.value("roughness").toFixed(2);
    out.away.textContent = this.value("away").toFixed(2);
    out.divider.textContent = `${this.value("divider")}%`;
    for (const name of ["side", "above", "around", "over"]) out[name].textContent = degrees(name);
    for (const one of this.presets) one.setAttribute("aria-pressed", String(one.dataset.preset === this.control.subject.value));
    this.stage.style.setProperty("--at", `${this.value("divider")}%`);
    for (const [side, none] of [["left", 0], ["right", 100]]) {
      const name = this.stage.querySelector(`[data-name=${side}]`);
      name.textContent = this.control[side].value;
      name.hidden = this.value("divider") === none;
    }
    for (const follower of this.followers) follower();
  }

  change() {
    this.say();
    this.ask();
  }

  get wanted() {
    const { subject, left, right, shown, half } = this.control, phase = 2 * Math.PI * (this.isOn("wobble") ? this.wobbled : 0);
    const numbers = Object.fromEntries(["side", "above", "roughness", "bits", "away"].map((name) => [name, this.value(name)]));
    return {
      ...numbers, subject: subject.value, left: left.value, right: right.value, shown: shown.value, isHalf: half.checked,
      around: (this.around ?? this.value("around")) + WOBBLE_DEGREES * Math.sin(phase),
      over: this.value("over") + 0.5 * WOBBLE_DEGREES * Math.sin(2 * phase),
      divider: this.value("divider") / 100, power: 2 ** this.value("power"), full: FULL_DEGREES[this.value("full")], gain: this.value("gain") / 100,
    };
  }

  // By hand.
  turn(around, over) {
    this.aim({ around: this.value("around") + around, over: this.value("over") + over });
  }

  nearer(by) {
    this.aim({ away: this.value("away") * by });
  }

  divide({ clientX }) {
    const box = this.canvas.getBoundingClientRect();
    this.control.divider.value = Math.round((100 * (clientX - box.left)) / box.width);
    this.change();
  }

  // All of the picture by the left codec, then by the right one, then both: the same pixels, light and exposure.
  flip() {
    const divider = this.value("divider"), isSplit = divider > 0 && divider < 100;
    if (isSplit) this.split = divider;
    this.control.divider.value = isSplit ? 100 : divider ? 0 : this.split ?? 50;
    this.change();
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
}

live.parts.push(async (root) => {
  live.see = new See(root);
  new Orbit(live.see).hold(live.see.canvas, live.see.stage);
  // The first picture is there before anything else is begun.
  while (!live.see.first && live.see.size && !live.device.isLost) await paused(4);
  await live.see.half();
});
