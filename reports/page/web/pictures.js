"use strict";

// Pictures: two codecs under a divider that is dragged on the picture, and a lens at the pointer. What is drawn is
// computed here from each pixel's stored bits, decoded normal and angle, or from its rendered colour.
const SIDES = ["left", "right"];
const ORIGINAL = -1, LACKING = -2;
// Full colour of a difference in a small picture, in steps of 8 bits.
const FULL_APART = 16, LIVE_TEXT = "live, your GPU";
const normalViews = ({ gain, power }) => ({
  angle: "angle",
  error: `${gain}× |error|`,
  power: `1 − dot^${power}`,
  code: "stored code",
  decoded: "decoded normal",
});
const IMAGE_VIEWS = { final: "image", apart: "difference", flip: "FLIP" };
// What full colour stands for.
const ANGLE_SCALES = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 45, 90, 180];
const APART_SCALES = [1, 2, 4, 8, 16, 32, 64, 128, 255];
// Pixels that the lens shows on a side, and how large each is; how wide a small picture is; how many codecs are kept.
const LENS = 11, CELL = 12, THUMB = 240, KEPT = 8, SEEN = 2, CROP = [64, 48];

function penOf(canvas) {
  return canvas.getContext("2d", { willReadFrequently: true });
}

async function pixelsOf(uri, width, height) {
  const image = new Image();
  image.src = uri;
  await image.decode();
  const canvas = new OffscreenCanvas(width, height), pen = canvas.getContext("2d", { willReadFrequently: true });
  pen.drawImage(image, 0, 0);
  return pen.getImageData(0, 0, width, height).data;
}

// Pictures beside the page are scripts, which a page from a folder may read; each calls this.
const beside = {};
function keepPicture(name, planes) {
  beside[name](planes);
}

function besides(codec) {
  return new Promise((resolve, reject) => {
    beside[codec.name] = resolve;
    const failed = () => reject(new Error(`${codec.file} is missing; put it in the folder next to this page`));
    document.head.append(element("script", { src: codec.file, onerror: failed }));
  });
}

const colours = { table: new Uint8ClampedArray(256 * 3) };

function fillColours(names) {
  const parts = names.map((name) => [1, 3, 5].map((at) => parseInt(name.slice(at, at + 2), 16)));
  for (let i = 0; i < 256; i++) {
    const at = (i / 255) * (parts.length - 1), low = Math.min(Math.floor(at), parts.length - 2);
    for (let c = 0; c < 3; c++) colours.table[3 * i + c] = parts[low][c] + (at - low) * (parts[low + 1][c] - parts[low][c]);
  }
}

// A codec's pixels on a subject.
class Planes {
  constructor(subject, codec, exact) {
    Object.assign(this, { subject, codec, exact });
  }

  static async of(subject, codec, exact) {
    const made = new Planes(subject, codec, exact), { width, height } = subject;
    if (codec === null) return made;
    const kept = codec.file ? await (codec.loading ||= besides(codec)) : codec;
    const read = (uri) => (uri ? pixelsOf(uri, width, height) : null);
    [made.angles, made.decoded, made.apart, made.flip] = await Promise.all(
      [kept.angle, kept.decoded, kept.apart, kept.flip].map(read),
    );
    made.bits = kept.bits;
    made.codes = kept.codes ? await made.readCodes(kept.codes, read) : null;
    return made;
  }

  // The bytes of every component, the highest of each first, three to a picture; shifted up to whole bytes.
  async readCodes(uris, read) {
    const pictures = await Promise.all(uris.map(read)), count = this.subject.width * this.subject.height;
    const sizes = this.bits.map((bits) => Math.ceil(bits / 8));
    const codes = this.bits.map(() => new Uint32Array(count));
    let plane = 0;
    for (let level = 0; level < Math.max(...sizes); level++) {
      for (const [c, size] of sizes.entries()) {
        if (level >= size) continue;
        const from = pictures[Math.floor(plane / 3)], channel = plane % 3, to = codes[c];
        for (let i = 0; i < count; i++) to[i] = to[i] * 256 + from[4 * i + channel];
        plane++;
      }
    }
    return codes.map((all, c) => all.map((value) => Math.floor(value / 2 ** (8 * sizes[c] - this.bits[c]))));
  }

