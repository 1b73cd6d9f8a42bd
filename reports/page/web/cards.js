"use strict";

// Every codec in a list, and everything about A in a card, B's figures next to A's. Both are built when their view is shown, from the
// block of cards.py and those of the tables.
// Among a few, a place says nothing.
const FEW = 3;
const CARD_FIGURES = 6, CARD_ROWS = 20, DOMAINS = ["sphere", "hemisphere", "view"];

function ordinal(count) {
  const tens = count % 100 >= 11 && count % 100 <= 13;
  return `${count}${(!tens && ["th", "st", "nd", "rd"][count % 10]) || "th"}`;
}

// A value's place among others, how near it is to the best, where 1 is as good, and whether it alone is the best.
function standing(value, values, better) {
  const sign = better === "more" ? -1 : 1, known = values.filter((one) => one !== null);
  const best = known.reduce((a, b) => (sign * b < sign * a ? b : a));
  const ratio = better === "more" ? value / best : best / value;
  return { rank: 1 + known.filter((one) => sign * one < sign * value).length, isBest: value === best && known.length > FEW && known.filter((one) => one === best).length === 1, of: known.length, share: value === best ? 1 : Math.max(0, Math.min(1, ratio || 0)) };
}

// A name that may break into lines behind each of its words.
const broken = (name) => name.split(/(?<=_)/).flatMap((word) => [word, element("wbr", {})]);

const placeText = ({ rank, of }, bits) => (of < 2 ? "no codec to compare with" : `${ordinal(rank)} of ${of}${bits ? ` at ${bits} bits` : ""}`);

// A figure, its bar, and below it its place.
function placedCell(text, place, said, attributes, isBest = false) {
  return element("td", { ...attributes, class: isBest ? "placed n best" : "placed n", style: `--share: ${place.share}` }, said ? `${text}\n${said}` : text);
}

// A table's rows by codec and context, the first back end of each.
class CardTable {
  constructor(about, data) {
    Object.assign(this, { about, data, columns: Object.fromEntries(data.columns.map((column) => [column.name, column])) });
    this.rows = new Map();
    this.groups = new Map();
    for (let row = 0; row < data.count; row++) this.add(row);
  }

  value(name, row) {
    return this.columns[name] ? valueIn(this.columns[name], row) : null;
  }

  // What the row is of: a codec, or an encoding in any storage.
  nameOf(row) {
    return codecLabel(...["encoding", "storage", "rounding"].map((name) => this.value(name, row)));
  }

  add(row) {
    const name = this.nameOf(row), context = JSON.stringify(this.about.keys.map((key) => this.value(key, row)));
    const own = this.rows.get(name) ?? new Map();
    if (!this.value("encoding", row) || own.has(context)) return;
    this.rows.set(name, own.set(context, row));
    this.groups.set(context, [...(this.groups.get(context) ?? []), { name, row }]);
  }

  // The rows of a codec: its own; those of its encoding, which hold in any storage; or those of a codec that stores the same numbers.
  rowsOf(name, codecs) {
    const [encoding, storage] = name.split(" "), { numbers } = codecs[name] ?? {};
    if (this.rows.has(name)) return { rows: this.rows.get(name), like: "" };
    if (this.rows.has(encoding)) return { rows: this.inBlock(this.rows.get(encoding), storage), like: "" };
    const like = numbers && Object.keys(codecs).find((other) => codecs[other].numbers === numbers && other.split(" ")[0] === encoding && this.rows.has(other));
    return like ? { rows: this.rows.get(like), like } : null;
  }

  // Of an encoding's rows those whose context names the storage, such as a block of compressed texels, if any does.
  inBlock(rows, storage) {
    const named = Array.from(rows).filter(([context]) => JSON.parse(context).includes(storage));
    return named.length ? new Map(named) : rows;
  }

  // A figure's place among the rows of its context, of codecs of as many bits where there are storages.
  place(context, row, figure, codecs) {
    const name = this.nameOf(row), bits = codecs[name]?.bits, { better } = this.columns[figure];
    const alike = this.groups.get(context).filter((one) => one.name.includes(" ") === name.includes(" ") && codecs[one.name]?.bits === bits && codecs[one.name]?.domain === codecs[name]?.domain);
    return { ...standing(this.value(figure, row), alike.map((one) => this.value(figure, one.row)), better), bits };
  }
}

