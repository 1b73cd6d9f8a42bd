"use strict";

// WebGL2 for the laboratory: a context that may be lost, programs of a codec and a shader, targets of any format.
const FUNCTIONS = ["encode", "decode", "pack", "unpack", "to_target", "from_target"];
const VECTORS = { 2: "vec2", 3: "vec3", 4: "vec4" };
// By the sized format: what a texture of it is made of and read as.
const PIXELS = {
  RGBA8: ["RGBA", "UNSIGNED_BYTE"], RG8: ["RG", "UNSIGNED_BYTE"], R8: ["RED", "UNSIGNED_BYTE"],
  RGB10_A2: ["RGBA", "UNSIGNED_INT_2_10_10_10_REV"], RGB565: ["RGB", "UNSIGNED_SHORT_5_6_5"],
  RG16F: ["RG", "HALF_FLOAT"], RGBA16F: ["RGBA", "HALF_FLOAT"], R11F_G11F_B10F: ["RGB", "UNSIGNED_INT_10F_11F_11F_REV"],
  R32F: ["RED", "FLOAT"], RG32F: ["RG", "FLOAT"], RGBA32F: ["RGBA", "FLOAT"],
  R32UI: ["RED_INTEGER", "UNSIGNED_INT"], RG32UI: ["RG_INTEGER", "UNSIGNED_INT"], RGBA32UI: ["RGBA_INTEGER", "UNSIGNED_INT"],
};
// What extensions add: sized formats by their numbers, which the extension's object names with a suffix.
const MORE = {
  EXT_texture_norm16: { RG16: "RG16_EXT", RGBA16: "RGBA16_EXT" },
  EXT_render_snorm: { RG8_SNORM: "RG8_SNORM", RGBA8_SNORM: "RGBA8_SNORM" },
};

// The bits of a float as its number, and back.
const bitsOf = { float: new Float32Array(1), word: new Uint32Array(0) };
bitsOf.word = new Uint32Array(bitsOf.float.buffer);
function floatOf(word) {
  bitsOf.word[0] = word;
  return bitsOf.float[0];
}

