"use strict";

// Tables: sorted by a button in each header, filtered by words that all must occur.
function cellsOf(row) {
  return Array.from(row.children);
}

function compared(a, b, numeric, direction) {
  // What is empty stays last, whichever way.
  if (!a || !b) return !a - !b;
  const order = numeric ? number(a) - number(b) : a.localeCompare(b, "en", { numeric: true });
  return direction * (order || 0);
}

function number(text) {
  return Number(text.replace("inf", "Infinity"));
}

function sortBy(header) {
  const table = header.closest("table"), body = table.tBodies[0];
  const index = cellsOf(header.parentNode).indexOf(header), numeric = header.classList.contains("n");
  const ascending = header.getAttribute("aria-sort") !== "ascending";
  for (const other of cellsOf(header.parentNode)) other.setAttribute("aria-sort", "none");
  header.setAttribute("aria-sort", ascending ? "ascending" : "descending");
  const value = (row) => row.children[index].dataset.v;
  const rows = Array.from(body.rows);
  rows.sort((a, b) => compared(value(a), value(b), numeric, ascending ? 1 : -1));
  body.append(...rows);
}

function filter(sheet) {
  const words = sheet.querySelector("[data-filter]").value.toLowerCase().split(/\s+/).filter(Boolean);
  const rows = Array.from(sheet.querySelector("tbody").rows);
  for (const row of rows) {
    const text = cellsOf(row).map((cell) => cell.textContent.toLowerCase()).join(" ");
    row.hidden = !words.every((word) => text.includes(word));
  }
  const left = rows.filter((row) => !row.hidden).length;
  sheet.querySelector("[data-count]").textContent = `${left} of ${rows.length} rows`;
}

for (const sheet of document.querySelectorAll("[data-sheet]")) {
  for (const header of sheet.querySelectorAll("thead th")) {
    header.querySelector("button").addEventListener("click", () => sortBy(header));
  }
  const field = sheet.querySelector("[data-filter]");
  if (field) field.addEventListener("input", () => filter(sheet));
}

// Light, dark, or as the system has it.
const THEMES = { "": "as the system", light: "light", dark: "dark" };

function setTheme(name) {
  if (name) document.documentElement.dataset.theme = name;
  else delete document.documentElement.dataset.theme;
  document.querySelector("#theme span").textContent = THEMES[name];
}

function remembered(name) {
  // A file's page may not be let to remember anything.
  try {
    if (name === undefined) return localStorage.getItem("normalbench-theme") || "";
    localStorage.setItem("normalbench-theme", name);
  } catch (error) {
    if (!(error instanceof DOMException)) throw error;
  }
  return "";
}

const themeButton = document.querySelector("#theme");
themeButton.hidden = false;
themeButton.addEventListener("click", () => {
  const names = Object.keys(THEMES), now = document.documentElement.dataset.theme || "";
  const next = names[(names.indexOf(now) + 1) % names.length];
  setTheme(next);
  remembered(next);
});
const kept = remembered();
setTheme(kept in THEMES ? kept : "");

// Pictures: two beside each other under a divider, and their pixels around a place.
const SIDES = ["left", "right"];

function penOf(canvas) {
  return canvas.getContext("2d", { willReadFrequently: true });
}

class Viewer {
  constructor(root) {
    this.root = root;
    this.buttons = Array.from(document.querySelectorAll(".thumbs button"));
    this.place = { x: 0, y: 0 };
    this.byName = Object.create(null);
    for (const button of this.buttons) {
      (this.byName[button.dataset.codec] ||= Object.create(null))[button.dataset.kind] = button.querySelector("img");
    }
    for (const side of SIDES) this.fill(side);
    this.listen();
    root.hidden = false;
  }

  one(selector) {
    return this.root.querySelector(selector);
  }

  pick(side, what) {
    return this.one(`[data-pick="${side}-${what}"]`);
  }

  fill(side) {
    const names = Object.keys(this.byName), judged = names.filter((name) => "error" in this.byName[name]);
    for (const name of names) this.pick(side, "codec").add(new Option(name));
    this.pick(side, "codec").value = judged[Math.min(SIDES.indexOf(side), judged.length - 1)] || names[0];
    this.kinds(side, "error");
  }

  kinds(side, wanted) {
    const select = this.pick(side, "kind"), pictures = this.byName[this.pick(side, "codec").value];
    select.replaceChildren();
    for (const [kind, image] of Object.entries(pictures)) {
      select.add(new Option(image.parentNode.querySelector("span").textContent, kind));
    }
    select.value = wanted in pictures ? wanted : Object.keys(pictures)[0];
  }

  image(side) {
    return this.byName[this.pick(side, "codec").value][this.pick(side, "kind").value];
  }

