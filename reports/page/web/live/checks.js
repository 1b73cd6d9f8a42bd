"use strict";

// The normals that this device encodes, bit for bit those of bench/measures/live/normals.py, and checksums of the run's codes.

// How many differing normals are kept to be shown.
const EXAMPLES = 8;
// Of the numbers of a group so many may have been rounded the other way: those nearest to a tie, in units of the error
// that float32 makes of numbers of their size, but for what sums of larger numbers leave.
const NEAR_TIES = 14, SUMS = 2 ** -6;
// Bits of a float's mantissa, by its size.
const MANTISSA = { 32: 23, 16: 10, 11: 6, 10: 5 };

// An integer of 32 bits, well mixed.
function hashed(word, { shifts, factors }) {
  let mixed = word >>> 0;
  for (let at = 0; at < shifts.length; at++) mixed = Math.imul(mixed ^ (mixed >>> shifts[at]), factors[at] ?? 1) >>> 0;
  return mixed;
}

// How near a number is to where its rounding turns, in units of its own error, and the step from the code on the other
// side to `place`, the code that it has.
function tieOf(x, place, { kind, bits, integer }, { rounding, bytes }) {
  const isCut = rounding !== "nearest";
  if (kind === "float") return floatTie(bits < 16 ? x * 0.5 + 0.5 : x, bits, isCut);
  const steps = (kind === "unorm" ? x * 0.5 + 0.5 : x) * (integer + (rounding === "truncate_half" ? 0.5 : 0));
  const own = kind === "snorm" && bytes ? place - integer : place, error = Math.abs(x) + SUMS;
  if (!isCut) return { distance: Math.abs(Math.floor(steps) + 0.5 - steps) / error, step: steps < own ? 1 : -1 };
  // cut off toward zero: from a whole number on, away from zero
  const size = Math.abs(steps), whole = Math.round(size), up = steps < 0 ? -1 : 1;
  return { distance: Math.abs(whole - size) / error, step: whole > Math.abs(own) ? -up : up };
}

// The same of a float, whose steps are as fine as its error but for the smallest.
function floatTie(value, bits, isCut) {
  const octave = Math.max(Math.floor(Math.log2(Math.abs(value))), -14), up = value < 0 ? -1 : 1;
  const steps = Math.abs(value) * 2 ** (MANTISSA[bits] - octave), from = steps - (isCut ? Math.round(steps) : Math.floor(steps) + 0.5);
  return { distance: Math.abs(from) / (Math.max(steps / 2 ** MANTISSA[bits], SUMS) + SUMS), step: from < 0 ? -up : up };
}

class Normals {
  constructor(common) {
    this.common = common;
    this.made = new Map();
  }

  // A number in [-1, 1), exact in float32.
  uniform(word) {
    return (hashed(word, this.common.hash) >>> 8) * 2 ** -23 - 1;
  }

  // G. Marsaglia (1972), as in bench/measures/live/normals.py. Every step is rounded to float32: a sum or a
  // product of two such numbers, rounded to a double and then to float32, is what float32 makes of it (S. Figueroa, 1995).
  random(index, to, at) {
    const { count, hash } = this.common, f = Math.fround;
    let a, b, s, turn = 0;
    do {
      const word = hash.starts.normals + 2 * (turn++ * count + index);
      a = this.uniform(word);
      b = this.uniform(word + 1);
      s = f(f(a * a) + f(b * b));
    } while (s >= 1);
    const root = f(Math.sqrt(f(1 - s)));
    to[at] = f(2 * a * root);
    to[at + 1] = f(2 * b * root);
    to[at + 2] = f(1 - f(2 * s));
  }

  // A position in front of the viewer.
  view(index, to, at) {
    const f = Math.fround, word = this.common.hash.starts.views + 3 * index;
    to[at] = this.uniform(word);
    to[at + 1] = this.uniform(word + 1);
    to[at + 2] = f(f(this.uniform(word + 2) * 1.25) - 1.75);
  }

  // Normals of a domain and views, four numbers each, as float textures take them.
  of(domain) {
    if (!this.made.has(domain)) this.made.set(domain, this.make(domain));
    return this.made.get(domain);
  }

  make(domain) {
    const { count, hard } = this.common, given = new Float32Array(bytesOf(hard.data).buffer);
    const n = new Float32Array(4 * count), view = new Float32Array(4 * count), f = Math.fround;
    for (let i = 0; i < count; i++) {
      const at = 4 * i;
      if (i < hard.count) n.set(given.subarray(3 * i, 3 * i + 3), at);
      else this.random(i, n, at);
      this.view(i, view, at);
      if (domain === "hemisphere") n[at + 2] = Math.abs(n[at + 2]);
      if (domain === "view") {
        const [x, y, z] = [0, 1, 2].map((c) => f(n[at + c] * view[at + c]));
        if (f(f(x + y) + z) > 0) for (let c = 0; c < 3; c++) n[at + c] = -n[at + c];
      }
    }
    return { n, view };
  }

