"use strict";

// Codes of this device: normals encoded into a codec's own render target by its shaders, read back, and decoded again.

const WORD_TARGETS = { 1: "R32UI", 2: "RG32UI", 4: "RGBA32UI" };
// Of the bits of a half float, from float32's: the exponent's bias goes from 127 to 15, and below 2^-14 numbers count steps.
const HALF_SHIFT = 0x38000000, HALF_NORMAL = 0x38800000, HALF_INFINITE = 0x47800000;

function defined(macros) {
  return Object.entries(macros).map(([name, value]) => `#define ${name} ${value}\n`).join("");
}

// Bits of a float32 that a float of fewer bits holds exactly, as the integer that counts that format's numbers from 0 on.
function smallFloat(word, mantissa) {
  const magnitude = word & 0x7fffffff;
  if (magnitude >= HALF_INFINITE) return 31 << mantissa;
  if (magnitude >= HALF_NORMAL) return (magnitude - HALF_SHIFT) >>> (23 - mantissa);
  const view = new DataView(new ArrayBuffer(4));
  view.setUint32(0, magnitude);
  return view.getFloat32(0) * 2 ** (14 + mantissa);
}

// The bits of one number of a code, as an integer in the order of the numbers that they stand for.
function ordered(bits, channel) {
  const { kind, is_across } = channel, size = channel.bits;
  if (kind === "unorm" || is_across || (kind === "float" && size < 16)) return bits | 0;
  const isNegative = (bits >>> (size - 1)) & 1;
  if (kind === "snorm") return isNegative ? (size < 32 ? bits - 2 ** size : bits | 0) : bits;
  const magnitude = size < 32 ? bits & (2 ** (size - 1) - 1) : bits & 0x7fffffff;
  return isNegative ? -magnitude : magnitude;
}

// What a shader read from a target, as the same integer: fixed-point integers, or the bits of float32.
function orderedRead(word, channel) {
  if (channel.kind === "unorm") return word;
  if (channel.kind === "snorm") return word | 0;
  if (channel.bits === 32) return ordered(word, channel);
  const steps = smallFloat(word, { 16: 10, 11: 6, 10: 5 }[channel.bits]);
  return word >>> 31 ? -steps : steps;
}

// The angle between a normal and what came back, in degrees; 180 where that is not a number.
function angleBetween(n, at, back, from) {
  const [a, b, c] = [n[at], n[at + 1], n[at + 2]], [x, y, z] = [back[from] - a, back[from + 1] - b, back[from + 2] - c];
  const across = Math.hypot(b * z - c * y, c * x - a * z, a * y - b * x);
  const degrees = (Math.atan2(across, a * back[from] + b * back[from + 1] + c * back[from + 2]) * 180) / Math.PI;
  return Number.isFinite(degrees) ? degrees : 180;
}

// Textures of numbers, and what a device is given to measure with; made anew when its context comes back.
class Inputs {
  constructor(device, data, normals) {
    Object.assign(this, { device, data, normals, side: Math.sqrt(data.checks.count), textures: new Map() });
  }

  texture(values, format, width, height) {
    const { gl } = this.device, texture = gl.createTexture();
    const [parts, type] = format.endsWith("UI") ? [gl.RGBA_INTEGER, gl.UNSIGNED_INT] : [gl.RGBA, gl.FLOAT];
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl[format], width, height, 0, parts, type, values);
    for (const name of ["TEXTURE_MIN_FILTER", "TEXTURE_MAG_FILTER"]) gl.texParameteri(gl.TEXTURE_2D, gl[name], gl.NEAREST);
    return texture;
  }

  // Normals and views of a domain as textures.
  of(domain) {
    if (!this.textures.has(domain)) {
      const { n, view } = this.normals.of(domain), made = (all) => this.texture(all, "RGBA32F", this.side, this.side);
      this.textures.set(domain, { normals: made(n), views: made(view) });
    }
    return this.textures.get(domain);
  }

  table({ width, height, data }) {
    if (!this.textures.has(data)) {
      const values = typeof data === "string" ? new Float32Array(bytesOf(data)) : Float32Array.from(data);
      const channels = values.length / (width * height), wide = new Float32Array(4 * width * height);
      for (let i = 0; i < width * height; i++) for (let c = 0; c < channels; c++) wide[4 * i + c] = values[channels * i + c];
      this.textures.set(data, this.texture(wide, "RGBA32F", width, height));
    }
    return this.textures.get(data);
  }

  release() {
    for (const one of this.textures.values()) {
      for (const texture of one instanceof WebGLTexture ? [one] : Object.values(one)) this.device.gl.deleteTexture(texture);
    }
    this.textures.clear();
  }
}

// One codec on a device: its passes at `side` by `side` texels.
class CodecOnDevice {
  constructor(inputs, codec) {
    Object.assign(this, { inputs, codec, device: inputs.device, side: inputs.side, made: [], programs: [] });
    this.target = codec.target ? this.own(codec.target, this.side) : null;
    this.packs = !this.target;
    this.format = this.packs ? WORD_TARGETS[codec.words] : codec.target;
    this.target ??= this.own(this.format, this.side);
    const tables = Object.entries(codec.tables ?? {}).map(([name, table]) => [name, inputs.table(table)]);
    this.given = { ...inputs.of(codec.domain), ...Object.fromEntries(tables) };
  }