const cardTables = new Map();

// A table of the run, read once.
function cardTable(about) {
  if (!cardTables.has(about.key)) cardTables.set(about.key, dataOf(about.key).then((data) => new CardTable(about, data)));
  return cardTables.get(about.key);
}

// Which engines keep normals so: in this storage, and in others.
function usersOf(used, storage) {
  const named = (some) => [...new Map(some.map(([engine, year]) => [engine, `${engine} (${year})`])).values()].join(", ");
  const here = used.filter(([, , kept]) => kept === storage), elsewhere = used.filter(([engine]) => !here.some(([other]) => other === engine));
  const said = [here.length && `In ${storage}: ${named(here)}.`, elsewhere.length && `In other storages: ${named(elsewhere)}.`].filter(Boolean);
  return said.join(" ") || "No known engine.";
}

// A codec's code in a language, as `normalbench code` writes it.
const codeText = ({ pieces, codecs }, name, language) => codecs[name].texts[language].map((place) => pieces[place]).join("");

// The languages of a codec's code; the one that a reader chose last is remembered, and HLSL is the first.
function languageList({ languages, codecs }, name) {
  const names = Object.keys(codecs[name].texts), usual = [remembered("language"), "hlsl", names[0]].find((language) => names.includes(language));
  const list = element("select", { "data-language": "" }, ...names.map((language) => element("option", { value: language, ...(language === usual ? { selected: "" } : {}) }, languages[language])));
  list.addEventListener("change", () => remembered("language", list.value));
  return list;
}

class Cards {
  constructor(root, made) {
    Object.assign(this, { root, ...made, turn: 0 });
    // Codes are compared that hold the same normals; of a reader's own all, as far as is known.
    for (const one of Object.values(this.codecs)) one.domain ??= "sphere";
    this.list = root.querySelector("[data-card-list]");
    this.card = root.querySelector("[data-card]");
    this.list.append(this.listed());
    for (const sheet of this.list.querySelectorAll(".sheet")) tendSheet(sheet);
  }

  bits(name) {
    return this.codecs[name]?.bits ?? null;
  }

  // The list: a row for each codec, with what it is compared by.
  listed() {
    const heads = [["codec"], ["A or B"], ["bits", "less"], ["mean", "less"], ["largest", "less"], ["slots", "less"]].map(([title, better], at) => {
      if (at === 1) return element("th", { scope: "col", class: "take" }, title);
      return element("th", { scope: "col", "aria-sort": "none", ...(at > 1 ? { class: "n", "data-better": better } : {}) }, element("button", { type: "button" }, title));
    });
    const cell = (value, text, of) => element("td", { class: "n", ...(value === undefined || value === null ? {} : { "data-v": String(value) }) }, of ? `${text}\n${of}` : text);
    const line = (name) => {
      const { mean, largest, slots, of, domain, codes } = this.codecs[name], bits = this.bits(name), aside = [of === this.usual ? "" : of, { hemisphere: "only z >= 0", view: "only facing" }[domain]].filter(Boolean).join(", ");
      const figures = [cell(bits, bitsText({ bits }), codes ? `codes of ${codes}` : ""), cell(mean, mean === undefined ? "" : degrees(mean), mean === undefined ? "" : aside), cell(largest, largest === undefined ? "" : largestText(this.codecs[name])), cell(slots, String(slots ?? ""))];
      return element("tr", { "data-codec": name }, element("th", { scope: "row" }, nameButton(name, ...broken(name))), element("td", { class: "take" }, ...sideButtons(name)), ...figures);
    };
    const counts = new Map();
    for (const { of } of Object.values(this.codecs)) if (of) counts.set(of, (counts.get(of) ?? 0) + 1);
    this.usual = [...counts].sort((a, b) => b[1] - a[1])[0]?.[0];
    const last = (value) => value ?? Infinity, keys = (name) => [DOMAINS.indexOf(this.codecs[name].domain), Number(this.codecs[name].of !== this.usual), last(this.codecs[name].mean)];
    const names = Object.keys(this.codecs).sort((one, other) => before(keys(one), keys(other))), count = `${names.length} of ${names.length} rows`;
    const tools = element("p", { class: "tools" }, element("label", { for: "cards-filter" }, "Filter"), element("input", { type: "search", id: "cards-filter", "data-filter": "", autocomplete: "off", spellcheck: "false" }), element("span", { role: "status", "data-count": "" }, count));
    const table = element("table", {}, element("caption", {}, element("span", {}, "Every codec")), element("thead", {}, element("tr", {}, ...heads)), element("tbody", {}, ...names.map(line)));
    const note = this.usual ? `Angles on the set ${this.usual}, unless the row names a different set. ≥: the largest of the samples; the others are suprema. Slots: issue slots to encode and decode once.` : "";
    return element("div", { class: "sheet", "data-sheet": "" }, tools, element("div", { class: "scroll", role: "region", "aria-label": "Every codec", tabindex: "0" }, table), element("p", { class: "tools" }, element("button", { type: "button", "data-more": "", value: LINES })), element("p", { class: "note" }, note));
  }

