// The skier: parts of a body between joints. Boots and joints come with the run, the parts' shape too (skier_shapes.py).

import * as THREE from "./three.module.min.js";
import { bootPose, poseAt, row } from "./motion.js";
import { matrixOf } from "./sledge.js";

const LEFT = new THREE.Vector3(0, 1, 0);
const BOOTS = ["left boot", "right boot"];

/** A skier as a group that a run's pose is set on; all in one colour for a ghost. */
export function skierMesh(run, ghost) {
  const group = new THREE.Group();
  group.matrixAutoUpdate = false;
  const { joints, parts } = run.skier;
  const shapes = geometries(run);
  const placed = parts.map(({ name, start, end }, i) => {
    const mesh = new THREE.Mesh(shapes[i], ghost ? translucent(ghost) : new THREE.MeshLambertMaterial({ vertexColors: true }));
    mesh.name = name;
    mesh.renderOrder = ghost ? 8 : 5;
    mesh.frustumCulled = false;
    group.add(mesh);
    return { mesh, boot: BOOTS.indexOf(start), start: joints.indexOf(start), end: joints.indexOf(end) };
  });
  const matrix = new THREE.Matrix4();
  /** Put the boots where they are, and each other part between its joints. */
  group.userData.stand = (pose) => {
    const back = matrixOf(pose.place, [pose.forward, pose.left, pose.up]).invert();
    const places = row(run.arrays.skier_joints.values, pose.at, 3 * joints.length);
    const at = (joint) => new THREE.Vector3(...places.subarray(3 * joint, 3 * joint + 3));
    for (const { mesh, boot, start, end } of placed) {
      if (boot >= 0) {
        const { place, forward, across, away } = bootPose(run, pose, boot);
        matrix.multiplyMatrices(back, matrixOf(place, [forward, across, away]));
      } else {
        const z = at(end).sub(at(start)).normalize();
        const y = LEFT.clone().addScaledVector(z, -LEFT.dot(z)).normalize();
        matrix.makeBasis(y.clone().cross(z), y, z).setPosition(at(start));
      }
      matrix.decompose(mesh.position, mesh.quaternion, mesh.scale);
    }
  };
  group.userData.stand(poseAt(run, run.arrays.time.values[0]));
  return group;
}

const translucent = (colour) =>
  new THREE.MeshBasicMaterial({ color: colour, transparent: true, opacity: 0.34, depthWrite: false });

/** A geometry for each part, from the run's arrays. */
function geometries(run) {
  const [vertices, colours, triangles] = ["vertices", "colours", "triangles"].map((name) => run.arrays[`skier_${name}`].values);
  let [vertex, triangle] = [0, 0];
  return run.skier.parts.map(({ vertices: count, triangles: pieces }) => {
    const geometry = new THREE.BufferGeometry();
    const some = (values) => new THREE.BufferAttribute(values.slice(3 * vertex, 3 * (vertex + count)), 3);
    geometry.setAttribute("position", some(vertices));
    geometry.setAttribute("color", some(colours));
    geometry.setIndex(Array.from(triangles.subarray(3 * triangle, 3 * (triangle + pieces)), Math.round));
    geometry.computeVertexNormals();
    [vertex, triangle] = [vertex + count, triangle + pieces];
    return geometry;
  });
}
