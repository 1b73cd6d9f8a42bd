"use strict";

// Inspect it: the pixel at the pointer in numbers, and the directions that the codes around its own stand for.
const AROUND = 3;

class Inspect {
  constructor(root, see) {
    this.see = see;
    this.field = Object.fromEntries(Array.from(root.querySelectorAll("[data-inspect]"), (one) => [one.dataset.inspect, one]));
    this.at = [0.4, 0.45];
    this.listen();
    see.listeners.push(() => this.show());
    see.ask();
  }

  listen() {
    const { stage, canvas } = this.see;
    // What is dragged turns the camera; a press that does not move takes the pixel.
    canvas.addEventListener("pointermove", (event) => event.buttons || this.point(event));
    canvas.addEventListener("click", (event) => this.point(event));
    stage.addEventListener("keydown", (event) => {
      const step = ARROWS[event.key];
      if (!step || !event.shiftKey) return;
      event.preventDefault();
      const [x, y] = this.pixel;
      this.go([x + step[0], y + step[1]]);
    });
    for (const name of ["x", "y"]) {
      this.field[name].addEventListener("input", () => {
        if (this.field[name].value !== "") this.go([Number(this.field.x.value), Number(this.field.y.value)], name);
      });
      // What was typed becomes the pixel that is shown.
      this.field[name].addEventListener("change", () => this.show());
    }
  }

  point(event) {
    const { canvas, size } = this.see, box = canvas.getBoundingClientRect();
    this.go([((event.clientX - box.left) / box.width) * size[0], ((event.clientY - box.top) / box.height) * size[1]].map(Math.floor));
  }

  // From the upper left corner.
  get pixel() {
    const [width, height] = this.see.size;
    return [Math.min(width - 1, Math.floor(this.at[0] * width)), Math.min(height - 1, Math.floor(this.at[1] * height))];
  }

  go([x, y], typed = "") {
    const [width, height] = this.see.size, kept = (value, size) => (Math.min(size - 1, Math.max(0, Math.floor(value) || 0)) + 0.5) / size;
    this.at = [kept(x, width), kept(y, height)];
    this.typed = typed;
    this.waiting ||= requestAnimationFrame(() => {
      this.waiting = 0;
      if (this.see.isDone) this.show();
    });
  }

  show() {
    if (this.see.device.isLost) return;
    const [x, y] = this.pixel, { stage } = this.see;
    for (const [name, value] of [["x", x], ["y", y]]) if (this.typed !== name) this.field[name].value = value;
    this.typed = "";
    stage.style.setProperty("--x", `${100 * this.at[0]}%`);
    stage.style.setProperty("--y", `${100 * this.at[1]}%`);
    const found = { left: this.read("left"), right: this.read("right") };
    const { normal, covered } = found.left;
    this.field.normal.textContent = covered ? `Exact normal ${vectorText(normal)}, view space.` : "There is no surface here.";
    for (const side of ["left", "right"]) this.field[side].textContent = covered ? this.text(side, found[side]) : "";
    this.around(found.right.codec ? found.right : found.left);
  }

  // A pixel of one side. Its code is drawn anew, because a side is drawn only where it is seen.
  read(side) {
    const { see } = this, { device } = see, codec = see.codec(side), uniforms = see.uniforms(), [x, y] = this.pixel;
    const row = see.canvas.height - 1 - y, made = codec ? see.encode(side, codec, uniforms, [x, row, 1, 1]) : null;
    const program = device.program(...see.inspected(side)), given = codec ? see.texels(codec, made) : { surfaces: see.seen };
    const target = device.target(device.gl.RGBA32UI, 4, 1);
    device.draw(program, target, { ...uniforms, pixel: { ints: [x, row] } }, given);
    const words = device.words(target), three = (at) => Array.from(words.slice(4 * at, 4 * at + 3), floatOf);
    device.release(target);
    const texel = Array.from(words.slice(8, 12));
    return { codec, normal: three(0), decoded: three(1), texel, view: three(3), covered: words[3] === 1, isFewer: see.levels > 0 };
  }

  text(side, { codec, normal, decoded, texel, isFewer }) {
    const name = `${side === "left" ? "Left" : "Right"}, ${codec?.label ?? EXACT}`;
    if (!codec) return `${name}.`;
    const code = isFewer
      ? `numbers ${texel.slice(0, codec.size).map((word) => digits(floatOf(word), 5)).join(", ")}`
      : `bits ${numbersIn(codec, texel).map((number, at) => number.toString(2).padStart(codec.channels[at].bits, "0")).join(" ")}`;
    return `${name}: ${code}; decodes to ${vectorText(decoded)}, off by ${digits(angleBetween(normal, decoded))}°.`;
  }

