"use strict";

// Figures: their charts, and d3, are unpacked when the first one comes into view, or the page is idle; text is painted before.
const toolsOf = (figure) => figure.querySelector("[data-tools]");
const painted = new Promise((done) => (document.hidden ? done() : requestAnimationFrame(() => setTimeout(done))));

function ready() {
  charts.ready ||= painted.then(() => Promise.all([unpacked("#chart-specs"), unpacked("#chart-library")])).then(([text, library]) => {
    document.head.append(element("script", {}, library));
    charts.specs = JSON.parse(text);
    performance.mark("first chart");
  });
  return charts.ready;
}

// What a pointer or a key has found, next to it.
function tooltip(hit, x, y) {
  charts.tip?.remove();
  if (!hit) return;
  const tip = (charts.tip = document.body.appendChild(element("dl", { class: "tip", "aria-hidden": "true" })));
  tip.replaceChildren(...told(hit).flatMap(([title, text]) => [element("dt", {}, title), element("dd", {}, text)]));
  const { width, height } = tip.getBoundingClientRect();
  tip.style.left = `${clamped(x + 14, 4, innerWidth - width - 4)}px`;
  tip.style.top = `${y + 14 + height > innerHeight ? y - height - 10 : y + 14}px`;
}

// Where a panel has A or B, the rest is faint, and a name for which there was no room is seen.
const faint = document.head.appendChild(element("style", {}));
shows.push((state) => {
  const same = CODECS.map((side) => state[side]).filter(Boolean).map(sameAs).join(", ");
  const rest = `.plot:has(${same}) [data-codec]:not(${same}) { opacity: var(--rest); }`;
  const text = same ? `${rest}\n.plot .unplaced:is(${same}) { display: inline; }` : "";
  if (faint.textContent !== text) faint.textContent = text;
});

// A codec of a mark is chosen as a name is.
function pick(codec, isB) {
  const name = codec && codecNamed(codec);
  if (name) choose(name, isB);
}

function drawLate() {
  const [view] = charts.late;
  charts.late.delete(view);
  view.draw();
  if (charts.late.size) requestAnimationFrame(drawLate);
}

// Draws the next panel of a figure, if there is one.
function drawNext(figure) {
  const { panels, ...spec } = charts.specs[figure.dataset.chart], plots = Array.from(figure.querySelectorAll(".plot"));
  const at = plots.findIndex((plot) => !charts.views.has(plot));
  if (at >= 0) {
    // By its place, not by a count: what comes into view first is drawn first.
    charts.views.set(plots[at], new View(plots[at], spec, panels[at], `${figure.dataset.chart}-panel-${at}`));
    plots[at].dispatchEvent(new Event("drawn", { bubbles: true }));
  }
  if (at === plots.length - 1) addSaving(figure);
  return at >= 0;
}

async function drawn(figure) {
  if (!charts.waiting.delete(figure)) return;
  coming.unobserve(figure);
  try {
    await ready();
    // Each panel in a task of its own, so that the page answers in between.
    do await new Promise((done) => setTimeout(done));
    while (drawNext(figure));
  } catch (error) {
    toolsOf(figure).append(`The chart cannot be drawn: ${error.message}`);
  }
}

const coming = new IntersectionObserver((entries) => {
  for (const { isIntersecting, target } of entries) if (isIntersecting) drawn(target);
}, { rootMargin: "400px" });

for (const figure of document.querySelectorAll("figure[data-chart]")) {
  charts.waiting.add(figure);
  coming.observe(figure);
  figure.querySelector("[data-switch]")?.addEventListener("change", () => {
    for (const plot of figure.querySelectorAll(".plot")) charts.views.get(plot)?.draw();
  });
}

// What nobody has come to is drawn when there is nothing else to do, in the view that is shown. What lies in a closed fold waits.
const idle = window.requestIdleCallback ?? setTimeout, isFolded = (figure) => figure.closest("details:not([open])");
async function drawRest() {
  if (charts.waiting.size) await ready();
  for (const figure of charts.waiting) {
    if (!isFolded(figure) && !figure.closest(".view[hidden]")) await drawn(figure);
    await new Promise(idle);
  }
}
window.addEventListener("load", () => idle(drawRest));

// The charts of a view that was left take no elements; paper has them all.
shows.push(({ view }, before) => {
  if (view === before.view) return;
  for (const [plot, one] of charts.views) {
    const isLeft = Boolean(plot.closest(".view[hidden]"));
    if (isLeft) one.svg.selectAll("*").remove();
    else if (one.isLeft) one.later();
    one.isLeft = isLeft;
  }
});
window.addEventListener("beforeprint", () => {
  if (!charts.specs) return;
  for (const one of charts.views.values()) if (one.isLeft) one.draw();
  for (const figure of document.querySelectorAll("figure[data-chart]")) while (!isFolded(figure) && drawNext(figure));
});

// A figure as a file: its panels as they are drawn, with the colours that are seen, its title and its legend.
function plainly(one, copy) {
  const css = getComputedStyle(one);
  if (css.display === "none") return copy.remove();
  copy.removeAttribute("style");
  for (const name of ["fill", "stroke", "stroke-width", "opacity", "fill-opacity", "font-size", "font-family"]) copy.setAttribute(name, css.getPropertyValue(name));
}

function asSvg(figure) {
  const drawn = figure.querySelector("[data-drawn]"), box = drawn.getBoundingClientRect(), above = 26, css = getComputedStyle(document.body);
  const made = set(d3.create("svg:svg"), { xmlns: "http://www.w3.org/2000/svg", "font-family": FONT, width: box.width, height: box.height + above });
  set(made.append("rect"), { width: "100%", height: "100%", fill: css.backgroundColor });
  const text = (said, x, y, size) => set(made.append("text"), { x, y, "font-size": size, fill: css.color }).text(said);
  text(fitted(figure.dataset.title, box.width, 13), 0, 16, 13);
  for (const svg of drawn.querySelectorAll("svg")) {
    const at = svg.getBoundingClientRect(), copy = svg.cloneNode(true), copied = copy.querySelectorAll("*");
    svg.querySelectorAll("*").forEach((one, index) => plainly(one, copied[index]));
    set(d3.select(copy), { x: at.left - box.left, y: at.top - box.top + above, width: at.width, height: at.height, style: null });
    made.node().append(copy);
  }
  for (const said of drawn.querySelectorAll("[data-key]")) {
    const at = said.getBoundingClientRect();
    text(said.textContent, at.left - box.left, at.top - box.top + above + 0.72 * at.height, TEXT);
  }
  return `data:image/svg+xml;charset=utf-8,${encodeURIComponent(new XMLSerializer().serializeToString(made.node()))}`;
}

async function asPng(figure) {
  const image = new Image(), canvas = element("canvas", {});
  image.src = asSvg(figure);
  await image.decode();
  [canvas.width, canvas.height] = [image.width * 2, image.height * 2];
  canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
  return canvas.toDataURL("image/png");
}

function addSaving(figure) {
  for (const [kind, made] of [["png", asPng], ["svg", asSvg]]) {
    const of = element("span", { class: "visually-hidden" }, `: ${figure.dataset.title}`);
    const button = element("button", { type: "button", [`data-${kind}`]: "" }, `Save as ${kind.toUpperCase()}`, of);
    button.addEventListener("click", async () => save(`${figure.dataset.chart}.${kind}`, await made(figure)));
    toolsOf(figure).append(button);
  }
}
