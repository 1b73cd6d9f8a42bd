"use strict";

// The answer for a reader's own constraints: the rule of pick's answer.py over codes that choices.py judged.
const LIMITS = { most: "most_instructions", readers: "readers", worth: "worth", enough: "enough", holes: "accept_holes", lengths: "accept_lengths", tables: "look_ups", uses: "mixing", gpu: "family" };
const NO_SURVEY = "the effect of mixing on it was not measured", WORDS = ["uses", "gpu"];

// Python rounds halves to even.
function even(value) {
  const low = Math.floor(value), rest = value - low;
  return rest < 0.5 || (rest === 0.5 && low % 2 === 0) ? low : low + 1;
}

// Less is better, the first number that differs decides.
function before(one, other) {
  const at = one.findIndex((figure, i) => figure !== other[i]);
  return at < 0 ? 0 : one[at] - other[at];
}

// A code under another use of mixing, and on another GPU, than the run asked for.
function codeAs(code, { aim, asked: usual }, { mixing, family }) {
  const made = { ...code };
  if (family !== usual.family) {
    const [encode, decode] = code.families?.[family] ?? [null, null], priced = encode !== null && decode !== null;
    Object.assign(made, { encode, decode, priced, once: priced ? encode + decode : null });
  }
  if ((mixing || "") === (usual.mixing || "")) return made;
  const uses = (mixing || "").split(",").filter(Boolean), known = uses.map((use) => code.uses?.[use] ?? { cannot: NO_SURVEY, count: 0, sum: 0, max: null });
  const count = known.reduce((sum, use) => sum + use.count, 0), mixed = count ? known.reduce((sum, use) => sum + use.sum, 0) / count : null;
  const most = (...values) => values.filter((value) => value !== null).reduce((a, b) => Math.max(a, b), -Infinity), or = (value) => (value === -Infinity ? null : value);
  const mean = or(most(code.plain[0], mixed)), largest = or(most(code.plain[1], ...known.map((use) => use.max)));
  const decibels = (angle) => (angle === null ? null : 20 * Math.log10(Math.max(angle, 1e-12)));
  const loss = aim === "image" ? code.loss : decibels(aim === "worst" ? largest : mean);
  return Object.assign(made, { mean, largest, loss, sampled: code.sampled || count > 0, cannot: known.map((use) => use.cannot).find(Boolean) ?? "" });
}

// The lowest PSNR of a code's images over some of its yaws.
function lowest({ turns }, kept, equal) {
  return Math.min(equal, ...turns.map((errors) => -10 * Math.log10(kept.reduce((sum, at) => sum + errors[at], 0) / kept.length)));
}

// The standard error of the gap between two codes' images, by leaving out one yaw after the other (turns.py).
function gapError(one, other, equal) {
  const count = Math.min(...[one, other].flatMap(({ turns }) => turns.map((errors) => errors.length))), yaws = [...Array(Number.isFinite(count) ? count : 0).keys()];
  if (count < 2 || !one.turns.length || !other.turns.length) return 0;
  const gaps = yaws.map((left) => yaws.filter((at) => at !== left)).map((kept) => lowest(one, kept, equal) - lowest(other, kept, equal));
  const mean = gaps.reduce((a, b) => a + b) / count;
  return Math.sqrt(((count - 1) / count) * gaps.reduce((sum, gap) => sum + (gap - mean) ** 2, 0));
}

// The weighted cost: of each pass, what memory traffic does not hide.
const priceOf = ({ encode, decode }, { readers }, { hidden }) => Math.max(encode || 0, hidden) + readers * Math.max(decode || 0, hidden);

// From how many decibels on two codes' images do not tie.
const clearImageGap = (one, other, { step, errors, equal }) => Math.max(step, errors * gapError(one, other, equal));

