"use strict";

// "Measure": every codec of the run on this device, in slices that leave the page alive.

// Names of columns, what they say, and whether they hold numbers.
const COLUMNS = [
  ["codec", "The encoding and its storage."],
  ["target", "The WebGL format of the render target. R32UI, RG32UI and RGBA32UI hold codes that the shader rounded and packed."],
  ["equal", "Percentage of codes that match the run's, bit for bit.", true],
  ["one step", "Codes that differ from the run's by one step in one component.", true],
  ["further", "Codes that differ by more, and codes in groups whose differences a checksum cannot distinguish.", true],
  ["mean", "The mean angle between normals and what this device decodes, in degrees.", true],
  ["run", "The same mean angle for the run's codes.", true],
  ["max", "The largest angle on this device, in degrees.", true],
  ["encode", "Milliseconds to encode a megapixel, minus a pass that only reads and writes.", true],
  ["decode", "Milliseconds to decode a megapixel, minus a pass that only reads and writes.", true],
  ["difference", "Which components of which normals differ."],
];

const FORMAT_COLUMNS = [
  ["format", "The WebGL format."],
  ["renders", "Whether the device can render to the format."],
  ["rounds", "How it rounds a number between two steps of the first channel."],
  ["filters", "Whether a lookup between two texels interpolates, and with how many bits of position."],
  ["resolves", "Result of resolving four samples with two different codes, in steps from their mean."],
];

class CancelledError extends Error {}

class Measuring {
  // Fills `root`. `data` is live.data.
  constructor(root, device, data) {
    Object.assign(this, { root, device, data, rows: [], facts: {}, normals: new Normals(data.checks), checks: new Checks(data.checks) });
    this.codecs = data.codecs.filter((codec) => codec.checks);
    this.without = data.codecs.length - this.codecs.length;
    this.build();
    device.on("lost", () => (this.wasLost = true));
  }

  build() {
    const start = () => this.start();
    this.button = element("button", { type: "button", "data-measure": "", onclick: start }, "Measure this device");
    this.cancelling = element("button", { type: "button", "data-cancel": "", onclick: () => this.cancel(), hidden: "" }, "Cancel");
    this.timed = element("input", { type: "checkbox", id: "measure-times", checked: "" });
    this.progress = element("progress", { max: this.codecs.length, value: 0, hidden: "", "aria-label": "Codecs measured" });
    this.said = element("p", { role: "status", class: "note", "data-measured": "" });
    const times = element("label", { for: "measure-times" }, this.timed, " with timings");
    this.results = element("div", { "data-results": "" });
    this.factList = element("div", { "data-facts": "" });
    this.keeping = element("div", { "data-keep": "" });
    const left = this.without ? [element("p", { class: "note" }, `${this.without} of ${this.data.codecs.length} codecs are not measured: the run did not store their expected codes.`)] : [];
    this.root.append(element("h3", {}, "Measure"), ...left, element("p", { class: "tools" }, this.button, times, this.cancelling), this.progress, this.said, this.results, this.factList, this.keeping);
  }

  say(text) {
    this.said.textContent = text;
  }

  cancel() {
    this.isCancelled = true;
    this.cancelling.disabled = true;
  }

  check() {
    if (this.isCancelled) throw new CancelledError();
  }

  get isBusy() {
    return !this.progress.hidden;
  }

  setBusy(is) {
    this.progress.hidden = !is;
    this.cancelling.hidden = !is;
    this.cancelling.disabled = false;
    this.button.disabled = is;
  }

  async start() {
    Object.assign(this, { isCancelled: false, wasLost: false, rows: [], facts: {} });
    for (const place of [this.results, this.factList, this.keeping]) place.replaceChildren();
    this.setBusy(true);
    try {
      this.say("Generating the normals.");
      await paused();
      await this.checkNormals();
      await this.surviving(() => this.probe());
      await this.all();
      this.say(`${this.rows.length} of ${this.codecs.length} codecs measured. ${this.agreement}`);
    } catch (error) {
      const kept = this.rows.length ? ` ${this.rows.length} codecs measured earlier are kept.` : "";
      this.say(`${error instanceof CancelledError ? "Cancelled." : `Not finished: ${error.message}.`}${kept}`);
    } finally {
      this.inputs?.release();
      this.inputs = null;
      this.setBusy(false);
      if (this.rows.length) keepDevice(this.keeping, this);
    }
  }

  async checkNormals() {
    for (const domain of new Set(this.codecs.map((codec) => codec.domain))) {
      if (!this.normals.areRuns(domain)) throw new Error(`this browser generates different ${domain} normals from the run's`);
      await paused();
    }
  }

  get agreement() {
    const all = this.rows.filter((row) => row.equal === row.normals).length;
    return `${all} of them match the run's codes, bit for bit.`;
  }

  async probe() {
    this.say("Checking the device's formats.");
    this.facts = await new Probe(this.device).facts(() => this.check());
    this.showFacts();
  }

  async all() {
    const { codecs } = this;
    for (const [at, codec] of codecs.entries()) {
      this.progress.value = at;
      this.say(`${at + 1} of ${codecs.length}, ${nameOf(codec)}`);
      await paused();
      this.check();
      this.add(await this.surviving(() => this.measured(codec)));
    }
    this.progress.value = codecs.length;
  }

  // What a step makes; where the context is lost on the way the step is made again when it is back.
  async surviving(step) {
    for (;;) {
      let made, failed = null;
      try {
        made = await step();
      } catch (error) {
        if (error instanceof CancelledError) throw error;
        failed = error;
      }
      if (!this.device.gl.isContextLost() && !this.wasLost) {
        if (failed) throw failed;
        return made;
      }
      await this.restored();
    }
  }