  own(format, side) {
    const target = this.device.target(format, side, side);
    if (target) this.made.push(target);
    return target;
  }

  macros(packs) {
    const { codec } = this, { names, channels } = codec, hasSign = codec.components > channels.length;
    const scale = (at) => (channels[0].is_across ? 255 : (channels[at]?.integer ?? 1)).toFixed(1);
    return {
      SIDE: this.side,
      CODE: `vec${codec.components}`,
      HAS_SIGN: Number(hasSign),
      SIGN: "xyzw"[codec.components - 1],
      STORED_SIGN: hasSign ? ", sign" : "",
      PACKS: Number(packs),
      PACKED: "xyzw".slice(0, codec.words),
      FLOATS: Number(channels[0].kind === "float"),
      SCALES: `vec4(${[0, 1, 2, 3].map(scale).join(", ")})`,
      ENCODE_TAKES: codec.takes.encode.join(", "),
      DECODE_TAKES: codec.takes.decode.join(", "),
      ...Object.fromEntries(Object.entries(names).map(([name, value]) => [name.toUpperCase(), value])),
    };
  }

  // A pass of this codec; one that needs none of its functions is given its macros alone.
  program(name, { needsCodec = true, packs = this.packs, ...more } = {}) {
    const { shaders } = this.inputs.data, macros = { ...this.macros(packs), HAS_CODEC: Number(needsCodec), TIMED: 0, ...more };
    const source = needsCodec ? this.codec.source : "";
    const made = this.device.program(defined(macros) + source + shaders["measure_given.glsl"] + shaders[name]);
    this.programs.push(made);
    return made;
  }

  draw(program, target, textures = {}) {
    this.device.draw(program, target, {}, { ...this.given, ...textures });
  }

  // The texels of a target of unsigned integers, four for each.
  words(target) {
    const { gl } = this.device, { side } = this, found = new Uint32Array(4 * side * side);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
    gl.readPixels(0, 0, side, side, gl.RGBA_INTEGER, gl.UNSIGNED_INT, found);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return found;
  }

  // Codes as integers in the order of their numbers, as many for each normal as are stored: as the shader packs them.
  packedCodes() {
    const target = this.packs ? this.target : this.own(WORD_TARGETS[this.codec.words], this.side);
    this.draw(this.program("measure_encode.frag", { packs: true }), target);
    return this.unpacked(this.words(target), true);
  }

  // The same as the codec's own render target has them.
  targetCodes() {
    this.draw(this.program("measure_encode.frag"), this.target);
    this.bits ??= this.own("RGBA32UI", this.side);
    this.draw(this.program("measure_read.frag", { needsCodec: false }), this.bits, { codes: this.target.texture });
    return this.unpacked(this.words(this.bits), false);
  }

  unpacked(words, packs) {
    const { channels } = this.codec, size = channels.length, found = new Int32Array((words.length / 4) * size);
    const read = channels[0].is_across ? acrossBytes(channels, packs) : packs ? fromWords(channels) : fromTarget(channels);
    for (let i = 0; i < words.length / 4; i++) for (let c = 0; c < size; c++) found[size * i + c] = read(words, 4 * i, c);
    return found;
  }

  // The mean and the largest angle, in degrees, between normals and what this device decodes from its own texels.
  angles() {
    this.bits ??= this.own("RGBA32UI", this.side);
    this.draw(this.program("measure_decode.frag"), this.bits, { codes: this.target.texture });
    const back = new Float32Array(this.words(this.bits).buffer), { n } = this.inputs.normals.of(this.codec.domain);
    let sum = 0, most = 0;
    for (let at = 0; at < n.length; at += 4) {
      const degrees = angleBetween(n, at, back, at);
      sum += degrees;
      most = Math.max(most, degrees);
    }
    return { mean: sum / (n.length / 4), most };
  }

  release() {
    for (const program of this.programs) this.device.gl.deleteProgram(program);
    for (const { framebuffer, texture } of this.made) {
      this.device.gl.deleteFramebuffer(framebuffer);
      this.device.gl.deleteTexture(texture);
    }
  }
}

function fromTarget(channels) {
  return (words, at, c) => orderedRead(words[at + c], channels[c]);
}

function fromWords(channels) {
  const masks = channels.map(({ bits }) => (bits < 32 ? 2 ** bits - 1 : 0xffffffff));
  return (words, at, c) => {
    const { first } = channels[c];
    return ordered(((words[at + (first >>> 5)] >>> (first & 31)) & masks[c]) >>> 0, channels[c]);
  };
}

// Numbers laid across bytes: the bytes read as one number, the first byte the highest.
function acrossBytes(channels, packs) {
  const count = (channels[0].first + channels[0].bits) / 8;
  const byte = (words, at, b) => (packs ? (words[at] >>> (8 * b)) & 255 : words[at + b] & 255);
  return (words, at, c) => {
    let joined = 0;
    for (let b = 0; b < count; b++) joined = ((joined << 8) | byte(words, at, b)) >>> 0;
    return (joined >>> channels[c].first) & (2 ** channels[c].bits - 1);
  };
}
