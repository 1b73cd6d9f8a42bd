"use strict";

// A and B in every figure of every table that has rows of both, the largest difference first.
const OF_CODEC = ["encoding", "storage", "rounding"], BIT_DB = 20 * Math.log10(2), WIDEST = 4, FIGURES = 30;

// The codec of a row; its encoding alone where the row is of no storage.
function codecOf(column, row) {
  const [encoding, storage, rounding] = OF_CODEC.map((name) => column[name] && valueIn(column[name], row));
  return encoding ? [encoding, storage, storage && rounding !== "nearest" && rounding].filter(Boolean).join(" ") : "";
}

// How often B is twice A; of decibels, how often 6 dB more. Of nothing, or less, there is no twice: it counts as once.
function doublings({ unit }, a, b) {
  if (a === b) return 0;
  if (unit === "dB") return (b - a) / BIT_DB;
  return a > 0 && b > 0 ? Math.log2(b / a) : Math.sign(b - a);
}

function saidApart({ unit }, a, b) {
  const sign = b > a ? "+" : "−", times = b / a;
  if (a === b) return "equal";
  if (!Number.isFinite(b - a)) return Number.isFinite(a) ? "only A is finite" : "only B is finite";
  if (unit === "dB") return `${sign}${Math.abs(b - a).toFixed(1)} dB`;
  if (!(a > 0 && b > 0)) return `${sign}${Number(Math.abs(b - a).toPrecision(3))}`;
  if (Math.abs(Math.log2(times)) < 0.15) return `${sign}${Number(Math.abs(100 * (times - 1)).toPrecision(2))} %`;
  return times > 1 ? `${Number(times.toPrecision(2))} ×` : `1/${Number((1 / times).toPrecision(2))}`;
}

// What a table says of both: for each figure, each condition under which both were measured.
function comparedIn(table, { count, columns }, a, b) {
  const column = Object.fromEntries(columns.map((one) => [one.name, one])), keys = columns.filter(({ name, role }) => role === "key" && !OF_CODEC.includes(name));
  if (!column.encoding) return [];
  const rows = { a: new Map(), b: new Map() }, textOfKey = (row) => JSON.stringify(keys.map((key) => valueIn(key, row)));
  for (let row = 0; row < count; row++) {
    const codec = codecOf(column, row);
    if (agrees(codec, a)) rows.a.set(textOfKey(row), row);
    if (agrees(codec, b)) rows.b.set(textOfKey(row), row);
  }
  const both = Array.from(rows.a.keys()).filter((key) => rows.b.has(key) && rows.b.get(key) !== rows.a.get(key)).map((key) => [rows.a.get(key), rows.b.get(key)]);
  const telling = keys.filter((key) => new Set(both.map(([row]) => valueIn(key, row))).size > 1);
  const under = (row) => telling.filter((key) => valueIn(key, row) !== null).map((key) => `${key.title} ${shownText(key, row)}`).join(", ");
  return columns.flatMap((figure) => {
    const isVerdict = figure.kind === "text" && figure.words.length && figure.words.every((word) => ["yes", "no"].includes(word));
    if (!isVerdict && (figure.role !== "figure" || figure.kind === "text")) return [];
    const known = both.filter((pair) => pair.every((row) => valueIn(figure, row) !== null));
    const cases = known.map(([one, other]) => {
      const values = [valueIn(figure, one), valueIn(figure, other)], apart = isVerdict ? Number(values[0] !== values[1]) : doublings(figure, ...values);
      return { under: under(one), a: shownText(figure, one), b: shownText(figure, other), apart, said: isVerdict ? "" : saidApart(figure, ...values) };
    });
    cases.sort((one, other) => Math.abs(other.apart) - Math.abs(one.apart));
    return cases.length ? [{ table, figure, isVerdict, cases, most: Math.abs(cases[0].apart) }] : [];
  });
}

class Compare {
  constructor(root) {
    Object.assign(this, { root, tables: JSON.parse(root.dataset.compare), turn: 0, isWhole: false });
    shows.push((state, before) => this.follow(state, before));
  }

  follow(state, before) {
    const isSame = this.turn && CODECS.every((side) => state[side] === before[side]);
    if (state.view !== this.root.closest(".view").dataset.view || (isSame && this.shown === `${state.a}/${state.b}`)) return;
    this.show(state);
  }