  // The card, a part of it in each task, so that the page answers in between.
  async show({ a, b }) {
    const turn = ++this.turn, names = [a, b].filter(Boolean);
    delete this.card.dataset.ready;
    if (!names.length) return this.card.replaceChildren(element("p", { class: "note" }, "Choose a codec in the list to see everything about it."));
    const made = [this.head(a || b, a ? "a" : "b"), this.short(a, b), this.pictures(names), this.written(a || b)];
    for (const about of this.tables) {
      const part = this.figures(about, await cardTable(about), a, b);
      if (part) made.push(part);
      await new Promise((done) => setTimeout(done));
      if (turn !== this.turn) return null;
    }
    made.push(this.storages(a || b));
    this.card.replaceChildren(...made.filter(Boolean));
    this.card.dataset.ready = a || b;
    // What an address names below the first card has moved. The list begins at A.
    if (!this.isShown && state.at) goTo(state);
    const row = Array.from(this.list.querySelectorAll("tbody tr")).find(({ dataset }) => dataset.codec === a), scroll = row?.closest(".scroll");
    if (!this.isShown && row) scroll.scrollTop += row.getBoundingClientRect().top - scroll.getBoundingClientRect().top - scroll.clientHeight / 3;
    this.isShown = true;
    return null;
  }

  close() {
    this.turn++;
    this.card.replaceChildren();
    delete this.card.dataset.ready;
  }

  // What it is: formulas, source, storage, and who uses it.
  head(name, side) {
    const [encoding, ...rest] = name.split(" "), about = this.encodings[encoding], { storage, numbers } = this.codecs[name];
    const facts = [], fact = (title, ...said) => said.some(Boolean) && facts.push(element("dt", {}, title), element("dd", {}, ...said.filter(Boolean)));
    const formula = ([says, ...lines]) => [says, ...lines.flatMap((line) => [element("br", {}), element("code", {}, line)])];
    if (about) {
      fact("what", about.says, about.precise ? " Of the neighbouring codes, the one that decodes closest is stored." : "");
      fact("encode", ...formula(about.encode));
      fact("decode", ...formula(about.decode));
      fact("source", about.source);
      fact("made for", about.domain);
      fact("used by", usersOf(about.used, rest[0]));
    } else fact("what", `Your own encoding, ${encoding}: its formulas are in its file.`);
    const more = about?.sign ? " The sign takes one bit elsewhere." : "", table = about?.tables ? " It uses lookup tables." : "";
    fact("stored in", storage ? `${storage}: ${about.components} numbers, ${bitsText(this.codecs[name], " bits")}.${more}${table}` : rest.join(" "));
    const same = numbers ? Object.keys(this.codecs).filter((other) => other !== name && other.split(" ")[0] === encoding && this.codecs[other].numbers === numbers) : [];
    if (same.length) fact("same numbers as", ...same.flatMap((other) => [nameButton(other, other), " "]), "in the same bit count, so the error is the same.");
    return element("div", {}, element("h3", { id: "card-h" }, element("b", { class: `side-${side}` }, `${side.toUpperCase()} `), name), element("dl", { class: "facts" }, ...facts));
  }