// What qualifies, in its order, and why the others do not.
function answerOf(question, asked, constants) {
  const { hidden, affordable, step, same, least, much, needless, hole, lost } = constants;
  const { said } = question, isImage = question.aim === "image", codes = question.codes.map((code) => codeAs(code, question, asked));
  const price = (code) => priceOf(code, asked, constants);
  const doublings = (code) => Math.log2(price(code) / (hidden * (1 + asked.readers)));
  const loss = (code) => code.loss ?? Infinity, bits = (code) => code.bits || Infinity, tenth = (x) => (Number.isFinite(x) ? even(x * 10) / 10 : x);
  const score = (code) => loss(code) + asked.worth * doublings(code), clearGap = (a, b) => (isImage ? clearImageGap(a, b, constants) : least);
  const isClearlyBetter = (one, other) => loss(other) - loss(one) >= clearGap(one, other);
  const ties = (code) => [price(code), bits(code), code.priced ? (code.encode || 0) + asked.readers * (code.decode || 0) : 0];
  const order = (code, count) => {
    const isEnough = code.largest !== null && 2 * code.largest <= asked.enough && price(code) <= affordable * hidden * (1 + asked.readers);
    const first = isEnough ? [0, Number(code.table), bits(code), even(doublings(code)), tenth(loss(code))] : [1, isImage || question.aim === "worst" ? score(code) : even(score(code) / step) * step, price(code), loss(code)];
    return [...first, ...ties(code)].slice(0, count);
  };
  const unfit = (code) => code.unfit || (code.long && !asked.accept_lengths ? said.length : "");
  const leasts = {};
  for (const code of codes) if (!unfit(code) && code.met !== null) leasts[code.storage] = Math.min(code.met, leasts[code.storage] ?? Infinity);
  const limit = ({ once }) => (asked.most_instructions === null ? "" : once === null ? "issue slots not known" : once > asked.most_instructions ? `more than ${asked.most_instructions} issue slots` : "");
  const own = (code) => unfit(code) || (code.table && !asked.look_ups && said.table) || code.cannot || limit(code) || (code.loss === null ? said.figure : "");
  const why = new Map(codes.map((code) => {
    const found = own(code), isHoled = !unfit(code) && !asked.accept_holes && code.met !== null && code.met > Math.min(hole * leasts[code.storage], lost);
    return [code, isHoled && (!found || found === said.figure) ? said.hole : found];
  }));
  if (codes.some((code) => !why.get(code) && code.priced)) for (const code of codes) if (!why.get(code) && !code.priced) why.set(code, said.price);
  let fit = codes.filter((code) => !why.get(code) && !code.beside).sort((a, b) => before(order(a), order(b)));
  if (isImage && fit.length && order(fit[0])[0] === 1) {
    const tied = fit.filter((code) => code === fit[0] || score(code) - score(fit[0]) < clearGap(fit[0], code));
    const first = tied.reduce((a, b) => (before([price(b), bits(b), score(b)], [price(a), bits(a), score(a)]) < 0 ? b : a));
    fit = [first, ...fit.filter((code) => code !== first)];
  }
  const best = fit[0], out = codes.filter((code) => why.get(code) && !code.beside);
  if (!best) return { codes, best, fit, out, why, others: [] };
  // Another storage of the same bytes is worth a word where it is much better, and not worse at its worst.
  const gain = (code) => loss(best) - loss(code), isMuchBetter = (code) => gain(code) >= much && (code.largest || Infinity) <= (best.largest || Infinity) && 2 * (best.largest || Infinity) * needless > asked.enough;
  const elsewhere = codes.filter((code) => code.beside && !why.get(code) && isMuchBetter(code)).sort((a, b) => before(order(a, -3), order(b, -3))).slice(0, 1);
  const figures = (code) => [tenth(loss(code)), price(code), bits(code)];
  const beats = (one, other) => figures(one).every((x, i) => x <= figures(other)[i]) && figures(one).some((x, i) => x < figures(other)[i]);
  const exact = fit.reduce((a, b) => (before(figures(b), figures(a)) < 0 ? b : a));
  const above = fit.filter((code) => code !== best && code !== exact && isClearlyBetter(code, best) && !fit.some((other) => beats(other, code))).sort((a, b) => loss(b) - loss(a));
  const rungs = above.reduce((kept, code) => (!kept.length || isClearlyBetter(code, kept.at(-1)) ? [...kept, code] : kept), []).slice(0, 2);
  if (exact !== best && isClearlyBetter(exact, best)) rungs.push(exact);
  const near = fit.filter((code) => rungs.includes(code) && code.storage !== best.storage && isMuchBetter(code)).slice(0, 1);
  return { codes, best, fit, out, why, rungs, exact, price, isSame: (a, b) => Math.abs(Math.log2(price(a) / price(b))) < same, others: elsewhere.length ? elsewhere : near, gain };
}

