"use strict";

// A and B: the figures by which codes are chosen, then every figure of every table that has rows of both.
const BIT_DB = 20 * Math.log10(2), WIDEST = 4;

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
  if (Math.abs(Math.log2(times)) < 0.15) return `${sign}${Number(Math.abs(100 * (times - 1)).toPrecision(2))}%`;
  return times > 1 ? `${Number(times.toPrecision(2))}×` : `1/${Number((1 / times).toPrecision(2))}`;
}

// What a table says of both: for each figure, each condition under which both were measured.
function comparedIn(table, sides) {
  const { about, columns, data } = table, [one, other] = sides.map(({ rows }) => rows), isLike = sides.some(({ like }) => like);
  const both = Array.from(one.keys()).filter((context) => other.has(context) && other.get(context) !== one.get(context)), keys = both.map(JSON.parse);
  const telling = about.keys.map((name, at) => [columns[name].title, at]).filter(([, at]) => new Set(keys.map((key) => String(key[at]))).size > 1);
  const under = (key) => telling.filter(([, at]) => key[at] !== null).map(([title, at]) => `${title} ${key[at]}`).join(", ");
  return data.columns.flatMap((figure) => {
    const isVerdict = figure.kind === "text" && figure.words.length > 0 && figure.words.every((word) => ["yes", "no"].includes(word));
    if ((!isVerdict && (figure.role !== "figure" || figure.kind === "text")) || (isLike && about.texel.includes(figure.name))) return [];
    const cases = both.flatMap((context, at) => {
      const rows = [one.get(context), other.get(context)], values = rows.map((row) => valueIn(figure, row)), [a, b] = rows.map((row) => shownText(figure, row));
      if (values.includes(null)) return [];
      const apart = isVerdict ? Number(values[0] !== values[1]) : doublings(figure, ...values);
      return [{ under: under(keys[at]), a, b, apart, said: isVerdict ? "" : saidApart(figure, ...values) }];
    });
    cases.sort((x, y) => Math.abs(y.apart) - Math.abs(x.apart));
    return cases.length ? [{ figure, isVerdict, cases, most: Math.abs(cases[0].apart) }] : [];
  });
}

// How B differs from A, in a sentence.
function apartText([a, b], asked, constants) {
  const of = (one, other, title, more, less) => {
    if (!one || !other) return [];
    const times = other / one;
    if (isSameFigure(one, other)) return [`the same ${title}`];
    if (times <= 0.5) return [`a ${title} ${Number((1 / times).toPrecision(2))} times ${less}`];
    return [times < 1 ? `a ${Math.round(100 * (1 - times))}% ${less} ${title}` : times < 2 ? `a ${Math.round(100 * (times - 1))}% ${more} ${title}` : `${Number(times.toPrecision(2))} times the ${title}`];
  };
  const image = a.image === null || b.image === null ? [] : isImageTie(a, b, constants) ? ["a worst image PSNR that ties"] : [`a worst image PSNR ${Math.abs(b.image - a.image).toFixed(1)} dB ${b.image > a.image ? "better" : "worse"}`];
  const isKnown = !a.sampled && !b.sampled, [priceA, priceB] = [a, b].map((code) => (code.priced ? priceOf(code, asked, constants) : null));
  const bits = a.bits && b.bits && a.bits !== b.bits ? [`${b.bits} bits in place of ${a.bits}`] : [];
  const parts = [...bits, ...of(a.mean, b.mean, "mean error", "larger", "smaller"), ...(isKnown ? of(a.largest, b.largest, "largest error", "larger", "smaller") : []), ...of(priceA, priceB, `cost with ${asked.readers} decoding passes`, "higher", "lower"), ...image];
  return parts.length ? `Compared with A, B has ${parts.length > 1 ? `${parts.slice(0, -1).join(", ")} and ${parts.at(-1)}` : parts[0]}.` : "";
}

class Compare {
  constructor(root, { codecs, tables }, choices) {
    Object.assign(this, { root, codecs, tables, choices, turn: 0 });
  }

  async show({ a, b, for: where }) {
    const turn = ++this.turn, groups = [], sides = { a, b }, notes = [], lacks = { a: [], b: [] };
    if (!a || !b) return this.root.replaceChildren(element("p", { class: "note" }, "Choose A and B above, or click a codec to make it A; Shift-click to make it B."));
    for (const about of this.tables) {
      const table = await cardTable(about), of = CODECS.map((side) => table.rowsOf(sides[side], this.codecs));
      if (turn !== this.turn) return null;
      for (const [at, side] of CODECS.entries()) {
        if (of[at]?.like) notes.push(`${side.toUpperCase()} was not measured in ${about.title}; the figures are for ${of[at].like}, which stores identical values.`);
        if (!of[at] && of[1 - at]) lacks[side].push(about.title);
      }
      const place = ({ figure }) => about.figures.indexOf(figure.name) + 1 || Infinity;
      const figures = of.every(Boolean) ? comparedIn(table, of).sort((one, other) => place(one) - place(other)) : [];
      if (figures.length) groups.push({ about, figures });
      await new Promise((done) => setTimeout(done));
    }
    for (const side of CODECS) if (lacks[side].length) notes.push(`${side.toUpperCase()}, ${sides[side]}, is not in: ${lacks[side].join("; ")}.`);
    const none = groups.length ? [] : [element("p", { class: "note" }, "No table of this run has rows of both A and B.")];
    const aside = notes.length ? [element("details", { class: "aside" }, element("summary", {}, `Notes on the comparison (${notes.length})`), ...notes.map((note) => element("p", {}, note)))] : [];
    const lead = this.lead(sides, where);
    this.root.replaceChildren(...lead, ...none, ...groups.map((group, at) => this.group(group, !at && !lead.length)), ...aside);
    return null;
  }

