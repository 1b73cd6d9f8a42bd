"use strict";

// Files of pixels, read here: PNG of 8 bits by the browser, PNG of 16, Radiance HDR and OpenEXR by hand. Whatever a file holds, reading it ends in
// pixels or in an Error of one line.
const MOST_FILE_PIXELS = 64 * 2 ** 20, KEPT_PIXELS = 4 * 2 ** 20, KEPT_SIDE = 4096, BREATH_MS = 30, MOST_HEADER = 2 ** 20;
const SHORT = "the file ends too early";

// What is kept of a picture: every pixel, or one of each `step` x `step`, as four floats, the upper row first.
class Kept {
  constructor(width, height) {
    if (!(width > 0 && height > 0)) throw new Error("it has no pixels");
    if (width * height > MOST_FILE_PIXELS) throw new Error(`it has ${width} x ${height} pixels; the maximum is ${MOST_FILE_PIXELS}`);
    this.step = Math.max(Math.ceil(Math.sqrt((width * height) / KEPT_PIXELS)), Math.ceil(Math.max(width, height) / KEPT_SIDE));
    [this.width, this.height] = [width, height].map((size) => Math.ceil(size / this.step));
    this.full = [width, height];
    this.pixels = new Float32Array(4 * this.width * this.height);
    this.since = performance.now();
  }

  // Takes a row: `at` gives a pixel's three numbers.
  row(y, at) {
    if (y % this.step) return;
    for (let x = 0, to = 4 * (y / this.step) * this.width; x < this.full[0]; x += this.step, to += 4) {
      const [r, g, b] = at(x);
      this.pixels[to] = r;
      this.pixels[to + 1] = g;
      this.pixels[to + 2] = b;
      this.pixels[to + 3] = 1;
    }
  }

  // The page goes on between rows.
  async breathe() {
    if (performance.now() - this.since < BREATH_MS) return;
    await paused();
    this.since = performance.now();
  }
}

// The kind of a file by its first bytes, and its pixels: { width, height, pixels, full, kind }.
async function pixelsOfFile(file, bytes) {
  const begins = (...wanted) => wanted.every((byte, at) => bytes[at] === byte);
  try {
    if (begins(0x89, 0x50, 0x4e, 0x47)) return { ...(await readPng(file, bytes)), kind: "PNG" };
    if (begins(0x23, 0x3f)) return { ...(await readHdr(bytes)), kind: "HDR" };
    if (begins(0x76, 0x2f, 0x31, 0x01)) return { ...(await readExr(bytes)), kind: "EXR" };
  } catch (error) {
    throw error instanceof RangeError ? new Error(SHORT) : error;
  }
  throw new Error("it is not a PNG, Radiance HDR, EXR or glTF file");
}

async function readPng(file, bytes) {
  const view = new DataView(bytes.buffer), kept = new Kept(view.getUint32(16), view.getUint32(20)), { width, height, step } = kept;
  const chunks = [...pngChunks(bytes, view)];
  // Some browsers show what there is of a file that ends too early.
  if (chunks.at(-1)?.name !== "IEND") throw new Error(SHORT);
  if (bytes[24] === 16) return wholePng(bytes, chunks, kept);
  const small = step > 1 ? { resizeWidth: width, resizeHeight: height, resizeQuality: "pixelated" } : {};
  const image = await createImageBitmap(file, { colorSpaceConversion: "none", premultiplyAlpha: "none", ...small }).catch(() => null);
  if (!image) throw new Error("the browser cannot read this PNG");
  const pen = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
  pen.drawImage(image, 0, 0);
  const { data } = pen.getImageData(0, 0, width, height);
  for (let i = 0; i < data.length; i++) kept.pixels[i] = data[i] / 255;
  return kept;
}

// The parts of a PNG up to its end.
function* pngChunks(bytes, view) {
  for (let at = 8, name = ""; at + 12 <= bytes.length && name !== "IEND"; at += 12 + view.getUint32(at)) {
    name = String.fromCharCode(...bytes.subarray(at + 4, at + 8));
    yield { name, data: bytes.subarray(at + 8, at + 8 + view.getUint32(at)) };
  }
}

// A PNG of 16 bits, of which browsers keep 8: its packed rows (W3C, Portable Network Graphics, 2003).
async function wholePng(bytes, chunks, kept) {
  const [width, height] = kept.full, channels = { 0: 1, 2: 3, 4: 2, 6: 4 }[bytes[25]], near = 2 * channels, size = near * width;
  if (!channels) throw new Error("a 16-bit PNG must be grey or colour");
  if (bytes[28]) throw new Error("16-bit interlaced PNGs are not supported");
  const parts = chunks.filter(({ name }) => name === "IDAT").map(({ data }) => data);
  const rows = await unpackedBytes(new Blob(parts), "deflate", height * (size + 1)).catch(() => new Uint8Array(0)), places = channels > 2 ? [0, 2, 4] : [0, 0, 0];
  if (rows.length < height * (size + 1)) throw new Error("its rows are damaged");
  for (let y = 0, above = new Uint8Array(size); y < height; y++) {
    const row = rows.subarray(y * (size + 1) + 1, (y + 1) * (size + 1));
    unfilter(row, above, near, rows[y * (size + 1)]);
    kept.row(y, (x) => places.map((place) => ((row[near * x + place] << 8) | row[near * x + place + 1]) / 65535));
    above = row;
    await kept.breathe();
  }
  return kept;
}