  // Degrees; NaN on the background. What is not a number is as far as can be.
  angle(i) {
    return this.angles ? viewer.degrees[this.angles[4 * i]] : 0;
  }

  isNumber(i) {
    return this.angles[4 * i] !== viewer.data.angle.not_a_number;
  }

  final(i, c) {
    return this.apart ? (this.exact[4 * i + c] + this.apart[4 * i + c]) & 255 : this.exact[4 * i + c];
  }

  // The largest difference of a channel, in steps of 8 bits.
  difference(i) {
    if (!this.apart) return 0;
    let most = 0;
    for (let c = 0; c < 3; c++) most = Math.max(most, Math.abs(this.final(i, c) - this.exact[4 * i + c]));
    return most;
  }

  // The largest error of a pixel: an angle, or steps of 8 bits.
  most() {
    const count = this.subject.width * this.subject.height, error = this.subject.of === "image" ? (i) => this.difference(i) : (i) => this.angle(i);
    let most = 0;
    for (let i = 0; i < count; i++) most = Math.max(most, error(i) || 0);
    return most;
  }

  // How far an image is off at most, and where that is to be seen.
  offBy() {
    if (this.off) return this.off;
    let most = 0, seen = 0;
    const count = this.subject.width * this.subject.height;
    for (let i = 0; i < count; i++) {
      const apart = this.difference(i);
      most = Math.max(most, apart);
      seen += apart > SEEN;
    }
    const share = Number(((100 * seen) / count).toPrecision(2));
    return (this.off = { most, said: `largest difference ${most} of 255, above ${SEEN} in ${share}% of the pixels` });
  }

  // The colour of a pixel in a view; `scale` is what full colour stands for.
  paint(view, scale, isGrey, to, at) {
    const i = at / 4;
    let share;
    if (view === "angle") share = this.angle(i) / scale;
    else if (view === "apart") share = this.difference(i) / scale;
    else if (view === "flip") share = this.flip ? this.flip[at] / 255 : 0;
    else if (view === "error") return grey(viewer.data.articles.gain * 2 * Math.sin((this.angle(i) * Math.PI) / 360), to, at);
    else if (view === "power") return grey(1 - Math.max(0, Math.cos((this.angle(i) * Math.PI) / 180)) ** viewer.data.articles.power, to, at);
    else return this.colour(view, i, to, at);
    if (isGrey) return grey(share, to, at);
    const from = 3 * Math.max(0, Math.min(255, Math.round(share * 255)));
    for (let c = 0; c < 3; c++) to[at + c] = share === share ? colours.table[from + c] : 0;
  }

  colour(view, i, to, at) {
    for (let c = 0; c < 3; c++) {
      if (view === "code" && this.codes) to[at + c] = c < this.codes.length ? (255 * this.codes[c][i]) / (2 ** this.bits[c] - 1) : 0;
      else if (view === "final") to[at + c] = this.final(i, c);
      else to[at + c] = (this.decoded || this.exact)[4 * i + c];
    }
    if (view === "code" && this.angles && this.angles[4 * i] === 0) to[at] = to[at + 1] = to[at + 2] = 0;
  }

  // At most so many pixels wide, for a small picture.
  drawSmall(canvas, view, scale, isGrey, width = THUMB) {
    const whole = document.createElement("canvas");
    this.draw(whole, view, scale, isGrey);
    canvas.width = Math.min(width, whole.width);
    canvas.height = Math.max(1, Math.round((canvas.width * whole.height) / whole.width));
    penOf(canvas).drawImage(whole, 0, 0, canvas.width, canvas.height);
  }

  draw(canvas, view, scale, isGrey) {
    const { width, height } = this.subject, image = new ImageData(width, height);
    for (let at = 0; at < image.data.length; at += 4) {
      this.paint(view, scale, isGrey, image.data, at);
      image.data[at + 3] = 255;
    }
    canvas.width = width;
    canvas.height = height;
    penOf(canvas).putImageData(image, 0, 0);
  }

  bitsOf(i) {
    return this.codes.map((plane, c) => plane[i].toString(2).padStart(this.bits[c], "0"));
  }

  // What a pixel is, in lines that have room inside it.
  numbers(i) {
    if (this.subject.of === "image") return [0, 1, 2].map((c) => String(this.final(i, c))).concat(this.apart ? [`off ${this.difference(i)}`] : []);
    if (!this.angles) return componentsOf(this.exact, i);
    const angle = this.angle(i);
    if (Number.isNaN(angle)) return [];
    return [...this.bitsOf(i), ...componentsOf(this.decoded, i), this.isNumber(i) ? `${Number(angle.toPrecision(2))}°` : "not a number"];
  }

