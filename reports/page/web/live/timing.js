"use strict";

// How long a pass takes, in milliseconds for a megapixel, less an empty pass into the same target.

const TIMED_SIDE = 1024, TIMES = 5;
// Passes are repeated until they take this long, so that clocks tell; no slice of work is to take longer than `most`.
const SLICE_MS = { least: 8, most: 40 };
// How long a timer query may keep its answer back, and how often one may be disturbed.
const QUERY_MS = 2000, RETRIES = 3;

// A page that nobody sees is slowed down by the browser: times are measured when it is seen again.
function seen() {
  if (document.visibilityState === "visible") return Promise.resolve();
  return new Promise((resolve) => {
    const listen = () => {
      if (document.visibilityState !== "visible") return;
      document.removeEventListener("visibilitychange", listen);
      resolve();
    };
    document.addEventListener("visibilitychange", listen);
  });
}

class Timer {
  constructor(device) {
    this.device = device;
    this.query = device.gl.getExtension("EXT_disjoint_timer_query_webgl2");
  }

  get says() {
    return this.query ? "EXT_disjoint_timer_query_webgl2" : `wall clock, ${this.passes} passes and a read-back`;
  }

  // The GPU's own milliseconds for `count` passes; null where it does not say.
  async byQuery(draw, count) {
    const { gl } = this.device, { TIME_ELAPSED_EXT, GPU_DISJOINT_EXT } = this.query;
    for (let turn = 0; turn < RETRIES; turn++) {
      const query = gl.createQuery();
      gl.beginQuery(TIME_ELAPSED_EXT, query);
      for (let i = 0; i < count; i++) draw();
      gl.endQuery(TIME_ELAPSED_EXT);
      gl.flush();
      const until = performance.now() + QUERY_MS;
      do await paused(); while (!gl.getQueryParameter(query, gl.QUERY_RESULT_AVAILABLE) && performance.now() < until && !gl.isContextLost());
      const isThere = gl.getQueryParameter(query, gl.QUERY_RESULT_AVAILABLE), isDisturbed = gl.getParameter(GPU_DISJOINT_EXT);
      const found = isThere && !isDisturbed ? gl.getQueryParameter(query, gl.QUERY_RESULT) / 1e6 : null;
      gl.deleteQuery(query);
      if (found !== null) return found;
    }
    return null;
  }

  // Milliseconds until `count` passes are drawn and a pixel of the last is read.
  async byClock(draw, count, read) {
    await paused();
    read();
    const begin = performance.now();
    for (let i = 0; i < count; i++) draw();
    read();
    return performance.now() - begin;
  }

  // The least time of a pass, which the rest of the machine disturbed least, in milliseconds; null where the device does
  // not tell.
  async of(draw, read) {
    let count = 1, once = await this.byClock(draw, count, read);
    while (once < SLICE_MS.least && count < 1024) once = await this.byClock(draw, (count *= 2), read);
    const found = [];
    this.passes = count;
    for (let turn = 0; turn < TIMES; turn++) {
      await seen();
      const time = this.query ? await this.byQuery(draw, count) : await this.byClock(draw, count, read);
      if (time === null) return null;
      found.push(time / count);
      if (once > SLICE_MS.most && turn > 1) break;
    }
    return Math.min(...found);
  }
}

// A pixel of a target, so that the passes before it are done.
function readPixel(gl, { framebuffer, name }) {
  const [parts, type, Numbers] = name.endsWith("UI")
    ? [gl.RGBA_INTEGER, gl.UNSIGNED_INT, Uint32Array]
    : name.endsWith("F") ? [gl.RGBA, gl.FLOAT, Float32Array] : [gl.RGBA, gl.UNSIGNED_BYTE, Uint8Array];
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  gl.readPixels(0, 0, 1, 1, parts, type, new Numbers(4));
}

// The times of one codec's passes at TIMED_SIDE by TIMED_SIDE texels.
class TimedCodec {
  // `on` is the codec on its device, whose target holds codes.
  constructor(on, timer) {
    Object.assign(this, { on, timer, megapixels: TIMED_SIDE ** 2 / 1e6 });
  }

  // Milliseconds for a megapixel of a pass into `target`, less its empty pass; null where the device does not tell, or
  // tells no difference.
  async pass(name, target, textures) {
    const { on } = this, isInteger = target.name.endsWith("UI"), times = [];
    const empty = [...(isInteger ? ["WRITES_INTEGERS"] : []), ...("codes" in textures ? ["READS_CODES"] : [])];
    const programs = [on.program(name, { defines: ["TIMED"] }), on.program("measure_empty.frag", { needsCodec: false, defines: empty })];
    for (const program of programs) {
      await seen();
      times.push(await this.timer.of(() => on.draw(program, target, textures), () => readPixel(on.device.gl, target)));
    }
    return times.includes(null) || times[0] <= times[1] ? null : (times[0] - times[1]) / this.megapixels;
  }

  async encode() {
    const target = this.on.own(this.on.target.format, TIMED_SIDE);
    return target && this.pass("measure_encode.frag", target, {});
  }

  async decode() {
    const target = this.on.own(this.on.device.gl.RGBA8, TIMED_SIDE);
    return target && this.pass("measure_decode.frag", target, { codes: this.on.target });
  }
}