// Its first sentence, as pick writes it.
function sentenceOf({ where, needs }, asked, { best, others, gain }) {
  if (best) return [`${where}: take ${best.name}.`, ...(best.lost ? [best.lost] : []), ...others.map((code) => `${code.begin}${even(gain(code))}${code.end.replace("{mean}", degrees(code.mean))}`)].join(" ");
  const limits = [...(asked.most_instructions === null ? [] : [`at most ${asked.most_instructions} issue slots`]), ...needs, ...(asked.mixing ? [`that survives ${asked.mixing.replaceAll(",", ", ")}`] : [])];
  return `${where}: no encoding qualifies${limits.length ? ` (${limits.join(", ")})` : ""}.`;
}

// What is asked for: the question's own limits, or a reader's.
function askedOf(question, state) {
  const asked = { ...question.asked };
  for (const [key, name] of Object.entries(LIMITS)) {
    if (!state[key]) continue;
    if (WORDS.includes(key)) asked[name] = state[key] === "none" ? null : state[key];
    else asked[name] = ["yes", "no"].includes(state[key]) ? state[key] === "yes" : Number(state[key]);
  }
  return asked;
}

// What a code occupies; of one that has fewer codes than that, also what these are worth.
const bitsText = ({ bits, codes }, unit = "") => (bits ? `${bits}${unit}${codes ? `, for codes of ${codes}` : ""}` : "");
const degrees = (value) => (value === null ? "" : `${Number(value.toPrecision(3))}°`);
const IMAGE = "worst image PSNR", LARGEST = "largest error", SAME_LOG2 = 0.03;
const isSameFigure = (a, b) => a === b || Math.abs(Math.log2(a / b)) < SAME_LOG2;
// What only samples are known of may be larger.
const largestText = ({ largest, sampled }) => `${sampled && largest !== null ? "≥ " : ""}${degrees(largest)}`;
const COMPARED = [
  ["mean error", (code) => degrees(code.mean), (code) => code.mean, "less"],
  [LARGEST, largestText, (code) => code.largest, "less"],
  ["slots to encode + decode", (code) => (code.priced ? `${code.encode} + ${code.decode}` : ""), (code) => code.once, "less"],
  [IMAGE, (code) => (code.image === null ? "not drawn" : `${code.image.toFixed(1)} dB${code.pole ? `, ${code.pole}` : ""}`), (code) => code.image, "more"],
  ["bits", (code) => bitsText(code), (code) => code.bits, "less"],
  ["bits free", (code) => String(code.free ?? ""), (code) => code.free, "more"],
];

// Errors are those after the mixing that is asked for.
const titleUnder = (title, mixing) => (mixing && title.endsWith(" error") ? `${title} after ${mixing.replaceAll(",", ", ")}` : title);