  // What a pixel is, in words.
  say(i) {
    if (this.subject.of === "image") {
      const rgb = [0, 1, 2].map((c) => this.final(i, c)).join(" ");
      const flip = this.flip ? `, FLIP ${(this.flip[4 * i] / 255).toFixed(2)}` : "";
      return this.apart ? `${rgb}, off by ${this.difference(i)} of 255${flip}` : rgb;
    }
    if (!this.angles) return `normal ${normalOf(this.exact, i)}`;
    const angle = this.angle(i);
    if (Number.isNaN(angle)) return "background";
    const bits = this.bitsOf(i).join(" ");
    if (!this.isNumber(i)) return `code ${bits}, decoded to a value that is not finite`;
    return `code ${bits}, decoded ${normalOf(this.decoded, i)}, off by ${Number(angle.toPrecision(2))}°`;
  }
}

// In place of a codec's pixels that the page does not have.
class NoPixels {
  constructor({ width, height }, exact) {
    Object.assign(this, { width, height, exact });
  }

  // Hatched, so that nobody takes the other side's picture for it.
  draw(canvas) {
    Object.assign(canvas, { width: this.width, height: this.height });
    const pen = penOf(canvas), step = Math.max(4, Math.round(this.width / 40));
    pen.fillStyle = "#777";
    pen.fillRect(0, 0, this.width, this.height);
    pen.strokeStyle = "#555";
    for (let x = -this.height; x < this.width; x += step) {
      pen.moveTo(x, this.height);
      pen.lineTo(x + this.height, 0);
    }
    pen.stroke();
  }

  numbers() {
    return [];
  }

  say() {
    return "no image";
  }
}

function componentsOf(from, i) {
  return [0, 1, 2].map((c) => (from[4 * i + c] / 127.5 - 1).toFixed(3));
}

function normalOf(from, i) {
  return `(${componentsOf(from, i).join(", ")})`;
}

function grey(share, to, at) {
  to[at] = to[at + 1] = to[at + 2] = 255 * Math.max(0, Math.min(1, share || 0));
}

class Viewer {
  constructor(root, data) {
    Object.assign(this, { root, data, place: { x: 0, y: 0 }, shown: {}, read: new Map(), turn: 0 });
    fillColours(data.colours);
    const { least_log2, steps_per_octave, not_a_number } = data.angle;
    this.degrees = Array.from({ length: 256 }, (_, step) => 2 ** (least_log2 + (step - 1) / steps_per_octave));
    Object.assign(this.degrees, { 0: NaN, 1: 0, [not_a_number]: 180 });
    data.subjects.forEach((subject, at) => this.one("#subject").add(new Option(subject.title, at)));
    this.zoom = new Zoom(this);
    this.listen();
  }

  one(selector) {
    return this.root.querySelector(selector);
  }

  get subject() {
    return this.data.subjects[this.one("#subject").value];
  }

  get view() {
    return this.one("#view").value;
  }

  get scales() {
    return this.subject.of === "image" ? APART_SCALES : ANGLE_SCALES;
  }

  get scale() {
    return this.scales[this.one("#scale").value];
  }

  get isGrey() {
    return this.one("#colours").value === "grey";
  }

  side(side) {
    return this.one(`#${side}`);
  }

  // A codec's pixels; the exact ones for ORIGINAL. The last few are kept.
  planes(at) {
    const subject = this.subject, key = `${this.one("#subject").value}/${at}`;
    if (!this.read.has(key)) {
      subject.exact ||= pixelsOf(subject.original, subject.width, subject.height);
      const codec = Number(at) === ORIGINAL ? null : subject.codecs[at], isLacking = Number(at) === LACKING;
      this.read.set(key, subject.exact.then((exact) => (isLacking ? new NoPixels(subject, exact) : Planes.of(subject, codec, exact))));
      if (this.read.size > KEPT) this.read.delete(this.read.keys().next().value);
    }
    return this.read.get(key);
  }

