"use strict";

// Your own encoder: compiled as it is typed, stored by the functions of any storage, and seen in the picture above.
const OWN = "your encoder", WAIT_MS = 250, LONGEST_TEXT = 2 ** 16, MOST_SAID = 8, KEPT_TEXT = "encoder";
// Lines of the page's own shaders, in messages of the compiler, begin here.
const OTHERS = 100000;

class OwnEncoder {
  constructor(root, see) {
    this.see = see;
    this.device = live.device;
    this.field = Object.fromEntries(Array.from(root.querySelectorAll("[data-own]"), (one) => [one.dataset.own, one]));
    this.options = ["left", "right"].map((side) => see.control[side].appendChild(element("option", { disabled: "" }, OWN)));
    // Sides that show it as soon as it runs.
    this.wanted = [];
    this.comparing = 0;
    see.failed = (error) => this.refuse(error.message);
    see.followers.push(() => this.compare());
    const storages = new Map(live.data.storages.map(({ storage, title }) => [storage, title]));
    this.field.storage.append(...Array.from(storages, ([storage, title]) => element("option", { value: storage }, title)));
    const texts = live.data.codecs.filter(({ text }) => text);
    this.field.from.append(...Array.from(new Map(texts.map((codec) => [codec.encoding, codec])).keys(), (name) => element("option", { value: name }, name)));
    this.first = live.data.shaders["first.glsl"];
    this.field.text.value = this.first;
    this.listen();
    this.device.on("lost", () => this.lost());
  }

  listen() {
    const { text, storage, domain, from, keep, run, lines } = this.field;
    text.addEventListener("input", () => this.later());
    text.addEventListener("scroll", () => (lines.scrollTop = text.scrollTop));
    for (const one of [storage, domain]) one.addEventListener("input", () => this.run());
    from.addEventListener("input", () => {
      text.value = live.data.codecs.find(({ encoding, text: own }) => own && encoding === from.value)?.text ?? this.first;
      this.run();
    });
    run.addEventListener("click", () => this.run());
    keep.addEventListener("click", () => saveText("mine.glsl", text.value));
  }

