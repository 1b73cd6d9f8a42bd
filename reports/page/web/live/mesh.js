"use strict";

// Models that a reader drops: glTF 2.0 as one file, .glb or .gltf with its data inside. Its triangles with their normals are drawn, in
// their place; materials, normal maps, skins and animations are not. Whatever a file holds, reading it ends in triangles or in an Error
// of one line.
const MOST_TRIANGLES = 3e6, DEEPEST = 500, GLB_JSON = 0x4e4f534a, GLB_BIN = 0x004e4942, TRIANGLES = 4;
const ACCESSED = { 5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array };
const WIDTHS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };
const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
// What such an extension changes is not drawn, or is read.
const HARMLESS = /^KHR_(materials_|texture_|lights_|mesh_quantization)|^EXT_texture_/;

const isGltf = (name, bytes) => /\.(glb|gltf)$/i.test(name) || String.fromCharCode(...bytes.subarray(0, 4)) === "glTF";

// The triangles of a file: { places, normals, count }, three floats a corner, in the world's axes, within a sphere of radius 1
// over the ground.
function trianglesOf(bytes) {
  const { document, binary } = gltfOf(bytes), needed = (document.extensionsRequired ?? []).find((name) => !HARMLESS.test(name));
  if (needed) throw new Error(`it needs ${needed}, which is not supported; export it without`);
  const parts = [], all = document.nodes ?? [], scene = document.scenes?.[document.scene ?? 0];
  const walk = (nodes, outer, depth) => {
    for (const index of nodes) {
      const node = all[index];
      if (!node || depth > DEEPEST) throw new Error("its nodes are damaged");
      const matrix = product(outer, matrixOf(node));
      for (const primitive of document.meshes?.[node.mesh]?.primitives ?? []) {
        if ((primitive.mode ?? TRIANGLES) === TRIANGLES) parts.push(cornersOf(document, binary, primitive, matrix));
      }
      walk(node.children ?? [], matrix, depth + 1);
      if (parts.reduce((sum, { places }) => sum + places.length, 0) > 9 * MOST_TRIANGLES) throw new Error(`it has more than ${MOST_TRIANGLES} triangles`);
    }
  };
  walk(scene?.nodes ?? all.keys(), IDENTITY, 0);
  const length = parts.reduce((sum, { places }) => sum + places.length, 0), places = new Float32Array(length), normals = new Float32Array(length);
  if (!length) throw new Error("it has no triangles");
  let from = 0;
  for (const part of parts) {
    places.set(part.places, from);
    normals.set(part.normals, from);
    from += part.places.length;
  }
  centre(places);
  return { places, normals, count: length / 3 };
}

// The JSON of a file and the bytes of its buffers.
function gltfOf(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength), isBinary = bytes.length > 20 && view.getUint32(0, true) === 0x46546c67, chunks = {};
  if (isBinary && view.getUint32(4, true) !== 2) throw new Error(`glTF version ${view.getUint32(4, true)} is not supported; use version 2`);
  for (let place = 12; isBinary && place + 8 <= bytes.length; ) {
    const size = view.getUint32(place, true);
    if (place + 8 + size > bytes.length) throw new Error(SHORT);
    chunks[view.getUint32(place + 4, true)] ??= bytes.subarray(place + 8, place + 8 + size);
    place += 8 + size;
  }
  let document = null;
  try {
    document = JSON.parse(new TextDecoder().decode(isBinary ? chunks[GLB_JSON] : bytes));
  } catch {
    throw new Error("it is not a glTF file");
  }
  if (document?.asset?.version === undefined) throw new Error("it is not a glTF file");
  const binary = (document.buffers ?? []).map(({ uri }) => {
    if (uri === undefined && chunks[GLB_BIN]) return chunks[GLB_BIN];
    if (!uri?.startsWith("data:")) throw new Error("its data is in other files; export it as .glb");
    return bytesOf(uri.slice(uri.indexOf(",") + 1));
  });
  return { document, binary };
}