  async show({ a, b }) {
    const turn = ++this.turn, found = [], has = { a: [], b: [] };
    this.shown = `${a}/${b}`;
    for (const [table, title] of a && b ? this.tables : []) {
      const data = await dataOf(table);
      if (turn !== this.turn) return;
      const column = Object.fromEntries(data.columns.map((one) => [one.name, one]));
      found.push(...comparedIn({ key: table, title }, data, a, b));
      if (column.encoding) for (const side of CODECS) if (hasCodec(column, data.count, { a, b }[side])) has[side].push(table);
    }
    const rank = ({ isVerdict, figure }) => (figure.hidden ? 2 : Number(isVerdict));
    found.sort((one, other) => rank(one) - rank(other) || other.most - one.most);
    Object.assign(this, { found, isWhole: false });
    this.root.replaceChildren(...(a && b ? this.said(found, { a, b }, has) : [element("p", { class: "note" }, "Choose A and B above, or click a codec's name anywhere: it is A, with shift B.")]));
    if (found.length) this.root.append(this.list());
  }

  said(found, sides, has) {
    const differs = found.filter(({ most }) => most > 0), tables = new Set(found.map(({ table }) => table.key));
    const made = [element("p", { class: "note" }, `${found.length} figures in ${tables.size} tables have rows of both; ${differs.length} of them differ.`)];
    for (const side of CODECS) {
      const lacks = this.tables.map(([key]) => key).filter((key) => !has[side].includes(key) && has[side === "a" ? "b" : "a"].includes(key));
      const others = known.codecs.filter((codec) => codec !== sides[side] && codec.split(" ")[0] === sides[side].split(" ")[0]);
      if (!lacks.length) continue;
      made.push(element("p", { class: "note" }, `${side.toUpperCase()}, ${sides[side]}, is not in ${lacks.join(", ")}.`, ...(others.length ? [" The same encoding in other storages: ", ...others.flatMap((name, at) => [...(at ? [", "] : []), nameButton(name, name)]), "."] : [])));
    }
    return made;
  }

  list() {
    const { found, isWhole } = this, shown = isWhole ? found : found.slice(0, FIGURES);
    const head = ["figure", "table", "A", "B", "B against A", "where they differ most"].map((title, at) => element("th", { scope: "col", class: at === 2 || at === 3 ? `n side-${"ab"[at - 2]}` : "" }, title));
    const body = element("tbody", {}, ...shown.map((one) => this.line(one, one.cases[0], true)));
    const table = element("table", {}, element("caption", {}, element("span", {}, "Each figure under the condition where A and B differ most")), element("thead", { class: "plain" }, element("tr", {}, ...head)), body);
    const more = element("button", { type: "button", onclick: () => { this.isWhole = true; this.root.lastChild.replaceWith(this.list()); } }, `Show all ${found.length} figures`);
    return element("div", {}, element("div", { class: "scroll", role: "region", "aria-label": "A and B in every figure", tabindex: "0" }, table), element("p", { class: "tools" }, ...(shown.length < found.length ? [more] : [])));
  }

  line(one, { under, a, b, apart, said }, isFirst) {
    const { figure, table, isVerdict, cases } = one, winner = !figure.better || !apart ? "" : (apart > 0) === (figure.better === "more") ? "b" : "a";
    const cell = (side, text) => element("td", { class: winner === side ? "n best" : "n" }, text);
    const name = isFirst ? [element("th", { scope: "row", ...(figure.says ? { title: figure.says } : {}) }, figure.title), element("td", {}, element("a", { href: `#${table.key}` }, table.title))] : [element("th", { scope: "row" }), element("td", {})];
    const row = element("tr", {}, ...name, cell("a", a), cell("b", b), element("td", { class: "apart" }, ...(isVerdict ? [] : [bar(apart, winner), said])), element("td", { class: "long" }, under));
    if (!isFirst || cases.length < 2) return row;
    const all = element("button", { type: "button", class: "pick", "aria-expanded": "false" }, `all ${cases.length}`);
    all.addEventListener("click", () => this.unfold(row, all, one));
    row.lastChild.append(" ", all);
    return row;
  }

  // The other conditions, below the first one.
  unfold(row, button, one) {
    const isOpen = button.getAttribute("aria-expanded") === "true";
    button.setAttribute("aria-expanded", String(!isOpen));
    for (const other of one.rows ?? []) other.remove();
    one.rows = isOpen ? [] : one.cases.slice(1).map((each) => this.line(one, each, false));
    row.after(...one.rows);
  }
}

function hasCodec(column, count, name) {
  for (let row = 0; row < count; row++) if (agrees(codecOf(column, row), name)) return true;
  return false;
}

// To the right where B has more, in the colour of the better one.
function bar(apart, winner) {
  const share = clamped(apart / WIDEST, -1, 1), colour = winner ? `var(--${winner})` : "var(--faint)";
  return element("span", { class: "balance", "aria-hidden": "true", style: `--from: ${50 + 50 * Math.min(0, share)}%; --wide: ${50 * Math.abs(share)}%; --colour: ${colour}` });
}

const compareRoot = document.querySelector("[data-compare]");
if (compareRoot) new Compare(compareRoot);
