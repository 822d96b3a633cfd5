// Two skis and the sledge or the skier on them, as meshes that follow a run.

import * as THREE from "./three.module.min.js";
import { forceColour, GHOST } from "./colours.js";
import { poseAt, row, sections, surfaceHeight } from "./motion.js";
import { skierMesh } from "./skier.js";
import { SHADOW, sledgeMesh, slopeShadow } from "./sledge.js";
import { hills, SUN } from "./snow.js";

// corners of a cross section, each as often as a face needs its own colour and normal: [across, thickness, kind]
const CORNERS = [
  [1, 1, "face"], [-1, 1, "face"], // top
  [-1, 0, "face"], [1, 0, "face"], // base
  [1, 0, "side"], [1, 1, "side"], // left wall
  [-1, 1, "side"], [-1, 0, "side"], // right wall
];

/** Both skis of a run with who rides them. `show(time, exaggeration)` moves them and returns the pose. */
export function skis(run, { most, ghost = false }) {
  const group = new THREE.Group();
  const parts = [0, 1].map((ski) => skiMesh(run, ski, ghost));
  const shadows = [0, 1].map(() => shadowMesh(run, ghost));
  const rider = (run.skier ? skierMesh : sledgeMesh)(run, ghost ? tone(GHOST) : null);
  const shade = slopeShadow(run, rider);
  const sun = sunOnSlope(run);
  group.add(...shadows, ...parts, rider);
  if (!ghost) group.add(shade.mesh);
  return {
    group,
    sections: [null, null],
    /** Whether the sun casts shadows; else the skis' lie straight below them. */
    shine(on) {
      this.isSunny = on;
      shade.mesh.visible = on;
    },
    show(time, exaggeration) {
      const pose = poseAt(run, time);
      for (const ski of [0, 1]) {
        const found = sections(run, pose, ski, exaggeration);
        this.sections[ski] = found;
        bendMesh(parts[ski], run, found);
        if (!ghost) colourMesh(parts[ski], run, pose, ski, most);
        castShadow(shadows[ski], run, found, this.isSunny ? sun : [0, 0, 1]);
      }
      rider.matrix.makeBasis(...[pose.forward, pose.left, pose.up].map((axis) => new THREE.Vector3(...axis)));
      rider.matrix.setPosition(...pose.place);
      if (run.arrays.boot_place) rider.userData.stand(pose);
      if (this.isSunny) shade.cast(pose, sun);
      return pose;
    },
  };
}

function strip(count, corners, pairs) {
  const indices = [];
  for (let j = 0; j < count - 1; j++) {
    for (const [a, b] of pairs) {
      const [p, q, r, s] = [j * corners + a, j * corners + b, (j + 1) * corners + a, (j + 1) * corners + b];
      indices.push(p, r, q, q, r, s);
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * count * corners), 3));
  geometry.setIndex(indices);
  return geometry;
}

function skiMesh(run, ski, ghost) {
  const count = run.arrays.station.values.length;
  const geometry = strip(count, CORNERS.length, [[0, 1], [2, 3], [4, 5], [6, 7]]);
  const colours = new Float32Array(3 * count * CORNERS.length);
  geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
  for (let j = 0; j < count; j++) {
    CORNERS.forEach(([, , kind], c) => paint(colours, j * CORNERS.length + c, kind === "side" ? run.colours.side : run.colours.unloaded));
  }
  const material = ghost
    ? new THREE.MeshBasicMaterial({
        color: tone(GHOST), transparent: true, opacity: 0.38, side: THREE.DoubleSide, depthWrite: false,
      })
    : new THREE.MeshLambertMaterial({ vertexColors: true, side: THREE.DoubleSide });
  const mesh = new THREE.Mesh(geometry, material);
  mesh.renderOrder = ghost ? 8 : 5;
  mesh.frustumCulled = false;
  mesh.name = `${["left", "right"][ski]} ski`;
  return mesh;
}

const tone = ([r, g, b]) => new THREE.Color().setRGB(r / 255, g / 255, b / 255, THREE.SRGBColorSpace);

function paint(colours, vertex, colour) {
  for (let i = 0; i < 3; i++) {
    const part = colour[i] / 255;
    colours[3 * vertex + i] = part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4; // sRGB to linear
  }
}

function bendMesh(mesh, run, found) {
  const half = run.arrays.half_width.values;
  const thick = run.arrays.thickness.values;
  const positions = mesh.geometry.attributes.position;
  for (let j = 0; j < half.length; j++) {
    const high = thick[j];
    CORNERS.forEach(([side, up], c) => {
      const inset = half[j] * (up ? 0.97 : 1);
      const at = 3 * (j * CORNERS.length + c);
      for (let i = 0; i < 3; i++) {
        positions.array[at + i] = found[9 * j + i] + side * inset * found[9 * j + 3 + i] + up * high * found[9 * j + 6 + i];
      }
    });
  }
  positions.needsUpdate = true;
  mesh.geometry.computeVertexNormals();
}

function colourMesh(mesh, run, pose, ski, most) {
  const count = run.arrays.station.values.length;
  const force = row(run.arrays.force_per_length.values, pose.at, 2 * count);
  const colours = mesh.geometry.attributes.color;
  for (let j = 0; j < count; j++) {
    const colour = forceColour(force[ski * count + j], most, run.colours);
    for (let c = 0; c < 4; c++) paint(colours.array, j * CORNERS.length + c, colour);
  }
  colours.needsUpdate = true;
}

/** Towards the sun in the run's axes. */
function sunOnSlope(run) {
  const [c, s] = [Math.cos(run.tilt), Math.sin(run.tilt)];
  return [c * SUN.x - s * SUN.z, SUN.y, s * SUN.x + c * SUN.z];
}

/** A shadow on the snow tells how high the ends of a ski are. */
function shadowMesh(run, ghost) {
  const geometry = strip(run.arrays.station.values.length, 2, [[0, 1]]);
  const material = new THREE.MeshBasicMaterial({
    color: SHADOW, side: THREE.DoubleSide, depthWrite: false, depthTest: hills(run), // flat on the snow, under the rest
  });
  const mesh = new THREE.Mesh(geometry, material);
  mesh.renderOrder = 2;
  mesh.frustumCulled = false;
  mesh.visible = !ghost;
  return mesh;
}

function castShadow(mesh, run, found, sun) {
  const half = run.arrays.half_width.values;
  const positions = mesh.geometry.attributes.position;
  for (let j = 0; j < half.length; j++) {
    [1, -1].forEach((side, c) => {
      const edge = [0, 1, 2].map((i) => found[9 * j + i] + side * half[j] * found[9 * j + 3 + i]);
      const high = Math.max(edge[2] - surfaceHeight(run, edge[0], edge[1]), 0) / sun[2];
      const [x, y] = [edge[0] - high * sun[0], edge[1] - high * sun[1]];
      positions.setXYZ(2 * j + c, x, y, surfaceHeight(run, x, y));
    });
  }
  positions.needsUpdate = true;
}
