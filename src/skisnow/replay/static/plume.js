// A plume at the loaded edges: drawn, not computed with. It is the thicker the larger the force of the snow times the speed.

import { edgeAngle, poseAt, row, sections } from "./motion.js";
import * as THREE from "./three.module.min.js";

const NUMBER = 160;
const LIFE = 0.32; // s
const FULL_POWER = 3000; // W, force times speed of a ski, at which all of its part is there

/** Grains that `show(time)` sets: each leaves an edge, rises and falls, and begins again; the same at the same time. */
export function plume(run) {
  const geometry = new THREE.BufferGeometry();
  const positions = new THREE.BufferAttribute(new Float32Array(3 * NUMBER), 3);
  geometry.setAttribute("position", positions);
  const material = new THREE.PointsMaterial({
    map: puff(), size: 0.075, transparent: true, opacity: 0.5, depthWrite: false,
  });
  const points = new THREE.Points(geometry, material);
  points.frustumCulled = false;
  points.renderOrder = 7;
  const moments = new Map(); // of this picture, by age
  return {
    points,
    show(time) {
      moments.clear();
      let count = 0;
      for (let i = 0; i < NUMBER; i++) {
        const cycle = time / LIFE + i / NUMBER;
        const place = grain(run, moments, i, Math.floor(cycle), time, cycle - Math.floor(cycle));
        if (place) positions.setXYZ(count++, ...place);
      }
      geometry.setDrawRange(0, count);
      positions.needsUpdate = true;
    },
  };
}

/** A round soft grain, a little bluer than the snow in the sun. */
function puff() {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 32;
  const pen = canvas.getContext("2d");
  const shades = pen.createRadialGradient(16, 16, 0, 16, 16, 16);
  shades.addColorStop(0, "rgba(222, 233, 243, 1)");
  shades.addColorStop(0.4, "rgba(226, 236, 245, 0.7)");
  shades.addColorStop(1, "rgba(232, 240, 248, 0)");
  pen.fillStyle = shades;
  pen.fillRect(0, 0, 32, 32);
  const map = new THREE.CanvasTexture(canvas);
  map.colorSpace = THREE.SRGBColorSpace;
  return map;
}

/** Where a grain is, or null where its edge raises none. */
function grain(run, moments, i, round, time, age) {
  const ski = i % 2;
  const born = Math.round((time - age * LIFE) * 50) / 50;
  const key = `${ski} ${born}`;
  if (!moments.has(key)) moments.set(key, source(run, born, ski));
  const from = moments.get(key);
  const [a, b, c] = [1, 2, 3].map((part) => share(i + NUMBER * part + 7 * round));
  if (!from || a > from.power) return null;
  const t = age * LIFE;
  const up = (0.4 + 0.9 * b) * t - 4.9 * t * t;
  if (up < 0) return null;
  const ahead = 0.35 * from.speed * t + 0.3 * (b - 0.5);
  const aside = (0.2 + 0.9 * c) * t;
  return [0, 1, 2].map(
    (axis) => from.place[axis] - aside * from.outward[axis] + ahead * from.along[axis] + (axis === 2 ? up : 0),
  );
}

/** The place of a ski's largest force at a time, the loaded edge there, and how much snow it may raise. */
function source(run, time, ski) {
  if (time < run.arrays.time.values[0]) return null;
  const pose = poseAt(run, time);
  const count = run.arrays.station.values.length;
  const force = row(run.arrays.force_per_length.values, pose.at, 2 * count).subarray(ski * count, (ski + 1) * count);
  let [most, sum] = [0, 0];
  for (let j = 0; j < count; j++) {
    if (force[j] > force[most]) most = j;
    sum += force[j] * Math.abs(run.arrays.station.values[1] - run.arrays.station.values[0]);
  }
  const speed = row(run.arrays.speed.values, pose.at, 1)[0];
  const found = sections(run, pose, ski, 1);
  const side = edgeAngle(run, ski, time) >= 0 ? 1 : -1;
  const half = run.arrays.half_width.values[most];
  const outward = pose.left.map((part) => side * part);
  return {
    place: [0, 1, 2].map((axis) => found[9 * most + axis] + side * half * found[9 * most + 3 + axis]),
    outward, along: pose.forward, speed, power: Math.min(1, (sum * speed) / FULL_POWER),
  };
}

function share(seed) {
  const wave = Math.sin(seed * 78.233) * 43758.5453;
  return wave - Math.floor(wave);
}