  // Errors, image, cost and bits, each once, under the conditions of a question that has both, or else of each one's own.
  lead(sides, where) {
    const { questions, constants } = this.choices ?? { questions: [] }, has = ({ codes }, name) => codes.some(({ codec }) => codec === name), names = CODECS.map((side) => sides[side]);
    const inOrder = [...questions.filter((one) => one.where === where), ...questions], both = inOrder.find((one) => names.every((name) => has(one, name)));
    const own = names.map((name) => both ?? inOrder.find((one) => has(one, name)));
    if (!own.every(Boolean)) return [];
    const codes = names.map((name, at) => codeAs(own[at].codes.find(({ codec }) => codec === name), own[at], own[at].asked));
    const unfit = codes.flatMap(({ name, unfit: why }, at) => (why ? [element("p", { class: "remark" }, `${CODECS[at].toUpperCase()}, ${name}: ${why}.`)] : []));
    return [element("p", { class: "subhead" }, ...(unfit.length ? [] : [apartText(codes, own[0].asked, constants)])), ...unfit, pairTable(codes, own[0].asked, constants), element("p", { class: "note" }, `Angles on ${[...new Set(own.map(({ on }) => on))].join(" and ")}.${codes.some(({ sampled }) => sampled) ? " ≥: the largest of the samples." : ""}`)];
  }

  group({ about, figures }, isOpen) {
    const differ = figures.filter(({ most }) => most), equal = figures.filter(({ most }) => !most);
    const head = ["figure", "A", "B", "B against A", "where they differ most"].map((title, at) => element("th", { scope: "col", class: at === 1 || at === 2 ? `n side-${"ab"[at - 1]}` : "" }, title));
    const body = element("tbody", {}, ...[false, true].flatMap((isHidden) => differ.filter(({ figure }) => Boolean(figure.hidden) === isHidden)).map((one) => this.line(one, one.cases[0], true)));
    const table = element("table", {}, element("thead", { class: "plain" }, element("tr", {}, ...head)), body);
    const same = equal.length ? [element("p", { class: "note" }, `Equal: ${equal.map(({ figure }) => figure.title).join(", ")}.`)] : [];
    const rows = element("a", { href: about.view === "codecs" ? `#${about.key}` : `#rows-${about.key}` }, "All rows");
    const said = `${about.title}: ${differ.length} of ${figures.length} figures differ`, bars = body.rows.length ? [element("p", { class: "note" }, "A bar to the right: B's value is larger.")] : [];
    return element("details", { class: "aside", "data-group": about.title, ...(isOpen ? { open: "" } : {}) }, element("summary", {}, said), ...(body.rows.length ? [element("div", { class: "scroll", role: "region", "aria-label": `A and B compared: ${about.title}`, tabindex: "0" }, table)] : []), ...bars, ...same, element("p", { class: "tools" }, rows));
  }

  line(one, { under, a, b, apart, said }, isFirst) {
    const { figure, isVerdict, cases } = one, winner = !figure.better || !apart || a === b ? "" : (apart > 0) === (figure.better === "more") ? "b" : "a";
    const cell = (side, text) => element("td", { class: winner === side ? "n best" : "n" }, text);
    const name = element("th", { scope: "row", ...(isFirst && figure.says ? { title: figure.says } : {}) }, isFirst ? figure.title : "");
    const row = element("tr", {}, name, cell("a", a), cell("b", b), element("td", { class: "apart" }, ...(isVerdict ? [] : [bar(apart, winner), said])), element("td", { class: "long" }, under));
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

// To the right where B has more, in the colour of the better one.
function bar(apart, winner) {
  const share = clamped(apart / WIDEST, -1, 1), colour = winner ? `var(--${winner})` : "var(--faint)";
  return element("span", { class: "balance", "aria-hidden": "true", style: `--from: ${50 + 50 * Math.min(0, share)}%; --wide: ${50 * Math.abs(share)}%; --colour: ${colour}` });
}

const compareRoot = document.querySelector("[data-compare]");
if (compareRoot) {
  let built = null, shown = "";
  shows.push((now) => {
    const key = now.view === compareRoot.closest(".view").dataset.view ? JSON.stringify([now.a, now.b, now.for]) : "";
    if (!key || key === shown) return;
    shown = key;
    built ||= Promise.all([dataOf("cards"), document.querySelector("[data-choose]") && dataOf("choices")]).then((data) => new Compare(compareRoot, ...data));
    built.then((compare) => compare.show(now));
  });
}
