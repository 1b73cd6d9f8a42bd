"use strict";

const clamped = (value, low, high) => Math.max(low, Math.min(high, value));

// Bytes of base64.
function bytesOf(text) {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
}

// The text of an element that holds it packed, as packing.py does.
async function unpacked(id) {
  const packed = new Blob([bytesOf(document.querySelector(id).textContent)]);
  return new Response(packed.stream().pipeThrough(new DecompressionStream("deflate-raw"))).text();
}

function element(tag, attributes, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else made.setAttribute(name, value);
  }
  made.append(...children);
  return made;
}

// Tables: sorted by a button in each header, filtered by words that all must occur.
function cellsOf(row) {
  return Array.from(row.children);
}

function valueOf(cell) {
  return cell.dataset.v ?? cell.textContent;
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

// The first click puts the best on top, the second the worst.
function nextOrder(better, order) {
  const [first, second] = better === "more" ? ["descending", "ascending"] : ["ascending", "descending"];
  return order === first ? second : first;
}

// A table with a button for more keeps all of its rows, and shows a hundred of those that are left, then a hundred more.
const LINES = 100;
const moreOf = (table) => table.closest("[data-sheet]").querySelector("[data-more]");
function allRows(table) {
  if (!moreOf(table)) return Array.from(table.tBodies[0].rows);
  return (table.all ??= Array.from(table.tBodies[0].rows));
}

function showRows(table, rows = allRows(table)) {
  const more = moreOf(table), left = rows.filter((row) => !row.hidden), lines = Number(more?.value);
  table.tBodies[0].replaceChildren(...(more ? left.slice(0, lines) : rows));
  if (!more) return;
  more.hidden = left.length <= lines;
  more.textContent = `Show ${Math.min(LINES, left.length - lines)} more of ${left.length}`;
  for (const button of table.querySelectorAll("[data-name]")) pressed(button);
  for (const button of table.querySelectorAll("[data-take]")) taken(button);
}

function sortBy(header) {
  const table = header.closest("table");
  const index = cellsOf(header.parentNode).indexOf(header), numeric = header.classList.contains("n");
  const order = nextOrder(header.dataset.better, header.getAttribute("aria-sort"));
  for (const other of cellsOf(header.parentNode)) other.setAttribute("aria-sort", "none");
  header.setAttribute("aria-sort", order);
  const value = (row) => valueOf(row.children[index]);
  showRows(table, allRows(table).sort((a, b) => compared(value(a), value(b), numeric, order === "ascending" ? 1 : -1)));
}

function filter(sheet) {
  const words = sheet.querySelector("[data-filter]").value.toLowerCase().split(/\s+/).filter(Boolean);
  const table = sheet.querySelector("table"), rows = allRows(table);
  for (const row of rows) {
    const text = cellsOf(row).map((cell) => cell.textContent.toLowerCase()).join(" ");
    row.hidden = !words.every((word) => text.includes(word));
  }
  const left = rows.filter((row) => !row.hidden).length;
  showRows(table, rows);
  sheet.querySelector("[data-count]").textContent = `${left} of ${rows.length} rows`;
}

// What is shown of a table: titles and rows, as filtered and sorted.
function shownOf(table, read) {
  const isText = (cell) => !cell.matches(".take"), titles = cellsOf(table.tHead.rows[0]).filter(isText).map((cell) => cell.textContent.trim());
  const rows = allRows(table).filter((row) => !row.hidden);
  return [titles, ...rows.map((row) => cellsOf(row).filter(isText).map(read))];
}

// A figure with four digits, as tables.py shows it.
function textOf(value, isFloat) {
  if (value === null) return "";
  if (!isFloat || !Number.isFinite(value)) return String(value).replace("Infinity", "inf");
  const text = Math.abs(value) < 1e-3 && value ? value.toExponential(2) : value.toPrecision(4);
  return text.replace(/e([+-])(\d)$/, "e$10$2");
}

function markdownOf(titles, numeric, rows) {
  const line = (texts) => `| ${texts.map((text) => text.replace(/([|\\`*_<>[\]])/g, "\\$1")).join(" | ")} |`;
  const rule = numeric.map((is) => (is ? "---:" : "---"));
  return [line(titles), `| ${rule.join(" | ")} |`, ...rows.map(line)].join("\n") + "\n";
}

function asMarkdown(table) {
  const [titles, ...rows] = shownOf(table, (cell) => cell.textContent.trim().replace("\n", ", "));
  return markdownOf(titles, cellsOf(table.tHead.rows[0]).filter((cell) => !cell.matches(".take")).map((cell) => cell.classList.contains("n")), rows);
}

// A spreadsheet shows text behind an apostrophe, and computes nothing. What it takes for a number is harmless.
function safeInSheets(text) {
  return /^[=+\-@\t\r]/.test(text) && !/^([-+]?(\d+(\.\d*)?(e[-+]?\d+)?( ?%)?|inf))$/.test(text) ? `'${text}` : text;
}