// Undoes the filter of a row: what it is the difference to, of the bytes to the left, above, and to the left of that.
function unfilter(row, above, near, filter) {
  const nearest = (a, b, c) => [a, b, c].reduce((one, other) => (Math.abs(a + b - c - other) < Math.abs(a + b - c - one) ? other : one));
  const guess = [() => 0, (a) => a, (_, b) => b, (a, b) => (a + b) >> 1, nearest][filter];
  if (!guess) throw new Error("its rows are damaged");
  for (let i = 0; i < row.length; i++) row[i] += guess(i < near ? 0 : row[i - near], above[i], i < near ? 0 : above[i - near]);
}

// Radiance's RGBE (G. Ward, Real Pixels, Graphics Gems II, 1991): rows from above, whole or run by run.
async function readHdr(bytes) {
  let at = 0;
  const line = () => {
    const end = bytes.indexOf(10, at);
    if (end < 0 || end - at > MOST_HEADER) throw new Error(SHORT);
    const text = String.fromCharCode(...bytes.subarray(at, Math.min(end, at + 200)));
    at = end + 1;
    return text.trim();
  };
  for (let text = line(); text; text = line()) {
    if (/^FORMAT=/.test(text) && text !== "FORMAT=32-bit_rle_rgbe") throw new Error(`its ${text} is not supported; use 32-bit_rle_rgbe`);
  }
  const [, height, width] = line().match(/^-Y (\d{1,6}) \+X (\d{1,6})$/) ?? [];
  if (!width) throw new Error("its row order is not supported; use -Y +X");
  const kept = new Kept(Number(width), Number(height)), row = new Uint8Array(4 * kept.full[0]);
  for (let y = 0; y < kept.full[1]; y++) {
    at = hdrRow(bytes, at, row, kept.full[0]);
    kept.row(y, (x) => {
      const scale = row[4 * x + 3] ? 2 ** (row[4 * x + 3] - 136) : 0;
      return [row[4 * x] * scale, row[4 * x + 1] * scale, row[4 * x + 2] * scale];
    });
    await kept.breathe();
  }
  return kept;
}

// A row into `row`; where the next one begins.
function hdrRow(bytes, at, row, width) {
  const isPacked = bytes[at] === 2 && bytes[at + 1] === 2 && bytes[at + 2] < 128;
  if (!isPacked) {
    if (at + 4 * width > bytes.length) throw new Error(SHORT);
    if (bytes[at] === 1 && bytes[at + 1] === 1 && bytes[at + 2] === 1) throw new Error("its run-length coding is from before 1991 and is not supported");
    row.set(bytes.subarray(at, at + 4 * width));
    return at + 4 * width;
  }
  if (((bytes[at + 2] << 8) | bytes[at + 3]) !== width) throw new Error("a row has the wrong width");
  at += 4;
  for (let channel = 0; channel < 4; channel++) {
    for (let x = 0; x < width; ) {
      const count = bytes[at++], isRun = count > 128, length = isRun ? count - 128 : count;
      if (count === undefined || at + (isRun ? 1 : length) > bytes.length) throw new Error(SHORT);
      if (!length || x + length > width) throw new Error("a run is longer than its row");
      for (let i = 0; i < length; i++, x++) row[4 * x + channel] = bytes[isRun ? at : at + i];
      at += isRun ? 1 : length;
    }
  }
  return at;
}