  // The directions of the codes around, seen along the exact normal.
  around({ codec, normal, decoded, texel, view, covered, isFewer }) {
    const canvas = this.field.sphere, pen = canvas.getContext("2d");
    pen.clearRect(0, 0, canvas.width, canvas.height);
    this.field.around.textContent = "";
    if (!codec || !covered || isFewer) return;
    const near = this.decoded(codec, this.neighbours(codec, numbersIn(codec, texel)), view, codec.sign_bits ? (normal[2] < 0 ? -1 : 1) : 1);
    const side = unit3(cross3(Math.abs(normal[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0], normal)), up = cross3(normal, side);
    const flat = (n) => scaled([dot3(n, side), dot3(n, up)], angleBetween(normal, n) / Math.max(Math.hypot(dot3(n, side), dot3(n, up)), 1e-30));
    const points = near.filter((n) => n.every(Number.isFinite)).map(flat), own = flat(decoded);
    const nearest = points.map((p) => Math.hypot(p[0] - own[0], p[1] - own[1])).filter((d) => d > 0).sort((a, b) => a - b);
    const reach = Math.max(3 * (nearest[Math.min(3, nearest.length - 1)] ?? 0), 1.3 * Math.hypot(...own), 1e-6);
    drawAround(pen, canvas.width, { points, own, reach, colour: getComputedStyle(canvas) });
    this.field.around.textContent = `Codes of ${codec.label} around the exact normal, which is at the centre (cross). The filled point is the code used. The image is ${digits(2 * reach)}° wide.`;
  }

  // Texels whose numbers are up to AROUND steps away; of three numbers one step less, because there are more of them.
  neighbours(codec, numbers) {
    const isPacked = codec.bytes > 0, reach = codec.channels.length > 2 ? AROUND - 1 : AROUND;
    let all = [[]];
    for (const [at, channel] of codec.channels.entries()) {
      const [least, most] = places(channel, isPacked), own = placeOf(channel, isPacked, numbers[at]);
      const steps = Array.from({ length: 2 * reach + 1 }, (_, step) => own + step - reach).filter((place) => place >= least && place <= most);
      all = all.flatMap((before) => steps.map((place) => [...before, bitsAt(channel, isPacked, place)]));
    }
    return all.map((one) => wordsOf(codec, one));
  }

  decoded(codec, texels, view, sign) {
    const { device } = this.see, width = texels.length, texture = device.texture("RGBA32UI", width, 1, new Uint32Array(texels.flat()));
    const target = device.target(device.gl.RGBA32UI, width, 1);
    device.draw(device.program(codec, ["neighbours.frag"]), target, { view, sign_of_all: sign }, { ...device.tablesOf(codec), texels: texture });
    const words = device.words(target);
    device.release(texture);
    device.release(target);
    return texels.map((_, at) => Array.from(words.slice(4 * at, 4 * at + 3), floatOf));
  }
}

function vectorText(v) {
  return `(${v.map((x) => x.toFixed(5)).join(", ")})`;
}

function drawAround(pen, size, { points, own, reach, colour }) {
  const at = ([x, y]) => [size / 2 + (x / reach) * (size / 2), size / 2 - (y / reach) * (size / 2)];
  const ink = colour.color, dot = (p, radius, fill) => {
    pen.beginPath();
    pen.arc(...at(p), radius, 0, 2 * Math.PI);
    if (fill) pen.fill();
    else pen.stroke();
  };
  pen.strokeStyle = pen.fillStyle = ink;
  pen.lineWidth = 1;
  for (const p of points) dot(p, 3, false);
  pen.lineWidth = 2;
  dot(own, 5, true);
  const middle = size / 2;
  pen.beginPath();
  for (const [x, y] of [[1, 0], [0, 1]]) {
    pen.moveTo(middle - 8 * x, middle - 8 * y);
    pen.lineTo(middle + 8 * x, middle + 8 * y);
  }
  pen.moveTo(middle, middle);
  pen.lineTo(...at(own));
  pen.stroke();
}

live.parts.push((root) => {
  live.inspect = new Inspect(root, live.see);
});
