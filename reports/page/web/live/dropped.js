"use strict";

// A file of the reader's: its normals go through the codecs, or it is what surfaces mirror.
const TESTED = 20000, SURE = 0.9, DROPPED_SLOPE = 0.4, BRIGHT = 0.3, MOST_RADIANCE = 60000;

class Dropped {
  constructor(root, see) {
    this.see = see;
    this.field = Object.fromEntries(Array.from(root.querySelectorAll("[data-drop]"), (one) => [one.dataset.drop, one]));
    const { file, kind, flipped, gone } = this.field, place = root.querySelector(".window");
    file.addEventListener("change", () => file.files[0] && this.take(file.files[0]));
    for (const one of [kind, flipped]) one.addEventListener("input", () => this.show());
    gone.addEventListener("click", () => this.forget());
    place.addEventListener("dragover", (event) => event.preventDefault());
    place.addEventListener("drop", (event) => {
      event.preventDefault();
      if (event.dataTransfer.files[0]) this.take(event.dataTransfer.files[0]);
    });
  }

  // A file that cannot be read is said, and changes nothing.
  async take(file) {
    this.field.said.textContent = `Reading ${file.name}`;
    try {
      const bytes = new Uint8Array(await file.arrayBuffer());
      if (isGltf(file.name, bytes)) return this.place(file.name, trianglesOf(bytes));
      this.found = { ...(await pixelsOfFile(file, bytes)), name: file.name };
    } catch (error) {
      this.field.said.textContent = `${file.name} is not shown: ${error instanceof RangeError ? SHORT : error.message}.`;
      return;
    }
    this.field.kind.value = kindOf(this.found.pixels);
    this.field.flipped.checked = false;
    this.show();
  }

  // A model, in the surroundings that there are.
  place(name, triangles) {
    const { see, field } = this;
    this.found = null;
    see.add(DROPPED, sceneOfMesh({ title: name, triangles }));
    see.go(DROPPED);
    field.chosen.hidden = false;
    for (const one of [field.kind, field.flipped]) one.parentNode.hidden = true;
    field.said.textContent = `${name}: ${triangles.count / 3} triangles with the model's normals; no materials or normal maps`;
  }

  show() {
    if (!this.found) return;
    const { name, width, height, full, kind: format } = this.found, kind = this.field.kind.value, { see } = this;
    this.field.chosen.hidden = this.field.kind.parentNode.hidden = false;
    this.field.flipped.parentNode.hidden = kind === "surroundings";
    const part = width < full[0] ? `, ${width} x ${height} of its ${full.join(" x ")} pixels` : "";
    this.field.said.textContent = `${name} as ${this.field.kind.selectedOptions[0].textContent}${part}`;
    if (kind === "surroundings") return this.surround(format);
    see.surround(null);
    const normals = normalsOf(this.found, kind === "coded", this.field.flipped.checked);
    see.add(DROPPED, sceneOf({ title: name, width, height, slope: [DROPPED_SLOPE, (DROPPED_SLOPE * height) / width], normals: async () => normals }));
    see.go(DROPPED);
  }

  surround(format) {
    const { see } = this, pixels = radiances(this.found.pixels, format === "PNG");
    if (see.control.subject.value === DROPPED) see.go(FIRST_SCENE);
    see.control.shown.value = "studio";
    see.surround({ ...this.found, pixels, brightness: brightnessOf(pixels) });
  }

  forget() {
    const { see, field } = this;
    this.found = null;
    see.surround(null);
    if (see.control.subject.value === DROPPED) see.go(FIRST_SCENE);
    see.remove(DROPPED);
    field.chosen.hidden = true;
    field.said.textContent = field.file.value = "";
  }
}

// What pixels are likely to be: unit vectors as they are, unit vectors as colours, or light from all around.
function kindOf(pixels) {
  const step = 4 * Math.max(1, Math.floor(pixels.length / 4 / TESTED)), share = (number) => {
    let unit = 0, all = 0;
    for (let i = 0; i < pixels.length; i += step) {
      const length = Math.hypot(...[0, 1, 2].map((axis) => number(pixels[i + axis])));
      all += length > 0 || Number.isNaN(length) ? 1 : 0;
      unit += Math.abs(length - 1) < 0.05 ? 1 : 0;
    }
    return unit / Math.max(all, 1);
  };
  if (share((c) => c) > SURE) return "vectors";
  return share((c) => 2 * c - 1) > SURE ? "coded" : "surroundings";
}

// Unit normals with the lowest row first; where there is no direction, there is no surface.
function normalsOf({ pixels, width, height }, isCoded, isFlipped) {
  const normals = new Float32Array(4 * width * height), number = (c) => (isCoded ? 2 * c - 1 : c), up = isFlipped ? -1 : 1;
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const from = 4 * (y * width + x), [nx, ny, nz] = [number(pixels[from]), up * number(pixels[from + 1]), number(pixels[from + 2])], length = Math.hypot(nx, ny, nz);
      if (length > 0.1 && length < Infinity) normals.set([nx / length, ny / length, nz / length, 1], 4 * ((height - 1 - y) * width + x));
    }
  }
  return normals;
}

// Light, linear and finite.
function radiances(pixels, isOfScreen) {
  const linear = (c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
  return pixels.map((c) => Math.min(MOST_RADIANCE, Math.max(0, (isOfScreen ? linear(c) : c) || 0)));
}

// What brings the mean of a picture's logarithms to a middle grey.
function brightnessOf(pixels) {
  let sum = 0, count = 0;
  for (let i = 0; i < pixels.length; i += 4, count++) sum += Math.log(1e-4 + 0.2126 * pixels[i] + 0.7152 * pixels[i + 1] + 0.0722 * pixels[i + 2]);
  return BRIGHT / Math.exp(sum / count);
}

live.parts.push((root) => {
  live.dropped = new Dropped(root, live.see);
});
