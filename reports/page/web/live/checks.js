"use strict";

// The normals that this device encodes, bit for bit those of bench/live/normals.py, and checksums of the run's codes.

// An integer of 32 bits, well mixed.
function hashed(word, { shifts, factors }) {
  let mixed = word >>> 0;
  for (let at = 0; at < shifts.length; at++) mixed = Math.imul(mixed ^ (mixed >>> shifts[at]), factors[at] ?? 1) >>> 0;
  return mixed;
}

function bytesOf(text) {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer;
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

  // G. Marsaglia (1972), as in bench/live/normals.py. Every step is rounded to float32: a sum or a
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
    const { count, hard } = this.common, given = new Float32Array(bytesOf(hard.data));
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

  // Codes are integers in the order of their numbers, `size` for each normal.
  compare(expected, codes, size) {
    const { group, count } = this.common, asked = new Uint32Array(bytesOf(expected.groups)), given = this.sums(codes, size);
    const found = { equal: count, oneStep: 0, further: 0, steps: [], groups: [] };
    for (let g = 0; g < asked.length; g++) {
      const difference = (given[g] - asked[g]) >>> 0;
      const told = difference ? this.told(difference, size) : [];
      if (!told) {
        found.groups.push(g);
        found.further += group;
      } else if (told.length === 2 && told[0].k === told[1].k) found.further++;
      else found.oneStep += told.length;
      for (const { k, c, step } of told ?? []) found.steps.push({ normal: g * group + k, number: c, step });
    }
    found.equal -= found.oneStep + found.further;
    return { ...found, ...this.samples(expected, codes, size) };
  }

  // Which numbers differ at all, and the normals whose codes travel with the page and differ.
  samples(expected, codes, size) {
    const { stride, count } = this.common, sample = new Int32Array(bytesOf(expected.sample));
    const sums = new Uint32Array(bytesOf(expected.numbers)), normals = new Normals(this.common), differing = [];
    const numbers = Array.from({ length: size }, (_, c) => c).filter((c) => {
      const one = Int32Array.from({ length: count }, (_, i) => codes[size * i + c]);
      return normals.checksum(one, 1, 1) !== sums[c];
    });
    for (let i = 0; i < count / stride; i++) {
      const run = Array.from(sample.subarray(size * i, size * (i + 1)));
      const here = Array.from(codes.subarray(size * stride * i, size * (stride * i + 1)));
      if (run.some((code, c) => code !== here[c])) differing.push({ normal: stride * i, run, here });
    }
    return { numbers, differing, sampled: count / stride };
  }
}