function quotedInCsv(text) {
  return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

function asCsv(table) {
  const line = (texts) => texts.map((text) => quotedInCsv(safeInSheets(text))).join(",");
  return shownOf(table, (cell) => valueOf(cell).trim()).map(line).join("\n") + "\n";
}

// What was copied is said next to the button, and read out.
async function copy(text, said) {
  try {
    await navigator.clipboard.writeText(text);
    said.textContent = "Copied";
  } catch (error) {
    said.textContent = `Not copied: ${error.message}`;
  }
  setTimeout(() => (said.textContent = ""), 3000);
}

function save(name, href) {
  const link = element("a", { href, download: name });
  document.body.append(link);
  link.click();
  link.remove();
}

function saveText(name, text) {
  const href = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  save(name, href);
  setTimeout(() => URL.revokeObjectURL(href), 1000);
}

function addTools(sheet) {
  const table = sheet.querySelector("table"), name = table.caption.textContent.trim();
  const file = `${name.replace(/[^\w.-]+/g, "-").slice(0, 60)}.csv`, of = element("span", { class: "visually-hidden" }, `: ${name}`);
  const markdown = element("button", { type: "button", "data-copy": "markdown" }, "Copy as Markdown", of);
  const csv = element("button", { type: "button", "data-copy": "csv" }, "Save as CSV", of.cloneNode(true));
  const said = element("span", { role: "status", "data-copied": "" });
  markdown.addEventListener("click", () => copy(asMarkdown(table), said));
  csv.addEventListener("click", () => saveText(file, asCsv(table)));
  let tools = sheet.querySelector(".tools");
  if (!tools) sheet.prepend((tools = element("p", { class: "tools" })));
  tools.append(markdown, csv, said);
}

function tendSheet(sheet) {
  for (const header of sheet.querySelectorAll("thead th")) {
    header.querySelector("button")?.addEventListener("click", () => sortBy(header));
  }
  const field = sheet.querySelector("[data-filter]");
  if (field) field.addEventListener("input", () => filter(sheet));
  sheet.querySelector("[data-more]")?.addEventListener("click", ({ target }) => {
    target.value = Number(target.value) + LINES;
    showRows(sheet.querySelector("table"));
  });
  addTools(sheet);
  showRows(sheet.querySelector("table"));
}

for (const sheet of document.querySelectorAll("[data-sheet]")) tendSheet(sheet);
// A link to each heading.
for (const heading of document.querySelectorAll("section[id] > h2")) {
  const link = element("a", { class: "anchor", href: `#${heading.parentNode.id}` }, "#");
  link.setAttribute("aria-label", `Link to ${heading.textContent}`);
  heading.append(" ", link);
}

// Light, dark, or as the system has it.
const THEMES = { "": "system", light: "light", dark: "dark" };

function setTheme(name) {
  if (name) document.documentElement.dataset.theme = name;
  else delete document.documentElement.dataset.theme;
  document.querySelector("#theme span").textContent = `: ${THEMES[name]}`;
}

function remembered(key, value) {
  // A file's page may not be let to remember anything.
  try {
    if (value === undefined) return localStorage.getItem(`normalbench-${key}`) || "";
    localStorage.setItem(`normalbench-${key}`, value);
  } catch (error) {
    if (!(error instanceof DOMException)) throw error;
  }
  return "";
}

const themeButton = document.querySelector("#theme");
themeButton.addEventListener("click", () => {
  const names = Object.keys(THEMES), now = document.documentElement.dataset.theme || "";
  const next = names[(names.indexOf(now) + 1) % names.length];
  setTheme(next);
  remembered("theme", next);
});
const kept = remembered("theme");
setTheme(kept in THEMES ? kept : "");

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
