"use strict";

// Your own encoder: compiled as it is typed, stored by the functions of any storage, and seen in the picture above.
const OWN = "your encoder", WAIT_MS = 250, LONGEST_TEXT = 2 ** 16, TRIED = 256, DISC = 160;
// Lines of the page's own shaders, in messages of the compiler, begin here.
const OTHERS = 100000;
const FIRST_TEXT = `// A unit normal to numbers in [-1, 1], and back.
vec2 mine_encode(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    return n.z < 0.0 ? (1.0 - abs(p.yx)) * sign_not_zero(p) : p;
}

vec3 mine_decode(vec2 e) {
    float z = 1.0 - abs(e.x) - abs(e.y);
    vec2 p = e - sign_not_zero(e) * max(-z, 0.0);
    return normalize(vec3(p, z));
}
`;

class OwnEncoder {
  constructor(root, see) {
    this.see = see;
    this.device = live.device;
    this.field = Object.fromEntries(Array.from(root.querySelectorAll("[data-own]"), (one) => [one.dataset.own, one]));
    this.options = ["left", "right"].map((side) => see.control[side].appendChild(element("option", { disabled: "" }, OWN)));
    see.failed = (error) => this.refuse(error);
    const storages = new Map(live.data.storages.map(({ storage, title }) => [storage, title]));
    this.field.storage.append(...Array.from(storages, ([storage, title]) => element("option", { value: storage }, title)));
    const texts = live.data.codecs.filter(({ text }) => text);
    this.field.from.append(...Array.from(new Map(texts.map((codec) => [codec.encoding, codec])).keys(), (name) => element("option", { value: name }, name)));
    this.field.text.value = FIRST_TEXT;
    this.listen();
    this.device.on("lost", () => this.lost());
    this.read().then((isShared) => isShared || this.run());
  }

  listen() {
    const { text, storage, domain, from, share, keep, run } = this.field;
    text.addEventListener("input", () => this.later());
    for (const one of [storage, domain]) one.addEventListener("input", () => this.run());
    from.addEventListener("input", () => {
      text.value = live.data.codecs.find(({ encoding, text: own }) => own && encoding === from.value)?.text ?? FIRST_TEXT;
      this.run();
    });
    run.addEventListener("click", () => this.run());
    share.addEventListener("click", () => this.share());
    keep.addEventListener("click", () => saveText("mine.glsl", text.value));
    shows.push((state, before) => state.live !== before.live && this.read());
  }

