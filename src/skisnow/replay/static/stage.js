// Everything that is drawn: snow, grooves, skis, forces, poles, ghost, measured track; one call draws a moment.

import * as THREE from "./three.module.min.js";
import { largest } from "./binary.js";
import { Follower } from "./cameras.js";
import { GHOST, roundAbove, TRACK } from "./colours.js";
import { forceArrows, largeForce } from "./force_arrows.js";
import { grid } from "./grid.js";
import { deepest, groove, measuredTrack, path } from "./groove.js";
import { fallLine, gates, horizonHills, poles } from "./landmarks.js";
import { plume } from "./plume.js";
import { MOST_EFFECTS } from "./sharpness.js";
import { skis } from "./skis.js";
import { BACKGROUND, sky, SUN, surface } from "./snow.js";

const GHOST_GROOVE = GHOST.map((part) => 255 - 0.55 * (255 - part));

/** The picture of a run on a canvas. */
export class Stage {
  constructor(canvas, run, ghost) {
    this.run = run;
    this.ghost = ghost;
    this.renderer = new THREE.WebGLRenderer({ canvas, context: context(canvas) });
    this.scene = new THREE.Scene();
    this.scene.background = BACKGROUND;
    this.space = new THREE.Group();
    this.space.rotation.y = run.tilt; // x goes down by the slope's inclination
    this.scene.add(sky(), horizonHills(), this.space);
    this.effects = MOST_EFFECTS;
    this.#light();
    const runs = ghost ? [run, ghost] : [run];
    const force = roundAbove(Math.max(...runs.map(largeForce))); // most of a ski would be pale beside a moment's largest
    this.scales = {
      force,
      forceGoesOn: runs.some((each) => largest(each.arrays.force_per_length.values) > force),
      depth: roundAbove(1000 * Math.max(...runs.map(deepest))) / 1000,
      staysNothing: deepest(run) < 1e-6,
    };
    this.#fill();
    this.follower = new Follower(run, this.space);
    this.space.updateMatrixWorld(true);
  }

  #light() {
    const sky = new THREE.HemisphereLight(0xffffff, 0xc9d8e5, 1.9);
    sky.position.set(0, 0, 1);
    const sun = new THREE.DirectionalLight(0xfff4e4, 1.9);
    sun.position.copy(SUN);
    this.scene.add(sky);
    this.scene.add(sun);
  }

  #fill() {
    const { run, ghost } = this;
    this.skis = skis(run, { most: this.scales.force });
    this.groove = groove(run, { most: this.scales.depth, order: 4 });
    this.surface = surface(run);
    this.fallLine = fallLine(run);
    this.arrows = forceArrows(run);
    this.plume = plume(run);
    this.lines = grid(run);
    this.path = path(run);
    this.space.add(this.surface, this.lines, this.path, this.groove.mesh, this.skis.group, poles(run), gates(run));
    this.space.add(this.fallLine.group, this.arrows.group, this.plume.points);
    this.arrows.group.visible = false;
    this.spend(MOST_EFFECTS);
    if (ghost) {
      this.ghostSkis = skis(ghost, { most: this.scales.force, ghost: true });
      this.ghostGroove = groove(ghost, { most: this.scales.depth, colour: GHOST_GROOVE, order: 3 });
      this.space.add(this.ghostGroove.mesh, this.ghostSkis.group);
    }
    if (run.arrays.track_place) {
      this.track = measuredTrack(run);
      this.marker = marker();
      this.space.add(this.track.mesh, this.marker);
    }
  }

  resize(width, height, ratio) {
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.follower.resize(width, height);
    this.space.traverse((each) => {
      if (each.material?.uniforms?.height) each.material.uniforms.height.value = height;
    });
  }

  /** So many effects: 0 none, 1 light on the snow and shadows of the sun, 2 the plume too. */
  spend(effects) {
    this.effects = effects;
    this.surface.material.uniforms.lit.value = effects > 0 ? 1 : 0;
    this.skis.shine(effects > 0);
    this.plume.points.visible = effects > 1;
  }

  /** What is shown: groove, metre marks, forces, ghost and track, each true or false. */
  choose({ groove: grooves, marks, forces, ghost, track }) {
    this.surface.material.uniforms.squares.value = marks ? 1 : 0;
    this.lines.visible = this.path.visible = marks;
    this.groove.mesh.visible = grooves;
    this.arrows.group.visible = forces;
    if (this.ghost) {
      this.ghostSkis.group.visible = ghost;
      this.ghostGroove.mesh.visible = ghost && grooves;
    }
    if (this.track) this.track.mesh.visible = track;
    this.trackShown = track;
  }

  /** Draw the groove's depth and width so often. */
  deepen(times) {
    this.groove.deepen(times);
  }

  draw(time, exaggeration) {
    const pose = this.skis.show(time, exaggeration);
    this.groove.grow(time);
    this.fallLine.show(pose);
    if (this.arrows.group.visible) this.arrows.show(pose, this.skis.sections);
    if (this.effects > 1) this.plume.show(time);
    if (this.ghost) {
      const its = time - this.run.arrays.time.values[0] + this.ghost.arrays.time.values[0]; // both begin together
      this.ghostSkis.show(its, exaggeration);
      this.ghostGroove.grow(its);
    }
    this.#mark(time);
    this.follower.follow(pose);
    this.follower.camera.updateMatrixWorld(true);
    this.fallLine.face(this.follower.camera);
    this.renderer.render(this.scene, this.follower.camera);
    return pose;
  }

  /** Until what was asked for is drawn: without a graphics card the very first picture takes a second or two. */
  async drawn() {
    const gl = this.renderer.getContext();
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    while (!gl.isContextLost() && gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED) {
      await new Promise((done) => setTimeout(done, 4));
    }
    gl.deleteSync(fence);
  }

  #mark(time) {
    if (!this.track) return;
    const place = this.track.placeAt(time);
    this.marker.visible = Boolean(place) && this.trackShown;
    if (place) this.marker.position.set(...place);
  }
}

/** Opaque and without smoothing by the card: a picture that stands is drawn twice as fine instead. */
function context(canvas) {
  const wishes = { alpha: false, antialias: false, stencil: false, powerPreference: "high-performance" };
  const found = canvas.getContext("webgl2", wishes);
  if (!found) throw new Error("no WebGL 2");
  return found;
}

function marker() {
  const [r, g, b] = TRACK.map((part) => part / 255);
  const material = new THREE.MeshLambertMaterial({
    color: new THREE.Color().setRGB(r, g, b, THREE.SRGBColorSpace),
  });
  const mesh = new THREE.Mesh(new THREE.SphereGeometry(0.05, 16, 10), material);
  mesh.renderOrder = 5;
  return mesh;
}
