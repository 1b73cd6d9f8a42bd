"use strict";

// What is seen as an address, and as a file: the address follows what the reader does, and gives all of it back.
const WRITE_MS = 300, LONGEST_SHARED = 2 ** 16, INK = "#fff", GROUND = "#111";

class Share {
  constructor(root, see, own) {
    Object.assign(this, { see, own });
    this.field = Object.fromEntries(Array.from(root.querySelectorAll("[data-share]"), (one) => [one.dataset.share, one]));
    this.first = this.values();
    see.followers.push(() => this.later());
    this.field.share.addEventListener("click", () => this.share());
    this.field.picture.addEventListener("click", () => this.picture());
    shows.push((state, before) => state.live !== before.live && state.live !== this.written && this.restore());
  }

  // What a reader chose: controls by name, less what cannot be sent.
  values() {
    const made = {};
    for (const [name, one] of Object.entries(this.see.control)) {
      if (one.matches("select")) made[name] = one.value;
      else if (one.matches("[type=range]")) made[name] = Number(one.value);
      else if (one.matches("[type=checkbox]")) made[name] = one.checked;
    }
    if (made.subject === DROPPED) Object.assign(made, { subject: this.first?.subject ?? FIRST_SCENE, file: this.see.scene.title });
    const { text, storage, domain } = this.own.field;
    return { ...made, text: text.value, storage: storage.value, domain: domain.value };
  }

  // The same where nothing was chosen: A and B say what the sides are.
  get usual() {
    return { ...this.first, ...this.see.sidesOf(state), text: this.own.first };
  }

  // What differs from the usual, packed; empty for nothing. The encoder's text goes along where it is seen or asked for.
  async packed(withText) {
    const values = this.values(), { usual } = this, isSeen = [values.left, values.right].includes(OWN);
    const isOwn = (name) => ["text", "storage", "domain"].includes(name);
    const differs = ([name, value]) => (isOwn(name) ? (isSeen || withText) && (isSeen || value !== usual[name]) : value !== usual[name]);
    const found = Object.entries(values).filter(differs);
    if (!found.length) return "";
    const text = JSON.stringify(Object.fromEntries(found));
    if (new Blob([text]).size > LONGEST_SHARED) throw new Error(`the encoder is too long for an address; the maximum is ${LONGEST_SHARED} bytes`);
    return deflated(text);
  }

  // The address is written at most a few times a second.
  later() {
    // A link that was made is of what was seen then.
    this.field.link.parentNode.hidden = true;
    this.writing ||= setTimeout(() => this.write(), WRITE_MS);
  }

  async write() {
    const packed = await this.packed(false).catch(() => "");
    this.writing = 0;
    if (packed === state.live || this.isRestoring) return;
    this.written = packed;
    change({ live: packed }, true);
  }

  async share() {
    try {
      const link = `${location.href.split("#")[0]}${hashOf({ ...state, view: "see", at: "", live: await this.packed(true) })}`;
      this.field.link.value = link;
      this.field.link.parentNode.hidden = false;
      await copy(link, this.field.said);
      if (this.see.control.subject.value === DROPPED) this.field.said.textContent += `, without ${this.see.scene.title}: a link has no files`;
    } catch (error) {
      this.field.said.textContent = `Not shared: ${error.message}.`;
    }
  }

  // Takes everything from the address; what it names and cannot be, is said.
  async restore() {
    this.isRestoring = true;
    const wrong = [];
    let found = {};
    try {
      if (state.live) found = JSON.parse(await inflated(state.live));
      if (typeof found !== "object" || found === null || Array.isArray(found)) throw new Error("it contains no controls");
    } catch (error) {
      sayUnknown(`The laboratory's part of the address is damaged: ${error.message.replace(/\.$/, "")}.`);
      found = {};
    }
    const { text, file, ...values } = { ...this.usual, ...found }, { own } = this;
    own.wanted = [];
    if (file) sayUnknown(`The link was made with ${String(file).slice(0, 40)}, which a link does not contain: open the file here to see the same.`);
    for (const [name, value] of Object.entries(values)) if (!this.set(name, value)) wrong.push(`${name} ${String(value).slice(0, 40)}`);
    if (wrong.length) sayUnknown(`The address names ${wrong.slice(0, 5).join(" and ")}, which the laboratory does not have.`);
    this.see.aim({});
    if (typeof found.text === "string" && text.length <= LONGEST_TEXT) await own.receive(text, values);
    else if (own.wanted.length) await own.run();
    this.isRestoring = false;
  }