class LiveDevice {
  constructor(canvas) {
    this.canvas = canvas;
    const options = { antialias: false, alpha: false, depth: false, preserveDrawingBuffer: true, powerPreference: "high-performance" };
    this.gl = canvas.getContext("webgl2", options);
    if (!this.gl) throw new Error("this browser provides no WebGL 2 context");
    this.listeners = { lost: [], restored: [] };
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      this.forget();
      for (const listener of this.listeners.lost) listener();
    });
    canvas.addEventListener("webglcontextrestored", () => {
      this.begin();
      for (const listener of this.listeners.restored) listener();
    });
    this.begin();
  }

  on(what, listener) {
    this.listeners[what].push(listener);
  }

  get isLost() {
    return this.gl.isContextLost();
  }

  begin() {
    const { gl } = this;
    this.forget();
    // Some browsers name the device only by the extension, which others are about to remove.
    const plain = String(gl.getParameter(gl.RENDERER)), info = /^WebKit/.test(plain) && gl.getExtension("WEBGL_debug_renderer_info");
    this.renderer = info ? String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)) : plain;
    this.vendor = String(gl.getParameter(info ? info.UNMASKED_VENDOR_WEBGL : gl.VENDOR));
    gl.getExtension("EXT_color_buffer_float");
    gl.getExtension("EXT_color_buffer_half_float");
    this.formats = Object.fromEntries(Object.keys(PIXELS).map((name) => [gl[name], name]));
    for (const [extension, names] of Object.entries(MORE)) {
      const found = gl.getExtension(extension);
      for (const [name, property] of Object.entries(found ? names : {})) this.formats[found[property] ?? gl[name]] = name;
    }
    this.parallel = gl.getExtension("KHR_parallel_shader_compile");
    this.empty = gl.createVertexArray();
  }

  forget() {
    this.programs = new Map();
    this.tables = new Map();
    this.renderable = new Map();
  }

  // A program of a codec's functions and one of the page's shaders.
  //   codec: a codec of the page's data; null for shaders that need none.
  //   parts: names of shaders, in order.
  //   options.defines: names that are defined; options.precision: of the codec's own arithmetic; options.vertex: the vertex shader.
  // Kept until the context is lost. Raises an Error with the compiler's log.
  program(codec, parts, options) {
    const [key, made] = this.begun(codec, parts, options);
    if (!made.shaders) return made;
    try {
      return this.checked(made);
    } catch (error) {
      this.programs.delete(key);
      throw error;
    }
  }

  // Begins to compile it, which does not wait for the compiler.
  begun(codec, parts, { defines = [], precision = "highp", vertex = "screen.vert" } = {}) {
    const key = [codec?.label, codec?.source, precision, vertex, ...defines, ...parts].join("\0");
    if (!this.programs.has(key)) this.programs.set(key, this.link(this.text(codec, parts, defines, precision), vertex));
    return [key, this.programs.get(key)];
  }

  // Compiles programs, each given as `program` takes it, while the page goes on. `program` says whether it could. A browser that
  // compiles in the page's own time is asked for one at a time.
  async compiled(...wanted) {
    const status = this.parallel?.COMPLETION_STATUS_KHR ?? this.gl.LINK_STATUS, begun = [];
    const isOpen = ({ program, shaders }) => shaders && !this.isLost && !this.gl.getProgramParameter(program, status);
    for (const one of wanted) {
      const [, made] = this.begun(...one);
      begun.push(made);
      if (this.parallel || !made.shaders) continue;
      isOpen(made);
      await paused();
    }
    if (this.parallel) while (begun.some(isOpen)) await paused(4);
  }

  // Forgets the programs of a codec.
  drop({ source }) {
    for (const [key, { program }] of this.programs) {
      if (!key.includes(source)) continue;
      this.gl.deleteProgram(program);
      this.programs.delete(key);
    }
  }

  text(codec, parts, defines, precision) {
    const head = ["#version 300 es", ...defines.map((name) => `#define ${name}`), "precision highp float;", "precision highp int;"];
    const own = codec ? [codec.source.replace("precision highp float;", `precision ${precision} float;`), macros(codec)] : [];
    return [...head, ...own, "precision highp float;", ...parts.map((name) => live.data.shaders[name])].join("\n") + "\n";
  }

  link(fragment, name = "screen.vert") {
    const { gl } = this, program = gl.createProgram();
    const vertex = `#version 300 es\n${live.data.shaders[name]}`;
    const shaders = [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]].map(([kind, text]) => {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      return shader;
    });
    gl.linkProgram(program);
    return { program, shaders, places: new Map() };
  }

  checked(made) {
    const { gl } = this, { program, shaders } = made;
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
      const failed = shaders.find((shader) => !gl.getShaderParameter(shader, gl.COMPILE_STATUS));
      const log = failed ? gl.getShaderInfoLog(failed) || "the compiler gives no reason" : gl.getProgramInfoLog(program) || "the linker gives no reason";
      for (const one of shaders) gl.deleteShader(one);
      gl.deleteProgram(program);
      throw new Error(log);
    }
    for (const one of shaders) gl.deleteShader(one);
    made.shaders = null;
    return made;
  }

  // A texture that can be drawn to and read by texelFetch; null where the device cannot render to the format, a number
  // of OpenGL's.
  target(format, width, height) {
    const { gl } = this, name = this.formats[format];
    if (!name || this.renderable.get(format) === false) return null;
    const texture = gl.createTexture(), framebuffer = gl.createFramebuffer();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
    this.nearest();
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    // To ask waits for all that is being drawn.
    const works = this.renderable.get(format) ?? gl.checkFramebufferStatus(gl.FRAMEBUFFER) === gl.FRAMEBUFFER_COMPLETE;
    this.renderable.set(format, works);
    const made = { texture, framebuffer, format, name, width, height };
    if (works) return made;
    this.release(made);
    return null;
  }

  // Whether it can be drawn to.
  renders(format) {
    if (!this.renderable.has(format)) this.release(this.target(format, 1, 1));
    return this.renderable.get(format) ?? false;
  }

  release(target) {
    if (!target) return;
    this.gl.deleteTexture(target.texture);
    if (target.framebuffer) this.gl.deleteFramebuffer(target.framebuffer);
  }

  nearest() {
    const { gl } = this;
    for (const name of ["MIN_FILTER", "MAG_FILTER"]) gl.texParameteri(gl.TEXTURE_2D, gl[`TEXTURE_${name}`], gl.NEAREST);
    for (const name of ["WRAP_S", "WRAP_T"]) gl.texParameteri(gl.TEXTURE_2D, gl[`TEXTURE_${name}`], gl.CLAMP_TO_EDGE);
  }

  // A texture of numbers that shaders read by texelFetch: floats of one, two or four channels, integers of four.
  texture(name, width, height, data, linear = false) {
    const { gl } = this, [layout, kind] = PIXELS[name], texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl[name], width, height, 0, gl[layout], gl[kind], data);
    this.nearest();
    if (linear) for (const end of ["MIN", "MAG"]) gl.texParameteri(gl.TEXTURE_2D, gl[`TEXTURE_${end}_FILTER`], gl.LINEAR);
    return { texture, width, height };
  }

  // A picture of everything around, by longitude and latitude, with smaller levels where the device makes them.
  panorama({ width, height, pixels }) {
    const { gl } = this, made = this.texture("RGBA16F", width, height, null);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16F, width, height, 0, gl.RGBA, gl.FLOAT, pixels);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.REPEAT);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    const isSmaller = this.renders(gl.RGBA16F);
    gl.bindTexture(gl.TEXTURE_2D, made.texture);
    if (isSmaller) gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, isSmaller ? gl.LINEAR_MIPMAP_LINEAR : gl.LINEAR);
    return made;
  }

  // A codec's look-up tables by the names of their samplers.
  tablesOf(codec) {
    const key = codec.source;
    if (!this.tables.has(key)) {
      const made = Object.entries(codec.tables).map(([name, { width, height, channels, data }]) => {
        return [name, this.texture({ 1: "R32F", 2: "RG32F", 4: "RGBA32F" }[channels], width, height, new Float32Array(bytesOf(data).buffer))];
      });
      this.tables.set(key, Object.fromEntries(made));
    }
    return this.tables.get(key);
  }

  // Corners of triangles on the GPU: three floats each for their places and normals.
  corners({ places, normals, count }) {
    const { gl } = this, vertices = gl.createVertexArray(), buffers = [places, normals].map(() => gl.createBuffer());
    gl.bindVertexArray(vertices);
    for (const [location, numbers] of [places, normals].entries()) {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffers[location]);
      gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, 3, gl.FLOAT, false, 0, 0);
    }
    return { vertices, buffers, count };
  }

  releaseCorners({ vertices, buffers }) {
    this.gl.deleteVertexArray(vertices);
    for (const buffer of buffers) this.gl.deleteBuffer(buffer);
  }

  // Draws them over a target that was cleared, the nearest in front.
  drawCorners(made, target, uniforms, corners) {
    const { gl } = this, { width, height, framebuffer } = target, depth = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT32F, width, height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
    gl.clearBufferuiv(gl.COLOR, 0, new Uint32Array(4));
    gl.clearBufferfv(gl.DEPTH, 0, [1]);
    gl.enable(gl.DEPTH_TEST);
    this.draw(made, target, uniforms, {}, null, corners);
    gl.disable(gl.DEPTH_TEST);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, null);
    gl.deleteRenderbuffer(depth);
  }

  // Draws one triangle over a target, or over the canvas where that is null; or the corners that are given.
  //   uniforms: numbers and arrays by name; a whole number of an `int` is given as { int: 3 } or { ints: [1, 2] }.
  //   textures: by the name of their samplers.
  //   scissor: [x, y, width, height] in pixels, or null for all.
  draw({ program, places }, target, uniforms = {}, textures = {}, scissor = null, { vertices = this.empty, count = 3 } = {}) {
    const { gl } = this, { width, height } = target ?? this.canvas;
    gl.bindFramebuffer(gl.FRAMEBUFFER, target?.framebuffer ?? null);
    gl.viewport(0, 0, width, height);
    gl.useProgram(program);
    gl.bindVertexArray(vertices);
    const place = (name) => {
      if (!places.has(name)) places.set(name, gl.getUniformLocation(program, name));
      return places.get(name);
    };
    Object.entries(textures).forEach(([name, { texture }], unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.uniform1i(place(name), unit);
    });
    for (const [name, value] of Object.entries(uniforms)) this.uniform(place(name), value);
    if (scissor) {
      gl.enable(gl.SCISSOR_TEST);
      gl.scissor(...scissor);
    }
    gl.drawArrays(gl.TRIANGLES, 0, count);
    gl.disable(gl.SCISSOR_TEST);
  }

  uniform(place, value) {
    const { gl } = this;
    if (typeof value === "number") gl.uniform1f(place, value);
    else if ("int" in value) gl.uniform1i(place, value.int);
    else if ("ints" in value) gl[`uniform${value.ints.length}iv`](place, value.ints);
    else if (value.length === 9) gl.uniformMatrix3fv(place, false, value);
    else gl[`uniform${value.length}fv`](place, value);
  }

  // Fills a target of integers with bits that stand for no number, which a shader that writes nothing leaves there.
  clearWords({ framebuffer }) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.clearBufferuiv(gl.COLOR, 0, new Uint32Array(4).fill(0xffffffff));
  }

  // When everything that was asked of the GPU is done. The page does not wait for it.
  async done() {
    const { gl } = this, fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    do await paused(); while (fence && gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED);
    gl.deleteSync(fence);
  }

  // Texels of a target of RGBA32UI, four words each.
  words(target, width = target.width, height = target.height) {
    const { gl } = this, found = new Uint32Array(4 * width * height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
    gl.readPixels(0, 0, width, height, gl.RGBA_INTEGER, gl.UNSIGNED_INT, found);
    return found;
  }

  // Bits of the mantissa that a precision really keeps: the least power of two that, added to 1, is lost.
  async mantissa(precision) {
    const wanted = [null, [`mantissa_${precision}.frag`]], target = this.target(this.gl.RGBA32UI, 1, 1);
    await this.compiled(wanted);
    this.draw(this.program(...wanted), target, { one: 1 });
    const [bits] = await wordsLater(this, target);
    this.release(target);
    return bits;
  }
}