// OpenEXR's scanlines, of half or float, by the file layout of openexr.com: as they are, or by ZIP of 1 or 16 rows.
const EXR_PACKING = ["none", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB"], EXR_ROWS = { none: 1, ZIPS: 1, ZIP: 16 };
const EXR_BYTES = [4, 2, 4];

async function readExr(bytes) {
  const view = new DataView(bytes.buffer), { packing, channels, top, width, height, end } = exrHeader(bytes, view);
  const rows = EXR_ROWS[packing], kept = new Kept(width, height), starts = [];
  let size = 0;
  for (const channel of channels) {
    starts.push(size);
    size += EXR_BYTES[channel.kind] * width;
  }
  const wanted = exrColours(channels), blocks = Math.ceil(height / rows), seen = new Set();
  for (let block = 0; block < blocks; block++) {
    const at = Number(view.getBigUint64(end + 8 * block, true)), y = view.getInt32(at, true) - top, length = view.getUint32(at + 4, true);
    if (at + 8 + length > bytes.length) throw new Error(SHORT);
    if (y < 0 || y >= height || y % rows || seen.has(y)) throw new Error("a block does not match its rows");
    seen.add(y);
    const count = Math.min(rows, height - y), data = await exrBlock(bytes.subarray(at + 8, at + 8 + length), count * size, packing);
    const numbers = new DataView(data.buffer, data.byteOffset, data.byteLength);
    for (let row = 0; row < count; row++) {
      const read = wanted.map((one) => exrReader(numbers, row * size + starts[one], channels[one].kind));
      kept.row(y + row, (x) => read.map((number) => number(x)));
    }
    await kept.breathe();
  }
  return kept;
}

function exrReader(numbers, start, kind) {
  if (kind === 1) return (x) => halfOf(numbers.getUint16(start + 2 * x, true));
  return (x) => numbers.getFloat32(start + 4 * x, true);
}

function halfOf(word) {
  const exponent = (word >> 10) & 31, mantissa = word & 1023, sign = word & 0x8000 ? -1 : 1;
  if (exponent === 31) return mantissa ? NaN : sign * Infinity;
  return sign * (exponent ? (1 + mantissa / 1024) * 2 ** (exponent - 15) : (mantissa / 1024) * 2 ** -14);
}

function exrHeader(bytes, view) {
  const flags = view.getUint32(4, true);
  for (const [bit, name] of [[0x200, "tiles"], [0x800, "deep pixels"], [0x1000, "several parts"]]) if (flags & bit) throw new Error(`EXR with ${name} is not supported; save one part as scanlines`);
  if ((flags & 255) !== 2) throw new Error(`EXR version ${flags & 255} is not supported; use version 2`);
  const found = {};
  let at = 8;
  const word = () => {
    const end = bytes.indexOf(0, at);
    if (end < 0 || end - at > 255) throw new Error(SHORT);
    const text = String.fromCharCode(...bytes.subarray(at, end));
    at = end + 1;
    return text;
  };
  for (let name = word(); name; name = word()) {
    word();
    const size = view.getUint32(at, true), start = at + 4;
    if (start + size > bytes.length || start > MOST_HEADER) throw new Error(SHORT);
    found[name] = start;
    at = start;
    if (name === "channels") found.channels = exrChannels(view, word, () => at, (to) => (at = to), start + size);
    at = start + size;
  }
  for (const name of ["channels", "compression", "dataWindow"]) if (found[name] === undefined) throw new Error(`its header has no ${name}`);
  const packing = EXR_PACKING[view.getUint8(found.compression)] ?? "an unknown way";
  if (!EXR_ROWS[packing]) throw new Error(`its compression is ${packing}; use none, ZIPS or ZIP`);
  const [left, top, right, bottom] = [0, 4, 8, 12].map((off) => view.getInt32(found.dataWindow + off, true));
  return { packing, channels: found.channels, top, width: right - left + 1, height: bottom - top + 1, end: at };
}

function exrChannels(view, word, where, go, end) {
  const channels = [];
  for (let name = word(); name; name = word()) {
    const at = where(), kind = view.getUint32(at, true);
    if (at + 16 > end || kind > 2) throw new Error("its list of channels is damaged");
    if (view.getInt32(at + 8, true) !== 1 || view.getInt32(at + 12, true) !== 1) throw new Error(`its channel ${name} is subsampled, which is not supported`);
    channels.push({ name, kind });
    go(at + 16);
  }
  return channels;
}

// Which channels are red, green and blue, or x, y and z: of the first layer that has three. One alone is grey.
function exrColours(channels) {
  const isRead = ({ kind }) => kind > 0, layers = [...new Set(channels.map(({ name }) => name.replace(/[^.]*$/, "")))];
  for (const layer of layers) {
    for (const names of ["RGB", "XYZ"]) {
      const places = Array.from(names, (name) => channels.findIndex((one) => isRead(one) && one.name.startsWith(layer) && one.name.slice(layer.length).toUpperCase() === name));
      if (places.every((place) => place >= 0)) return places;
    }
  }
  const grey = channels.findIndex((one) => isRead(one) && /^Y$/i.test(one.name));
  if (grey < 0) throw new Error(`it has no channels R, G, B or X, Y, Z of half or float, but ${channels.map(({ name }) => name).join(", ").slice(0, 80) || "none"}`);
  return [grey, grey, grey];
}

// A block's bytes. ZIP keeps differences of neighbours, even bytes before odd ones.
async function exrBlock(packed, size, packing) {
  if (packing === "none" || packed.length === size) {
    if (packed.length !== size) throw new Error(SHORT);
    return packed;
  }
  const bytes = await unpackedBytes(packed, "deflate", size).catch(() => new Uint8Array(0));
  if (bytes.length !== size) throw new Error("a block is damaged");
  for (let i = 1; i < size; i++) bytes[i] = (bytes[i - 1] + bytes[i] - 128) & 255;
  const made = new Uint8Array(size), half = (size + 1) >> 1;
  for (let i = 0; i < size; i++) made[i] = bytes[i & 1 ? half + (i >> 1) : i >> 1];
  return made;
}