  // Sets a control; whether it can be that.
  set(name, value) {
    const one = this.see.control[name] ?? this.own.field[name];
    if (!one?.matches("input, select")) return false;
    if (one.matches("[type=checkbox]")) {
      if (typeof value === "boolean" && !one.disabled) one.checked = value;
      return typeof value === "boolean";
    }
    if (one.matches("[type=range]")) {
      const isThere = typeof value === "number" && value >= Number(one.min) && value <= Number(one.max);
      if (isThere) one.value = value;
      return isThere;
    }
    if (value === OWN) return this.own.wanted.push(name);
    const isThere = Array.from(one.options).some((option) => option.value === value);
    if (isThere) one.value = value;
    return isThere;
  }

  get scene() {
    return this.see.control.subject.selectedOptions[0].textContent;
  }

  // What the picture shows, and at which setting, as the controls say it.
  get caption() {
    const { control, out } = this.see;
    const settings = [control.shown.selectedOptions[0].textContent, control.roughness.disabled ? "" : `roughness ${out.roughness.textContent}`, control.legend.hidden ? "" : `full colour at ${out.most.textContent}`];
    return [this.scene, ...settings].filter(Boolean).join(", ");
  }

  // The picture as a PNG file, with the names of both sides and their figures.
  async picture() {
    const { see } = this, { canvas } = see, [width, height] = see.size, size = Math.max(12, Math.round(width / 75)), bar = 5.5 * size;
    if (canvas.width !== width) await see.rest();
    const made = element("canvas", { width, height: height + bar }), pen = made.getContext("2d"), at = Math.round((width * see.value("divider")) / 100);
    pen.drawImage(canvas, 0, 0);
    pen.fillStyle = INK;
    const isWhole = { left: at > 0, right: at < width };
    if (isWhole.left && isWhole.right) pen.fillRect(at - 1, 0, 2, height);
    pen.fillStyle = GROUND;
    pen.fillRect(0, height, width, bar);
    pen.fillStyle = INK;
    pen.font = `${size}px system-ui, sans-serif`;
    for (const [side, x, align] of [["left", size, "left"], ["right", width - size, "right"]]) {
      // What is not in the picture has no figures below it.
      if (!isWhole[side]) continue;
      pen.textAlign = align;
      for (const [line, text] of (await this.lines(side)).entries()) pen.fillText(text, x, height + (1.5 + 1.5 * line) * size, width / 2 - 2 * size);
    }
    pen.textAlign = "left";
    pen.fillText(this.caption, size, height + 4.5 * size, width - 2 * size);
    const blob = await new Promise((resolve) => made.toBlob(resolve, "image/png")), href = URL.createObjectURL(blob);
    const name = `${["normalbench", this.scene, see.control.shown.value, ...["left", "right"].filter((side) => isWhole[side]).map((side) => see.control[side].value)].join("-").replace(/[^\w.]+/g, "-")}.png`;
    save(name, href);
    setTimeout(() => URL.revokeObjectURL(href), 1000);
    this.field.said.textContent = `Saved as ${name}`;
  }

  // A side's name and figures.
  async lines(side) {
    const codec = this.see.codec(side);
    if (!codec) return [EXACT, ""];
    const found = codec.label === OWN ? this.own.trips : await knownTrips(this.see.device, codec, "sphere");
    return [codec.label, found ? `mean ${digits(found.mean)}°, largest ${digits(found.worst)}°, PSNR ${digits(found.decibels, 4)} dB on ${found.count} directions, ${codec.bits} bits` : ""];
  }
}

function sayUnknown(text) {
  const said = document.querySelector("#unknown");
  said.textContent = [said.hidden ? "" : said.textContent, text].filter(Boolean).join(" ");
  said.hidden = false;
}

async function deflated(text) {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join("")).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

// Read in pieces, so that a small link cannot become a large text.
async function inflated(packed) {
  const bytes = await unpackedBytes(bytesOf(packed.replaceAll("-", "+").replaceAll("_", "/")), "deflate-raw", LONGEST_SHARED);
  return new TextDecoder("utf-8", { fatal: true }).decode(bytes);
}

// Bytes of a packed text, at most so many.
async function unpackedBytes(packed, format, most) {
  const reader = new Blob([packed]).stream().pipeThrough(new DecompressionStream(format)).getReader(), parts = [];
  let size = 0;
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    parts.push(part.value);
    size += part.value.length;
    if (size > most) {
      await reader.cancel();
      throw new Error("it is too long");
    }
  }
  const made = new Uint8Array(size);
  let at = 0;
  for (const part of parts) {
    made.set(part, at);
    at += part.length;
  }
  return made;
}

live.parts.push(async (root) => {
  live.share = new Share(root, live.see, live.own);
  live.own.begin();
  if (state.live) await live.share.restore();
});