  // Whether these are the run's: the checksums of Python must be those of this browser.
  areRuns(domain) {
    const { n, view } = this.of(domain);
    return [n, view].every((all, at) => this.checksum(all, 4, 3) === this.common.sums[domain][at]);
  }

  // A sum of hashed words: of `used` out of every `size` numbers of 32 bits.
  checksum(values, size, used) {
    const { hash } = this.common, words = new Uint32Array(values.buffer, values.byteOffset, values.length);
    let sum = 0, place = hash.starts.sums;
    for (let at = 0; at < words.length; at += size) {
      for (let c = 0; c < used; c++) sum = (sum + hashed(words[at + c] ^ hashed(place++, hash), hash)) >>> 0;
    }
    return sum;
  }
}

// What a codec's codes differ by from the run's.
class Checks {
  constructor(common) {
    this.common = common;
    const { group, numbers, hash } = common;
    this.weights = Uint32Array.from({ length: group * numbers }, (_, at) => hashed(hash.starts.weights + at, hash) | 1);
    this.tables = new Map();
  }

  // Every single step by its difference of checksums: the normal in its group, the number, and the step.
  steps(size) {
    if (!this.tables.has(size)) {
      const { group, numbers } = this.common, table = new Map();
      for (let k = 0; k < group; k++) {
        for (let c = 0; c < size; c++) {
          const weight = this.weights[numbers * k + c];
          table.set(weight, { k, c, step: 1 }).set(-weight >>> 0, { k, c, step: -1 });
        }
      }
      this.tables.set(size, table);
    }
    return this.tables.get(size);
  }

  sums(codes, size) {
    const { group, numbers } = this.common, found = new Uint32Array(codes.length / size / group);
    for (let g = 0, at = 0; g < found.length; g++) {
      let sum = 0;
      for (let k = 0; k < group; k++) for (let c = 0; c < size; c++) sum = (sum + Math.imul(this.weights[numbers * k + c], codes[at++])) | 0;
      found[g] = sum >>> 0;
    }
    return found;
  }

  // The steps that make a difference of checksums: one or two, or null where it takes more.
  told(difference, size) {
    const table = this.steps(size), one = table.get(difference);
    if (one) return [one];
    for (const [part, first] of table) {
      const second = table.get((difference - part) >>> 0);
      if (second && !(second.k === first.k && second.c === first.c)) return [first, second];
    }
    return null;
  }

  // The steps that make a difference of checksums, of numbers that lie near a tie; null where they do not make it. `exact`
  // are the numbers before they were stored, four for each normal of the group, and `places` their codes.
  nearTies(difference, exact, places, codec) {
    const { numbers } = this.common, { channels } = codec, found = [];
    for (let k = 0; k < exact.length / 4; k++) {
      for (let c = 0; c < channels.length; c++) found.push({ k, c, ...tieOf(exact[4 * k + c], places[k * channels.length + c], channels[c], codec) });
    }
    const near = found.sort((a, b) => a.distance - b.distance).slice(0, NEAR_TIES);
    const parts = near.map(({ k, c, step }) => Math.imul(step, this.weights[numbers * k + c]));
    let sum = 0, chosen = 0;
    // Every set of them in an order in which one joins or leaves at a time (F. Gray, 1953).
    for (let at = 1; at < 2 ** near.length; at++) {
      const turned = 31 - Math.clz32(at & -at);
      chosen ^= 1 << turned;
      sum = (sum + ((chosen >> turned) & 1 ? parts[turned] : -parts[turned])) | 0;
      if (sum >>> 0 === difference) return near.filter((_, i) => (chosen >> i) & 1);
    }
    return null;
  }