  later() {
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => this.run(), WAIT_MS);
  }

  // An encoder that takes the GPU away is not run again until somebody asks for it.
  lost() {
    if (performance.now() - (this.ran ?? -1e9) > 5000) return;
    this.withdraw();
    this.say("The GPU was lost while this encoder ran: does a loop of it not end?");
  }

  // It is no longer to be seen.
  withdraw() {
    this.codec = null;
    for (const side of ["left", "right"]) if (this.see.control[side].value === OWN) this.see.control[side].value = EXACT;
    for (const option of this.options) option.disabled = true;
    live.byLabel.delete(OWN);
  }

  // What a compiler says of the text, in the page's own shaders too.
  refuse(error) {
    this.withdraw();
    this.say(...linesOf(error.message, this.field.text.value));
    this.field.text.setAttribute("aria-invalid", "true");
  }

  say(...lines) {
    this.field.said.replaceChildren(...lines.map((line) => element("p", {}, line)));
  }

  run() {
    clearTimeout(this.waiting);
    this.field.run.hidden = true;
    if (this.device.isLost) return;
    this.ran = performance.now();
    const codec = this.made();
    try {
      if (typeof codec === "string") throw new Error(codec);
      const program = this.device.program(codec, ["angle.frag", "trip.frag", "figures.frag"]);
      this.forget(codec);
      this.show(codec, program);
    } catch (error) {
      this.say(...linesOf(error.message, this.field.text.value));
      this.field.text.setAttribute("aria-invalid", "true");
      return;
    }
    this.field.text.removeAttribute("aria-invalid");
    live.byLabel.set(OWN, codec);
    for (const option of this.options) option.disabled = false;
    if (["left", "right"].some((side) => this.see.control[side].value === OWN)) this.see.change();
  }

  forget(codec) {
    if (this.codec && this.codec.source !== codec.source) this.device.drop(this.codec);
    this.codec = codec;
  }

  // The codec that is typed, or what is wrong with its text.
  made() {
    const text = this.field.text.value, bare = text.replace(/\/\/[^\n]*|\/\*[\s\S]*?\*\//g, (comment) => comment.replace(/[^\n]/g, " "));
    if (text.length > LONGEST_TEXT) return `The text is longer than ${LONGEST_TEXT} letters.`;
    const found = (pattern) => new Map(Array.from(bare.matchAll(pattern), (match) => [match.groups.name, match]));
    const encoders = found(/\bvec(?<size>[23])\s+(?<name>\w+)_encode\s*\((?<given>[^)]*)\)/g);
    const decoders = found(/\bvec3\s+(?<name>\w+)_decode\s*\((?<given>[^)]*)\)/g);
    const name = Array.from(encoders.keys()).find((one) => decoders.has(one));
    if (!encoders.size) return "There is no encoder: vec2 NAME_encode(vec3 n), or of vec3.";
    if (!name) return `There is no decoder of it: vec3 ${encoders.keys().next().value}_decode(vec2 e), or of vec3.`;
    if (/\buniform\b/.test(bare)) return "A uniform has no value here: give its number as a constant.";
    const encode = encoders.get(name).groups, decode = decoders.get(name).groups;
    const size = Number(encode.size), stored = live.data.storages.find((one) => one.storage === this.field.storage.value && one.size === size);
    if (!stored) return `This storage holds no codes of ${size} numbers; choose another one.`;
    const takes = (parameters) => parameters.split(",").length > 1;
    const source = `${stored.source}\nprecision highp float;\n${live.data.helpers}\n#line 1\n${text}\n#line ${OTHERS}\n`;
    const calls = { encode: `${name}_encode`, decode: `${name}_decode` }, views = { encode: takes(encode.given), decode: takes(decode.given) };
    return { ...stored, label: OWN, source, calls, views, domain: this.field.domain.value };
  }

  show(codec, program) {
    const { device } = this, target = device.target(device.gl.RGBA32UI, TRIED, TRIED), isHalf = this.field.domain.value === "hemisphere";
    const uniforms = { halves: isHalf ? 1 : 2 };
    device.clearWords(target);
    device.draw(program, target, uniforms, device.tablesOf(codec));
    const found = new Float32Array(device.words(target).buffer);
    let sum = 0, squares = 0, differences = 0, worst = -1, at = 0, lost = 0;
    for (let i = 0; i < found.length; i += 4) {
      const off = found[i];
      if (!(off >= 0)) {
        lost++;
        continue;
      }
      sum += off;
      squares += off * off;
      differences += found[i + 1];
      if (off > worst) [worst, at] = [off, i];
    }
    const count = found.length / 4 - lost;
    device.draw(device.program(codec, ["angle.frag", "trip.frag", "figures.frag"], { defines: ["DIRECTION"] }), target, uniforms, device.tablesOf(codec));
    const direction = Array.from(device.words(target).slice(at, at + 3), floatOf);
    device.release(target);
    // Of the three components, with a peak of 1, as in the tables.
    const decibels = -10 * Math.log10(differences / (3 * count));
    const figures = count
      ? `On ${count} random directions: mean ${digits(sum / count)}°, RMS ${digits(Math.sqrt(squares / count))}°, largest ${digits(worst)}°, at ${vectorText(direction)}; PSNR ${digits(decibels, 4)} dB.`
      : "No direction comes back as a number.";
    this.say(`${codec.bits} bits in ${codec.title}. ${figures}`, ...(lost && count ? [`${lost} directions come back as no number.`] : []));
    this.field.command.textContent = `normalbench quality --encoding mine.glsl --storage ${codec.storage} --normals ${codec.domain}`;
    this.map(codec, count ? worst : 1);
  }

  // The error over the sphere; full colour is the largest that was met.
  map(codec, worst) {
    const { device } = this, { gl } = device, canvas = this.field.sphere, target = device.target(gl.RGBA8, 2 * DISC, DISC);
    const program = device.program(codec, ["angle.frag", "trip.frag", "sphere.frag"]);
    const given = { ...device.tablesOf(codec), colours: this.see.colours };
    device.draw(program, target, { size: { ints: [2 * DISC, DISC] }, full: worst }, given);
    const bytes = new Uint8ClampedArray(8 * DISC * DISC);
    gl.readPixels(0, 0, 2 * DISC, DISC, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    device.release(target);
    [canvas.width, canvas.height] = [2 * DISC, DISC];
    const image = new ImageData(2 * DISC, DISC), line = 8 * DISC;
    for (let y = 0; y < DISC; y++) image.data.set(bytes.subarray((DISC - 1 - y) * line, (DISC - y) * line), y * line);
    canvas.getContext("2d").putImageData(image, 0, 0);
    this.field.most.textContent = `${digits(worst)}°`;
  }

  // A link to this page that holds the text behind its #, which no server is sent.
  async share() {
    const { text, storage, domain } = this.field;
    const packed = await deflated(JSON.stringify({ text: text.value, storage: storage.value, domain: domain.value }));
    const link = `${location.href.split("#")[0]}${hashOf({ ...state, view: "see", at: "", live: packed })}`;
    this.field.link.value = link;
    this.field.link.parentNode.hidden = false;
    copy(link, this.field.copied);
  }

  // What a link brought; whether it brought anything. It is shown, and run when somebody asks for it.
  async read() {
    if (!state.live) return false;
    try {
      const { text, storage, domain } = JSON.parse(await inflated(state.live)) ?? {};
      if (typeof text !== "string") throw new Error("it holds no text");
      this.field.text.value = text;
      for (const [name, value] of [["storage", storage], ["domain", domain]]) {
        if (Array.from(this.field[name].options).some((one) => one.value === value)) this.field[name].value = value;
      }
      this.say("This encoder came with the link. Read it, then run it.");
      this.field.run.hidden = false;
    } catch (error) {
      this.say(`The link cannot be read: ${error.message.replace(/\.$/, "")}.`);
    }
    return true;
  }
}

// What a compiler says, by the line of the text.
function linesOf(log, text) {
  const last = text.split("\n").length, lines = log.replaceAll("\0", "").split("\n").map((line) => line.trim()).filter(Boolean);
  return lines.slice(0, 8).map((line) => {
    const [, at, said] = line.match(/^(?:ERROR|WARNING): \d+:(\d+): ?(.*)$/) ?? [];
    if (!at) return line;
    if (Number(at) <= last) return `Line ${at}: ${said}`;
    if (Number(at) < OTHERS) return `At the end of the text: ${said}`;
    return /redefinition/.test(said) ? `The page uses this name itself; choose another one: ${said}` : `Where the page calls it: ${said}`;
  });
}

async function deflated(text) {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join("")).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

// Read in pieces, so that a small link cannot become a large text.
async function inflated(packed) {
  const bytes = bytesOf(packed.replaceAll("-", "+").replaceAll("_", "/"));
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw")).pipeThrough(new TextDecoderStream()).getReader();
  let text = "";
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    text += part.value;
    if (text.length > 2 * LONGEST_TEXT) throw new Error("it is too long");
  }
  return text;
}

live.parts.push((root) => {
  live.own = new OwnEncoder(root, live.see);
});
