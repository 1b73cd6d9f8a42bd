"use strict";

// What the parts of the laboratory share: its data, its device, small helpers for controls and vectors.
const live = { data: null, device: null, root: null, parts: [], byLabel: new Map() };
const EXACT = "exact normals";
const DEGREES = 180 / Math.PI;

function browserName() {
  const brands = navigator.userAgentData?.brands ?? [], known = brands.find(({ brand }) => !/not.*brand|chromium/i.test(brand)) ?? brands.at(-1);
  return known ? `${known.brand} ${known.version}` : navigator.userAgent.split(" ").at(-1);
}

// A moment for the page: what waits for it is done, and the browser draws.
const paused = (ms = 0) => new Promise((resolve) => setTimeout(resolve, ms));

const dot3 = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross3 = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const scaled = (a, s) => a.map((x) => x * s);
const unit3 = (a) => scaled(a, 1 / Math.hypot(...a));
const angleBetween = (a, b) => Math.atan2(Math.hypot(...cross3(a, b)), dot3(a, b)) * DEGREES;
const digits = (value, count = 3) => (Number.isFinite(value) ? String(Number(value.toPrecision(count))) : "not a number");

// Numbers of a code in a texel, as whole numbers, and the texel of such numbers. A number that is laid across bytes
// begins with the highest bit of the first byte, which is the lowest of the word.
function turned(word, count) {
  let made = 0n;
  for (let at = 0; at < count; at++) made |= ((word >> BigInt(8 * at)) & 255n) << BigInt(8 * (count - 1 - at));
  return made;
}

function numbersIn(codec, words) {
  let all = words.slice(0, codec.words).reduce((sum, word, at) => sum | (BigInt(word) << BigInt(32 * at)), 0n);
  if (codec.bytes) all = turned(all, codec.bytes);
  return codec.channels.map(({ first, bits }) => Number((all >> BigInt(first)) & ((1n << BigInt(bits)) - 1n)));
}

function wordsOf(codec, numbers) {
  let all = codec.channels.reduce((sum, { first }, at) => sum | (BigInt(numbers[at]) << BigInt(first)), 0n);
  if (codec.bytes) all = turned(all, codec.bytes);
  return Array.from({ length: 4 }, (_, at) => Number((all >> BigInt(32 * at)) & 0xffffffffn));
}

// A stored number's place in the order of the numbers that its bits stand for, and the bits of a place.
function placeOf({ kind, bits }, isPacked, word) {
  const isSigned = kind === "snorm" || (kind === "float" && bits >= 16);
  if (!isSigned || isPacked || word < 2 ** (bits - 1)) return word;
  return kind === "snorm" ? word - 2 ** bits : 2 ** (bits - 1) - word;
}

function bitsAt({ kind, bits }, isPacked, place) {
  if (place >= 0) return place;
  return kind === "snorm" && !isPacked ? place + 2 ** bits : 2 ** (bits - 1) - place;
}

// The least and the largest place that a number has.
function places({ kind, bits, integer }, isPacked) {
  if (kind === "unorm") return [0, 2 ** bits - 1];
  if (kind === "snorm") return isPacked ? [0, 2 * integer] : [-integer, integer];
  // The largest finite float: all bits of the exponent but the lowest, and the whole mantissa.
  const exponent = bits === 32 ? 8 : 5, mantissa = bits - exponent - (bits >= 16);
  const largest = (2 ** exponent - 1) * 2 ** mantissa - 1;
  return [bits >= 16 ? -largest : 0, largest];
}
