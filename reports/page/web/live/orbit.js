"use strict";

// The camera by hand: a pointer or a finger turns it, a wheel or two fingers come nearer, and so do keys.
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const NEARER = { "+": -1, "=": -1, "-": 1, _: 1 };
// Degrees for a pixel and for a key; how much nearer a step comes, and a pixel of a wheel.
const TURNED = 0.35, KEY_TURNED = 3, STEPPED = 1.1, WHEELED = 1.0015, LINE_PIXELS = 16;

class Orbit {
  constructor(see) {
    this.see = see;
    this.fingers = new Map();
    const { stage, canvas, control } = see, { line } = control;
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.drag(event));
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, ({ pointerId }) => this.fingers.delete(pointerId));
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    // A drag is no press.
    canvas.addEventListener("click", (event) => this.hasTurned && event.stopImmediatePropagation());
    stage.addEventListener("keydown", (event) => this.key(event));
    line.addEventListener("pointerdown", (event) => {
      line.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    line.addEventListener("pointermove", (event) => line.hasPointerCapture(event.pointerId) && this.divide(event));
  }

  divide({ clientX }) {
    const { canvas, control } = this.see, box = canvas.getBoundingClientRect();
    control.divider.value = Math.round((100 * (clientX - box.left)) / box.width);
    this.see.change();
  }

  press(event) {
    if (event.button) return;
    this.see.canvas.setPointerCapture(event.pointerId);
    if (!this.fingers.size) this.hasTurned = false;
    this.fingers.set(event.pointerId, [event.clientX, event.clientY]);
  }

  drag(event) {
    const before = this.fingers.get(event.pointerId), now = [event.clientX, event.clientY];
    if (!before || Math.hypot(now[0] - before[0], now[1] - before[1]) < (this.hasTurned ? 0.5 : 4)) return;
    this.hasTurned = true;
    const apart = this.apart;
    this.fingers.set(event.pointerId, now);
    if (apart) this.nearer(apart / Math.max(this.apart, 1));
    else this.turn(-TURNED * (now[0] - before[0]), TURNED * (now[1] - before[1]));
  }

  // How far two fingers are apart; 0 for one.
  get apart() {
    const [a, b] = this.fingers.values();
    return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0;
  }

  turn(around, over) {
    const { see } = this;
    see.aim({ around: see.value("around") + around, over: see.value("over") + over });
  }

  nearer(by) {
    this.see.aim({ away: this.see.value("away") * by });
  }

  wheel(event) {
    event.preventDefault();
    this.nearer(WHEELED ** Math.max(-400, Math.min(400, event.deltaY * (event.deltaMode ? LINE_PIXELS : 1))));
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target !== this.see.stage) return;
    const [x, y] = ARROWS[event.key] ?? [], step = NEARER[event.key];
    if (x === undefined ? !step : event.shiftKey) return;
    event.preventDefault();
    if (step) this.nearer(STEPPED ** step);
    else this.turn(-x * KEY_TURNED, -y * KEY_TURNED);
  }
}

live.parts.push(() => {
  live.orbit = new Orbit(live.see);
});