  listen() {
    this.one("#subject").addEventListener("change", () => this.begin());
    for (const side of SIDES) {
      this.side(side).addEventListener("change", () => this.chosen(side));
    }
    for (const id of ["view", "scale", "colours"]) this.one(`#${id}`).addEventListener("input", () => this.show());
    this.one("[data-fit]").addEventListener("click", () => this.fitToMost());
    this.one("[data-blink]").addEventListener("click", () => this.blink());
    this.one("#divider").addEventListener("input", () => this.divide(this.one("#divider").value));
    const stage = this.one(".stage");
    stage.addEventListener("pointermove", (event) => this.point(event));
    stage.addEventListener("pointerdown", (event) => {
      stage.setPointerCapture(event.pointerId);
      this.point(event);
    });
    stage.addEventListener("pointerleave", () => (this.one(".lens").hidden = true));
    stage.addEventListener("keydown", (event) => this.key(event));
    stage.addEventListener("focus", () => this.look());
    for (const axis of ["x", "y"]) {
      const field = this.one(`#lens-${axis}`);
      field.addEventListener("input", () => this.goTo({ [axis]: Number(field.value) || 0 }));
      field.addEventListener("change", () => (field.value = this.place[axis]));
    }
    shows.push((state) => this.follow(state));
  }

  // A subject from its start: the best codec against the next one, or against the exact pixels.
  async begin() {
    const { subject } = this, turn = ++this.turn;
    this.shown = {};
    this.fillLists(subject);
    this.place = { x: Math.floor(subject.width / 2), y: Math.floor(subject.height / 2) };
    this.zoom.by(0);
    const note = `${subject.of === "image" ? "Above: where they are furthest from exact. " : ""}${subject.step > 1 ? `One pixel of each block of ${subject.step} × ${subject.step} is shown.` : "Every pixel is shown."}`;
    this.one("[data-step]").textContent = note;
    this.fillThumbs();
    this.take(state);
    try {
      const both = await Promise.all(SIDES.map((side) => this.planes(this.side(side).value)));
      if (turn !== this.turn) return;
      this.fitScale(both);
      if (subject.of === "image") this.place = this.worstPlace(both);
    } catch (error) {
      this.say(error.message);
    }
    this.isReady = true;
    await this.show();
    this.root.dataset.begun = "";
  }

  // The same crop of the left and the right image and of the exact one, where A and B are furthest from it.
  async crop() {
    const { subject } = this, box = this.one("[data-crops]"), turn = this.turn;
    box.hidden = subject.of !== "image";
    const wanted = [...SIDES.map((side) => [this.side(side).value, this.side(side).selectedOptions[0].textContent]), [ORIGINAL, "exact"]];
    const pair = JSON.stringify([subject.title, wanted]);
    if (box.hidden || box.dataset.pair === pair) return;
    const planes = await Promise.all(wanted.map(([at]) => this.planes(at)));
    if (turn !== this.turn) return;
    box.dataset.pair = pair;
    const { x, y } = this.worstPlace(planes.slice(0, 2));
    const [wide, high] = CROP, left = clamped(x - wide / 2, 0, subject.width - wide), top = clamped(y - high / 2, 0, subject.height - high);
    box.replaceChildren(...planes.map((one, index) => {
      const whole = element("canvas", {}), canvas = element("canvas", { width: wide, height: high, role: "img", "aria-label": `${wanted[index][1]}, enlarged` });
      one.draw(whole, "final", 1, false);
      penOf(canvas).drawImage(whole, left, top, wide, high, 0, 0, wide, high);
      return element("figure", {}, canvas, element("figcaption", {}, wanted[index][1]));
    }));
  }

  // Where both sides together are off most.
  worstPlace(both) {
    const { width, height } = this.subject;
    let worst = { off: 0, ...this.place };
    for (let i = 0; i < width * height; i++) {
      const off = both.reduce((sum, planes) => sum + (planes.codec ? planes.difference(i) : 0), 0);
      if (off > worst.off) worst = { off, x: i % width, y: Math.floor(i / width) };
    }
    return { x: worst.x, y: worst.y };
  }