// The lowest roughness at which each codec's banding is acceptable, and at which it is invisible (the looser and the stricter
// threshold of the run), on its most demanding object.
async function cleanRoughness() {
  if (!document.querySelector("#data-roughness")) return new Map();
  const { columns, count } = await dataOf("roughness"), column = Object.fromEntries(columns.map((one) => [one.name, one])), codecs = new Map();
  const value = (name, row) => (column[name] ? valueIn(column[name], row) : null), isUsual = (name, row, usual) => [null, usual].includes(value(name, row)), height = ({ roughness }) => roughness ?? Infinity;
  for (let row = 0; row < count; row++) {
    if (!value("decides", row) || !isUsual("dither", row, "none") || !isUsual("frames", row, 1)) continue;
    const codec = codecLabel(...["encoding", "storage", "rounding"].map((name) => value(name, row)));
    const threshold = Number(value("threshold", row)), decides = { roughness: value("roughness", row), where: `${value("object", row)} under ${value("environment", row)}` }, thresholds = codecs.get(codec) ?? new Map();
    // Metal and plaster each have an object that decides.
    if (!thresholds.has(threshold) || height(decides) > height(thresholds.get(threshold))) codecs.set(codec, thresholds.set(threshold, decides));
  }
  return new Map(Array.from(codecs, ([codec, thresholds]) => [codec, Array.from(thresholds).sort(([one], [other]) => other - one).map(([, decides]) => decides)]));
}

const fromRoughness = ({ roughness }) => (roughness === null ? "at no roughness" : `from roughness ${roughness}`);

class Choose {
  constructor(root, { constants, questions, found }) {
    Object.assign(this, { root, constants, questions, title: found, answers: new Map() });
    this.control = Object.fromEntries(Array.from(root.querySelectorAll("[data-limit]"), (one) => [one.dataset.limit, one]));
    for (const [key, one] of Object.entries(this.control)) one.addEventListener("input", () => this.take(key, one));
    this.parts = Array.from(root.querySelectorAll("[data-part]"));
    for (const one of this.parts) one.addEventListener("input", () => this.ask(one.dataset.part, one.value));
    this.uses = Array.from(root.querySelectorAll("[data-use]"));
    for (const one of this.uses) one.addEventListener("input", () => change({ uses: this.uses.filter(({ checked }) => checked).map(({ value }) => value).join(",") || (this.question.asked.mixing ? "none" : "") }));
    root.querySelector("[data-again]").addEventListener("click", () => change(Object.fromEntries(Object.keys(LIMITS).map((key) => [key, ""]))));
    root.addEventListener("drawn", ({ target }) => this.plot(target));
    shows.push((state, before) => this.show(state, before));
    answersTo = (state) => this.answersTo(state);
    titles.choose = () => (this.found.best ? `${this.question.where}: ${this.found.best.name}` : this.question.where);
    this.show(state, null);
    // What a page comes with may be here before its last script, which reads the address.
    if (isShown) change({}, true);
  }

  take(key, { type, checked, value, validity }) {
    if (!validity.valid) return void this.control[key].reportValidity();
    change({ [key]: type === "checkbox" ? (checked ? "yes" : "no") : value }, type === "number");
  }

  // The question of a storage, or of normals, and of what else was asked for.
  ask(part, value) {
    const asked = { of: this.question.of, on: this.question.on, [part]: value }, fitting = this.questions.filter((one) => one[part] === value);
    const question = fitting.find(({ of, on }) => of === asked.of && on === asked.on) ?? fitting[0];
    // A reader's A and B stay where one of them is a code of the other question.
    if (!question.codes.some(({ codec }) => CODECS.some((side) => state[side] === codec))) picked.clear();
    change({ for: question.where });
  }

  questionOf(state) {
    return this.questions.find(({ where }) => where === state.for) ?? this.questions[0];
  }

  // The codecs of the answer that the page has, the best one first. A state changes with each move of a drag; what it asks does not.
  answersTo(state) {
    const asked = JSON.stringify(CONSTRAINTS.map((key) => state[key]));
    if (!this.answers.has(asked)) {
      const question = this.questionOf(state), { fit } = answerOf(question, askedOf(question, state), this.constants);
      this.answers.set(asked, fit.map(({ codec }) => codec).filter((codec) => known.codecs.includes(codec)));
    }
    return this.answers.get(asked);
  }

