// Landmarks: poles every 10 m, gates where there are, an arrow along the fall line, hills at the horizon.

import { sprite } from "./labels.js";
import { surfaceGrade, surfaceHeight } from "./motion.js";
import { extent, flat } from "./snow.js";
import * as THREE from "./three.module.min.js";
import { said } from "./words.js";

const EVERY = 10; // m
const AROUND = 20; // m beyond the run that poles stand
const CLEAR = 1.3; // m from the run's path that none stands
const MOST = 600; // maximum number of poles; on a longer run they are only at the sides of the run
const POLE = { radius: 0.02, height: 1.5 };
const GATE = { radius: 0.03, height: 1.8, colours: [0xd0342c, 0x1f5fbf] };

/** Poles on the crossings of the 10 m lines, upright against gravity. */
export function poles(run) {
  const places = polePlaces(run);
  const group = new THREE.Group();
  group.name = "poles";
  group.add(upright(run, places, POLE, 0x46525e));
  const band = { radius: POLE.radius * 1.35, height: 0.22 };
  group.add(upright(run, places, band, 0xf07c1e, POLE.height - 0.3));
  return group;
}

/** Poles of gates, red and blue by turns. */
export function gates(run) {
  const values = run.arrays.gate_place?.values;
  const group = new THREE.Group();
  group.name = "gates";
  if (!values) return group;
  const places = Array.from({ length: values.length / 3 }, (_, i) => Array.from(values.subarray(3 * i, 3 * i + 3)));
  GATE.colours.forEach((colour, turn) => {
    const own = places.filter((_, i) => i % 2 === turn);
    if (own.length) group.add(upright(run, own, GATE, colour));
  });
  return group;
}

function polePlaces(run) {
  const path = run.arrays.place.values;
  const [[x0, x1], [y0, y1]] = [0, 1].map((axis) => extent(path, axis));
  const round = (low, high) => {
    const first = Math.ceil((low - AROUND) / EVERY);
    const last = Math.floor((high + AROUND) / EVERY);
    return Array.from({ length: last - first + 1 }, (_, i) => EVERY * (first + i));
  };
  const [xs, ys] = [round(x0, x1), round(y0, y1)];
  const across = xs.length * ys.length > MOST ? [ys[0], ys.at(-1)] : ys;
  const found = [];
  for (const x of xs) for (const y of across) if (isClear(path, x, y)) found.push([x, y, surfaceHeight(run, x, y)]);
  return found;
}

function isClear(path, x, y) {
  for (let i = 0; i < path.length; i += 3) if (Math.hypot(path[i] - x, path[i + 1] - y) < CLEAR) return false;
  return true;
}

function upright(run, places, { radius, height }, colour, up = 0) {
  const geometry = new THREE.CylinderGeometry(radius, radius, height, 8);
  geometry.translate(0, up + height / 2, 0).rotateX(Math.PI / 2).rotateY(-run.tilt); // against gravity, not the slope
  const mesh = new THREE.InstancedMesh(geometry, new THREE.MeshLambertMaterial({ color: colour }), places.length);
  places.forEach((place, i) => mesh.setMatrixAt(i, new THREE.Matrix4().setPosition(...place)));
  return flat(mesh, 5);
}

const LENGTH = 1.1; // m
const ARROW = [[0, 0.04], [0.72, 0.04], [0.72, 0.13], [LENGTH, 0], [0.72, -0.13], [0.72, -0.04], [0, -0.04]];

/** An arrow that lies on the snow beside the sledge and points down the fall line; `show(pose)` takes it along. */
export function fallLine(run) {
  const shape = new THREE.Shape(ARROW.map(([x, y]) => new THREE.Vector2(x, y)));
  const material = new THREE.MeshBasicMaterial({ color: 0x0b4f8a, side: THREE.DoubleSide, depthTest: false, depthWrite: false });
  const arrow = flat(new THREE.Mesh(new THREE.ShapeGeometry(shape), material), 4.5);
  const label = sprite(said("fall line"), 0.038);
  const group = new THREE.Group();
  group.add(arrow, label);
  const side = run.skier ? 1.7 : 1.25; // m beside the boots
  const seen = (x, camera) => arrow.localToWorld(new THREE.Vector3(x, 0, 0)).project(camera);
  return {
    group,
    /** Put the word beside the arrow's tail in the picture: where neither its head nor the middle is, and not cut off. */
    face(camera) {
      group.updateWorldMatrix(true, true);
      const [tail, head] = [seen(0, camera), seen(LENGTH, camera)];
      const [ahead, up] = [(head.x - tail.x) * camera.aspect, head.y - tail.y];
      const isRight = Math.abs(ahead) > 0.3 * Math.abs(up) ? ahead < 0 : tail.x > 0;
      const end = tail.x + (isRight ? 1.04 : -1.04) * label.scale.x * camera.projectionMatrix.elements[0];
      if (Math.abs(end) < 1) label.center.set(isRight ? -0.04 : 1.04, 0.5);
      else label.center.set(isRight ? 1 : 0, up > 0 ? 1.3 : -0.3); // below or above the tail
    },
    show(pose) {
      const [x, y] = [pose.place[0] + side * pose.left[0] + 0.5 * pose.forward[0], pose.place[1] + side * pose.left[1] + 0.5 * pose.forward[1]];
      group.position.set(x, y, surfaceHeight(run, x, y));
      const [ahead, aside] = surfaceGrade(run, x, y, 0.25);
      const way = run.arrays.terrain_height ? Math.atan2(-aside, -ahead) : 0; // else it is x
      group.rotation.z = way;
      arrow.rotation.y = -Math.atan2(ahead * Math.cos(way) + aside * Math.sin(way), 1);
    },
  };
}

/** Two rows of hills far out, paler the farther; they show where level is. */
export function horizonHills() {
  const group = new THREE.Group();
  const rows = [{ far: 385, colour: 0xc4d5e3, high: 34, waves: [3, 7, 17, 37] }, { far: 370, colour: 0xd3e0ea, high: 19, waves: [5, 11, 23, 53] }];
  rows.forEach(({ far, colour, high, waves }, row) => {
    const positions = [];
    const indices = [];
    const count = 240;
    for (let i = 0; i <= count; i++) {
      const angle = (2 * Math.PI * i) / count;
      const swell = waves.reduce((sum, wave, k) => sum + Math.abs(Math.sin(0.5 * wave * angle + 2.1 * k + row)) / (k + 1.4), 0);
      const [x, y] = [far * Math.cos(angle), far * Math.sin(angle)];
      positions.push(x, y, -90, x, y, high * swell * 0.55);
      if (i > 0) indices.push(2 * i - 2, 2 * i - 1, 2 * i, 2 * i, 2 * i - 1, 2 * i + 1);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(positions, 3));
    geometry.setIndex(indices);
    const material = new THREE.MeshBasicMaterial({ color: colour, side: THREE.DoubleSide, depthTest: false, depthWrite: false });
    group.add(flat(new THREE.Mesh(geometry, material), 0.2 + 0.1 * row));
  });
  return group;
}
