"use strict";

// Charts by Vega-Lite, unpacked when the first one comes into view. What they say is read without `eval`.
const charts = { views: [] };

function library() {
  charts.library ||= unpacked("#chart-library").then((text) => {
    document.head.append(element("script", {}, text));
  });
  return charts.library;
}

function specs() {
  charts.specs ||= unpacked("#chart-specs").then(JSON.parse);
  return charts.specs;
}

// Canvas, of which PNG files are made, knows no variables of CSS.
function withColours(spec) {
  const style = getComputedStyle(document.documentElement), probe = document.body.appendChild(document.createElement("i"));
  const text = JSON.stringify(spec).replace(/var\((--[\w-]+)\)/g, (_, name) => {
    probe.style.color = style.getPropertyValue(name);
    return getComputedStyle(probe).color;
  });
  const paper = (probe.style.color = style.getPropertyValue("--paper"), getComputedStyle(probe).color);
  probe.remove();
  return { ...JSON.parse(text), background: paper };
}

const OPTIONS = { ast: true, actions: false, renderer: "svg", tooltip: { theme: "page" } };

async function draw(figure) {
  const [all] = await Promise.all([specs(), library()]), shown = [];
  const plots = Array.from(figure.querySelectorAll(".plot"));
  for (const [at, spec] of all[figure.dataset.chart].entries()) {
    const { view } = await vegaEmbed(plots[at], spec, OPTIONS);
    charts.views.push({ view, spec });
    highlight(view, spec);
    view.addEventListener("click", (event, item) => item?.datum?.codec && choose(codecNamed(item.datum.codec), event.shiftKey));
    const said = typeof spec.title?.text === "string" ? spec.title.text : spec.description;
    const title = element("span", { class: "visually-hidden" }, `: ${said}`);
    const button = element("button", { type: "button", "data-png": "" }, "Save as PNG", title);
    button.addEventListener("click", () => png(spec, view, plots[at].clientWidth, figure.dataset.chart));
    figure.querySelector(".tools").append(button);
    shown.push(view);
  }
  if (all[figure.dataset.chart][0].usermeta?.switch) figure.prepend(control(all[figure.dataset.chart][0], shown));
}

// A stands out where the chart has it.
function highlight(view, spec) {
  const has = JSON.stringify(spec).includes(JSON.stringify(state.a));
  view.signal("picked", has ? state.a : "").runAsync();
}

// One control for all charts of a figure, which sets a parameter that each of them has.
function control(spec, views) {
  const { param, label, options } = spec.usermeta.switch;
  const chosen = spec.params.find(({ name }) => name === param).value;
  const select = element("select", {}, ...options.map((name) => element("option", name === chosen ? { selected: "" } : {}, name)));
  select.addEventListener("change", () => views.forEach((view) => view.signal(param, select.value).runAsync()));
  return element("p", { class: "tools" }, element("label", {}, `${label} `, select));
}

// As it is shown: with what is highlighted and the bits that are chosen.
async function png(spec, shown, width, name) {
  const params = spec.params.map(({ name: param }) => ({ name: param, value: shown.signal(param) }));
  const made = await vegaEmbed(document.createElement("div"), { ...withColours({ ...spec, params }), width }, { ...OPTIONS, renderer: "canvas" });
  save(`${name}.png`, await made.view.toImageURL("png", 2));
  made.finalize();
}

shows.push((state, before) => {
  if (state.a !== before.a) for (const { view, spec } of charts.views) highlight(view, spec);
});

const coming = new IntersectionObserver((entries) => {
  for (const { isIntersecting, target } of entries) {
    if (!isIntersecting) continue;
    coming.unobserve(target);
    draw(target).catch((error) => target.querySelector(".tools").append(`The chart cannot be drawn: ${error.message}`));
  }
}, { rootMargin: "400px" });
for (const figure of document.querySelectorAll("figure[data-chart]")) coming.observe(figure);