  // Until the context is back.
  async restored() {
    const before = this.said.textContent;
    this.say("The GPU context was lost. The measured codecs are kept; the rest continues when the browser restores it.");
    while (this.device.gl.isContextLost()) {
      await paused(50);
      this.check();
    }
    await paused(50);
    this.inputs = null;
    this.wasLost = false;
    this.say(before);
  }

  async measured(codec) {
    this.inputs ??= new Inputs(this.device, this.normals);
    const row = { encoding: codec.encoding, storage: codec.storage, rounding: codec.rounding, target: "", normals: this.data.checks.count };
    const { domain, checks } = codec, on = new CodecOnDevice(this.inputs, codec);
    try {
      const codes = [await on.packedCodes()];
      if (!on.packs) codes.push(await on.targetCodes());
      this.check();
      await paused();
      let found = this.checks.compare(codec, codes);
      if (found.untold) found = this.checks.compare(codec, codes, await on.exactNumbers());
      const { mean, most } = await on.angles();
      const { equal, oneStep, further } = found, times = { encode_ms: null, decode_ms: null, timer: "" };
      const difference = saysDifference(found, this.normals.of(domain).n);
      Object.assign(row, { target: on.format, equal, one_step: oneStep, further, mean_deg: mean, max_deg: most, run_mean_deg: checks.mean_deg }, times);
      if (this.timed.checked) await this.time(on, row);
      return Object.defineProperty(row, "difference", { value: difference });
    } finally {
      on.release();
    }
  }

  async time(on, row) {
    // What else is drawn would be measured as well.
    for (const name of ["turn", "wobble"]) live.see.move(name, false);
    const timer = new Timer(this.device), timed = new TimedCodec(on, timer);
    await seen();
    row.encode_ms = await timed.encode();
    this.check();
    row.decode_ms = await timed.decode();
    row.timer = timer.says;
  }

  // A row more, without a new table: readers may have scrolled and sorted this one.
  add(row) {
    this.rows.push(row);
    if (this.rows.length === 1) this.results.replaceChildren(sheetOf("This device's codes compared with the run's", COLUMNS, [], "measured-codes"));
    this.results.querySelector("tbody").append(lineOf(COLUMNS, cellsOfRow(row)));
  }

  showFacts() {
    const formats = Object.keys(PROBED), rows = formats.map((format) => ({ codec: "", isWhole: true, cells: [format, ...FORMAT_COLUMNS.slice(1).map(([what]) => this.facts[`${what} ${format}`] ?? "")] }));
    const list = element("dl", { class: "facts" }), others = Object.entries(this.facts).filter(([name]) => !formats.includes(name.split(" ")[1]));
    for (const [name, value] of others) list.append(element("dt", {}, name), element("dd", {}, String(value)));
    const table = sheetOf("Formats on this device", FORMAT_COLUMNS, rows, "measured-formats");
    this.factList.replaceChildren(element("details", { class: "all" }, element("summary", {}, "Formats and numbers on this device"), table, list));
  }
}

const nameOf = ({ encoding, storage, rounding }) => codecLabel(encoding, storage, rounding);

function cellsOfRow(row) {
  const ms = (value) => (value === null ? "" : value.toPrecision(3)), degrees = (value) => value.toPrecision(4);
  const figures = [((100 * row.equal) / row.normals).toFixed(3), row.one_step, row.further];
  const angles = [row.mean_deg, row.run_mean_deg, row.max_deg].map(degrees);
  return { codec: nameOf(row), isWhole: row.equal === row.normals, cells: [nameOf(row), row.target, ...figures, ...angles, ms(row.encode_ms), ms(row.decode_ms), row.difference] };
}

function lineOf(columns, { codec, isWhole, cells }) {
  const style = (at) => (columns[at][2] ? "n" : at === cells.length - 1 ? "long" : "");
  const made = cells.map((text, at) => (at ? element("td", { class: style(at) }, String(text)) : element("th", { scope: "row" }, text)));
  return element("tr", { ...(codec && { "data-codec": codec }), class: isWhole ? "" : "differs" }, ...made);
}

// A table as the page's others are: sorted by its headers, filtered by none.
function sheetOf(title, columns, rows, id) {
  const head = columns.map(([name, says, isNumber]) => {
    const button = element("button", { type: "button", title: says }, name);
    const header = element("th", { scope: "col", "aria-sort": "none", class: isNumber ? "n" : "" }, button);
    button.addEventListener("click", () => sortBy(header));
    return header;
  });
  const caption = element("caption", { id: `${id}-caption` }, element("span", {}, title)), body = rows.map((row) => lineOf(columns, row));
  const table = element("table", {}, caption, element("thead", {}, element("tr", {}, ...head)), element("tbody", {}, ...body));
  const says = columns.flatMap(([name, text]) => [element("dt", {}, name), element("dd", {}, text)]);
  const columnsSay = element("details", { class: "columns" }, element("summary", {}, "Column definitions"), element("dl", {}, ...says));
  const scroll = element("div", { class: "scroll", role: "region", "aria-labelledby": `${id}-caption`, tabindex: "0" }, table);
  const sheet = element("div", { class: "sheet" }, scroll, columnsSay);
  addTools(sheet);
  return sheet;
}

live.parts.push((root) => {
  live.measuring = new Measuring(root.querySelector("[data-live=measure]"), live.device, live.data);
});