  // The headline figures of A and B, with their places.
  short(a, b) {
    const sides = [["a", a], ["b", b]].filter(([, name]) => name), figures = [["mean", "mean error", degrees], ["largest", "largest error", degrees], ["slots", "slots to encode + decode", String]];
    const cell = (key, text, name) => {
      const value = this.codecs[name][key], bits = this.bits(name), { of } = this.codecs[name];
      if (value === undefined) return element("td", {}, "not measured");
      const isBound = key === "largest" && this.codecs[name].sampled;
      const place = standing(value, this.others(bits, of, this.codecs[name].domain).map((one) => one[key] ?? null), "less");
      return placedCell(isBound ? largestText(this.codecs[name]) : text(value), place, placeText(place, bits), { "data-codec": name, "data-figure": key }, place.isBest);
    };
    const rows = figures.map(([key, title, text]) => element("tr", {}, element("th", { scope: "row" }, title), ...sides.map(([, name]) => cell(key, text, name))));
    const ofs = [...new Set(sides.map(([, name]) => this.codecs[name].of).filter(Boolean))];
    const table = element("table", { class: "short" }, element("thead", { class: "plain" }, element("tr", {}, element("td", {}), ...sides.map(([side, name]) => element("th", { scope: "col", class: `side-${side}` }, `${side.toUpperCase()} `, ...broken(name))))), element("tbody", {}, ...rows));
    const note = `${ofs.length ? `Angles on ${ofs.join(" and ")}. ` : ""}Longer bars are closer to the best result at the same bit count.`;
    return element("div", {}, element("h4", {}, "In short"), element("div", { class: "scroll", role: "region", "aria-label": "In short", tabindex: "0" }, table), element("p", { class: "note" }, note));
  }

  // What the list has of codecs of as many bits on a set of normals, once of those that store the same numbers.
  others(bits, of, domain) {
    const alike = Object.entries(this.codecs).filter(([, one]) => (one.bits ?? null) === bits && one.of === of && one.domain === domain);
    return [...new Map(alike.map(([name, one]) => [`${name.split(" ")[0]} ${one.numbers ?? name}`, one])).values()];
  }

  // Where on the sphere A and B are off, and what they make of an image: a row for each, with one scale where both share it.
  pictures(names, level = "h4") {
    const maps = names.map((name) => this.mapOf(name)), isOf = (name) => ({ codec }) => codec === name;
    const counted = viewer?.data.subjects.map((subject) => [names.filter((name) => subject.codecs.some(isOf(name))).length, subject]) ?? [];
    const [count, subject] = counted.reduce((best, other) => (other[0] > best[0] ? other : best), [0, null]);
    const rows = ["mean", "largest"].map((which) => [`${which === "mean" ? "Mean" : "Largest"} angle in each direction`, maps.map((map) => map && this.globe(map, which)), maps.map((map) => map && map.closest(".globes").previousElementSibling)]);
    if (count) {
      const isImage = subject.of === "image", scale = isImage ? this.scaleTo(`${FULL_APART} of 255`) : element("p", { class: "note" }, `${viewer.data.articles.gain}× |error|`);
      rows.push([`Difference of the image: ${subject.title}`, names.map((name) => this.picture(subject, subject.codecs.find(isOf(name)), isImage)), names.map(() => scale)]);
    }
    const shown = rows.filter(([, cells]) => cells.some(Boolean));
    if (!shown.length) return null;
    const sides = CODECS.filter((side) => names.includes(state[side])), heads = names.map((name, at) => element("p", {}, element("b", { class: `side-${sides[at]}` }, `${sides[at].toUpperCase()} `), ...broken(name)));
    return element("div", {}, element(level, {}, "Images"), element("div", { class: "twins", style: `--count: ${names.length}` }, ...heads, ...shown.flatMap(([title, cells, scales]) => this.twins(title, cells, scales))));
  }

