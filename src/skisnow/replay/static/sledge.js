// The sledge as it is drawn: on each ski a plate with a bracket, a frame of tubes between them, and the mass as a stack of
// discs at the centre of mass. Where boots, skis and centre of mass are is the run's; the rest is drawn, not computed with.

import * as THREE from "./three.module.min.js";
import { largest } from "./binary.js";
import { bootPose, poseAt, surfaceHeight, surfaceNormal } from "./motion.js";
import { hills } from "./snow.js";

export const SHADOW = 0x6c8299;
const STEEL = 0x36424e;
const TUBE = 0x1b242d;
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
  const thick = largest(run.arrays.thickness.values);
  const brackets = [0, 1].map(() => bracket(add, thick));
  group.add(...brackets);
  const mass = new THREE.Vector3(0, 0, run.centre_of_mass_height);
  const span = frame(add, mass);
  weights(add, mass);
  group.traverse((each) => {
    each.renderOrder = ghost ? 8 : 5;
  });
  /** Put the brackets where the boots are, and the tubes between them and the mass. */
  group.userData.stand = (pose) => {
    const back = matrixOf(pose.place, [pose.forward, pose.left, pose.up]).invert();
    const ends = brackets.map((each, ski) => {
      const boot = bootPose(run, pose, ski);
      const matrix = back.clone().multiply(matrixOf(boot.place, [boot.forward, boot.across, boot.away]));
      matrix.decompose(each.position, each.quaternion, each.scale);
      return JOINTS.map((x) => new THREE.Vector3(x, 0, thick + BRACKET.height).applyMatrix4(matrix));
    });
    span(ends);
  };
  group.userData.stand(poseAt(run, run.arrays.time.values[0]));
  return group;
}

const BRACKET = { long: 0.3, top: 0.12, width: 0.05, height: 0.085 };
const JOINTS = [-0.045, 0.045]; // m ahead of the boot, on each bracket

/** From a frame at a place with three axes into space. */
export function matrixOf(place, axes) {
  return new THREE.Matrix4().makeBasis(...axes.map((axis) => new THREE.Vector3(...axis))).setPosition(...place);
}

/** A plate on the ski and a bracket that grows narrower upwards, square to the ski's base. */
function bracket(add, thick) {
  const turned = new THREE.Group();
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

/** Two tubes across from bracket to bracket, and four up to the mass; put between the brackets' joints by what is returned. */
function frame(add, mass) {
  const across = JOINTS.map(() => tube(add, 0.018));
  const joints = [0, 1].map(() => JOINTS.map(() => add(new THREE.SphereGeometry(0.019, 12, 8), STEEL)));
  const up = [0, 1].map(() => JOINTS.map(() => tube(add, 0.013)));
  return (ends) => {
    JOINTS.forEach((_, i) => {
      stretch(across[i], ends[0][i], ends[1][i]);
      for (const ski of [0, 1]) {
        joints[ski][i].position.copy(ends[ski][i]);
        stretch(up[ski][i], ends[ski][i], mass);
      }
    });
  };
}

/** Three discs on a spindle; the middle of the middle one is the centre of mass. */
function weights(add, mass) {
  const disc = (radius, high, up, colour) => {
    const geometry = new THREE.CylinderGeometry(radius, radius, high, 28).rotateX(Math.PI / 2);
    add(geometry, colour).position.copy(mass).add(new THREE.Vector3(0, 0, up));
  };
  disc(0.135, 0.03, -0.036, TUBE);
  disc(0.15, 0.042, 0, RED);
  disc(0.135, 0.03, 0.036, RED);
  disc(0.022, 0.17, 0, PALE);
}

const tube = (add, radius) => add(new THREE.CylinderGeometry(radius, radius, 1, 10), TUBE);

/** A tube of length 1 from one place to another. */
function stretch(mesh, from, to) {
  const way = to.clone().sub(from);
  mesh.scale.set(1, way.length(), 1);
  mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), way.normalize());
  mesh.position.copy(from).add(to).multiplyScalar(0.5);
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
  const pairs = sledge.children.map((each, i) => [each, mesh.children[i]]);
  const onto = new THREE.Matrix4();
  return {
    mesh,
    /** `sun`: towards it, in the run's axes. */
    cast(pose, sun) {
      const [x, y] = pose.place;
      const here = surfaceHeight(run, x, y);
      const normal = new THREE.Vector3(...surfaceNormal(run, x, y, 0.2));
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
      for (const [each, its] of run.arrays.boot_place ? pairs : []) {
        its.position.copy(each.position);
        its.quaternion.copy(each.quaternion);
        its.scale.copy(each.scale);
      }
      mesh.matrix.multiplyMatrices(onto, sledge.matrix);
    },
  };
}
