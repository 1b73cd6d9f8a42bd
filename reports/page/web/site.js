"use strict";

// One search for every table of the index: a row is found by its cells, and by what belongs to it on its own page.
const searchField = document.querySelector("#search");

function searchAll() {
  const words = searchField.value.toLowerCase().split(/\s+/).filter(Boolean), counts = [];
  for (const sheet of document.querySelectorAll("[data-searched]")) {
    const rows = Array.from(sheet.querySelector("tbody").rows);
    for (const row of rows) {
      const text = [row.dataset.words, ...cellsOf(row).map((cell) => cell.textContent)].join(" ").toLowerCase();
      row.hidden = !words.every((word) => text.includes(word));
    }
    counts.push(`${sheet.dataset.searched}: ${rows.filter((row) => !row.hidden).length} of ${rows.length}`);
  }
  document.querySelector("#found").textContent = counts.join("; ");
}

if (searchField) {
  searchField.addEventListener("input", searchAll);
  document.querySelector("#searching").hidden = false;
  searchAll();
}