  // A row of images; what a page lacks is said in its place.
  twins(title, cells, scales) {
    const isShared = new Set(scales.filter(Boolean)).size < 2, copies = scales.map((scale) => scale && scale.cloneNode(true));
    const figures = cells.map((cell, at) => element("figure", {}, cell ?? element("p", { class: "note" }, "Not in this page."), ...(isShared || !copies[at] ? [] : [copies[at]])));
    return [element("h5", { class: "whole" }, title), ...figures, ...(isShared ? [element("div", { class: "whole" }, copies.find(Boolean))] : [])];
  }

  // The colours from 0 to what full colour stands for.
  scaleTo(most) {
    const strip = element("div", { class: "strip", role: "img", "aria-label": `colours from 0 to ${most}`, style: `background: linear-gradient(to right, ${viewer.data.colours.join(", ")})` });
    return element("div", { class: "scale ends" }, strip, element("div", { class: "ticks", "aria-hidden": "true" }, element("span", { style: "left: 0" }, "0"), element("span", { style: "left: 100%" }, `${most} and more`)));
  }

  // The map of a codec, or of one that stores the same numbers.
  mapOf(name) {
    const { numbers } = this.codecs[name], same = (other) => numbers && this.codecs[other]?.numbers === numbers && other.split(" ")[0] === name.split(" ")[0];
    const maps = Array.from(document.querySelectorAll("#sphere figure[data-codec]")), found = maps.find(({ dataset }) => dataset.codec === name) ?? maps.find(({ dataset }) => same(dataset.codec));
    return found;
  }

  globe(map, which) {
    const copy = map.querySelector(`[data-which="${which}"]`).cloneNode();
    copy.removeAttribute("data-which");
    copy.hidden = false;
    return copy;
  }

  // A codec's image; a click opens it in the viewer.
  picture(subject, codec, isImage) {
    if (!codec) return null;
    const view = isImage ? "apart" : "error", canvas = element("canvas", { role: "img", "aria-label": `${codec.label}, ${subject.title}` });
    const button = element("button", { type: "button", title: "Look closer", onclick: () => viewer.open(subject, codec, view) }, canvas);
    pixelsOf(subject.original, subject.width, subject.height).then((exact) => Planes.of(subject, codec, exact)).then((planes) => planes.drawSmall(canvas, view, FULL_APART, !isImage, 2 * THUMB), () => button.remove());
    return button;
  }

  // The code to copy, as `normalbench code` writes it.
  written(name, level = "h4") {
    const { languages, codecs } = this.code, one = codecs[name], [encoding, storage] = name.split(" ");
    const command = `normalbench code ${encoding} --storage ${storage}`;
    const title = element(level, {}, `Code to copy: ${name}`);
    if (!one) return this.codecs[name].numbers ? element("div", {}, title, element("p", { class: "note" }, "This page does not contain its code. To write it, run ", element("code", {}, `${command} --to hlsl`), ".")) : null;
    const select = languageList(this.code, name), text = () => codeText(this.code, name, select.value), said = element("span", { role: "status" });
    const shown = element("pre", { tabindex: "0", "data-code": "" }), fill = () => {
      shown.textContent = text();
      shown.setAttribute("aria-label", `${name} in ${languages[select.value]}`);
    };
    select.addEventListener("change", fill);
    fill();
    const button = element("button", { type: "button", "data-copy": "code", onclick: () => copy(text(), said) }, "Copy");
    const proof = one.proven ? "The code was run and compared with the catalogue; the comment at its top has the result." : "The code was not run. The command in its top comment runs it and compares it with the catalogue.";
    const tables = one.tables ? [" It reads lookup tables, which ", element("code", {}, `${command} --to ${select.value} -o folder`), " writes next to it."] : [];
    return element("div", {}, title, element("p", { class: "tools" }, element("label", {}, "Language ", select), button, said), element("p", { class: "note" }, proof, ...tables), shown);
  }

