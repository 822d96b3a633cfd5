// Where one looks from: behind the run, the boot, above, along the edge, or freely around the sledge.

import * as THREE from "./three.module.min.js";
import { bootPose, poseAt, surfaceHeight } from "./motion.js";

export const VIEWS = ["chase", "boot", "above", "edge", "free"];
const UPRIGHT = new THREE.Vector3(0, 0, 1);
const NEAREST = 0.15;
const FARTHEST = 15;
// Far and high enough that a turn is seen as a curve: m, and s that the camera comes after.
const CHASE = { behind: 3.5, height: 2.2, outward: 0.9, ahead: 0.35, up: -0.1, lag: 0.7 };
const CHASE_SKIER = { ...CHASE, behind: 5, height: 2.8, outward: 1.2, up: 0.3 };
const BOOT = { behind: 0.7, height: 1.05 }; // m
const BOOT_SKIER = { behind: -0.35, height: 0.75 }; // before the knees, which would hide the skis

/** A camera that follows a run shown in `space`, whose axes may be tilted against the horizon. */
export class Follower {
  constructor(run, space) {
    this.run = run;
    this.space = space;
    this.camera = new THREE.PerspectiveCamera(50, 1, 0.05, 900);
    this.view = "chase";
    this.zoom = { chase: 1, boot: 1, above: 1, edge: 1, free: 1 };
    this.around = { azimuth: -2.4, height: 0.42 };
    this.outer = outerSki(run);
    this.behind = run.skier ? CHASE_SKIER : CHASE;
    this.overBoot = run.skier ? BOOT_SKIER : BOOT;
    this.middle = run.skier ? 0.5 : 0; // m above the skis that one looks at when turning about
  }

  resize(width, height) {
    this.camera.aspect = width / height;
    this.camera.fov = width < height ? 66 : 48; // a narrow picture needs the height to hold both skis
    this.camera.updateProjectionMatrix();
  }

  nearer(factor) {
    this.zoom[this.view] = Math.min(Math.max(this.zoom[this.view] * factor, NEAREST), FARTHEST);
  }

  /** Turn about the sledge (rad); any other view becomes the free one from where it stands. */
  turn(azimuth, height) {
    if (this.view !== "free") this.#setFree();
    this.around.azimuth += azimuth;
    this.around.height = Math.min(Math.max(this.around.height + height, 0.03), 1.55);
  }

  #setFree() {
    const target = this.#world(offset(this.pose, 0, 0, this.middle));
    const from = this.camera.position.clone().sub(target);
    this.around.azimuth = Math.atan2(from.y, from.x);
    this.around.height = Math.atan2(from.z, Math.hypot(from.x, from.y));
    this.zoom.free = Math.min(Math.max(from.length() / FREE_DISTANCE, NEAREST), FARTHEST);
    this.view = "free";
  }

  follow(pose) {
    this.pose = pose;
    this[this.view](pose);
  }

  /** Behind and above, a little on the outside of the turn: both skis, what they leave, and where they go. */
  chase(pose) {
    const zoom = this.zoom.chase;
    const [x, y] = this.#heading(pose);
    const turning = Math.sign(pose.left[0] * x + pose.left[1] * y) || (this.outer === 1 ? 1 : -1);
    const { behind, height, outward, ahead, up } = this.behind;
    const side = -turning * outward * zoom;
    const from = [
      pose.place[0] - behind * zoom * x - side * y,
      pose.place[1] - behind * zoom * y + side * x,
      0,
    ];
    from[2] = surfaceHeight(this.run, from[0], from[1]) + height * zoom;
    this.#look(from, offset(pose, ahead, 0, up), UPRIGHT);
  }

  /** Where the skis have pointed of late, on the slope. */
  #heading(pose) {
    let [x, y] = pose.forward;
    for (const part of [0.25, 0.5, 0.75, 1]) {
      const before = poseAt(this.run, pose.time - part * CHASE.lag).forward;
      [x, y] = [x + before[0], y + before[1]];
    }
    const size = Math.hypot(x, y) || 1;
    return [x / size, y / size];
  }

  boot(pose) {
    const zoom = this.zoom.boot;
    const { behind, height } = this.overBoot;
    const from = offset(pose, -behind * zoom, 0, height * zoom);
    this.#look(from, offset(pose, 0.95, 0, 0), UPRIGHT);
  }

  above(pose) {
    const from = pose.place.slice();
    from[2] += 5.5 * this.zoom.above;
    const down = this.#direction([-1, 0, 0]); // the fall line goes down the picture
    this.#look(from, pose.place, down);
  }

  edge(pose) {
    const zoom = this.zoom.edge;
    const { place, forward } = bootPose(this.run, pose, this.outer);
    const boot = { place, forward, left: pose.left, up: pose.up };
    const tail = this.run.arrays.station.values.at(-1);
    const from = offset(boot, tail - 0.55 * zoom, (this.outer === 0 ? 1 : -1) * 0.16 * zoom, 0);
    from[2] = surfaceHeight(this.run, from[0], from[1]) + 0.2 * zoom;
    this.#look(from, offset(boot, 0.35, 0, 0.02), UPRIGHT);
  }

  free(pose) {
    const { azimuth, height } = this.around;
    const distance = FREE_DISTANCE * this.zoom.free;
    const target = this.#world(offset(pose, 0, 0, this.middle));
    const way = new THREE.Vector3(
      Math.cos(azimuth) * Math.cos(height), Math.sin(azimuth) * Math.cos(height), Math.sin(height),
    );
    this.#aim(target.clone().addScaledVector(way, distance), target, UPRIGHT);
  }

  #look(from, to, up) {
    this.#aim(this.#world(from), this.#world(to), up);
  }

  #aim(from, to, up) {
    this.camera.position.copy(from);
    this.camera.up.copy(up);
    this.camera.lookAt(to);
  }

  #world(place) {
    return this.space.localToWorld(new THREE.Vector3(...place));
  }

  #direction(vector) {
    return new THREE.Vector3(...vector).transformDirection(this.space.matrixWorld);
  }
}

const FREE_DISTANCE = 4;

/** A place beside the sledge: forward, left, up of its own axes (m). */
function offset(pose, forward, left, up) {
  return [0, 1, 2].map(
    (axis) => pose.place[axis] + forward * pose.forward[axis] + left * pose.left[axis] + up * pose.up[axis],
  );
}

/** The ski with the larger total force over the run: 0 left, 1 right. */
function outerSki(run) {
  const force = run.arrays.force.values;
  const sums = [0, 0];
  for (let i = 0; i < force.length; i += 3) sums[(i / 3) % 2] += Math.hypot(force[i], force[i + 1], force[i + 2]);
  return sums[1] >= sums[0] ? 1 : 0;
}
