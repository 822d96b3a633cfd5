// Two skis and the sledge on them, as meshes that follow a run.

import * as THREE from "./three.module.min.js";
import { largest } from "./binary.js";
import { forceColour, GHOST } from "./colours.js";
import { poseAt, row, sections, surfaceHeight } from "./motion.js";
import { hills } from "./snow.js";

// corners of a cross section, each as often as a face needs its own colour and normal: [across, thickness, kind]
const CORNERS = [
  [1, 1, "face"], [-1, 1, "face"], // top
  [-1, 0, "face"], [1, 0, "face"], // base
  [1, 0, "side"], [1, 1, "side"], // left wall
  [-1, 1, "side"], [-1, 0, "side"], // right wall
];

/** Both skis of a run with their sledge. `show(time, exaggeration)` moves them and returns the pose. */
export function skis(run, { most, ghost = false }) {
  const group = new THREE.Group();
  const parts = [0, 1].map((ski) => skiMesh(run, ski, ghost));
  const shadows = [0, 1].map(() => shadowMesh(run, ghost));
  const sledge = sledgeMesh(run, ghost);
  group.add(...shadows, ...parts, sledge);
  return {
    group,
    show(time, exaggeration) {
      const pose = poseAt(run, time);
      for (const ski of [0, 1]) {
        const found = sections(run, pose, ski, exaggeration);
        bendMesh(parts[ski], run, found);
        if (!ghost) colourMesh(parts[ski], run, pose, ski, most);
        castShadow(shadows[ski], run, found);
      }
      sledge.matrix.makeBasis(...[pose.forward, pose.left, pose.up].map((axis) => new THREE.Vector3(...axis)));
      sledge.matrix.setPosition(...pose.place);
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

/** A shadow straight under each ski tells how high its ends are. */
function shadowMesh(run, ghost) {
  const geometry = strip(run.arrays.station.values.length, 2, [[0, 1]]);
  const material = new THREE.MeshBasicMaterial({
    color: 0xc3d0dc, side: THREE.DoubleSide, depthWrite: false, depthTest: hills(run), // flat on the snow, under the rest
  });
  const mesh = new THREE.Mesh(geometry, material);
  mesh.renderOrder = 2;
  mesh.frustumCulled = false;
  mesh.visible = !ghost;
  return mesh;
}

function castShadow(mesh, run, found) {
  const half = run.arrays.half_width.values;
  const positions = mesh.geometry.attributes.position;
  for (let j = 0; j < half.length; j++) {
    [1, -1].forEach((side, c) => {
      const [x, y] = [0, 1].map((i) => found[9 * j + i] + side * half[j] * found[9 * j + 3 + i]);
      positions.setXYZ(2 * j + c, x, y, surfaceHeight(run, x));
    });
  }
  positions.needsUpdate = true;
}

/** Two boots, the beam between them and the centre of mass: enough to see how the sledge leans. */
function sledgeMesh(run, ghost) {
  const group = new THREE.Group();
  group.matrixAutoUpdate = false;
  const material = ghost
    ? new THREE.MeshBasicMaterial({ color: tone(GHOST), transparent: true, opacity: 0.25, depthWrite: false })
    : new THREE.MeshLambertMaterial({ color: 0x8492a0 });
  const middle = run.arrays.middle.values;
  const bases = [0, 1].map((ski) => new THREE.Vector3(...middle.subarray(3 * ski, 3 * ski + 3)));
  const height = 0.085;
  const thick = largest(run.arrays.thickness.values);
  for (const base of bases) {
    const boot = new THREE.Mesh(new THREE.BoxGeometry(0.27, 0.062, height), material);
    const turned = new THREE.Group();
    turned.add(boot);
    boot.position.z = thick + height / 2;
    turned.position.copy(base);
    turned.rotation.x = -run.edge_angle;
    group.add(turned);
  }
  const top = bases.map((base) => base.clone().add(upAlong(run.edge_angle, thick + height)));
  group.add(beam(top[0], top[1], material));
  const mass = new THREE.Mesh(new THREE.SphereGeometry(0.03, 16, 10), material);
  mass.position.set(0, 0, run.centre_of_mass_height);
  group.add(mass);
  group.traverse((each) => {
    each.renderOrder = ghost ? 8 : 5;
  });
  return group;
}

const upAlong = (angle, size) => new THREE.Vector3(0, size * Math.sin(angle), size * Math.cos(angle));

function beam(from, to, material) {
  const way = to.clone().sub(from);
  const mesh = new THREE.Mesh(new THREE.BoxGeometry(0.035, way.length(), 0.02), material);
  mesh.position.copy(from).addScaledVector(way, 0.5);
  mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), way.normalize());
  return mesh;
}
