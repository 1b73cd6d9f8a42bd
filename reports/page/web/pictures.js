"use strict";

// Pictures: two codecs under a divider that is dragged on the picture, and a lens at the pointer. What is drawn is
// computed here from each pixel's stored bits, decoded normal and angle, or from its rendered colour.
const SIDES = ["left", "right"];
const ORIGINAL = -1;
const NORMAL_VIEWS = {
  angle: "angle",
  error: "30 × |error|",
  power: "1 − dot^1024",
  code: "stored code",
  decoded: "decoded normal",
};
const IMAGE_VIEWS = { apart: "difference", final: "image", flip: "FLIP" };
// What full colour stands for.
const ANGLE_SCALES = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 45, 90, 180];
const APART_SCALES = [1, 2, 4, 8, 16, 32, 64, 128, 255];
const ARTICLE_GAIN = 30, ARTICLE_POWER = 1024;
const LENS = 11;

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
    const failed = () => reject(new Error(`${codec.file} cannot be read; it belongs beside this page`));
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
    const kept = codec.file ? (codec.loaded ||= await besides(codec)) : codec;
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
    const codes = this.bits.map(() => new Float64Array(count));
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

  // Degrees; NaN on the background.
  angle(i) {
    if (!this.angles) return 0;
    const step = this.angles[4 * i], { least_log2, steps_per_octave } = viewer.data.angle;
    return step === 0 ? NaN : step === 1 ? 0 : 2 ** (least_log2 + (step - 1) / steps_per_octave);
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

  // The colour of a pixel in a view; `scale` is what full colour stands for.
  paint(view, scale, isGrey, to, at) {
    const i = at / 4;
    let share;
    if (view === "angle") share = this.angle(i) / scale;
    else if (view === "apart") share = this.difference(i) / scale;
    else if (view === "flip") share = this.flip ? this.flip[at] / 255 : 0;
    else if (view === "error") return grey(ARTICLE_GAIN * 2 * Math.sin((this.angle(i) * Math.PI) / 360), to, at);
    else if (view === "power") return grey(1 - Math.max(0, Math.cos((this.angle(i) * Math.PI) / 180)) ** ARTICLE_POWER, to, at);
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

  // What a pixel is, in words.
  say(i) {
    if (this.subject.of === "image") {
      const rgb = [0, 1, 2].map((c) => this.final(i, c)).join(" ");
      const flip = this.flip ? `, FLIP ${(this.flip[4 * i] / 255).toFixed(2)}` : "";
      return this.apart ? `${rgb}, off by ${this.difference(i)} of 255${flip}` : rgb;
    }
    const normal = (from) => `(${[0, 1, 2].map((c) => (from[4 * i + c] / 127.5 - 1).toFixed(2)).join(", ")})`;
    if (!this.angles) return `normal ${normal(this.exact)}`;
    const angle = this.angle(i);
    if (Number.isNaN(angle)) return "background";
    const bits = this.codes.map((plane, c) => plane[i].toString(2).padStart(this.bits[c], "0")).join(" ");
    return `code ${bits}, decoded ${normal(this.decoded)}, off by ${Number(angle.toPrecision(2))}°`;
  }
}

function grey(share, to, at) {
  to[at] = to[at + 1] = to[at + 2] = 255 * Math.max(0, Math.min(1, share || 0));
}

class Viewer {
  constructor(root, data) {
    Object.assign(this, { root, data, place: { x: 0, y: 0 }, shown: {}, read: new Map(), turn: 0 });
    fillColours(data.colours);
    data.subjects.forEach((subject, at) => this.one("#subject").add(new Option(subject.title, at)));
    this.listen();
    root.hidden = false;
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

  // A codec's pixels, read once; the exact ones for ORIGINAL.
  planes(at) {
    const subject = this.subject, key = `${this.one("#subject").value}/${at}`;
    if (!this.read.has(key)) {
      subject.exact ||= pixelsOf(subject.original, subject.width, subject.height);
      const codec = Number(at) === ORIGINAL ? null : subject.codecs[at];
      this.read.set(key, subject.exact.then((exact) => Planes.of(subject, codec, exact)));
    }
    return this.read.get(key);
  }

  listen() {
    this.one("#subject").addEventListener("change", () => this.begin());
    for (const side of SIDES) {
      this.side(side).addEventListener("change", () => this.show());
    }
    for (const id of ["view", "scale", "colours"]) this.one(`#${id}`).addEventListener("input", () => this.show());
    this.one("#divider").addEventListener("input", () => this.divide(this.one("#divider").value));
    const stage = this.one(".stage");
    stage.addEventListener("pointermove", (event) => this.point(event));
    stage.addEventListener("pointerdown", (event) => {
      stage.setPointerCapture(event.pointerId);
      stage.classList.add("dragging");
      this.point(event);
    });
    for (const name of ["pointerup", "pointercancel"]) {
      stage.addEventListener(name, () => stage.classList.remove("dragging"));
    }
    stage.addEventListener("pointerleave", () => (this.one(".lens").hidden = true));
    stage.addEventListener("keydown", (event) => this.key(event));
    stage.addEventListener("focus", () => this.look());
    for (const axis of ["x", "y"]) {
      this.one(`#lens-${axis}`).addEventListener("input", (event) => this.goTo({ [axis]: Number(event.target.value) || 0 }));
    }
    picked.listeners.push((name) => this.follow(name));
  }

  // A subject from its start: the best codec against the next one.
  async begin() {
    const { subject } = this, views = subject.of === "image" ? IMAGE_VIEWS : NORMAL_VIEWS;
    for (const side of SIDES) {
      const options = subject.codecs.map((codec, at) => new Option(codec.label, at));
      this.side(side).replaceChildren(new Option("exact", ORIGINAL), ...options);
      this.side(side).value = Math.min(SIDES.indexOf(side), subject.codecs.length - 1);
    }
    const first = subject.codecs[0], hasFlip = first.flip || (first.loaded && first.loaded.flip);
    const names = Object.entries(views).filter(([name]) => name !== "flip" || hasFlip);
    this.one("#view").replaceChildren(...names.map(([name, title]) => new Option(title, name)));
    this.one("#scale").max = this.scales.length - 1;
    for (const [axis, size] of [["x", subject.width], ["y", subject.height]]) this.one(`#lens-${axis}`).max = size - 1;
    this.place = { x: Math.floor(subject.width / 2), y: Math.floor(subject.height / 2) };
    const note = subject.step > 1 ? `One pixel of ${subject.step} × ${subject.step} is shown, exactly as it is.` : "Every pixel is shown, exactly as it is.";
    this.one("[data-step]").textContent = note;
    await this.fitScale();
    this.fillThumbs();
    if (picked.name) this.follow(picked.name);
    return this.show();
  }

  // Full colour for what only one pixel in fifty exceeds, of the worse side.
  async fitScale() {
    const both = await Promise.all(SIDES.map((side) => this.planes(this.side(side).value)));
    const most = Math.max(...both.map((planes) => planes.codec ? this.nearlyMost(planes) : 0));
    const at = this.scales.findIndex((scale) => scale >= most);
    this.one("#scale").value = at < 0 ? this.scales.length - 1 : at;
  }

  nearlyMost(planes) {
    const values = [], count = this.subject.width * this.subject.height;
    for (let i = 0; i < count; i += 7) {
      const value = this.subject.of === "image" ? planes.difference(i) : planes.angle(i);
      if (value === value) values.push(value);
    }
    return values.sort((a, b) => a - b)[Math.floor(values.length * 0.98)] || 0;
  }

  async show() {
    const turn = ++this.turn, { view, scale, isGrey } = this;
    const scaled = ["angle", "apart"].includes(view);
    this.one("#scale").closest("label").hidden = !scaled;
    this.one("#colours").closest("label").hidden = !scaled && view !== "flip";
    try {
      for (const side of SIDES) {
        const planes = await this.planes(this.side(side).value);
        if (turn !== this.turn) return;
        this.shown[side] = planes;
        const canvas = this.one(`[data-canvas="${side}"]`), label = planes.codec ? planes.codec.label : "exact";
        planes.draw(canvas, view, scale, isGrey);
        const title = this.one("#view").selectedOptions[0].textContent;
        canvas.setAttribute("aria-label", `${side} of the divider: ${label}, ${title}, ${this.subject.title}`);
        this.one(`[data-name="${side}"]`).textContent = label;
      }
    } catch (error) {
      this.one("[data-values]").textContent = error.message;
      return;
    }
    this.legend(scaled || view === "flip");
    this.magnify();
  }

  legend(isThere) {
    const unit = this.subject.of === "image" ? " of 255" : "°", strip = this.one(".strip");
    this.one(".legend").hidden = !isThere;
    const most = this.view === "flip" ? "1" : `${this.scale}${unit}`;
    this.one("[data-most]").textContent = `${most}${this.view === "flip" ? "" : " and more"}`;
    this.one("[data-scale]").textContent = `${this.scale}${unit}`;
    strip.width = 256;
    strip.height = 1;
    const image = new ImageData(256, 1);
    for (let i = 0; i < 256; i++) {
      for (let c = 0; c < 3; c++) image.data[4 * i + c] = this.isGrey ? i : colours.table[3 * i + c];
      image.data[4 * i + 3] = 255;
    }
    penOf(strip).putImageData(image, 0, 0);
  }

  divide(at) {
    this.one(".stage").style.setProperty("--at", `${at}%`);
    this.one("#divider").value = at;
    this.one("[data-divided]").textContent = `${Math.round(at)} %`;
  }

  point(event) {
    const stage = this.one(".stage"), box = stage.getBoundingClientRect(), { width, height } = this.subject;
    const share = { x: (event.clientX - box.left) / box.width, y: (event.clientY - box.top) / box.height };
    if (stage.classList.contains("dragging")) this.divide(Math.max(0, Math.min(100, 100 * share.x)));
    this.goTo({ x: share.x * width, y: share.y * height });
  }

  key(event) {
    const by = event.shiftKey ? 10 : 1;
    const moves = { ArrowLeft: [-by, 0], ArrowRight: [by, 0], ArrowUp: [0, -by], ArrowDown: [0, by] };
    if (!(event.key in moves)) return;
    event.preventDefault();
    const [x, y] = moves[event.key];
    this.goTo({ x: this.place.x + x, y: this.place.y + y });
  }

  goTo(place) {
    const { width, height } = this.subject, inside = (value, size) => Math.max(0, Math.min(size - 1, Math.floor(value)));
    Object.assign(this.place, place);
    this.place = { x: inside(this.place.x, width), y: inside(this.place.y, height) };
    this.look();
  }

  look() {
    this.one(".lens").hidden = false;
    this.magnify();
  }

  // The pixels around the place, from either side, and what the one in the middle is.
  magnify() {
    const { x, y } = this.place, { width, height } = this.subject, half = Math.floor(LENS / 2);
    for (const side of SIDES) {
      const from = this.one(`[data-canvas="${side}"]`), to = this.one(`[data-lens="${side}"]`), pen = penOf(to);
      const cell = to.width / LENS;
      pen.imageSmoothingEnabled = false;
      pen.clearRect(0, 0, to.width, to.height);
      pen.drawImage(from, x - half, y - half, LENS, LENS, 0, 0, to.width, to.height);
      pen.strokeStyle = "#fff";
      pen.strokeRect(half * cell + 0.5, half * cell + 0.5, cell - 1, cell - 1);
      this.one(`[data-pixel="${side}"]`).textContent = this.shown[side] ? this.shown[side].say(y * width + x) : "";
    }
    for (const axis of ["x", "y"]) {
      const field = this.one(`#lens-${axis}`);
      if (document.activeElement !== field) field.value = this.place[axis];
    }
    const lens = this.one(".lens").style;
    // Away from what it shows, and never outside of the picture.
    lens.left = x > width / 2 ? "auto" : `${(100 * x) / width + 3}%`;
    lens.right = x > width / 2 ? `${100 - (100 * x) / width + 3}%` : "auto";
    lens.top = y > height / 2 ? "auto" : `${(100 * y) / height + 3}%`;
    lens.bottom = y > height / 2 ? `${100 - (100 * y) / height + 3}%` : "auto";
    const said = this.subject.of === "image" ? "" : this.shown.left ? `, ${normalOf(this.shown.left, y * width + x)}` : "";
    this.one("[data-values]").textContent = `Pixel ${x * this.subject.step}, ${y * this.subject.step}${said}`;
  }

  // What is highlighted on the page stands to the right.
  follow(name) {
    const at = this.subject.codecs.findIndex((codec) => codec.label === name || agrees(codec.label, name));
    if (!name || at < 0 || String(at) === this.side("right").value) return;
    this.side("right").value = at;
    this.show();
  }

  // One codec of a subject against the next one, brought into view.
  async open(subject, name, view) {
    this.one("#subject").value = this.data.subjects.indexOf(subject);
    this.begun = this.begin();
    await this.begun;
    const at = subject.codecs.findIndex((codec) => codec.label === name);
    this.side("left").value = at;
    this.side("right").value = (at + 1) % subject.codecs.length;
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
        this.planes(target.dataset.at).then((planes) => planes.draw(target.querySelector("canvas"), view, 1, true), () => {});
      }
    });
    const made = subject.codecs.map((codec, at) => {
      const picture = element("canvas", { role: "img", "aria-label": `${codec.label} in small` });
      const button = element("button", { type: "button", "data-at": at }, picture, element("span", {}, codec.label));
      button.addEventListener("click", () => picked.pick(codec.label));
      seen.observe(button);
      return button;
    });
    this.one(".thumbs").replaceChildren(...made);
  }
}