  listen() {
    for (const side of SIDES) {
      this.pick(side, "codec").addEventListener("change", () => {
        this.kinds(side, this.pick(side, "kind").value);
        this.show(side);
      });
      this.pick(side, "kind").addEventListener("change", () => this.show(side));
    }
    for (const button of this.buttons) button.addEventListener("click", () => this.choose(button));
    this.one("#divider").addEventListener("input", () => this.divide());
    const stage = this.one("[data-stage]");
    stage.addEventListener("pointerdown", (event) => this.point(event));
    stage.addEventListener("pointermove", (event) => event.buttons && this.point(event));
    for (const axis of ["x", "y"]) {
      this.one(`#zoom-${axis}`).addEventListener("input", (event) => {
        this.place[axis] = Number(event.target.value) || 0;
        this.zoom();
      });
    }
    this.one("#zoom-by").addEventListener("change", () => this.zoom());
  }

  choose(button) {
    this.pick("right", "codec").value = button.dataset.codec;
    this.kinds("right", button.dataset.kind);
    this.show("right");
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.one("#divider").focus({ preventScroll: true });
    this.root.scrollIntoView({ behavior: calm ? "auto" : "smooth" });
  }

  async start() {
    await Promise.all(SIDES.map((side) => this.show(side)));
    const canvas = this.one('[data-canvas="left"]');
    this.place = { x: Math.floor(canvas.width / 2), y: Math.floor(canvas.height / 2) };
    this.zoom();
  }

  async show(side) {
    const image = this.image(side), canvas = this.one(`[data-canvas="${side}"]`);
    await image.decode();
    if (image !== this.image(side)) return;
    canvas.width = image.naturalWidth;
    canvas.height = image.naturalHeight;
    penOf(canvas).drawImage(image, 0, 0);
    canvas.setAttribute("aria-label", `${side} of the divider: ${image.alt}`);
    this.zoom();
  }

  divide() {
    const at = this.one("#divider").value;
    this.one("[data-stage]").style.setProperty("--at", `${at}%`);
    this.one("[data-divided]").textContent = `${at} %`;
  }

  point(event) {
    const stage = this.one("[data-stage]").getBoundingClientRect(), canvas = this.one('[data-canvas="left"]');
    this.place = {
      x: Math.floor(((event.clientX - stage.left) / stage.width) * canvas.width),
      y: Math.floor(((event.clientY - stage.top) / stage.height) * canvas.height),
    };
    this.zoom();
  }

  zoom() {
    const canvas = this.one('[data-canvas="left"]');
    for (const [axis, size] of [["x", canvas.width], ["y", canvas.height]]) {
      this.place[axis] = Math.max(0, Math.min(size - 1, Math.floor(this.place[axis])));
      const field = this.one(`#zoom-${axis}`);
      field.max = size - 1;
      if (document.activeElement !== field || Number(field.value) !== this.place[axis]) field.value = this.place[axis];
    }
    this.one("[data-values]").textContent = `At ${this.place.x}, ${this.place.y}: ` + SIDES.map((s) => this.magnify(s)).join("; ");
  }

  // The pixels around the place, each as a square; says the pixel's own values.
  magnify(side) {
    const from = this.one(`[data-canvas="${side}"]`), to = this.one(`[data-zoom="${side}"]`);
    const by = Number(this.one("#zoom-by").value), wide = to.width / by, high = to.height / by;
    const left = Math.max(0, Math.min(from.width - wide, this.place.x - Math.floor(wide / 2)));
    const top = Math.max(0, Math.min(from.height - high, this.place.y - Math.floor(high / 2)));
    const pen = to.getContext("2d");
    pen.imageSmoothingEnabled = false;
    pen.clearRect(0, 0, to.width, to.height);
    pen.drawImage(from, left, top, wide, high, 0, 0, to.width, to.height);
    pen.strokeStyle = "#fff";
    pen.strokeRect((this.place.x - left) * by + 0.5, (this.place.y - top) * by + 0.5, by - 1, by - 1);
    const here = this.one(".here").style, share = (value, size) => `${(100 * value) / size}%`;
    Object.assign(here, { left: share(left, from.width), top: share(top, from.height) });
    Object.assign(here, { width: share(wide, from.width), height: share(high, from.height) });
    this.one(`[data-said="${side}"]`).textContent = this.image(side).alt;
    const values = penOf(from).getImageData(this.place.x, this.place.y, 1, 1).data;
    return `${side} ${Array.from(values.slice(0, 3)).join(" ")}`;
  }
}

const root = document.querySelector("#viewer");
if (root) new Viewer(root).start();

// The sphere: the mean or the largest angle of each cell.
const which = document.querySelector("#which");
if (which) {
  const show = (value) => {
    for (const image of document.querySelectorAll("[data-which]")) image.hidden = image.dataset.which !== value;
  };
  which.hidden = false;
  which.addEventListener("change", (event) => show(event.target.value));
  show("mean");
}