// The names by which shaders call a codec's functions.
function macros({ size, sign_bits: signs, takes_view: view, words, names, calls = {}, views = { encode: view, decode: view } }) {
  const code = VECTORS[size], called = { ...Object.fromEntries(FUNCTIONS.map((name) => [name, `${names}_${name}`])), ...calls };
  const lanes = "xyzw".slice(0, words), sign = signs ? ", s" : "";
  const padding = (count, zero) => Array(count).fill(zero).map((text) => `, ${text}`).join("");
  return [
    `#define CODE ${code}`, `#define SIZE ${size}`, ...(signs ? ["#define HAS_SIGN"] : []),
    `#define ENCODE(n, view) ${called.encode}(n${views.encode ? ", view" : ""})`,
    `#define DECODE(e, view) ${called.decode}(e${views.decode ? ", view" : ""})`,
    `#define TO_TARGET(e) ${called.to_target}(e)`, `#define FROM_TARGET(t, s) ${called.from_target}(t${sign})`,
    `#define PACK(e) uvec4(${called.pack}(e)${padding(4 - words, "0u")})`,
    `#define UNPACK(w, s) ${called.unpack}((w).${lanes}${sign})`,
    `#define PADDED(e) vec4(e${padding(4 - size, "0.0")})`, `#define CODE_OF(v) ${code}((v).${"xyzw".slice(0, size)})`,
    `${code} fewer_bits(${code} e, float levels) { return round(clamp(e * 0.5 + 0.5, 0.0, 1.0) * levels) / levels * 2.0 - 1.0; }`,
  ].join("\n");
}