  show(state, before) {
    if (before && ["for", "a", "b", ...Object.keys(LIMITS)].every((key) => state[key] === before[key])) return;
    const question = this.questionOf(state), asked = askedOf(question, state);
    const found = answerOf(question, asked, this.constants), isOwn = JSON.stringify(asked) !== JSON.stringify(question.asked);
    Object.assign(this, { question, found, asked });
    // The table stays under the pointer that chose a code in it.
    if (before && ["for", ...Object.keys(LIMITS)].every((key) => state[key] === before[key])) return;
    this.fill(question, asked, isOwn);
    for (const part of this.root.querySelectorAll("[data-question]")) part.hidden = isOwn || part.dataset.question !== question.where;
    for (const place of this.root.querySelectorAll("[data-of]")) place.hidden = ![question.chart, question.spread].includes(place.dataset.of);
    for (const plot of this.root.querySelectorAll(`[data-of="${question.chart}"] .plot`)) this.plot(plot);
    const [reply, reasons] = ["reply", "reasons"].map((part) => this.root.querySelector(`[data-own-${part}]`));
    for (const part of [reply, reasons]) part.hidden = !isOwn;
    const [answer, ...others] = sentenceOf(question, asked, found).split(/(?<=\.) /);
    reply.replaceChildren(element("h2", { class: "lead" }, answer), ...(others.length ? [element("p", { class: "subhead" }, others.join(" "))] : []));
    reasons.replaceChildren(element("details", { class: "aside" }, element("summary", {}, "Reasons"), element("ul", {}, ...this.said(found, asked, question).map((line) => element("li", {}, line)))));
    this.tile(found, asked, question);
    this.offerCode(found);
    this.root.querySelector("[data-left]").textContent = `${found.fit.length} of ${found.fit.length + found.out.length} encodings are left`;
    this.root.querySelector("[data-codes]").replaceChildren(...(found.fit.length ? [this.table(found, asked)] : []), this.leftOut(found));
  }

  // The chart of the question: what the constraints leave out is grey, and the line joins what no other code beats in both.
  plot(plot) {
    const view = charts.views.get(plot), { question, found, asked } = this;
    if (!view || plot.closest("[data-of]").dataset.of !== question.chart) return;
    const tableOf = (kind) => view.panel.marks.find((mark) => mark.kind === kind).table, codeOf = new Map(found.codes.map((code) => [code.codec, code]));
    const { x } = (view.panelAsRun ??= view.panel), rows = (view.rowsAsRun ??= view.tables[tableOf("points")]), isKnown = ({ codec }) => codeOf.get(codec).once !== null && codeOf.get(codec).mean;
    const points = rows.filter(isKnown).map((row) => {
      const code = codeOf.get(row.codec), why = found.why.get(code);
      return { ...row, x: code.once, y: Number(code.mean.toPrecision(4)), why, rest: Boolean(why) };
    });
    view.tables[tableOf("points")] = points;
    for (const axis of ["x", "y"]) view.panel = { ...view.panel, [axis]: { ...view.panel[axis], domain: d3.extent([...view.panelAsRun[axis].domain, ...points.map((point) => point[axis])]) } };
    view.panel.x.title = x.title.replace(question.asked.family, asked.family);
    view.panel.y.title = view.panelAsRun.y.title.replace("mean error", titleUnder("mean error", asked.mixing));
    const left = points.filter(({ rest }) => !rest).sort((one, other) => before([one.x, one.y], [other.x, other.y]));
    const front = left.reduce((kept, point) => (!kept.length || point.y < kept.at(-1).y ? [...kept, point] : kept), []);
    view.tables[tableOf("lines")] = front;
    const figure = plot.closest("figure"), title = !left.length ? `${question.where}: no encoding is left` : this.title.replace("{where}", question.where).replace("{front}", front.length).replace("{all}", left.length);
    figure.dataset.title = title;
    figure.querySelector("[data-finding]").textContent = title;
    for (const of of toolsOf(figure).querySelectorAll("button > span")) of.textContent = `: ${title}`;
    view.draw();
  }