  fillLists(subject) {
    for (const side of SIDES) {
      this.side(side).replaceChildren(new Option("exact", ORIGINAL), ...grouped(subject.codecs.map((codec, at) => [codec.label, at])));
    }
    this.side("left").value = 0;
    this.side("right").value = subject.codecs.length > 1 ? 1 : ORIGINAL;
    const views = subject.of === "image" ? IMAGE_VIEWS : normalViews(this.data.articles);
    const names = Object.entries(views).filter(([name]) => name !== "flip" || subject.flip);
    this.one("#view").replaceChildren(...names.map(([name, title]) => new Option(title, name)));
    this.one("#scale").max = this.scales.length - 1;
    for (const [axis, size] of [["x", subject.width], ["y", subject.height]]) this.one(`#lens-${axis}`).max = size - 1;
  }

  // Full colour for what only one pixel in fifty exceeds, of the worse side.
  fitScale(both) {
    const most = Math.max(...both.map((planes) => (planes.codec ? this.nearlyMost(planes) : 0)));
    const at = this.scales.findIndex((scale) => scale >= most);
    this.one("#scale").value = at < 0 ? this.scales.length - 1 : at;
  }

  // Full colour for the largest error of either side.
  fitToMost() {
    const shown = Object.values(this.shown).filter(({ codec }) => codec), most = Math.max(0, ...shown.map((planes) => planes.most()));
    this.one("#scale").value = Math.max(0, this.scales.findLastIndex((scale) => scale <= most));
    this.show();
  }

  nearlyMost(planes) {
    const counts = new Uint32Array(256), count = this.subject.width * this.subject.height;
    const isImage = this.subject.of === "image";
    for (let i = 0; i < count; i++) counts[isImage ? planes.difference(i) : planes.angles[4 * i]]++;
    let left = (isImage ? count : count - counts[0]) * 0.02, at = 255;
    while (at > 0 && left >= counts[at]) left -= counts[at--];
    return isImage ? at : this.degrees[at] || 0;
  }

  say(text) {
    this.one("[data-values]").textContent = text;
  }

  async show() {
    const turn = ++this.turn, { view, scale, isGrey } = this;
    const scaled = ["angle", "apart"].includes(view);
    this.one("#scale").closest("label").hidden = !scaled;
    this.one("#colours").closest("label").hidden = !scaled && view !== "flip";
    this.one("[data-fit]").hidden = !scaled;
    try {
      for (const side of SIDES) {
        const planes = await this.planes(this.side(side).value);
        if (turn !== this.turn) return;
        this.put(side, planes, view, scale, isGrey);
      }
    } catch (error) {
      this.say(error.message);
      return;
    }
    this.legend(scaled || view === "flip");
    this.magnify();
    this.zoom.write();
    await this.crop();
  }

  put(side, planes, view, scale, isGrey) {
    this.shown[side] = planes;
    const canvas = this.one(`[data-canvas="${side}"]`), label = this.side(side).selectedOptions[0].textContent;
    planes.draw(canvas, view, scale, isGrey);
    const title = this.one("#view").selectedOptions[0].textContent;
    canvas.setAttribute("aria-label", `${side} of the divider: ${label}, ${title}, ${this.subject.title}`);
    this.one(`[data-name="${side}"]`).textContent = label;
  }

  legend(isThere) {
    const unit = this.subject.of === "image" ? " of 255" : "°", strip = this.one(".strip");
    this.one(".legend").hidden = !isThere;
    const most = this.view === "flip" ? "1" : `${this.scale}${unit}`;
    this.one("[data-most]").textContent = `${most}${this.view === "flip" ? "" : " and more"}`;
    this.one("[data-scale]").textContent = `${this.scale}${unit}`;
    this.one("#scale").setAttribute("aria-valuetext", `${this.scale}${unit}`);
    strip.width = 256;
    strip.height = 1;
    const image = new ImageData(256, 1);
    for (let i = 0; i < 256; i++) {
      for (let c = 0; c < 3; c++) image.data[4 * i + c] = this.isGrey ? i : colours.table[3 * i + c];
      image.data[4 * i + 3] = 255;
    }
    penOf(strip).putImageData(image, 0, 0);
  }

  get divided() {
    return Number(this.one("#divider").value);
  }

  // One side, and then the other, in the same place.
  blink() {
    this.divide(this.divided === 100 ? 0 : 100);
  }

  divide(at) {
    for (const [side, none] of [["left", 0], ["right", 100]]) this.one(`[data-name="${side}"]`).hidden = Number(at) === none;
    this.one(".stage").style.setProperty("--at", `${at}%`);
    this.one("#divider").value = at;
    this.one("[data-divided]").textContent = `${Math.round(at)}%`;
    this.one("#divider").setAttribute("aria-valuetext", `${Math.round(at)}%`);
    this.zoom.write();
  }

