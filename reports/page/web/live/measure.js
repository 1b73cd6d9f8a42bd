"use strict";

// Codes of this device: normals encoded into a codec's own render target by its shaders, read back, and decoded again.

const WORD_TARGETS = { 1: "R32UI", 2: "RG32UI", 4: "RGBA32UI" };
// Of the bits of a half float, from float32's: the exponent's bias goes from 127 to 15, and below 2^-14 numbers count steps.
const HALF_SHIFT = 0x38000000, HALF_NORMAL = 0x38800000, HALF_INFINITE = 0x47800000;

// Bits of a float32 that a float of fewer bits holds exactly, as the integer that counts that format's numbers from 0 on.
function smallFloat(word, mantissa) {
  const magnitude = word & 0x7fffffff;
  if (magnitude >= HALF_INFINITE) return 31 << mantissa;
  if (magnitude >= HALF_NORMAL) return (magnitude - HALF_SHIFT) >>> (23 - mantissa);
  const view = new DataView(new ArrayBuffer(4));
  view.setUint32(0, magnitude);
  return view.getFloat32(0) * 2 ** (14 + mantissa);
}

// What a shader read from a target, as an integer in the order of the numbers: of fixed-point steps, or of float32's bits.
function placeRead(word, channel) {
  if (channel.kind !== "float") return word | 0;
  if (channel.bits === 32) return placeOf(channel, false, word);
  const steps = smallFloat(word, MANTISSA[channel.bits]);
  return word >>> 31 ? -steps : steps;
}

// The angle between a normal and what came back, in degrees; 180 where that is not a number.
function degreesBack(n, at, back, from) {
  const [a, b, c] = [n[at], n[at + 1], n[at + 2]], [x, y, z] = [back[from] - a, back[from + 1] - b, back[from + 2] - c];
  const across = Math.hypot(b * z - c * y, c * x - a * z, a * y - b * x);
  const degrees = (Math.atan2(across, a * back[from] + b * back[from + 1] + c * back[from + 2]) * 180) / Math.PI;
  return Number.isFinite(degrees) ? degrees : 180;
}

// The texels of a target of RGBA32UI or fewer, four words each, once the GPU is done: the page does not wait for it.
async function wordsLater(device, { framebuffer, width, height }) {
  const { gl } = device, found = new Uint32Array(4 * width * height), buffer = gl.createBuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  gl.bindBuffer(gl.PIXEL_PACK_BUFFER, buffer);
  gl.bufferData(gl.PIXEL_PACK_BUFFER, found.byteLength, gl.STREAM_READ);
  gl.readPixels(0, 0, width, height, gl.RGBA_INTEGER, gl.UNSIGNED_INT, 0);
  gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
  await device.done();
  gl.bindBuffer(gl.PIXEL_PACK_BUFFER, buffer);
  gl.getBufferSubData(gl.PIXEL_PACK_BUFFER, 0, found);
  gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
  gl.deleteBuffer(buffer);
  return found;
}

// What every codec is given on a device: normals and views of its domain as textures. Of one context: when that is lost,
// new ones are made.
class Inputs {
  constructor(device, normals) {
    Object.assign(this, { device, normals, side: Math.sqrt(normals.common.count), made: new Map() });
    // What is stored is to be what was written.
    device.gl.disable(device.gl.DITHER);
  }

  of(domain) {
    if (!this.made.has(domain)) {
      const { n, view } = this.normals.of(domain), texture = (all) => this.device.texture("RGBA32F", this.side, this.side, all);
      this.made.set(domain, { normals: texture(n), views: texture(view) });
    }
    return this.made.get(domain);
  }

  release() {
    for (const both of this.made.values()) for (const { texture } of Object.values(both)) this.device.gl.deleteTexture(texture);
    this.made.clear();
  }
}

// One codec on a device: its passes at `side` by `side` texels.
class CodecOnDevice {
  constructor(inputs, codec) {
    Object.assign(this, { inputs, codec, device: inputs.device, side: inputs.side, targets: [], programs: [] });
    this.target = this.own(codec.format, this.side);
    this.packs = !this.target;
    this.target ??= this.own(this.words, this.side);
    this.given = { ...inputs.of(codec.domain), ...this.device.tablesOf(codec) };
  }

  // The format of codes that the shader packs.
  get words() {
    return this.device.gl[WORD_TARGETS[this.codec.words]];
  }