// The corners of a primitive's triangles, one after another; where it has no normals, those of its triangles.
function cornersOf(document, binary, { attributes, indices }, matrix) {
  const positions = numbersOf(document, binary, attributes?.POSITION), own = attributes?.NORMAL === undefined ? null : numbersOf(document, binary, attributes.NORMAL);
  const order = indices === undefined ? null : numbersOf(document, binary, indices), count = order ? order.length : positions.length / 3, whole = count - (count % 3);
  const places = new Float32Array(3 * whole), normals = new Float32Array(3 * whole), turn = cofactors(matrix), isMirrored = dot3(cross3(matrix.slice(0, 3), matrix.slice(4, 7)), matrix.slice(8, 11)) < 0;
  const corner = (list, at) => [list[3 * at], list[3 * at + 1], list[3 * at + 2]];
  for (let at = 0; at < whole; at += 3) {
    const corners = [0, 1, 2].map((one) => (order ? order[at + one] : at + one));
    // A mirrored model's triangles are seen from the other side.
    if (isMirrored) corners.reverse();
    const placed = corners.map((one) => moved(matrix, corner(positions, one))), flat = cross3(minus3(placed[1], placed[0]), minus3(placed[2], placed[0]));
    for (const [one, index] of corners.entries()) {
      places.set(placed[one], 3 * (at + one));
      normals.set(own ? moved(turn, corner(own, index)) : flat, 3 * (at + one));
    }
  }
  return { places, normals };
}

// An accessor's numbers, one after another; whole numbers that stand for shares are those.
function numbersOf(document, binary, index) {
  const accessor = document.accessors?.[index], block = document.bufferViews?.[accessor?.bufferView], Kind = ACCESSED[accessor?.componentType], width = WIDTHS[accessor?.type];
  if (accessor?.sparse) throw new Error("its sparse accessors are not supported");
  if (!block || !Kind || !width || !binary[block.buffer]) throw new Error("its accessors are damaged");
  const size = Kind.BYTES_PER_ELEMENT, stride = block.byteStride ?? size * width, start = (block.byteOffset ?? 0) + (accessor.byteOffset ?? 0), { count } = accessor, bytes = binary[block.buffer];
  if (!(count > 0) || start + stride * (count - 1) + size * width > bytes.length) throw new Error(SHORT);
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength), read = `get${Kind.name.replace("Array", "")}`, most = accessor.normalized ? 2 ** (8 * size - (Kind.name.startsWith("Int") ? 1 : 0)) - 1 : 1;
  const numbers = new (Kind === Float32Array || most > 1 ? Float32Array : Float64Array)(count * width);
  for (let at = 0; at < count; at++) for (let lane = 0; lane < width; lane++) numbers[at * width + lane] = view[read](start + at * stride + lane * size, true) / most;
  return numbers;
}

const minus3 = (a, b) => a.map((number, axis) => number - b[axis]);
// Matrices are in columns, as glTF has them.
const product = (a, b) => IDENTITY.map((_, at) => [0, 1, 2, 3].reduce((sum, k) => sum + a[4 * k + (at % 4)] * b[4 * (at >> 2) + k], 0));
const moved = (m, [x, y, z]) => [0, 1, 2].map((row) => m[row] * x + m[4 + row] * y + m[8 + row] * z + m[12 + row]);

function matrixOf({ matrix, translation: t = [0, 0, 0], rotation: [x, y, z, w] = [0, 0, 0, 1], scale: [a, b, c] = [1, 1, 1] }) {
  if (matrix) return matrix;
  const turn = [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)];
  return [...scaled(turn.slice(0, 3), a), 0, ...scaled(turn.slice(3, 6), b), 0, ...scaled(turn.slice(6), c), 0, ...t, 1];
}

// What turns normals where a matrix moves places: its cofactors, whose lengths do not matter.
function cofactors(m) {
  const [a, b, c] = [m.slice(0, 3), m.slice(4, 7), m.slice(8, 11)], sign = Math.sign(dot3(cross3(a, b), c)) || 1;
  return [...scaled(cross3(b, c), sign), 0, ...scaled(cross3(c, a), sign), 0, ...scaled(cross3(a, b), sign), 0, 0, 0, 0, 1];
}

// Moves places into a sphere of radius 1 around (0, MESH_HEIGHT, 0).
function centre(places) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let at = 0; at < places.length; at++) {
    low[at % 3] = Math.min(low[at % 3], places[at]);
    high[at % 3] = Math.max(high[at % 3], places[at]);
  }
  const middle = low.map((number, axis) => (number + high[axis]) / 2);
  let radius = 0;
  for (let at = 0; at < places.length; at += 3) radius = Math.max(radius, Math.hypot(places[at] - middle[0], places[at + 1] - middle[1], places[at + 2] - middle[2]));
  if (!(radius > 0 && radius < Infinity)) throw new Error("its positions are not finite, or all the same");
  for (let at = 0; at < places.length; at++) places[at] = (places[at] - middle[at % 3]) / radius + (at % 3 === 1 ? MESH_HEIGHT : 0);
}