  // The controls say what is asked for.
  fill(question, asked, isOwn) {
    for (const one of this.parts) one.value = question[one.dataset.part];
    for (const one of this.uses) one.checked = (asked.mixing || "").split(",").includes(one.value);
    for (const [key, name] of Object.entries(LIMITS)) {
      const one = this.control[key], value = asked[name];
      if (!one) continue;
      if (key === "gpu") one.value = value;
      else if (one.type === "checkbox") one.checked = value;
      else if (document.activeElement !== one || one.tagName === "SELECT") {
        if (one.tagName === "SELECT" && !Array.from(one.options).some((option) => Number(option.value) === value)) one.append(new Option(String(value), value));
        one.value = one.tagName === "SELECT" ? Array.from(one.options).find((option) => Number(option.value) === value).value : value ?? "";
      }
    }
    this.root.querySelector("[data-again]").hidden = !isOwn;
    const uses = this.root.querySelector("[data-uses]"), folded = Object.keys(LIMITS).filter((key) => key !== "uses" && asked[LIMITS[key]] !== question.asked[LIMITS[key]]);
    if (uses) uses.textContent = `: ${(asked.mixing || "nothing more").replaceAll(",", ", ")}`;
    this.root.querySelector("[data-set]").textContent = folded.length ? ` (${folded.length} changed)` : "";
  }

  // What one sees, what it costs and what it takes, of the answer.
  async tile({ best }, { family }, { families }) {
    const place = this.root.querySelector("[data-tiles]"), turn = (this.tiling = {});
    const clean = best && (await cleanRoughness()).get(best.codec);
    if (turn !== this.tiling) return;
    const most = best && `${best.sampled ? "about" : "at most"} ${degrees(Math.min(2 * best.largest, 180))}`, moves = `A mirror's reflection moves by ${most}.`;
    const seen = clean ? ["Acceptable reflections", fromRoughness(clean[0]), `${clean.length > 1 ? `Invisible ${fromRoughness(clean.at(-1))}. ` : ""}Worst case: ${clean[0].where}. ${moves}`] : best && ["Reflections", `move by ${most}`, `A mirror's; ${degrees(2 * best.mean)} on average.`];
    const isKnown = best?.priced, tiles = !best ? [] : [
      seen,
      ["Cost", isKnown ? `${best.encode} + ${best.decode} issue slots` : "not known", isKnown ? `To encode + to decode${families[family] ? `, ${families[family]}` : ""}.` : "No compiler on the machine of this run reports it."],
      ["Bits", String(best.bits || ""), `${best.free ? `${best.free} more bits of the texel are free` : "Uses all bits of the texel"}${best.codes ? `; its codes are worth ${best.codes} bits` : ""}.`],
    ];
    place.replaceChildren(...tiles.map(([title, text, note]) => element("div", {}, element("dt", {}, title), element("dd", {}, text), element("dd", { class: "note" }, note))));
  }

  // The code of the answer, in the language that a reader uses.
  async offerCode({ best }) {
    const place = this.root.querySelector("[data-copying]"), turn = (this.offering = {});
    const { code } = best && document.querySelector("#data-cards") ? await dataOf("cards") : {};
    if (turn !== this.offering) return;
    if (!code?.codecs[best.codec]) return void place.replaceChildren();
    const list = languageList(code, best.codec), said = element("span", { role: "status" });
    const button = element("button", { type: "button", "data-copy": "answer", onclick: () => copy(codeText(code, best.codec, list.value), said) }), title = () => (button.textContent = `Copy ${code.languages[list.value]}`);
    list.setAttribute("aria-label", "Language of the code");
    list.addEventListener("change", title);
    title();
    // Images are those of the best axis, which a world's own may not be.
    const axis = best.pole.endsWith(" up") ? [element("span", { class: "note" }, `for worlds with z up; with y up: ${best.codec.split(" ")[0]}:axis=y`)] : [];
    place.replaceChildren(button, list, said, ...axis);
  }

