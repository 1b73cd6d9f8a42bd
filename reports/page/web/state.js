"use strict";

// The state of the whole page: which view is shown, what is asked of a code, the codecs A and B, a place in the view. One object, one
// function that changes it, one that shows it, and the address, which holds it.
const VERSION = "v1", CODECS = ["a", "b"], CONSTRAINTS = ["for", "most", "readers", "worth", "enough", "holes", "lengths", "tables", "uses", "gpu"];
const KEYS = [...CONSTRAINTS, "a", "b", "at", "live"];
const views = Array.from(document.querySelectorAll(".view")), known = JSON.parse(document.querySelector("#beginning").textContent);
const NONE = Object.fromEntries(KEYS.map((key) => [key, ""]));
const DEFAULTS = { ...NONE, view: known.view, a: known.a, b: known.b };
// What is no key of this version is kept, for the one that wrote it.
let state = { ...DEFAULTS, others: [] };
const shows = [];
// The codecs of the answer to what a state asks, the best one first; and which of A and B a reader has chosen.
let answersTo = () => [];
const picked = new Set();
let isShown = false;

// Whatever is asked for, A and B are two codecs, or none.
function changed(state, change) {
  const next = { ...state, ...change };
  if (next.a && next.a === next.b) {
    if ("b" in change) next.a = state.b;
    else next.b = state.a;
  }
  return next;
}

// What A is unless a reader chooses it: the answer, or an encoding of the user's own. And B: the next one that is not A, of
// the same storage where the answer has only one.
const usualA = (state) => (answersTo(DEFAULTS)[0] === DEFAULTS.a ? answersTo(state)[0] : null) ?? DEFAULTS.a;
const usualB = (state) => {
  const answers = answersTo(state), isOther = (name) => name !== state.a, isNear = (name) => !answers.length || name.split(" ")[1] === state.a.split(" ")[1];
  return answers.find(isOther) ?? [DEFAULTS.b, DEFAULTS.a].find((name) => isOther(name) && isNear(name)) ?? "";
};

function followed(state) {
  const next = { ...state, a: picked.has("a") ? state.a : usualA(state) };
  return { ...next, b: picked.has("b") && !(state.b && state.b === next.a) ? state.b : usualB(next) };
}

// The address of a state, less what is as usual.
function hashOf({ others, ...values }) {
  const usual = { ...DEFAULTS, a: usualA(values), b: usualB(values) };
  const pairs = [...KEYS.filter((key) => values[key] !== usual[key]).map((key) => [key, values[key]]), ...others];
  return `#${VERSION}/${values.view}${pairs.length ? "?" : ""}${pairs.map((pair) => pair.map(encodeURIComponent).join("=")).join("&")}`;
}

// The state of an address, and what of it is not known here.
function stateOf(hash) {
  const found = { ...DEFAULTS, others: [] }, unknown = [];
  if (hash && !hash.startsWith(`#${VERSION}/`)) return [at(state, decoded(hash.slice(1))), unknown];
  const [view, query = ""] = hash.slice(VERSION.length + 2).split(/\?(.*)/s);
  if (views.some((one) => one.dataset.view === view)) found.view = view;
  else if (view) unknown.push(`the view ${decoded(view)}`);
  for (const pair of query.split("&").filter(Boolean)) {
    const [key, value] = pair.split(/=(.*)/s).map(decoded);
    if (!KEYS.includes(key)) found.others.push([key, value ?? ""]);
    else if (CODECS.includes(key) && value && !known.codecs.includes(value)) unknown.push(`the codec ${value}`);
    else found[key] = value ?? "";
  }
  if (found.a && found.a === found.b) found.b = "";
  return [found.at ? at(found, found.at) : found, unknown];
}

function decoded(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}

// A state that shows an element, of the view that it is in.
function at(state, id) {
  const place = document.querySelector(`main [id="${CSS.escape(id)}"]`);
  return place ? { ...state, view: place.closest(".view")?.dataset.view ?? state.view, at: id } : { ...state, at: "" };
}

// Changes the state. A step that Back takes is one of A, B and the view.
function change(next, isDragged = false) {
  const before = state, moved = changed(state, next);
  for (const side of CODECS) if (moved[side] !== before[side]) picked.add(side);
  state = followed(moved);
  const hash = hashOf(state), isStep = ["a", "b", "view", "at", ...CONSTRAINTS].some((key) => before[key] !== state[key]);
  if (hash !== location.hash) history[isStep && !isDragged ? "pushState" : "replaceState"](null, "", hash);
  show(before);
}

function readAddress() {
  // Browsers tell of one step twice.
  if (isShown && location.hash === hashOf(state)) return;
  const [found, unknown] = stateOf(location.hash), before = state, isLink = location.hash && !location.hash.startsWith(`#${VERSION}/`);
  picked.clear();
  for (const side of CODECS) if (location.hash.match(`[?&]${side}=`)) picked.add(side);
  state = followed(found);
  const said = document.querySelector("#unknown");
  said.hidden = !unknown.length;
  said.textContent = unknown.length ? `The address names ${unknown.join(" and ")}, which this page does not have.` : "";
  if (location.hash && hashOf(state) !== location.hash) history.replaceState(null, "", hashOf(state));
  show(before, isLink || !isShown);
  isShown = true;
}

// Names of codecs, or of encodings, which stand for each of their codecs.
function agrees(one, other) {
  const covers = (encoding, codec) => !encoding.includes(" ") && codec.startsWith(`${encoding} `);
  return Boolean(one && other) && (one === other || covers(one, other) || covers(other, one));
}