  // A table's figures of A, and of B in the same contexts.
  figures(about, table, a, b) {
    const sides = [["a", a], ["b", b]].filter(([, name]) => name).map(([side, name]) => ({ side, name, ...table.rowsOf(name, this.codecs) })).filter(({ rows }) => rows);
    if (!sides.some(({ name }) => name === (a || b))) return null;
    const contexts = [...new Set(sides.flatMap(({ rows }) => [...rows.keys()]))], like = sides.filter((one) => one.like);
    const lines = contexts.flatMap((context) => this.linesOf(context, sides));
    const figures = about.figures.filter((figure) => this.tells(table, figure, contexts, lines) && !(like.length && about.texel.includes(figure))).slice(0, CARD_FIGURES);
    if (!figures.length) return null;
    const parsed = contexts.map(JSON.parse), varies = about.keys.map((_, at) => new Set(parsed.map((one) => String(one[at]))).size > 1);
    const constant = about.keys.map((key, at) => (!varies[at] && parsed[0][at] !== null ? `${table.columns[key].title} ${parsed[0][at]}` : "")).filter(Boolean).join(", ");
    const shownKeys = about.keys.filter((_, at) => varies[at]);
    const reasoned = about.reasons.filter((reason) => lines.some(({ row }) => table.value(reason, row) !== null));
    const heads = [[{ title: "codec" }, false], ...(shownKeys.length ? [[{ title: shownKeys.map((key) => table.columns[key].title).join(", ") }, false]] : []), ...figures.map((figure) => [table.columns[figure], true]), ...reasoned.map((reason) => [table.columns[reason], false])];
    const head = element("tr", {}, ...heads.map(([{ title, says }, isFigure]) => element("th", { scope: "col", ...(says ? { title: says } : {}), ...(isFigure ? { class: "n" } : {}) }, title)));
    const body = (from, to) => lines.slice(from, to).map((line) => this.line(table, line, varies, figures, reasoned));
    const made = element("table", { "data-table": about.key }, element("thead", { class: "plain" }, head), element("tbody", {}, ...body(0, CARD_ROWS)));
    const more = element("button", { type: "button" }, `Show all ${lines.length} rows`);
    more.addEventListener("click", () => {
      made.tBodies[0].append(...body(CARD_ROWS));
      more.remove();
    });
    const notes = [constant && `In every row: ${constant}.`, ...like.map((one) => `Not measured: ${one.name}. The figures are for ${one.like}, which stores identical values.`)].filter(Boolean);
    const finding = this.finding(table, figures, lines.filter(({ name }) => name === (a || b)));
    const links = element("p", { class: "note" }, "To repeat it: ", element("code", {}, this.command(about, sides[0].like || sides[0].name)), ". ", ...(about.view === "codecs" ? [element("a", { href: `#${about.key}` }, "All codecs in this table")] : []));
    return element("details", { class: "aside" }, element("summary", {}, about.title), element("p", { class: "note" }, [finding, ...notes].join(" ")), element("div", { class: "scroll", role: "region", "aria-label": about.title, tabindex: "0" }, made), ...(lines.length > CARD_ROWS ? [element("p", { class: "tools" }, more)] : []), links);
  }

  // The rows of A and B in a context.
  linesOf(context, sides) {
    return sides.filter(({ rows }) => rows.has(context)).map(({ side, name, rows }) => ({ side, name, context, row: rows.get(context) }));
  }

  // Whether a figure tells codecs apart: it is known of these, and not the same of all.
  tells(table, figure, contexts, lines) {
    if (!table.columns[figure] || lines.every(({ row }) => table.value(figure, row) === null)) return false;
    return contexts.some((context) => new Set(table.groups.get(context).map(({ row }) => table.value(figure, row)).filter((one) => one !== null)).size > 1);
  }

  line(table, { side, name, context, row }, varies, figures, reasoned) {
    const keys = JSON.parse(context).filter((value, at) => varies[at] && value !== null);
    const cells = figures.map((figure) => {
      const value = table.value(figure, row);
      if (value === null) return element("td", {});
      const place = table.place(context, row, figure, this.codecs);
      const text = table.columns[figure].kind === "float" ? textOf(value, true) : String(value);
      return placedCell(text, place, place.of > FEW ? `${ordinal(place.rank)} of ${place.of}` : "", { "data-figure": figure, title: placeText(place, place.bits) }, place.isBest);
    });
    const reasons = reasoned.map((reason) => element("td", { class: "long" }, table.value(reason, row) ?? ""));
    return element("tr", { "data-codec": name }, element("th", { scope: "row", class: `side-${side}` }, side.toUpperCase()), ...(varies.includes(true) ? [element("td", {}, keys.join(", "))] : []), ...cells, ...reasons);
  }