  // How many codes are left without each of the constraints.
  without(question, asked) {
    const uses = (asked.mixing || "").split(",").filter(Boolean), left = (change) => answerOf(question, { ...asked, ...change }, this.constants).fit.length;
    const relaxed = uses.map((use) => [use, left({ mixing: uses.filter((one) => one !== use).join(",") || null })]);
    if (asked.most_instructions !== null) relaxed.push([`the limit of ${asked.most_instructions} issue slots`, left({ most_instructions: null })]);
    if (relaxed.length < 1) return [];
    if (uses.length > 1) relaxed.push(["any use of mixing", left({ mixing: null })]);
    return [`Without ${relaxed.map(([what, count]) => `${what}, ${count || "none"}`).join("; without ")} left.`];
  }

  said({ best, fit, out, why, rungs, exact, gain, price, isSame }, asked, question) {
    const dear = out.filter((code) => code.once !== null && why.get(code).startsWith("more than ")).map((code) => code.once);
    const decodeFirst = asked.mixing && !asked.mixing.split(",").includes("upsample") ? ["Or decode each texel before you mix: only upsample works with every encoding."] : [];
    if (!best) return [...(dear.length ? [`The cheapest encoding that only the slot limit excludes takes ${Math.min(...dear)} issue slots.`] : this.without(question, asked)), ...decodeFirst];
    const isEnough = (code) => code.largest !== null && 2 * code.largest <= asked.enough, limit = degrees(asked.enough);
    const moved = isEnough(best) ? [`A reflection moves by at most ${degrees(2 * best.largest)}, within your limit. Of the low-cost encodings within it, the one with the fewest bits is chosen.`] : fit.some(isEnough) || !asked.enough ? [] : [`No remaining encoding moves a reflection by ${limit} or less.`];
    const image = best.image === null ? [] : [`Worst image, without mixing: ${best.image.toFixed(1)} dB.`];
    const slots = best.priced ? `${best.encode} issue slots to encode, ${best.decode} to decode. Uses ${bitsText(best, " bits")}.` : "The cost is not known on this machine.";
    const rung = (code) => {
      const better = gain(code), ratio = price(code) / price(best);
      return `${better < 0 ? "Less accurate" : code === exact ? "Most accurate (within 0.1 dB)" : "More accurate"}: ${code.name}, ${Math.abs(better).toFixed(1)} dB, ${isSame(code, best) ? "at the same cost" : `at ${Number(ratio.toPrecision(2))} times the cost`}.`;
    };
    return [`${asked.mixing ? `After ${asked.mixing.replaceAll(",", ", ")}: mean` : "Mean"} error ${degrees(best.mean)}, largest ${degrees(best.largest)}. A mirror's reflection moves by ${degrees(2 * best.mean)} on average and by at most ${degrees(Math.min(2 * best.largest, 180))}.`, ...moved, slots, ...image, ...rungs.map(rung)];
  }

