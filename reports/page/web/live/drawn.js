"use strict";

// The renderer: a scene whose normals go through the codecs' own targets on this GPU, one codec left of a line and one right of it. It
// has no controls. Drawn when it is asked for, and at every frame while something moves by itself.

// A picture that takes longer is drawn in fewer pixels while something moves, and whole after a pause.
const SLOW_MS = 45, PAUSE_MS = 150, COARSEST = 4;
const SURFACE = ["ray.frag", "surface.frag"];

// Whoever extends it says in `wanted` what is drawn:
//   subject: the name of a scene; left, right: codecs' labels, or EXACT; divider: where the line is, 0 to 1.
//   around, over, away: the camera, in degrees and distance; side, above: the light, in degrees.
//   shown: a name of SHOWN; roughness, power: of what is lit; full, gain: of the error in colours.
//   bits: of each number, or AS_STORED; isHalf: whether codecs compute in half precision.
class Renderer {
  constructor(device) {
    this.device = device;
    this.canvas = device.canvas;
    this.scenes = new Map(Object.entries(SCENES));
    // Called with what is drawn whole.
    this.listeners = [];
    // Milliseconds that a pixel takes.
    this.cost = 0;
    fillColours(live.data.colours);
    this.scale = new Uint8ClampedArray(256 * 4);
    for (let i = 0; i < 256; i++) this.scale.set([...colours.table.slice(3 * i, 3 * i + 3), 255], 4 * i);
    device.on("restored", () => this.restore());
  }

  // Everything that was on the GPU is gone, or was never there.
  restore() {
    this.device.renders(this.device.gl.RGBA32UI);
    this.colours = this.device.texture("RGBA8", 256, 1, this.scale, true);
    this.pictures = new Map();
    for (const scene of this.scenes.values()) scene.corners = null;
    this.sides = { left: {}, right: {} };
    this.seen = this.back = null;
    this.environment = null;
    this.change();
  }

  get scene() {
    return this.scenes.get(this.wanted.subject);
  }

  codec(side) {
    const name = this.wanted[side];
    return name === EXACT ? null : live.byLabel.get(name);
  }

  get levels() {
    const { bits } = this.wanted;
    return bits === AS_STORED ? 0 : 2 ** bits - 1;
  }

  // Draw at the next frame. While the tab is hidden there is none.
  change() {
    this.ask();
  }

  ask() {
    this.waiting ||= requestAnimationFrame((now) => {
      this.waiting = 0;
      if (this.isBusy) this.again = true;
      else this.draw(now);
    });
  }

  // What moves by itself, moved on.
  step() {}

  get moves() {
    return false;
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
    const { scene } = this, { subject } = this.wanted;
    await this.device.compiled(...this.programs(scene));
    if (scene.isPicture && !this.pictures.has(subject)) await this.hang(subject, scene);
    if (scene.triangles && !scene.corners) scene.corners = this.device.corners(scene.triangles);
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

  get isDone() {
    return !this.pause && !this.waiting && !this.isBusy;
  }

  // One pixel for `coarse` x `coarse` of them.
  fit(coarse) {
    const [width, height] = this.size.map((pixels) => Math.max(1, Math.round(pixels / coarse)));
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
  }

  async hang(name, scene) {
    const { width, height } = scene, normals = await scene.normals();
    if (!this.device.isLost) this.pictures.set(name, this.device.texture("RGBA32F", width, height, normals));
  }

  // A shader that does not compile is an error.
  guarded(work) {
    work();
  }

  // The camera, the light and what is shown, as uniforms.
  uniforms() {
    const { scene, wanted } = this, size = [this.canvas.width, this.canvas.height], [side, above] = [wanted.side * RADIANS, wanted.above * RADIANS];
    return {
      size: { ints: size }, ...slopesOf(scene, size, wanted.away), ...cameraOf(scene, wanted),
      light: [Math.sin(side) * Math.cos(above), Math.sin(above), Math.cos(side) * Math.cos(above)],
      levels: this.levels, power: wanted.power, roughness: wanted.roughness, full: wanted.full, gain: wanted.gain,
      studio: { int: this.surroundings ? -1 : scene.studio }, brightness: this.surroundings?.brightness ?? 1, backdrop: scene.backdrop ?? 0.7, exposure: scene.exposure ?? 0.6,
    };
  }

  // What a picture takes: the scene's program, those of each side, and the one that lights it. As `program` takes them.
  programs(scene) {
    return [this.scenery(scene), ...["left", "right"].flatMap((side) => this.sided(side)), this.lighting()];
  }

  scenery(scene) {
    if (scene.triangles) return [null, ["mesh.frag"], { vertex: "mesh.vert" }];
    return [null, scene.isPicture ? ["ray.frag", "pixels.frag"] : ["ray.frag", "camera.frag", scene.shader, "leave.frag"]];
  }

  lighting() {
    return [null, [...SURFACE, "angle.frag", "reflections.frag", "light.frag"], { defines: [`SHOWN ${SHOWN[this.wanted.shown]}`] }];
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
    const uniforms = this.uniforms(), { width, height } = this.canvas, at = Math.round(width * this.wanted.divider), { device } = this;
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
    const { device } = this, { size, slope, reach, to_view: axes, eye } = uniforms, name = this.wanted.subject;
    const key = [name, size.ints, slope, reach, axes, eye].join();
    if (this.seen?.key === key) return;
    this.seen = this.sized(this.seen, ...size.ints);
    this.seen.key = key;
    if (this.scene.triangles) return void device.drawCorners(device.program(...this.scenery(this.scene)), this.seen, { to_view: axes, eye, slope, depths: MESH_DEPTHS }, this.scene.corners);
    const textures = this.scene.isPicture ? { normals: this.pictures.get(name) } : {};
    device.draw(device.program(...this.scenery(this.scene)), this.seen, uniforms, textures);
  }

  drawSide(side, uniforms, scissor) {
    const codec = this.codec(side), { device } = this, made = codec ? this.encode(side, codec, uniforms, scissor) : null;
    device.draw(device.program(...this.sided(side)[0]), this.back, uniforms, codec ? this.texels(codec, made) : { surfaces: this.seen }, scissor);
  }

  options({ isPacked }, ...more) {
    return { defines: [...(isPacked ? ["PACKED"] : []), ...more], precision: this.wanted.isHalf ? "mediump" : "highp" };
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
