"use strict";

// The camera by hand: a pointer or a finger turns it, a wheel or two fingers come nearer, and so do keys.
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const NEARER = { "+": -1, "=": -1, "-": 1, _: 1 };
// Degrees for a pixel and for a key; how much nearer a step comes, and a pixel of a wheel.
const TURNED = 0.35, KEY_TURNED = 3, STEPPED = 1.1, WHEELED = 1.0015, LINE_PIXELS = 16;

// It turns what has `turn`, in degrees around and above, and `nearer`, a factor.
class Orbit {
  constructor(turned) {
    this.turned = turned;
    this.fingers = new Map();
  }

  // Takes a canvas in hand, and keys where the focus is. Where the page scrolls, a wheel counts after a press alone, until the
  // pointer leaves.
  hold(canvas, focus, scrolls = false) {
    this.pressed = scrolls ? null : canvas;
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.drag(event));
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, ({ pointerId }) => this.fingers.delete(pointerId));
    if (scrolls) canvas.addEventListener("pointerleave", () => (this.pressed = null));
    canvas.addEventListener("wheel", (event) => canvas === this.pressed && this.wheel(event), { passive: false });
    // A drag is no press.
    canvas.addEventListener("click", (event) => this.hasTurned && this.spend(event));
    focus.addEventListener("keydown", (event) => event.target === focus && this.key(event));
  }

  spend(event) {
    event.stopImmediatePropagation();
    event.preventDefault();
  }

  press(event) {
    if (event.button) return;
    this.pressed = event.currentTarget;
    this.pressed.setPointerCapture(event.pointerId);
    if (!this.fingers.size) this.hasTurned = false;
    this.fingers.set(event.pointerId, [event.clientX, event.clientY]);
  }

  drag(event) {
    const before = this.fingers.get(event.pointerId), now = [event.clientX, event.clientY];
    if (!before || Math.hypot(now[0] - before[0], now[1] - before[1]) < (this.hasTurned ? 0.5 : 4)) return;
    this.hasTurned = true;
    const apart = this.apart;
    this.fingers.set(event.pointerId, now);
    if (apart) this.turned.nearer(apart / Math.max(this.apart, 1));
    else this.turned.turn(-TURNED * (now[0] - before[0]), TURNED * (now[1] - before[1]));
  }

  // How far two fingers are apart; 0 for one.
  get apart() {
    const [a, b] = this.fingers.values();
    return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0;
  }

  wheel(event) {
    event.preventDefault();
    this.turned.nearer(WHEELED ** Math.max(-400, Math.min(400, event.deltaY * (event.deltaMode ? LINE_PIXELS : 1))));
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const [x, y] = ARROWS[event.key] ?? [], step = NEARER[event.key];
    if (x === undefined ? !step : event.shiftKey) return;
    event.preventDefault();
    if (step) this.turned.nearer(STEPPED ** step);
    else this.turned.turn(-x * KEY_TURNED, -y * KEY_TURNED);
  }
}
