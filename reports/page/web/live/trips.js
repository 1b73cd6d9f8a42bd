"use strict";

// How far normals come back from a codec: figures on random directions, and a map of the sphere.
const TRIED = 256, DISC = 160, TRIP = ["angle.frag", "trip.frag", "figures.frag"], GLOBE = ["angle.frag", "trip.frag", "sphere.frag"];

// Angles in degrees on TRIED^2 directions of a domain, the direction of the largest, and the PSNR of the three components with a
// peak of 1, as in the tables. `lost` counts what is no number.
async function tripsOf(device, codec, domain) {
  await device.compiled([codec, TRIP]);
  const program = device.program(codec, TRIP), target = device.target(device.gl.RGBA32UI, TRIED, TRIED), uniforms = { halves: domain === "hemisphere" ? 1 : 2 };
  device.clearWords(target);
  device.draw(program, target, uniforms, device.tablesOf(codec));
  const found = new Float32Array((await wordsLater(device, target)).buffer);
  let sum = 0, squares = 0, differences = 0, worst = -1, at = 0, lost = 0;
  for (let i = 0; i < found.length; i += 4) {
    const off = found[i];
    // The angle of what is no number is 0 by some drivers; its difference is none by any.
    if (!(off >= 0 && found[i + 1] >= 0)) {
      lost++;
      continue;
    }
    sum += off;
    squares += off * off;
    differences += found[i + 1];
    if (off > worst) [worst, at] = [off, i];
  }
  const count = found.length / 4 - lost;
  device.draw(device.program(null, ["figures.frag"], { defines: ["DIRECTION"] }), target, uniforms);
  const direction = Array.from((await wordsLater(device, target)).slice(at, at + 3), floatOf);
  device.release(target);
  return { count, lost, mean: sum / count, rms: Math.sqrt(squares / count), worst, direction, decibels: -10 * Math.log10(differences / (3 * count)) };
}

const perDevice = new WeakMap();

// The figures of one of the run's codecs, measured once.
function knownTrips(device, codec, domain) {
  if (!perDevice.has(device)) device.on("lost", () => perDevice.get(device).clear());
  if (!perDevice.has(device)) perDevice.set(device, new Map());
  const known = perDevice.get(device), key = `${codec.label}\0${domain}`;
  if (!known.has(key)) known.set(key, tripsOf(device, codec, domain));
  return known.get(key);
}

// The error over the sphere on a canvas; full colour is an angle in degrees.
async function drawGlobe(device, codec, full, table, canvas) {
  await device.compiled([codec, GLOBE]);
  const { gl } = device, target = device.target(gl.RGBA8, 2 * DISC, DISC);
  device.draw(device.program(codec, GLOBE), target, { size: { ints: [2 * DISC, DISC] }, full }, { ...device.tablesOf(codec), colours: table });
  const bytes = new Uint8ClampedArray(8 * DISC * DISC), image = new ImageData(2 * DISC, DISC), line = 8 * DISC;
  gl.readPixels(0, 0, 2 * DISC, DISC, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
  device.release(target);
  [canvas.width, canvas.height] = [2 * DISC, DISC];
  for (let y = 0; y < DISC; y++) image.data.set(bytes.subarray((DISC - 1 - y) * line, (DISC - y) * line), y * line);
  canvas.getContext("2d").putImageData(image, 0, 0);
}
