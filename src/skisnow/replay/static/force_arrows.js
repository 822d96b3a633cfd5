// Force of the snow as arrows: along each ski its normal force per length, and one for the total force.

import { row } from "./motion.js";
import * as THREE from "./three.module.min.js";

const LONG = 0.3; // m, of a force per length that a twentieth of those in the run exceed: its largest may be a moment's
const LEAST = 0.02; // share of it below which none is drawn
const EVERY = 0.06; // m between arrows, at least
const WHOLE = 0.0011; // m for each N of a ski's total force
const COLOURS = { along: 0xd55e00, whole: 0xb43be0 };
const AWAY = new THREE.Vector3(0, 0, 1);

/** Force of the snow on each ski (N): {vector, total, normal}. */
export function skiForces(run, at) {
  const [vectors, normals] = [row(run.arrays.force.values, at, 6), row(run.arrays.normal_force.values, at, 2)];
  return [0, 1].map((ski) => {
    const vector = Array.from(vectors.subarray(3 * ski, 3 * ski + 3));
    return { vector, total: Math.hypot(...vector), normal: normals[ski] };
  });
}

/** A force per length (N/m) that a twentieth of those in the run exceed. */
export function largeForce(run) {
  const pressed = run.arrays.force_per_length.values.filter((force) => force > 0).sort();
  return pressed.length ? pressed[Math.floor(0.95 * pressed.length)] : 1;
}

/** Arrows that `show(pose, sections)` sets; sections of both skis are those that motion.js gives. */
export function forceArrows(run) {
  const most = largeForce(run);
  const chosen = spaced(run.arrays.station.values);
  const along = arrows(2 * chosen.length, 0.007, COLOURS.along);
  const whole = arrows(2, 0.02, COLOURS.whole, { over: true }); // else it would be hidden in a skier's leg
  const group = new THREE.Group();
  group.add(...along.meshes, ...whole.meshes);
  const count = run.arrays.station.values.length;
  return {
    group,
    show(pose, sections) {
      const force = row(run.arrays.force_per_length.values, pose.at, 2 * count);
      const forces = skiForces(run, pose.at);
      for (const ski of [0, 1]) {
        const own = force.subarray(ski * count, (ski + 1) * count);
        chosen.forEach((j, i) => {
          const share = own[j] / most;
          along.set(ski * chosen.length + i, ...placed(sections[ski], j), share > LEAST ? LONG * share : 0);
        });
        whole.set(ski, centre(run, sections[ski], own), forces[ski].vector, WHOLE * forces[ski].total);
      }
      for (const each of [along, whole]) each.done();
    },
  };
}

function spaced(station) {
  const found = [0];
  for (let j = 1; j < station.length; j++) if (Math.abs(station[j] - station[found.at(-1)]) >= EVERY) found.push(j);
  return found;
}

const placed = (section, j) => [Array.from(section.subarray(9 * j, 9 * j + 3)), Array.from(section.subarray(9 * j + 6, 9 * j + 9))];

/** Centre of the normal force on a ski, where its total force is drawn. */
function centre(run, section, force) {
  const station = run.arrays.station.values;
  const place = [0, 0, 0];
  let sum = 0;
  for (let j = 0; j < station.length; j++) {
    const [before, after] = [station[Math.max(j - 1, 0)], station[Math.min(j + 1, station.length - 1)]];
    const share = force[j] * Math.abs(after - before);
    sum += share;
    for (let i = 0; i < 3; i++) place[i] += share * section[9 * j + i];
  }
  return sum > 0 ? place.map((part) => part / sum) : placed(section, 0)[0];
}

/** So many arrows of one thickness and colour: a shaft and a head each. */
function arrows(number, radius, colour, { over = false } = {}) {
  const material = new THREE.MeshBasicMaterial({ color: colour, depthTest: !over });
  const shaft = new THREE.CylinderGeometry(radius, radius, 1, 8).translate(0, 0.5, 0).rotateX(Math.PI / 2);
  const head = new THREE.ConeGeometry(2.6 * radius, 6 * radius, 10).translate(0, 3 * radius, 0).rotateX(Math.PI / 2);
  const meshes = [shaft, head].map((geometry) => new THREE.InstancedMesh(geometry, material, number));
  for (const each of meshes) {
    each.frustumCulled = false;
    each.renderOrder = over ? 7 : 6;
  }
  const [matrix, turn] = [new THREE.Matrix4(), new THREE.Quaternion()];
  return {
    meshes,
    set(i, place, away, length) {
      const way = new THREE.Vector3(...away).normalize();
      turn.setFromUnitVectors(AWAY, way);
      const from = new THREE.Vector3(...place);
      const stem = Math.max(length - 6 * radius, 0);
      const there = length > 0 ? 1 : 0;
      meshes[0].setMatrixAt(i, matrix.compose(from, turn, new THREE.Vector3(there, there, stem)));
      meshes[1].setMatrixAt(i, matrix.compose(from.addScaledVector(way, stem), turn, new THREE.Vector3(there, there, there)));
    },
    done() {
      for (const each of meshes) each.instanceMatrix.needsUpdate = true;
    },
  };
}