// What agrees with a name, as a selector.
function sameAs(name) {
  const text = CSS.escape(name), encoding = CSS.escape(name.split(" ")[0]);
  return name.includes(" ") ? `[data-codec="${text}"], [data-codec="${encoding}"]` : `[data-codec="${text}"], [data-codec^="${text} "]`;
}

// What A and B are, everywhere: one rule each, for tables, charts and pictures.
function ruleOf(name, side) {
  if (!name) return "";
  return `:is(${sameAs(name)}) { --side: var(--${side}); --side-ground: var(--${side}-ground); --side-width: 2.6px; --side-name: "${side.toUpperCase()}\\00a0"; }\n`;
}

// What the tab is called, by view: the answer, or the codecs that are shown.
const titles = { compare: ({ a, b }) => a && b && `${a} against ${b}`, codecs: ({ a }) => a }, usualTitle = document.title;

function titled(state) {
  const told = titles[state.view]?.(state) || document.querySelector(`nav [data-to="${state.view}"]`)?.textContent.trim();
  document.title = told ? `${told} - normalbench` : usualTitle;
}

function show(before, goes = false) {
  for (const view of views) view.hidden = view.dataset.view !== state.view;
  for (const link of document.querySelectorAll("nav [data-to]")) {
    if (link.dataset.to === state.view) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  }
  // Where one row is both, it is A's.
  const rules = ruleOf(state.b, "b") + ruleOf(state.a, "a");
  const style = document.querySelector("#sides");
  if (style.textContent !== rules) style.textContent = rules;
  for (const button of document.querySelectorAll("button[data-name]")) pressed(button);
  for (const button of document.querySelectorAll("button[data-take]")) taken(button);
  for (const side of CODECS) {
    const list = document.querySelector(`#side-${side}`);
    if (list) list.value = state[side];
  }
  for (const listener of shows) listener(state, before);
  titled(state);
  if (state.view !== before.view || state.at !== before.at || goes) goTo(before);
}

function pressed(button) {
  button.setAttribute("aria-pressed", String(CODECS.some((side) => agrees(button.dataset.name, state[side]))));
}

function goTo(before) {
  const place = state.at && document.getElementById(state.at);
  // What is named is seen, and a section's own fold with it.
  for (let one = place && (place.querySelector(":scope > details.subject") ?? place); one; one = one.parentElement) {
    if (one instanceof HTMLDetailsElement) one.open = true;
  }
  if (place) place.scrollIntoView({ block: "start", behavior: "instant" });
  else if (state.view !== before.view) scrollTo({ top: 0, behavior: "instant" });
}

// A codec's name is a button: A, and with shift B. The one that is A or B already is taken back.
function choose(name, isB) {
  const side = isB ? "b" : "a";
  change({ [side]: state[side] === name ? "" : name });
}

// An encoding's name stands for the codec of it that is shown first.
function codecNamed(name) {
  return known.codecs.includes(name) ? name : known.codecs.find((codec) => agrees(codec, name)) ?? "";
}

// Options of a list, those of an encoding together. Each pair is a codec and its value.
function grouped(pairs) {
  const groups = new Map();
  for (const [name, value] of pairs) groups.set(name.split(" ")[0], [...(groups.get(name.split(" ")[0]) ?? []), new Option(name, value)]);
  return Array.from(groups, ([label, options]) => element("optgroup", { label }, ...options));
}

function nameButton(name, ...children) {
  const button = element("button", { type: "button", class: "pick", "data-name": name, title: `Click to make ${name} A; Shift-click to make it B` }, ...children);
  pressed(button);
  return button;
}

// A codec as A and as B without a key: for fingers.
function sideButtons(name) {
  return CODECS.map((side) => {
    const button = element("button", { type: "button", class: `side-${side}`, "data-take": side, value: name, "aria-label": `${side.toUpperCase()}: ${name}`, onclick: () => choose(name, side === "b") }, side.toUpperCase());
    taken(button);
    return button;
  });
}

function taken(button) {
  button.setAttribute("aria-pressed", String(state[button.dataset.take] === button.value));
}

document.addEventListener("click", (event) => {
  const button = event.target.closest?.("[data-name]");
  if (!button) return;
  const name = codecNamed(button.dataset.name);
  if (name) choose(name, event.shiftKey);
});
// A view keeps A, B and what is asked.
for (const link of document.querySelectorAll("nav [data-to]")) {
  link.addEventListener("click", (event) => {
    if (event.ctrlKey || event.metaKey || event.shiftKey || event.altKey) return;
    event.preventDefault();
    change({ view: link.dataset.to, at: "" });
    scrollTo({ top: 0, behavior: "instant" });
  });
}
for (const side of CODECS) document.querySelector(`#side-${side}`)?.addEventListener("change", (event) => change({ [side]: event.target.value }));
document.querySelector("#sides-swap")?.addEventListener("click", () => change({ a: state.b, b: state.a }));
for (const row of document.querySelectorAll("tr[data-codec]")) {
  if (codecNamed(row.dataset.codec)) row.cells[0].append(nameButton(row.dataset.codec, ...row.cells[0].childNodes));
}
// The navigation stays in sight, and what an address names lies below it.
const navigation = document.querySelector("nav");
new ResizeObserver(() => document.documentElement.style.setProperty("--nav", `${navigation.offsetHeight}px`)).observe(navigation);