  // Where it stands best, and where worst.
  finding(table, figures, lines) {
      const places = lines.flatMap(({ context, row }) => figures.filter((figure) => table.value(figure, row) !== null).map((figure) => ({ figure, ...table.place(context, row, figure, this.codecs) }))).filter(({ of }) => of > FEW);
    if (!places.length) return "Not ranked: too few codecs with the same bit count.";
    const by = (one) => (one.rank - 1) / (one.of - 1), best = places.reduce((x, y) => (by(y) < by(x) ? y : x)), worst = places.reduce((x, y) => (by(y) > by(x) ? y : x));
    const said = (one) => `${placeText(one, one.bits)} in ${table.columns[one.figure].title}`;
    return best === worst ? `Rank: ${said(best)}.` : `Best rank: ${said(best)}. Worst rank: ${said(worst)}.`;
  }

  command({ key, takes }, name) {
    const [encoding, storage, rounding] = name.split(" "), values = { encoding, storage: this.codecs[name]?.numbers && storage, rounding };
    return ["normalbench run --tables", key, ...takes.filter((option) => values[option]).map((option) => `--${option} ${values[option]}`)].join(" ");
  }

  // The same encoding in other storages.
  storages(name) {
    const encoding = name.split(" ")[0], others = Object.keys(this.codecs).filter((other) => other.split(" ")[0] === encoding);
    if (others.length < 2) return null;
    const line = (other) => {
      const { storage, mean, largest, slots } = this.codecs[other], figures = [bitsText(this.codecs[other]), mean === undefined ? "" : degrees(mean), largest === undefined ? "" : largestText(this.codecs[other]), slots ?? ""];
      return element("tr", { "data-codec": other }, element("th", { scope: "row" }, nameButton(other, other)), element("td", { class: "take" }, ...sideButtons(other)), element("td", {}, storage ?? ""), ...figures.map((text) => element("td", { class: "n" }, String(text))));
    };
    const heads = ["codec", "A or B", "storage", "bits", "mean", "largest", "slots"].map((title, at) => element("th", { scope: "col", class: at > 2 ? "n" : at === 1 ? "take" : "" }, title));
    const table = element("table", {}, element("thead", { class: "plain" }, element("tr", {}, ...heads)), element("tbody", {}, ...others.map(line)));
    return element("div", {}, element("h4", {}, `${encoding} in other storages`), element("div", { class: "scroll", role: "region", "aria-label": "Other storages", tabindex: "0" }, table));
  }
}

const cardsRoot = document.querySelector("[data-cards]");
if (cardsRoot) {
  const codecsView = cardsRoot.closest(".view").dataset.view;
  let built = null, shownCard = "";
  const once = () => (built ||= dataOf("cards").then((made) => new Cards(cardsRoot, made)));
  // The code of A, and where A and B are off, also below the answer.
  for (const details of document.querySelectorAll("[data-of-cards]")) {
    const fill = async () => {
      const made = await once(), names = CODECS.map((side) => state[side]).filter((name) => made.codecs[name]);
      const part = names.length ? (details.dataset.ofCards === "code" ? made.written(names[0], "h3") : made.pictures(names, "h3")) : null;
      details.replaceChildren(details.firstElementChild, ...(details.open ? [part ?? element("p", { class: "note" }, "This page has no data on A or B.")] : []));
    };
    details.addEventListener("toggle", fill);
    shows.push((now, before) => details.open && CODECS.some((side) => now[side] !== before[side]) && fill());
  }
  shows.push((now) => {
    const key = now.view === codecsView ? JSON.stringify([now.a, now.b]) : "";
    if (key === shownCard) return;
    shownCard = key;
    if (key) once();
    // What is not seen takes no elements.
    built.then((made) => (shownCard ? made.show(state) : made.close()));
  });
}
