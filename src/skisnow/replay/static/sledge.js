// The sledge as it is drawn: on each ski a plate with a bracket, a frame of tubes between them, and the mass as a stack of
// discs at the centre of mass. Where boots, skis and centre of mass are is the run's; the rest is drawn, not computed with.

import * as THREE from "./three.module.min.js";
import { largest } from "./binary.js";
import { surfaceHeight } from "./motion.js";
import { hills } from "./snow.js";

export const SHADOW = 0x93a7bb;
const STEEL = 0x4b5966;
const TUBE = 0x2c3742;
const RED = 0xc8372d;
const PALE = 0xe9edf0;

/** A sledge as a group that a run's pose is set on; all in one colour for a ghost. */
export function sledgeMesh(run, ghost) {
  const group = new THREE.Group();
  group.matrixAutoUpdate = false;
  const material = (colour) =>
    ghost
      ? new THREE.MeshBasicMaterial({ color: ghost, transparent: true, opacity: 0.25, depthWrite: false })
      : new THREE.MeshLambertMaterial({ color: colour });
  const add = (geometry, colour, parent = group) => {
    const mesh = new THREE.Mesh(geometry, material(colour));
    parent.add(mesh);
    return mesh;
  };
  const middle = run.arrays.middle.values;
  const thick = largest(run.arrays.thickness.values);
  const tops = [0, 1].map((ski) => {
    const base = new THREE.Vector3(...middle.subarray(3 * ski, 3 * ski + 3));
    group.add(bracket(add, base, run.edge_angle, thick));
    return base.add(upAlong(run.edge_angle, thick + BRACKET.height));
  });
  const mass = new THREE.Vector3(0, 0, run.centre_of_mass_height);
  frame(add, tops, mass);
  weights(add, mass);
  group.traverse((each) => {
    each.renderOrder = ghost ? 8 : 5;
  });
  return group;
}

const BRACKET = { long: 0.3, top: 0.12, width: 0.05, height: 0.085 };
const upAlong = (angle, size) => new THREE.Vector3(0, size * Math.sin(angle), size * Math.cos(angle));

/** A plate on the ski and a bracket that grows narrower upwards, square to the ski's base. */
function bracket(add, base, angle, thick) {
  const turned = new THREE.Group();
  turned.position.copy(base);
  turned.rotation.x = -angle;
  const { long, top, width, height } = BRACKET;
  add(new THREE.BoxGeometry(long, 0.062, 0.012), TUBE, turned).position.z = thick + 0.006;
  const side = new THREE.Shape([[-0.42 * long, 0], [0.42 * long, 0], [top / 2, height], [-top / 2, height]].map(
    ([x, z]) => new THREE.Vector2(x, z),
  ));
  const solid = new THREE.ExtrudeGeometry(side, { depth: width, bevelEnabled: false });
  solid.rotateX(Math.PI / 2).translate(0, width / 2, thick);
  add(solid, STEEL, turned);
  return turned;
}

/** Two tubes across from bracket to bracket, and four up to the mass. */
function frame(add, tops, mass) {
  for (const x of [-0.045, 0.045]) {
    const ends = tops.map((top) => top.clone().add(new THREE.Vector3(x, 0, 0)));
    add(tube(ends[0], ends[1], 0.013), TUBE);
    for (const end of ends) {
      const joint = add(new THREE.SphereGeometry(0.019, 12, 8), STEEL);
      joint.position.copy(end);
      add(tube(end, mass, 0.009), TUBE);
    }
  }
}

/** Three discs on a spindle; the middle of the middle one is the centre of mass. */
function weights(add, mass) {
  const disc = (radius, high, up, colour) => {
    const geometry = new THREE.CylinderGeometry(radius, radius, high, 28).rotateX(Math.PI / 2);
    add(geometry, colour).position.copy(mass).add(new THREE.Vector3(0, 0, up));
  };
  disc(0.085, 0.024, -0.027, STEEL);
  disc(0.09, 0.026, 0, RED);
  disc(0.085, 0.024, 0.027, STEEL);
  disc(0.018, 0.13, 0, PALE);
}

function tube(from, to, radius) {
  const way = to.clone().sub(from);
  const geometry = new THREE.CylinderGeometry(radius, radius, way.length(), 10);
  const turn = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 1, 0), way.normalize());
  return geometry.applyQuaternion(turn).translate(...from.clone().add(to).multiplyScalar(0.5).toArray());
}

/** The sledge's shadow: all of it laid flat on the snow along the light. */
export function slopeShadow(run, sledge) {
  const material = new THREE.MeshBasicMaterial({ color: SHADOW, depthWrite: false, depthTest: hills(run), side: THREE.DoubleSide });
  const mesh = new THREE.Group();
  mesh.matrixAutoUpdate = false;
  for (const each of sledge.children) mesh.add(each.clone());
  mesh.traverse((each) => {
    each.renderOrder = 2;
    if (each.isMesh) each.material = material;
    each.frustumCulled = false;
  });
  const onto = new THREE.Matrix4();
  return {
    mesh,
    /** `sun`: towards it, in the run's axes. */
    cast(pose, sun) {
      const [x, y] = pose.place;
      const here = surfaceHeight(run, x);
      const slope = hills(run) ? (surfaceHeight(run, x + 0.2) - surfaceHeight(run, x - 0.2)) / 0.4 : 0;
      const normal = new THREE.Vector3(-slope, 0, 1).normalize();
      const light = new THREE.Vector3(...sun);
      const down = normal.dot(light);
      const [a, b] = [light.toArray(), normal.toArray()];
      const entry = (i, j) => (i === j ? 1 : 0) - (a[i] * b[j]) / down;
      const off = normal.dot(new THREE.Vector3(x, y, here)) / down;
      onto.set(
        entry(0, 0), entry(0, 1), entry(0, 2), off * a[0],
        entry(1, 0), entry(1, 1), entry(1, 2), off * a[1],
        entry(2, 0), entry(2, 1), entry(2, 2), off * a[2],
        0, 0, 0, 1,
      );
      mesh.matrix.multiplyMatrices(onto, sledge.matrix);
    },
  };
}