  // What a page calls the format of the target.
  get format() {
    return this.target.name;
  }

  // A target that is released with the codec; null where the device cannot render to it.
  own(format, side) {
    const target = this.device.target(format, side, side);
    if (target) this.targets.push(target);
    return target;
  }

  // A program that is released with the codec; one that needs none of the codec's functions is not given them.
  program(name, { packs = this.packs, needsCodec = true, defines = [] } = {}) {
    const all = [`BLOCK ${this.side}`, ...(packs ? ["PACKED"] : []), ...defines];
    const parts = ["measure_given.glsl", name], made = this.device.link(this.device.text(needsCodec ? this.codec : null, parts, all, "highp"));
    this.programs.push(made);
    return made;
  }

  draw(program, target, textures = {}) {
    this.device.draw(program, target, {}, { ...this.given, ...textures });
  }

  // Codes as integers in the order of their numbers, as many for each normal as are stored: as the shader packs them.
  async packedCodes() {
    const target = this.packs ? this.target : this.own(this.words, this.side), program = this.program("measure_encode.frag", { packs: true });
    await paused();
    this.draw(program, target);
    return this.places(await wordsLater(this.device, target), true);
  }

  // The same as the codec's own render target has them.
  async targetCodes() {
    const { channels, bytes } = this.codec, scale = (at) => (bytes ? 255 : (channels[at]?.integer ?? 1)).toFixed(1);
    const kind = channels[0].kind === "float" ? "FLOATS" : `SCALES vec4(${[0, 1, 2, 3].map(scale).join(", ")})`;
    const [encode, read] = [this.program("measure_encode.frag"), this.program("measure_read.frag", { needsCodec: false, defines: [kind] })];
    await paused();
    this.draw(encode, this.target);
    this.draw(read, this.bits(), { codes: this.target });
    return this.places(await wordsLater(this.device, this.bits()), false);
  }

  // The numbers of codes before they are stored, four for each normal.
  async exactNumbers() {
    const program = this.program("measure_exact.frag");
    await paused();
    this.draw(program, this.bits());
    return new Float32Array((await wordsLater(this.device, this.bits())).buffer);
  }

  bits() {
    return (this.read ??= this.own(this.device.gl.RGBA32UI, this.side));
  }

  places(words, packs) {
    const { channels, bytes } = this.codec, size = channels.length, found = new Int32Array((words.length / 4) * size);
    const read = bytes ? acrossBytes(channels, bytes, packs) : packs ? fromWords(channels) : fromTarget(channels);
    for (let i = 0; i < words.length / 4; i++) for (let c = 0; c < size; c++) found[size * i + c] = read(words, 4 * i, c);
    return found;
  }

  // The mean and the largest angle, in degrees, between normals and what this device decodes from its own texels.
  async angles() {
    const program = this.program("measure_decode.frag"), { n } = this.inputs.normals.of(this.codec.domain);
    await paused();
    this.draw(program, this.bits(), { codes: this.target });
    const back = new Float32Array((await wordsLater(this.device, this.bits())).buffer);
    await paused();
    let sum = 0, most = 0;
    for (let at = 0; at < n.length; at += 4) {
      const degrees = degreesBack(n, at, back, at);
      sum += degrees;
      most = Math.max(most, degrees);
    }
    return { mean: sum / (n.length / 4), most };
  }

  release() {
    for (const { program } of this.programs) this.device.gl.deleteProgram(program);
    for (const target of this.targets) this.device.release(target);
  }
}

function fromTarget(channels) {
  return (words, at, c) => placeRead(words[at + c], channels[c]);
}

function fromWords(channels) {
  const masks = channels.map(({ bits }) => (bits < 32 ? 2 ** bits - 1 : 0xffffffff));
  return (words, at, c) => {
    const { first } = channels[c];
    return placeOf(channels[c], false, ((words[at + (first >>> 5)] >>> (first & 31)) & masks[c]) >>> 0);
  };
}

// Numbers laid across bytes: the bytes read as one number, the first byte the highest.
function acrossBytes(channels, count, packs) {
  const byte = (words, at, b) => (packs ? (words[at] >>> (8 * b)) & 255 : words[at + b] & 255);
  return (words, at, c) => {
    let joined = 0;
    for (let b = 0; b < count; b++) joined = ((joined << 8) | byte(words, at, b)) >>> 0;
    return (joined >>> channels[c].first) & (2 ** channels[c].bits - 1);
  };
}
