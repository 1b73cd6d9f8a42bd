"use strict";

// What a device does with formats and numbers: rounding, filtering, resolving, precision, NaN and small halves.

// Bits of the first channel: of fixed point, signed fixed point, or of a float's mantissa.
const PROBED = {
  RGBA8: ["unorm", 8], RGB10_A2: ["unorm", 10], RG8: ["unorm", 8], R8: ["unorm", 8],
  RG16F: ["float", 10], RGBA16F: ["float", 10], R11F_G11F_B10F: ["float", 6], RG32F: ["float", 23], RGBA32F: ["float", 23],
  RGB565: ["unorm", 5], RGBA4: ["unorm", 4], RGB5_A1: ["unorm", 5],
  RGBA8_SNORM: ["snorm", 8], RG16: ["unorm", 16], RGBA16: ["unorm", 16],
};
// Where between two steps numbers are written, a tie among them; and how many steps are tried.
const BETWEEN = [0.25, 0.49, 0.5, 0.51, 0.75], STEPS = 8;
// Positions between two texels that are filtered, and samples of a resolve.
const POSITIONS = 4096, SAMPLES = 4;

class Probe {
  constructor(device) {
    Object.assign(this, { device, gl: device.gl, textures: [], targets: [], buffers: [], programs: new Map() });
    // What is stored is to be what was written.
    this.gl.disable(this.gl.DITHER);
    for (const name of Object.keys(PROBED)) if (this.gl[name] !== undefined) device.formats[this.gl[name]] ??= name;
  }

  // The number of a format; undefined where neither WebGL2 nor an extension has it.
  number(format) {
    return Object.keys(this.device.formats).map(Number).find((number) => this.device.formats[number] === format);
  }

  // Every fact by its name: texts and numbers. `check` is called between slices, and may throw.
  async facts(check) {
    const found = {};
    try {
      for (const format of Object.keys(PROBED)) {
        Object.assign(found, await this.ofFormat(format));
        check();
      }
      for (const precision of ["highp", "mediump"]) Object.assign(found, await this.ofPrecision(precision));
      return { ...found, NaN: this.ofNaN(), "subnormal halves": this.ofSubnormals() };
    } finally {
      this.release();
    }
  }

  program(name, defines = []) {
    const key = [name, ...defines].join();
    if (!this.programs.has(key)) this.programs.set(key, this.device.link(this.device.text(null, [name], defines, "highp")));
    return this.programs.get(key);
  }

  // A target of a format by its name, one texel high; null where the device cannot render to it.
  target(format, width) {
    const number = this.number(format), target = number === undefined ? null : this.device.target(number, width, 1);
    if (target) this.targets.push(target);
    return target;
  }

  texture(numbers) {
    const made = this.device.texture("RGBA32F", numbers.length, 1, this.row(numbers));
    this.textures.push(made.texture);
    return made;
  }

  release() {
    const { gl } = this;
    for (const target of this.targets) this.device.release(target);
    for (const texture of this.textures) gl.deleteTexture(texture);
    for (const { renderbuffer, framebuffer } of this.buffers) {
      gl.deleteRenderbuffer(renderbuffer);
      gl.deleteFramebuffer(framebuffer);
    }
    for (const { program } of this.programs.values()) gl.deleteProgram(program);
  }

  // One number for each texel, in every channel.
  row(numbers) {
    return Float32Array.from({ length: 4 * numbers.length }, (_, at) => numbers[at >> 2]);
  }

  // What a program writes, as the bits of four numbers for each of `width` texels.
  read(program, width, textures) {
    const target = this.target("RGBA32UI", width);
    this.device.draw(program, target, {}, textures);
    return this.device.words(target);
  }

  // Numbers as the first channel of a format gives them back, and the target that holds them; null where it holds none.
  stored(format, numbers) {
    const target = this.target(format, numbers.length);
    if (!target) return null;
    this.device.draw(this.program("probe_write.frag"), target, {}, { given: this.texture(numbers) });
    return { target, numbers: this.first(target) };
  }

  first(texture) {
    const words = this.read(this.program("probe_read.frag"), texture.width, { codes: texture });
    return new Float32Array(words.buffer).filter((_, at) => at % 4 === 0);
  }

  async ofFormat(format) {
    const [kind, bits] = PROBED[format], step = stepOf(kind, bits), base = kind === "float" ? 1 : 0;
    const numbers = [];
    for (let i = 1; i <= STEPS; i++) for (const part of BETWEEN) numbers.push(base + (i + part) * step);
    const found = this.stored(format, numbers);
    if (!found) return { [`renders ${format}`]: "no" };
    // A float32 has no numbers between its steps.
    const rounds = bits === 23 ? "as computed" : roundingOf(Array.from(found.numbers, (value) => (value - base) / step));
    await paused();
    const filters = this.filtering(format);
    await paused();
    return { [`renders ${format}`]: "yes", [`rounds ${format}`]: rounds, [`filters ${format}`]: filters, [`resolves ${format}`]: this.resolving(format, step, base) };
  }

