"use strict";

// Figures of several runs: one column of a table at a time, what differs marked.
function showFigures(part, data) {
  const select = part.querySelector("[data-figure]"), only = part.querySelector("[data-only]");
  const body = part.querySelector("tbody"), heads = Array.from(part.querySelectorAll("thead th.n"));
  const better = select.selectedOptions[0].dataset.better;
  for (const head of heads) {
    head.dataset.better = better;
    head.setAttribute("aria-sort", "none");
  }
  const rows = data.columns[select.value].map(([name, values]) => {
    const known = values.filter((value) => value !== null), differs = known.some((value) => value !== known[0]);
    const row = element("tr", differs ? { class: "differs" } : {}, element("th", { scope: "row" }, name));
    for (const value of values) row.append(element("td", { class: "n", "data-v": value ?? "" }, textOf(value, !Number.isInteger(value))));
    row.hidden = only.checked && !differs;
    return row;
  });
  body.replaceChildren(...rows);
  part.querySelector("[data-shown]").textContent = `${rows.filter((row) => !row.hidden).length} of ${rows.length} rows`;
}

for (const part of document.querySelectorAll("[data-figures]")) {
  const data = JSON.parse(part.querySelector("script[type='application/json']").textContent);
  for (const control of part.querySelectorAll("[data-figure], [data-only]")) {
    control.addEventListener("change", () => showFigures(part, data));
  }
  part.querySelector(".choices").hidden = false;
}
