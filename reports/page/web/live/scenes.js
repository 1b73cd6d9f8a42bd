"use strict";

// What the laboratory shows: scenes, the three that have a button, and sets of normals that are pictures.
const FULL_DEGREES = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 45, 90, 180];
const SHOWN = { lit: 0, error: 1, normals: 2, code: 3, zebra: 4, studio: 5, difference: 6 };
// Full colour of a difference, in steps of 8 bits, as light.frag has it.
const DIFFERENCE = 16;
const RADIANS = Math.PI / 180, SLOPE = 0.62, SHAPE = 4 / 3, AS_STORED = 17;
// Each scene's shader, the place that the camera turns around, its set of lights in reflections.frag, and where the camera is at
// first: degrees around and above, and the distance; `high` is the slope of its upper edge. A preset also says how it is shown.
const SCENES = {
  bonnet: { shader: "bonnet.frag", middle: [0, 0.55, 0.35], studio: 0, camera: { around: 18, over: 30, away: 3.5 }, preset: { shown: "zebra", roughness: 0.1 } },
  floor: { shader: "floor.frag", middle: [0, 0.25, -1], studio: 1, backdrop: 0.02, camera: { around: -8, over: 7, away: 3 }, preset: { shown: "studio", roughness: 0.12 } },
  face: { shader: "face.frag", middle: [0, 0.98, 0], studio: 2, camera: { around: -13, over: 3, away: 3 }, preset: { shown: "studio", roughness: 0.3 } },
  // As gbuffer/scenes has it: its camera looks from (0, 2.1, 8.6), 38 degrees high. Roughness is that of its materials, or more.
  studio: { shader: "studio.frag", middle: [0, 1.45, 0], studio: 3, backdrop: 0.02, exposure: 2 ** -1.5, high: Math.tan(19 * RADIANS), camera: { around: 0, over: 4.322, away: 8.625 } },
};
// Where a model's middle is over the ground, below which no camera goes; and how near and far it is drawn.
const MESH_HEIGHT = 1.2, MESH_DEPTHS = [0.02, 20];
const FIRST_SCENE = "bonnet", DROPPED = "dropped", PICTURE_CAMERA = { around: 0, over: 0, away: 3.5 };

// A scene of a picture: { title, width, height, slope } and `normals`, which gives its normals, four floats a pixel, the lowest row
// first. A camera does not move in it: it turns what is mirrored, and comes nearer.
function sceneOf(picture) {
  return { ...picture, isPicture: true, middle: [0, 0, 0], studio: 2, camera: PICTURE_CAMERA };
}

// A scene of a reader's model: { title, triangles }.
function sceneOfMesh(model) {
  return { ...model, middle: [0, MESH_HEIGHT, 0], studio: 2, camera: { around: 25, over: 12, away: 2.5 } };
}

// The camera's axes and place as uniforms.
function cameraOf({ middle }, { around, over, away }) {
  const [a, o] = [around * RADIANS, over * RADIANS], back = [Math.sin(a) * Math.cos(o), Math.sin(o), Math.cos(a) * Math.cos(o)];
  const right = unit3(cross3([0, 1, 0], back)), up = cross3(back, right), eye = middle.map((at, axis) => at + back[axis] * away);
  // In columns: what each axis of the world is to the camera. The ground is not looked at from below.
  return { to_view: [0, 1, 2].flatMap((axis) => [right[axis], up[axis], back[axis]]), eye: [eye[0], Math.max(eye[1], 0.03), eye[2]] };
}

// The slopes of the rays at the window's right and upper edge, and how far a picture reaches there.
function slopesOf(scene, [width, height], away) {
  const shape = width / height;
  const high = scene.high ?? SLOPE / SHAPE;
  if (!scene.isPicture) return { slope: shape > SHAPE ? [high * shape, high] : [high * SHAPE, (high * SHAPE) / shape] };
  const own = scene.width / scene.height, near = away / PICTURE_CAMERA.away, reach = [Math.max(shape / own, 1) * near, Math.max(own / shape, 1) * near];
  return { slope: reach.map((by, axis) => by * scene.slope[axis]), reach };
}

// The normals of a run's picture: two numbers of 12 bits, an octahedron's, and turned back.
function unfolded({ width, height }, bytes) {
  const { levels, back } = live.data.unpacking, normals = new Float32Array(4 * width * height);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const from = 4 * (y * width + x), [a, b, c, there] = bytes.subarray(from, from + 4);
      if (!there) continue;
      const e = [(a << 4) | (b >> 4), ((b & 15) << 8) | c].map((number) => (number / levels) * 2 - 1);
      const z = 1 - Math.abs(e[0]) - Math.abs(e[1]), p = e.map((number) => number - (number < 0 ? -1 : 1) * Math.max(-z, 0));
      const n = unit3([...p, z]);
      normals.set([...back.map((row) => dot3(row, n)), 1], 4 * ((height - 1 - y) * width + x));
    }
  }
  return normals;
}