  table({ fit, price }, { readers, mixing }) {
    const most = Math.max(...fit.map((code) => price(code))), least = fit.length ? price(fit[0]) : 1;
    const heads = [element("th", { scope: "col" }, "encoding"), ...COMPARED.map(([title]) => element("th", { scope: "col", class: "n" }, titleUnder(title, mixing))), element("th", { scope: "col" }, `cost with ${readers} decoding passes`)];
    const rows = fit.map((code) => {
      const bar = element("span", { class: "bar", style: `--share: ${price(code) / most}` });
      const ratio = element("td", { class: "priced" }, bar, code.priced ? `${Number((price(code) / least).toPrecision(2))}×` : "");
      return element("tr", { "data-codec": code.codec }, element("th", { scope: "row" }, nameButton(code.codec, code.name)), ...COMPARED.map(([, text]) => element("td", { class: "n" }, text(code))), ratio);
    });
    const table = element("table", {}, element("caption", {}, element("span", {}, "Eligible encodings, ranked by error and cost")), element("thead", { class: "plain" }, element("tr", {}, ...heads)), element("tbody", {}, ...rows));
    const isBounded = fit.some(({ sampled }) => sampled), { worth, enough } = this.asked;
    const note = element("p", { class: "note" }, `${fit.some((code) => code.largest !== null && 2 * code.largest <= enough) ? `First those that move reflections by at most ${degrees(enough)}, fewest bits first; then` : "Ranked"} by error plus ${worth} dB for each doubling of the cost. Assumed: memory traffic hides ${this.constants.hidden} issue slots per pass, so a cost up to there counts the same.${isBounded ? " ≥: the largest of the samples; the others are suprema." : ""}`);
    return element("div", {}, element("div", { class: "scroll", role: "region", "aria-label": "Eligible encodings", tabindex: "0" }, table), note);
  }

  leftOut({ out, why }) {
    const reasons = new Map();
    for (const code of out) reasons.set(why.get(code), [...(reasons.get(why.get(code)) ?? []), code.name]);
    // A page has controls, not options.
    const lines = Array.from(reasons, ([reason, names]) => element("p", {}, `${names.join(", ")}: ${reason.replace(/; --\S+ allows \w+$/, "")}.`));
    return element("details", { class: "aside" }, element("summary", {}, `Excluded (${out.length})`), ...lines);
  }
}

const isImageTie = (a, b, constants) => a.image !== null && b.image !== null && Math.abs(a.image - b.image) < clearImageGap(a, b, constants);

// A and B in the figures by which codes are chosen, the better one of each marked; images that tie are no better, and neither is a
// code that cannot hold the normals.
function pairTable([a, b], asked, constants) {
  const isTie = isImageTie(a, b, constants), isFit = !a.unfit && !b.unfit, prices = new Map([a, b].map((code) => [code, code.priced ? priceOf(code, asked, constants) : null]));
  const columns = [...COMPARED, [`cost with ${asked.readers} decoding passes`, (code) => (code.priced ? `${Number((prices.get(code) / Math.min(...[...prices.values()].filter(Boolean))).toPrecision(2))}×` : ""), (code) => prices.get(code), "less"]];
  const cell = ([title, text, value, better], one, other) => {
    const isTied = isTie && title === IMAGE, isUnsure = title === LARGEST && one.sampled, isBest = isFit && !isTied && !isUnsure && !isSameFigure(value(one), value(other)) && value(one) !== null && value(other) !== null && (better === "less" ? value(one) < value(other) : value(one) > value(other));
    return element("td", { class: isBest ? "n best" : "n" }, `${text(one)}${isTied ? ", a tie" : ""}`);
  };
  const heads = [a, b].map(({ name }, at) => element("th", { scope: "col", class: `n side-${CODECS[at]}` }, `${CODECS[at].toUpperCase()} `, ...broken(name)));
  const rows = columns.map((column) => element("tr", {}, element("th", { scope: "row" }, titleUnder(column[0], asked.mixing)), cell(column, a, b), cell(column, b, a)));
  const table = element("table", { class: "pair-figures" }, element("thead", { class: "plain" }, element("tr", {}, element("td", {}), ...heads)), element("tbody", {}, ...rows));
  return element("div", { class: "scroll", role: "region", "aria-label": "A next to B", tabindex: "0" }, table);
}

const chooseRoot = document.querySelector("[data-choose]");
if (chooseRoot) dataOf("choices").then((made) => new Choose(chooseRoot, made));
