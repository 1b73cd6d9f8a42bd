"use strict";

// A picture looked at closer: by the wheel, two fingers and keys. Where a pixel is large enough, its numbers stand in it.
const CLOSEST = 112, ROOM = 64, WHEEL = 1.0015, STEP = 1.5, NEAR_LINE = 14;

class Zoom {
  constructor(viewer) {
    const stage = viewer.one(".stage");
    Object.assign(this, { viewer, stage, numbers: viewer.one("[data-numbers]"), fingers: new Map(), drag: null, k: 1, x: 0, y: 0 });
    stage.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    for (const name of ["pointerdown", "pointermove", "pointerup", "pointercancel"]) stage.addEventListener(name, (event) => this[name](event));
    for (const [name, factor] of [["closer", STEP], ["farther", 1 / STEP], ["whole", 0]]) {
      viewer.one(`[data-zoom="${name}"]`).addEventListener("click", () => this.by(factor));
    }
    new ResizeObserver(() => this.show()).observe(stage);
  }

  // Pixels of the screen that one of the whole picture takes.
  get unit() {
    return this.stage.clientWidth / this.viewer.subject.width;
  }

  get most() {
    return Math.max(1, CLOSEST / this.unit);
  }

  // The place in the picture, in its pixels, that is at a place of the window.
  at({ clientX, clientY }) {
    const box = this.stage.getBoundingClientRect(), size = this.unit * this.k;
    return { x: this.x + (clientX - box.left) / size, y: this.y + (clientY - box.top) / size };
  }

  // What is at a place of the window stays there.
  about(event, k) {
    const { x, y } = this.at(event), { left, top } = this.stage.getBoundingClientRect();
    this.k = clamped(k, 1, this.most);
    const size = this.unit * this.k;
    this.moveTo(x - (event.clientX - left) / size, y - (event.clientY - top) / size);
  }

  // About the lens; all of the picture for 0.
  by(factor) {
    const { place } = this.viewer;
    this.k = factor ? clamped(this.k * factor, 1, this.most) : 1;
    this.lookAt(place);
  }

  lookAt({ x, y }) {
    const { width, height } = this.viewer.subject;
    this.moveTo(x + 0.5 - width / this.k / 2, y + 0.5 - height / this.k / 2);
  }

  moveTo(x, y) {
    const { width, height } = this.viewer.subject;
    [this.x, this.y] = [clamped(x, 0, width - width / this.k), clamped(y, 0, height - height / this.k)];
    this.show();
  }

  // Keeps a pixel in sight that the keys went to.
  follow({ x, y }) {
    const { width, height } = this.viewer.subject, isSeen = x >= this.x && y >= this.y && x + 1 <= this.x + width / this.k && y + 1 <= this.y + height / this.k;
    if (isSeen) this.write();
    else this.lookAt({ x, y });
  }

  // The wheel moves the page until the picture has the focus.
  wheel(event) {
    if (!event.ctrlKey && document.activeElement !== this.stage) return;
    event.preventDefault();
    this.about(event, this.k * WHEEL ** -event.deltaY);
  }

  pointerdown(event) {
    this.fingers.set(event.pointerId, event);
    const box = this.stage.getBoundingClientRect(), line = box.left + (box.width * this.viewer.divided) / 100;
    const isLine = this.k === 1 || Math.abs(event.clientX - line) < NEAR_LINE;
    this.drag = this.fingers.size > 1 ? "pinch" : isLine ? "line" : "picture";
  }

  pointermove(event) {
    const before = this.fingers.get(event.pointerId);
    if (!before) return;
    const apart = () => { const [a, b] = this.fingers.values(); return b ? Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY) : 0; };
    const last = apart();
    this.fingers.set(event.pointerId, event);
    const size = this.unit * this.k;
    if (this.drag === "picture") this.moveTo(this.x - (event.clientX - before.clientX) / size, this.y - (event.clientY - before.clientY) / size);
    if (this.drag === "pinch" && last) {
      const [a, b] = this.fingers.values(), middle = { clientX: (a.clientX + b.clientX) / 2, clientY: (a.clientY + b.clientY) / 2 };
      this.about(middle, (this.k * apart()) / last);
    }
  }

  pointerup(event) {
    this.fingers.delete(event.pointerId);
    if (!this.fingers.size) this.drag = null;
  }

  pointercancel(event) {
    this.pointerup(event);
  }

  show() {
    const { width, height } = this.viewer.subject, { style } = this.stage;
    style.setProperty("--k", this.k);
    style.setProperty("--x", `${(-100 * this.x) / width}%`);
    style.setProperty("--y", `${(-100 * this.y) / height}%`);
    style.touchAction = this.k > 1 ? "none" : "";
    if (this.k * this.unit > CELL) this.viewer.one(".lens").hidden = true;
    this.viewer.one('[data-zoom="whole"]').disabled = this.k === 1;
    this.write();
  }

  // The numbers of all pixels in sight, each of the side of the divider that it is on.
  write() {
    const { viewer, numbers, stage } = this, size = this.unit * this.k, { width, height } = viewer.subject;
    numbers.hidden = size < ROOM || SIDES.some((side) => !viewer.shown[side]);
    if (numbers.hidden) return;
    const ratio = window.devicePixelRatio || 1, pen = numbers.getContext("2d");
    [numbers.width, numbers.height] = [stage.clientWidth * ratio, stage.clientHeight * ratio];
    pen.scale(ratio, ratio);
    Object.assign(pen, { font: `${Math.min(11, size / 8)}px ui-monospace, monospace`, textBaseline: "top", lineWidth: 2.5, strokeStyle: "#000", fillStyle: "#fff", lineJoin: "round" });
    const high = Math.min(13, size / 6.5), line = (stage.clientWidth * viewer.divided) / 100;
    for (let y = Math.floor(this.y); y < Math.min(height, this.y + stage.clientHeight / size); y++) {
      for (let x = Math.floor(this.x); x < Math.min(width, this.x + stage.clientWidth / size); x++) {
        const left = (x - this.x) * size, top = (y - this.y) * size, side = left + size / 2 < line ? "left" : "right";
        viewer.shown[side].numbers(y * width + x).forEach((text, at) => {
          pen.strokeText(text, left + 4, top + 4 + at * high);
          pen.fillText(text, left + 4, top + 4 + at * high);
        });
      }
    }
  }
}