  // The run's codes, as far as checksums tell them. `given` are codes of this device, as integers in the order of their
  // numbers, `size` for each normal; of several, those that come first are asked first. Of a group whose steps none of
  // them tells, nothing is known: `isKnown` is 0 there. `exact` are the numbers before the first of them was stored, four
  // for each normal, or null.
  runs(expected, given, codec, exact) {
    const { group } = this.common, size = codec.channels.length, asked = new Uint32Array(bytesOf(expected.groups).buffer);
    const sums = given.map((codes) => this.sums(codes, size));
    const codes = new Int32Array(given[0].length), isKnown = new Uint8Array(asked.length);
    for (let g = 0; g < asked.length; g++) {
      const [from, to] = [g * group * size, (g + 1) * group * size];
      for (let i = 0; i < given.length && !isKnown[g]; i++) {
        const difference = (sums[i][g] - asked[g]) >>> 0;
        let told = difference ? this.told(difference, size) : [];
        if (!told && exact && !i) told = this.nearTies(difference, exact.subarray(4 * g * group, 4 * (g + 1) * group), given[i].subarray(from, to), codec);
        if (!told) continue;
        isKnown[g] = 1;
        codes.set(given[i].subarray(from, to), from);
        for (const { k, c, step } of told) codes[from + k * size + c] -= step;
      }
    }
    return { codes, isKnown };
  }

  // How a device's codes differ from the run's. The last of `given` is what is judged; codes that the shader packed
  // by itself come before it: they tell the run's codes where a target rounds in its own way.
  compare(codec, given, exact = null) {
    const { group, count } = this.common, expected = codec.checks, size = codec.channels.length;
    const run = this.runs(expected, given, codec, exact), here = given.at(-1);
    const found = { equal: 0, oneStep: 0, further: 0, untold: 0, numbers: [], differing: [], checked: this.numbers(expected, here, size) };
    for (let c = 0; c < size; c++) found.numbers.push({ normals: 0, most: 0 });
    for (let i = 0; i < count; i++) {
      if (run.isKnown[Math.floor(i / group)]) this.judge(found, i, run.codes.subarray(size * i, size * i + size), here.subarray(size * i, size * i + size));
      else found.untold++;
    }
    found.further += found.untold;
    if (found.untold) this.addSamples(found, expected, run, here, size);
    return found;
  }

  judge(found, normal, run, here) {
    let wrong = 0, most = 0;
    for (let c = 0; c < run.length; c++) {
      const steps = Math.abs(here[c] - run[c]);
      if (!steps) continue;
      wrong++;
      most = Math.max(most, steps);
      found.numbers[c].normals++;
      found.numbers[c].most = Math.max(found.numbers[c].most, steps);
    }
    if (wrong) this.keep(found, normal, run, here);
    if (!wrong) found.equal++;
    else if (wrong === 1 && most === 1) found.oneStep++;
    else found.further++;
  }

  keep(found, normal, run, here) {
    if (found.differing.length < EXAMPLES) found.differing.push({ normal, run: Array.from(run), here: Array.from(here) });
  }

  // Of groups that nothing is known of: those normals whose codes travel with the page.
  addSamples(found, expected, run, here, size) {
    const { stride, group, count } = this.common, sample = new Int32Array(bytesOf(expected.sample).buffer);
    for (let i = 0; i < count / stride; i++) {
      const codes = sample.subarray(size * i, size * (i + 1)), own = here.subarray(size * stride * i, size * (stride * i + 1));
      const differs = codes.some((code, c) => code !== own[c]);
      if (differs && !run.isKnown[Math.floor((stride * i) / group)]) this.keep(found, stride * i, codes, own);
    }
  }

  // Which numbers differ anywhere.
  numbers(expected, codes, size) {
    const { count } = this.common, sums = new Uint32Array(bytesOf(expected.numbers).buffer), normals = new Normals(this.common);
    const one = (c) => Int32Array.from({ length: count }, (_, i) => codes[size * i + c]);
    return Array.from({ length: size }, (_, c) => c).filter((c) => normals.checksum(one(c), 1, 1) !== sums[c]);
  }
}

// What a comparison found, in words. `n` are the normals, four numbers each.
function saysDifference(found, n) {
  if (!found.further && !found.oneStep) return "none";
  const said = found.numbers.map(({ normals, most }, c) => normals && `${"xyzw"[c]} differs for ${normals} normals, by ${most === 1 ? "1 step" : `up to ${most} steps`}`);
  if (found.untold) {
    const numbers = found.checked.map((c) => "xyzw"[c]).join(", ");
    said.push(`${found.untold} normals are in groups with more differences than a checksum can distinguish; ${numbers} ${found.checked.length > 1 ? "differ" : "differs"} there or elsewhere`);
  }
  const shown = found.differing[0], at = shown && 4 * shown.normal;
  if (shown) said.push(`for example normal ${shown.normal} (${[0, 1, 2].map((c) => n[at + c].toFixed(4)).join(", ")}): here ${shown.here.join(", ")}, in the run ${shown.run.join(", ")}`);
  return said.filter(Boolean).join("; ");
}