  later() {
    this.number();
    this.remember(false);
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => this.run(), WAIT_MS);
  }

  // The text as it is now, and whether it ran: after a reload it is there again.
  remember(isSound) {
    const { text, storage, domain } = this.field;
    if (text.value !== this.first || this.kept) remembered(KEPT_TEXT, (this.kept = JSON.stringify({ text: text.value, storage: storage.value, domain: domain.value, isSound })));
  }

  // What was typed before, or an object without a text.
  get before() {
    try {
      return JSON.parse(remembered(KEPT_TEXT)) ?? {};
    } catch {
      return {};
    }
  }

  // Begins with what was typed before. What did not end well is not run by itself.
  begin() {
    const { text, isSound, ...chosen } = this.before;
    if (typeof text !== "string" || text.length > LONGEST_TEXT) return this.run();
    this.fill(text, chosen);
    this.kept = remembered(KEPT_TEXT);
    return isSound === true ? this.run() : this.offer("This is the encoder that you typed here before. It did not finish.");
  }

  // Takes what an address brought. It is run by itself where this browser ran the very same before.
  receive(text, chosen) {
    const { text: known, isSound } = this.before;
    this.fill(text, chosen);
    return text === this.first || (text === known && isSound === true) ? this.run() : this.offer("This encoder came with the link. Read it, then run it.");
  }

  fill(text, chosen) {
    this.field.text.value = text;
    for (const name of ["storage", "domain"]) if (Array.from(this.field[name].options).some(({ value }) => value === chosen[name])) this.field[name].value = chosen[name];
    this.number();
  }

  offer(said) {
    this.turn = null;
    this.withdraw();
    this.clear();
    this.say(said);
    this.field.run.hidden = false;
  }

  // An encoder that takes the GPU away is not run again until somebody asks for it.
  lost() {
    if (performance.now() - (this.ran ?? -1e9) > 5000) return;
    this.withdraw();
    this.clear();
    this.say("The GPU was lost while this encoder ran; check for endless loops.");
  }

  // It is no longer to be seen.
  withdraw() {
    this.codec = null;
    for (const side of ["left", "right"]) if (this.see.control[side].value === OWN) this.see.control[side].value = EXACT;
    for (const option of this.options) option.disabled = true;
    live.byLabel.delete(OWN);
  }

  // What a compiler says of the text. Nothing of an older text stays next to it.
  refuse(log) {
    this.withdraw();
    this.clear();
    const said = linesOf(log, this.field.text.value);
    this.field.said.replaceChildren(...said.map(({ at, text }) => element("p", {}, ...(at ? [this.link(at), `: ${text}`] : [text]))));
    this.field.text.setAttribute("aria-invalid", "true");
    this.number(said.map(({ at }) => at).filter(Boolean));
  }

  clear() {
    this.trips = null;
    this.field.globe.hidden = true;
    this.compare();
  }

  say(...lines) {
    this.field.said.replaceChildren(...lines.map((line) => element("p", {}, line)));
  }

  // A line's name, which leads there.
  link(at) {
    const go = (event) => {
      event.preventDefault();
      const { text } = this.field, lines = text.value.split("\n"), from = lines.slice(0, at - 1).join("\n").length + (at > 1);
      text.focus();
      text.setSelectionRange(from, from + lines[at - 1].length);
    };
    return element("a", { href: "#own-text", onclick: go }, `Line ${at}`);
  }

  // Numbers of the lines; those with a mistake are marked.
  number(wrong = []) {
    const count = this.field.text.value.split("\n").length, parts = [];
    let from = 1;
    const plain = (until) => parts.push(Array.from({ length: Math.max(0, until - from) }, (_, at) => `${from + at}\n`).join(""));
    for (const at of [...new Set(wrong)].sort((a, b) => a - b)) {
      plain(at);
      parts.push(element("mark", {}, `${at}`), "\n");
      from = at + 1;
    }
    plain(count + 1);
    this.field.lines.replaceChildren(...parts);
    this.field.lines.scrollTop = this.field.text.scrollTop;
  }

  async run() {
    clearTimeout(this.waiting);
    this.waiting = 0;
    this.field.run.hidden = true;
    if (this.device.isLost) return;
    this.number();
    this.ran = performance.now();
    const turn = (this.turn = {});
    await this.attempt(turn, this.made());
    if (turn === this.turn) this.turn = null;
  }

  async attempt(turn, codec) {
    if (typeof codec === "string") return this.refuse(codec);
    try {
      const trips = await tripsOf(this.device, codec, codec.domain);
      if (turn !== this.turn || this.device.isLost) return;
      this.forget(codec);
      await this.show(codec, trips);
    } catch (error) {
      if (turn === this.turn) this.refuse(error.message);
      return;
    }
    if (turn !== this.turn) return;
    this.remember(true);
    this.offerSides(codec);
  }

  get isBusy() {
    return Boolean(this.turn || this.waiting || this.comparing);
  }

  // It may be chosen, and is where an address wants it.
  offerSides(codec) {
    const { control } = this.see;
    live.byLabel.set(OWN, codec);
    for (const option of this.options) option.disabled = false;
    for (const side of this.wanted) control[side].value = OWN;
    this.wanted = [];
    if (["left", "right"].some((side) => control[side].value === OWN)) this.see.change();
  }

  forget(codec) {
    if (this.codec && this.codec.source !== codec.source) this.device.drop(this.codec);
    this.codec = codec;
  }

  // The codec that is typed, or what is wrong with its text.
  made() {
    const text = this.field.text.value, bare = text.replace(/\/\/[^\n]*|\/\*[\s\S]*?\*\//g, (comment) => comment.replace(/[^\n]/g, " "));
    if (text.length > LONGEST_TEXT) return `The text is longer than ${LONGEST_TEXT} characters.`;
    const found = (pattern) => new Map(Array.from(bare.matchAll(pattern), (match) => [match.groups.name, match]));
    const encoders = found(/\bvec(?<size>[23])\s+(?<name>\w+)_encode\s*\((?<given>[^)]*)\)/g);
    const decoders = found(/\bvec3\s+(?<name>\w+)_decode\s*\((?<given>[^)]*)\)/g);
    const name = Array.from(encoders.keys()).find((one) => decoders.has(one));
    if (!encoders.size) return "There is no encoder: write vec2 (or vec3) NAME_encode(vec3 n).";
    if (!name) return `There is no decoder: write vec3 ${encoders.keys().next().value}_decode(vec2 e), or with a vec3.`;
    if (/\buniform\b/.test(bare)) return "A uniform has no value here: use a constant.";
    const encode = encoders.get(name).groups, decode = decoders.get(name).groups;
    const size = Number(encode.size), stored = live.data.storages.find((one) => one.storage === this.field.storage.value && one.size === size);
    if (!stored) return `This storage cannot hold ${size} components; choose another.`;
    const takes = (parameters) => parameters.split(",").length > 1;
    const source = `${stored.source}\nprecision highp float;\n${live.data.helpers}\n#line 1\n${text}\n#line ${OTHERS}\n`;
    const calls = { encode: `${name}_encode`, decode: `${name}_decode` }, views = { encode: takes(encode.given), decode: takes(decode.given) };
    return { ...stored, label: OWN, source, calls, views, domain: this.field.domain.value };
  }

  async show(codec, trips) {
    const { count, lost, mean, rms, worst, direction, decibels } = trips;
    const figures = count
      ? `On ${count} random directions: mean ${digits(mean)}°, RMS ${digits(rms)}°, largest ${digits(worst)}°, at ${vectorText(direction)}; PSNR ${digits(decibels, 4)} dB.`
      : "No direction decodes to a finite value.";
    this.say(`${codec.bits} bits in ${codec.title}. ${figures}`, ...(lost && count ? [`${lost} directions decode to non-finite values.`] : []));
    this.field.text.removeAttribute("aria-invalid");
    this.field.command.textContent = `normalbench quality --encoding mine.glsl --storage ${codec.storage} --normals ${codec.domain}`;
    this.trips = trips;
    this.compare();
    // Full colour is the largest angle that was met.
    await drawGlobe(this.device, codec, count ? worst : 1, this.see.colours, this.field.sphere);
    this.field.most.textContent = `${digits(count ? worst : 1)}°`;
    this.field.globe.hidden = false;
  }

  // Its figures next to those of both sides.
  async compare() {
    const sides = ["left", "right"].map((side) => this.see.codec(side)).filter((codec) => codec && codec !== this.codec), domain = this.field.domain.value;
    const key = [domain, ...sides.map(({ label }) => label)].join(), { trips, codec } = this;
    if (this.compared?.key === key && this.compared.trips === trips) return;
    this.compared = { key, trips };
    if (!live.see?.first || this.device.isLost) return (this.compared = null);
    this.comparing++;
    const others = await Promise.all(sides.map(async (one) => [one, await knownTrips(this.device, one, domain)])).finally(() => this.comparing--);
    if (this.compared?.key !== key || this.compared.trips !== trips) return;
    const rows = [...(trips && codec ? [[codec, trips]] : []), ...others];
    this.field.figures.replaceChildren(...rows.map(([one, found]) => {
      const cells = [one.bits, ...[found.mean, found.rms, found.worst].map((value) => `${digits(value)}°`), `${digits(found.decibels, 4)} dB`];
      return element("tr", {}, element("th", { scope: "row" }, one.label), ...cells.map((text) => element("td", { class: "n" }, String(text))));
    }));
  }
}

// What a compiler says: { at, text }, where `at` is the line of the text or 0.
function linesOf(log, text) {
  const last = text.split("\n").length, lines = log.replaceAll("\0", "").split("\n").map((line) => line.trim()).filter(Boolean);
  return lines.slice(0, MOST_SAID).map((line) => {
    const [, at, said] = line.match(/^(?:ERROR|WARNING): \d+:(\d+): ?(.*)$/) ?? [];
    if (!at) return { at: 0, text: line };
    if (Number(at) <= last) return { at: Number(at), text: said };
    if (Number(at) < OTHERS) return { at: 0, text: `At the end of the text: ${said}` };
    return { at: 0, text: /redefinition/.test(said) ? `The page uses this name; choose another: ${said}` : `Where the page calls it: ${said}` };
  });
}

live.parts.push((root) => {
  live.own = new OwnEncoder(root, live.see);
});
