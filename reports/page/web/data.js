"use strict";

// Every row of a table, and whole disassemblies: packed, and built when they are opened.
const blocks = {};

// A table's columns, as data.py packs them.
function dataOf(key) {
  blocks[key] ||= unpacked(`#data-${key}`).then(JSON.parse);
  return blocks[key];
}

function valueIn(column, row) {
  const value = column.values[row];
  return value === null ? null : column.kind === "text" ? column.words[value] : column.kind === "float" ? number(String(value)) : value;
}

// What a codec is called: its rounding is named where it is not the usual one.
const codecLabel = (encoding, storage, rounding) => [encoding, storage, rounding === "nearest" ? null : rounding].filter(Boolean).join(" ");

// A float as Python prints it, the shortest digits that give it again.
function exactText(value) {
  if (!Number.isFinite(value)) return String(value).replace("Infinity", "inf");
  const [digits, power] = value.toExponential().split("e");
  if (value && (power < -4 || power >= 16)) return `${digits}e${power.replace(/^([+-])(\d)$/, "$10$2")}`;
  const text = Object.is(value, -0) ? "-0" : String(value);
  return text.includes(".") ? text : `${text}.0`;
}

function storedText(column, row) {
  const value = valueIn(column, row);
  return value === null ? "" : column.kind === "float" ? exactText(value) : String(value);
}

const csvText = (column, row) => safeInSheets(storedText(column, row));

function shownText(column, row) {
  const value = valueIn(column, row);
  return value === null ? "" : column.kind === "float" ? textOf(value, true) : String(value);
}

// Under what conditions rows were measured: what each column that says it has in them.
const VALUES = 8;
function conditionsOf(columns) {
  return columns.filter(({ role }) => role === "key" || role === "how").flatMap((column) => {
    const values = new Set(column.values.map((_, row) => storedText(column, row)).filter(Boolean)), few = Array.from(values).slice(0, VALUES);
    return few.length ? [element("dt", {}, column.title), element("dd", {}, few.join(", ") + (values.size > VALUES ? " ..." : ""))] : [];
  });
}

// A table of rows that are filtered and sorted as data, and shown a hundred at a time.
class DataTable {
  constructor(details, data) {
    Object.assign(this, { details, data, order: Array.from({ length: data.count }, (_, at) => at), sorted: null, lines: LINES });
    this.part = data.columns.find(({ name }) => name === details.dataset.parts);
    this.build();
    this.show();
  }

  build() {
    const { table, called } = this.details.dataset, id = `rows-${table}-filter`;
    this.filter = element("input", { type: "search", id, autocomplete: "off", spellcheck: "false", oninput: () => this.refilter() });
    this.count = element("span", { role: "status", "data-count": "" });
    this.said = element("span", { role: "status", "data-copied": "" });
    this.table = element("table", {});
    this.more = element("button", { type: "button", "data-more": "", onclick: () => { this.lines += LINES; this.show(); } });
    const button = (what, text, act) => element("button", { type: "button", "data-copy": what, onclick: act }, text, element("span", { class: "visually-hidden" }, `: ${called}`));
    const tools = element("p", { class: "tools" }, element("label", { for: id }, "Filter"), this.filter, this.count);
    if (this.part) tools.append(this.chooser());
    tools.append(button("markdown", "Copy as Markdown", () => copy(this.markdown(), this.said)), button("csv", "Save as CSV", () => saveText(`${table}.csv`, this.csv())), this.said);
    if (this.data.digits) tools.append(element("span", {}, `Rounded to ${this.data.digits} digits; ${table}.csv has full precision.`));
    this.none = element("p", { class: "missing" }, "No row contains all of these words.");
    const scroll = element("div", { class: "scroll", role: "region", "aria-label": called, tabindex: "0" }, this.table, this.none);
    this.definitions = element("dl", {});
    this.root = element("div", { class: "sheet", "data-rows": table }, tools, scroll, element("p", { class: "tools" }, this.more),
      element("details", { class: "columns" }, element("summary", {}, "Column definitions", element("span", { class: "visually-hidden" }, ` of ${table}`)), this.definitions));
    this.details.append(this.root);
  }

  // Rows of one effect or experiment, whose columns are its own.
  chooser() {
    const names = this.part.words, select = element("select", { onchange: () => this.refilter() }, element("option", { value: "" }, "all"), ...names.map((name) => element("option", {}, name)));
    this.chosen = select;
    return element("label", {}, `${this.part.title} `, select);
  }

  refilter() {
    this.lines = LINES;
    this.show();
  }