function normalOf(planes, i) {
  return `exact normal (${[0, 1, 2].map((c) => (planes.exact[4 * i + c] / 127.5 - 1).toFixed(2)).join(", ")})`;
}

// The pictures of an answer: its image, and how far that is off.
async function showAnswer(place) {
  const name = place.dataset.answer;
  for (const subject of viewer.data.subjects) {
    const codec = subject.codecs.find((one) => one.label === name);
    if (!codec || subject.of !== "image") continue;
    const exact = await pixelsOf(subject.original, subject.width, subject.height);
    const planes = await Planes.of(subject, codec, exact), most = 32;
    for (const [view, title] of [["final", "image"], ["apart", `difference, full colour at ${most} of 255`]]) {
      const canvas = element("canvas", { role: "img", "aria-label": `${name}, ${subject.title}: ${title}` });
      planes.draw(canvas, view, most, false);
      const button = element("button", { type: "button" }, canvas, element("span", {}, `${subject.title.replace("the answer on ", "")}: ${title}`));
      button.addEventListener("click", () => viewer.open(subject, name, view));
      place.append(button);
    }
    place.hidden = false;
    return;
  }
}

let viewer = null;
const viewerRoot = document.querySelector("#viewer");
if (viewerRoot) {
  viewer = new Viewer(viewerRoot, JSON.parse(document.querySelector("#picture-data").textContent));
  document.querySelectorAll("[data-answer]").forEach(showAnswer);
  const start = new IntersectionObserver((entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    start.disconnect();
    viewer.begun ||= viewer.begin();
  }, { rootMargin: "600px" });
  start.observe(viewerRoot);
}