  // Whether a look-up between 0 and 1 gives what lies between, and how many bits its position has.
  filtering(format) {
    const { gl } = this, { target } = this.stored(format, [0, 1]);
    gl.bindTexture(gl.TEXTURE_2D, target.texture);
    for (const name of ["TEXTURE_MIN_FILTER", "TEXTURE_MAG_FILTER"]) gl.texParameteri(gl.TEXTURE_2D, gl[name], gl.LINEAR);
    const words = this.read(this.program("probe_read.frag", ["FILTERS", `POSITIONS ${POSITIONS}`]), POSITIONS, { codes: target });
    const levels = new Set(words.filter((_, at) => at % 4 === 0)).size;
    if (levels < 3) return "no";
    const fraction = Math.round(Math.log2(levels));
    return fraction >= Math.log2(POSITIONS) ? `yes, ${fraction} bits of fraction or more` : `yes, ${fraction} bits of fraction`;
  }

  // Half of four samples hold one code, half another one: what comes of them.
  resolving(format, step, base) {
    const { gl } = this, low = [], high = [];
    for (let i = 1; i <= STEPS; i++) for (const apart of [1, 2, 3]) low.push(base + i * step), high.push(base + (i + apart) * step);
    const several = this.multisampled(format, low.length), single = this.target(format, low.length);
    if (!several) return "no";
    const draw = (numbers) => this.device.draw(this.program("probe_write.frag"), several, {}, { given: this.texture(numbers) });
    draw(low);
    gl.enable(gl.SAMPLE_COVERAGE);
    gl.sampleCoverage(0.5, false);
    draw(high);
    gl.disable(gl.SAMPLE_COVERAGE);
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, several.framebuffer);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, single.framebuffer);
    gl.blitFramebuffer(0, 0, low.length, 1, 0, 0, low.length, 1, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    if (gl.getError()) return "no";
    const found = this.first(single), apart = low.map((value, at) => Math.abs(found[at] - (value + high[at]) / 2) / step);
    const most = Math.max(...apart), isMean = most <= 0.5 + 1e-3;
    return isMean ? `the mean of the codes, to within ${Number(most.toFixed(2))} steps` : `up to ${Number(most.toFixed(2))} steps from the mean of the codes`;
  }

  multisampled(format, width) {
    const { gl } = this, internal = this.number(format);
    const most = (gl.getInternalformatParameter(gl.RENDERBUFFER, internal, gl.SAMPLES) ?? []);
    if (!Array.from(most).includes(SAMPLES)) return null;
    const renderbuffer = gl.createRenderbuffer(), framebuffer = gl.createFramebuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, renderbuffer);
    gl.renderbufferStorageMultisample(gl.RENDERBUFFER, SAMPLES, internal, width, 1);
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.RENDERBUFFER, renderbuffer);
    const isWhole = gl.checkFramebufferStatus(gl.FRAMEBUFFER) === gl.FRAMEBUFFER_COMPLETE;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    this.buffers.push({ renderbuffer, framebuffer });
    return isWhole ? { framebuffer, width, height: 1 } : null;
  }

  async ofPrecision(precision) {
    const { gl } = this, asked = { highp: gl.HIGH_FLOAT, mediump: gl.MEDIUM_FLOAT }[precision];
    const bits = await this.device.mantissa(precision);
    const promised = gl.getShaderPrecisionFormat(gl.FRAGMENT_SHADER, asked)?.precision ?? 0;
    return { [`${precision} mantissa bits`]: bits, [`${precision} mantissa bits, as the driver says`]: promised };
  }

  ofNaN() {
    const given = this.texture([NaN]), words = this.read(this.program("probe_nan.frag"), 1, { given });
    const [least, most, clamped] = new Float32Array(words.buffer), seen = words[3];
    const said = [`isnan ${seen & 1 ? "sees it" : "does not see it"}`, `NaN != NaN is ${seen & 2 ? "true" : "false"}`];
    said.push(`min(NaN, 1) is ${least}`, `max(NaN, 0) is ${most}`, `clamp(NaN, 0, 1) is ${clamped}`);
    for (const format of ["RGBA16F", "RGBA8"]) {
      const found = this.stored(format, [NaN]);
      if (found) said.push(`${format} stores ${found.numbers[0]}`);
    }
    return said.join("; ");
  }

  // The least half above zero is 2^-24; those below 2^-14 have fewer bits.
  ofSubnormals() {
    const numbers = [2 ** -24, 3 * 2 ** -24, 2 ** -20], found = this.stored("RGBA16F", numbers);
    if (!found) return "RGBA16F cannot be rendered to";
    if (numbers.every((number, at) => found.numbers[at] === number)) return "kept";
    return found.numbers.every((number) => number === 0) ? "flushed to 0" : `stored as ${Array.from(found.numbers).join(", ")}`;
  }
}

function stepOf(kind, bits) {
  if (kind === "float") return 2 ** -bits;
  return 1 / (2 ** (kind === "snorm" ? bits - 1 : bits) - 1);
}

// How numbers that lie between steps came back, in steps: STEPS times those of BETWEEN.
function roundingOf(found) {
  const whole = (i, part) => Math.round(found[BETWEEN.length * (i - 1) + BETWEEN.indexOf(part)]) - i;
  const every = (part, wanted) => Array.from({ length: STEPS }, (_, at) => at + 1).every((i) => whole(i, part) === wanted(i));
  const sides = [0.25, 0.49, 0.51, 0.75];
  if (found.some((value) => Math.abs(value - Math.round(value)) > 0.05)) return "other";
  if ([...sides, 0.5].every((part) => every(part, () => 0))) return "truncate";
  if (!sides.every((part) => every(part, () => (part < 0.5 ? 0 : 1)))) return "other";
  if (every(0.5, (i) => i % 2)) return "nearest, ties to even";
  return every(0.5, () => 1) ? "nearest, ties up" : "nearest";
}