  point(event) {
    // What a pointer passes over is not read out.
    this.one(".said").setAttribute("aria-live", "off");
    const stage = this.one(".stage"), box = stage.getBoundingClientRect();
    if (this.zoom.drag === "line") this.divide(clamped((100 * (event.clientX - box.left)) / box.width, 0, 100));
    this.goTo(this.zoom.at(event));
  }

  key(event) {
    const by = event.shiftKey ? 10 : 1, zooms = { "+": STEP, "=": STEP, "-": 1 / STEP, 0: 0 };
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === " ") this.blink();
    else if (event.key in zooms) this.zoom.by(zooms[event.key]);
    if (event.key === " " || event.key in zooms) event.preventDefault();
    const moves = { ArrowLeft: [-by, 0], ArrowRight: [by, 0], ArrowUp: [0, -by], ArrowDown: [0, by] };
    if (!(event.key in moves)) return;
    event.preventDefault();
    this.one(".said").setAttribute("aria-live", "polite");
    const [x, y] = moves[event.key];
    this.goTo({ x: this.place.x + x, y: this.place.y + y });
    this.zoom.follow(this.place);
  }

  goTo(place) {
    const { width, height } = this.subject, inside = (value, size) => Math.max(0, Math.min(size - 1, Math.floor(value)));
    Object.assign(this.place, place);
    this.place = { x: inside(this.place.x, width), y: inside(this.place.y, height) };
    this.look();
  }

  look() {
    this.one(".lens").hidden = this.zoom.k * this.zoom.unit > CELL;
    this.magnify();
  }

  // The pixels around the place, from either side, and what the one in the middle is.
  magnify() {
    const { x, y } = this.place, { width, height, step, of } = this.subject, i = y * width + x;
    for (const side of SIDES) {
      if (!this.shown[side]) return;
      this.enlarge(side, x, y);
      this.one(`[data-pixel="${side}"]`).textContent = this.shown[side].say(i);
    }
    for (const axis of ["x", "y"]) {
      const field = this.one(`#lens-${axis}`);
      if (document.activeElement !== field) field.value = this.place[axis];
    }
    this.placeLens(((x - this.zoom.x) * this.zoom.k) / width, ((y - this.zoom.y) * this.zoom.k) / height);
    const exact = of === "image" ? "" : `, exact normal ${normalOf(this.shown.left.exact, i)}`;
    this.say(`Pixel ${x}, ${y}${step > 1 ? ` (${x * step}, ${y * step} of the run's image)` : ""}${exact}`);
  }

  enlarge(side, x, y) {
    const to = this.one(`[data-lens="${side}"]`), half = Math.floor(LENS / 2);
    to.width = to.height = LENS * CELL;
    const pen = penOf(to);
    pen.imageSmoothingEnabled = false;
    pen.drawImage(this.one(`[data-canvas="${side}"]`), x - half, y - half, LENS, LENS, 0, 0, to.width, to.height);
    pen.strokeStyle = "#fff";
    pen.strokeRect(half * CELL + 0.5, half * CELL + 0.5, CELL - 1, CELL - 1);
  }

  // Away from what it shows, and never outside of the picture.
  placeLens(x, y) {
    const { style } = this.one(".lens"), beyond = (share) => `${100 * share + 3}%`;
    style.left = x > 0.5 ? "auto" : beyond(x);
    style.right = x > 0.5 ? beyond(1 - x) : "auto";
    style.top = y > 0.5 ? "auto" : beyond(y);
    style.bottom = y > 0.5 ? beyond(1 - y) : "auto";
  }

  find(name) {
    return name ? this.subject.codecs.findIndex((one) => one.codec && agrees(one.codec, name)) : -1;
  }

  // How many of A and B a subject has pictures of.
  has(subject) {
    return CODECS.filter((side) => subject.codecs.some(({ codec }) => codec && agrees(codec, state[side]))).length;
  }

  // A stands to the left and B to the right, where there are pictures of them.
  take(state) {
    const note = this.one("[data-lacking]"), missing = CODECS.filter((side) => state[side] && this.find(state[side]) < 0);
    const lines = missing.map((side) => [`The page has no images of ${side.toUpperCase()}, ${state[side]}. To see one, run: `, element("code", {}, this.commandFor(state[side], note.dataset.run)), element("br", {})]);
    note.replaceChildren(...lines.flat());
    const shown = () => SIDES.map((side) => this.side(side).selectedOptions[0].textContent), before = shown();
    for (const [at, side] of SIDES.entries()) this.choose(this.side(side), state[CODECS[at]]);
    return shown().some((text, at) => text !== before[at]);
  }

  // A codec in the list of a side; nothing is drawn there where the page has no picture of it.
  choose(list, name) {
    const found = this.find(name), isOut = list.value === String(LACKING);
    list.querySelector(`[value="${LACKING}"]`)?.remove();
    if (name && found < 0) list.prepend(new Option(`${name}: no image`, LACKING));
    if (name) list.value = found < 0 ? LACKING : found;
    else if (isOut) list.value = ORIGINAL;
  }

  commandFor(name, run) {
    const { left_out } = this.data, [encoding, storage] = name.split(" "), table = this.subject.of === "image" ? "render" : "quality";
    if (left_out.includes(`${name}, ${this.subject.title}`)) return `normalbench report ${run} --pictures beside`;
    return `normalbench run --tables ${table} --encoding ${encoding} --storage ${storage}`;
  }

  follow(state) {
    if (!this.isReady) return;
    const most = Math.max(...this.data.subjects.map((one) => this.has(one)));
    if (this.has(this.subject) < most) {
      this.one("#subject").value = this.data.subjects.findIndex((one) => this.has(one) === most);
      this.begun = this.begin();
    } else if (this.take(state)) this.show();
  }

  // What a reader chose: a codec of the page is A or B everywhere.
  chosen(side) {
    const name = this.subject.codecs[this.side(side).value]?.codec;
    if (name && known.codecs.includes(name)) change({ [CODECS[SIDES.indexOf(side)]]: name });
    this.show();
  }

  // One codec of a subject against the next one, brought into view.
  async open(subject, codec, view) {
    const a = known.codecs.includes(codec.codec) ? codec.codec : state.a;
    change({ view: this.root.closest(".view").dataset.view, at: "pictures", a });
    this.one("#subject").value = this.data.subjects.indexOf(subject);
    this.begun = this.begin();
    await this.begun;
    const at = subject.codecs.indexOf(codec), count = subject.codecs.length;
    this.side("left").value = at;
    if (this.side("right").value === String(at)) this.side("right").value = count > 1 ? (at + 1) % count : ORIGINAL;
    this.one("#view").value = view;
    await this.show();
    this.root.scrollIntoView();
    this.one(".stage").focus({ preventScroll: true });
  }

  // A small picture of each codec, drawn when it comes into view; a click puts it to the right.
  fillThumbs() {
    const subject = this.subject, seen = new IntersectionObserver((entries) => {
      for (const { isIntersecting, target } of entries) {
        if (!isIntersecting) continue;
        seen.unobserve(target);
        const view = subject.of === "image" ? "final" : "error";
        this.planes(target.dataset.at).then((planes) => planes.drawSmall(target.querySelector("canvas"), view, 1, true), () => {});
      }
    });
    const made = subject.codecs.map((codec, at) => {
      const picture = element("canvas", { "aria-hidden": "true" });
      const button = element("button", { type: "button", "data-at": at }, picture, element("span", {}, codec.label));
      button.addEventListener("click", () => {
        this.side("right").value = at;
        this.chosen("right");
      });
      seen.observe(button);
      return button;
    });
    this.one(".thumbs").replaceChildren(...made);
  }
}

// A beside B as the answer's scene shows them: the image, and how far it is off, of both at one gain.
class Pair {
  constructor(place) {
    Object.assign(this, { place, scene: place.dataset.proof, turn: 0, read: new Map(), stills: [], said: "" });
    shows.push((state, before) => CODECS.some((side) => state[side] !== before[side]) && this.show(state));
    this.show(state);
  }

  async show(state) {
    const turn = ++this.turn, of = ({ title }) => title.split(" at power ")[0] === `the answer on ${this.scene}`;
    const has = (subject, name) => name && subject.codecs.find(({ codec }) => codec === name);
    const subject = viewer.data.subjects.find((one) => of(one) && CODECS.some((side) => has(one, state[side])));
    const sides = subject ? CODECS.filter((side) => has(subject, state[side])) : [];
    const planes = await Promise.all(sides.map((side) => this.planes(subject, has(subject, state[side]))));
    if (turn !== this.turn) return;
    const views = [["final", () => "image"], ["apart", (one) => one.offBy().said]];
    const buttons = views.flatMap(([view, said]) => planes.map((one, at) => this.button(subject, sides[at], one, view, FULL_APART, said(one))));
    // What the run has no image of is drawn by the reader's GPU.
    const missing = CODECS.filter((side) => state[side] && !sides.includes(side)), drawn = missing.filter((side) => this.mayDraw(state[side]));
    const lacks = missing.filter((side) => !drawn.includes(side)).map((side) => `${side.toUpperCase()}, ${state[side]}`);
    const scene = subject ? subject.title.replace("the answer on ", "") : this.scene, none = lacks.length ? [`This page has no image of ${scene} with ${lacks.join(" or with ")}.`] : [];
    const note = [...none, ...(planes.length ? [`On ${scene}; full colour at ${FULL_APART} of 255.`] : [])].join(" ");
    this.note = element("p", { class: "note" }, `${note} `, element("span", { role: "status" }, this.said));
    const lively = drawn.map((side) => this.liveButton(side, state[side])), shown = [...sides, ...drawn], images = [...buttons.slice(0, sides.length), ...lively];
    // A stands left of B, and the differences below.
    const inOrder = CODECS.filter((side) => shown.includes(side)), placed = inOrder.map((side) => images[shown.indexOf(side)]);
    this.place.replaceChildren(...placed, ...buttons.slice(sides.length), this.note);
    this.stills = inOrder.map((side, at) => ({ name: state[side], canvas: placed[at].querySelector("canvas") }));
    this.place.dataset.sides = shown.length;
    this.place.hidden = false;
    if (drawn.length) this.begin?.();
    this.live?.take();
  }

  // Whether the laboratory can draw a codec; it is taken to be able to until it is there.
  mayDraw(name) {
    if (!this.isDrawable) return false;
    return typeof live === "undefined" || !live.data || (this.scene in SCENES && live.byLabel.has(name));
  }

  say(text) {
    this.said = text;
    if (this.note) this.note.lastChild.textContent = text;
  }

  // The images are drawn by the reader's GPU, where the laboratory has their scene.
  enliven() {
    // What it cannot draw is said.
    if (this.stills.some(({ name }) => !this.mayDraw(name))) this.show(state);
    if (!(this.scene in SCENES)) return this.say("These images are stills: the laboratory does not have their scene.");
    this.live = new Chosen(this);
    this.say("Live: drag to rotate; click, then scroll to zoom. No shadows and few lights; differences are those of the run's images.");
  }

  async planes(subject, codec) {
    if (!this.read.has(codec)) {
      const exact = await pixelsOf(subject.original, subject.width, subject.height);
      this.read.set(codec, await Planes.of(subject, codec, exact));
    }
    return this.read.get(codec);
  }

  // An image without a still: no figures, because none were measured for it.
  liveButton(side, name) {
    const canvas = element("canvas", { "aria-hidden": "true", width: 480, height: 360 });
    return element("button", { type: "button", onclick: () => change({ view: "see" }) }, canvas, element("span", {}, element("b", { class: `side-${side}` }, side.toUpperCase()), ` ${name}: `, element("mark", {}, LIVE_TEXT)));
  }

  button(subject, side, planes, view, scale, said) {
    const canvas = element("canvas", { "aria-hidden": "true" });
    planes.drawSmall(canvas, view, scale, false, 2 * THUMB);
    const name = element("span", {}, element("b", { class: `side-${side}` }, side.toUpperCase()), ` ${planes.codec.label}: ${said}`);
    return element("button", { type: "button", onclick: () => viewer.open(subject, planes.codec, view) }, canvas, name);
  }
}

let viewer = null;
const viewerRoot = document.querySelector("#viewer");
if (viewerRoot) {
  viewer = new Viewer(viewerRoot, JSON.parse(document.querySelector("#picture-data").textContent));
  const place = document.querySelector("[data-proof]");
  if (place) viewer.pair = new Pair(place);
  const start = new IntersectionObserver((entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    start.disconnect();
    viewer.begun ||= viewer.begin();
  }, { rootMargin: "600px" });
  start.observe(viewerRoot);
}