  // The rows that are left, in their order.
  rows() {
    const words = this.filter.value.toLowerCase().split(/\s+/).filter(Boolean), part = this.chosen?.value;
    return this.order.filter((row) => {
      if (part && valueIn(this.part, row) !== part) return false;
      if (!words.length) return true;
      const text = this.data.columns.map((column) => shownText(column, row).toLowerCase()).join(" ");
      return words.every((word) => text.includes(word));
    });
  }

  // Less what is empty in all of these rows, and what only a program reads.
  columns(rows) {
    return this.data.columns.filter((column) => column.role !== "raw" && rows.some((row) => column.values[row] !== null));
  }

  show() {
    const rows = this.rows(), columns = this.columns(rows.length ? rows : this.order);
    const heads = columns.map((column) => {
      const button = element("button", { type: "button", onclick: () => this.sort(column) }, column.title);
      if (column.says) button.title = column.says;
      const sort = this.sorted?.column === column ? this.sorted.direction : "none";
      return element("th", { scope: "col", "aria-sort": sort, ...(column.kind === "text" ? {} : { class: "n" }) }, button);
    });
    const line = (row) => {
      const cells = columns.map((column, at) => {
        const text = shownText(column, row), tag = at === 0 && text ? "th" : "td";
        const cell = element(tag, tag === "th" ? { scope: "row" } : {}, text);
        if (column.kind !== "text") cell.className = "n";
        else if (text.length > 24) cell.className = "long";
        return cell;
      });
      return element("tr", {}, ...cells);
    };
    const shown = rows.slice(0, this.lines);
    this.none.hidden = rows.length > 0;
    this.table.hidden = !rows.length;
    this.table.replaceChildren(element("thead", {}, element("tr", {}, ...heads)), element("tbody", {}, ...shown.map(line)));
    this.count.textContent = `${rows.length} of ${this.data.count} rows`;
    this.more.hidden = shown.length === rows.length;
    this.more.textContent = `Show ${Math.min(LINES, rows.length - shown.length)} more of ${rows.length}`;
    this.definitions.replaceChildren(...columns.filter(({ says }) => says).flatMap(({ title, says }) => [element("dt", {}, title), element("dd", {}, says)]));
  }

  sort(column) {
    const direction = nextOrder(column.better, this.sorted?.column === column ? this.sorted.direction : "none");
    this.sorted = { column, direction };
    const text = (row) => { const value = valueIn(column, row); return value === null ? "" : String(value); };
    const way = direction === "ascending" ? 1 : -1;
    this.order.sort((a, b) => compared(text(a), text(b), column.kind !== "text", way));
    this.show();
  }

  csv() {
    const line = (texts) => `${texts.map(quotedInCsv).join(",")}\n`;
    return [line(this.data.columns.map(({ name }) => safeInSheets(name))), ...this.rows().map((row) => line(this.data.columns.map((column) => csvText(column, row))))].join("");
  }

  markdown() {
    const rows = this.rows(), columns = this.columns(rows);
    return markdownOf(columns.map(({ title }) => title), columns.map(({ kind }) => kind !== "text"), rows.map((row) => columns.map((column) => shownText(column, row))));
  }
}

// What is closed takes no elements.
function buildWhenOpened(details, build) {
  details.addEventListener("toggle", async () => {
    if (!details.open) {
      for (const child of Array.from(details.children).slice(1)) child.remove();
      return;
    }
    try {
      await build();
    } catch (error) {
      details.append(element("p", { class: "missing" }, `The content cannot be unpacked: ${error.message}`));
    }
  });
}

for (const details of document.querySelectorAll("details[data-table]")) {
  buildWhenOpened(details, async () => {
    const data = await dataOf(details.dataset.table);
    if (details.open && details.children.length === 1) new DataTable(details, data);
  });
}

for (const details of document.querySelectorAll("details[data-conditions]")) {
  const list = details.querySelector("dl");
  details.addEventListener("toggle", async () => list.replaceChildren(...(details.open ? conditionsOf((await dataOf(details.dataset.conditions)).columns) : [])));
}

const listings = document.querySelector("details[data-listings]");
if (listings) {
  const code = (text, label) => element("pre", { tabindex: "0", "aria-label": label }, text);
  buildWhenOpened(listings, async () => {
    const kernels = await dataOf("listings");
    if (!listings.open || listings.children.length > 1) return;
    for (const [name, { text, source }] of Object.entries(kernels)) {
      const one = element("details", { class: "listing" }, element("summary", {}, name));
      buildWhenOpened(one, () => one.append(element("div", { class: "pair" }, ...(source ? [code(source, `GLSL of ${name}`)] : []), code(text, name))));
      listings.append(one);
    }
    listings.append(element("p", { class: "note" }, listings.dataset.listings));
  });
}
