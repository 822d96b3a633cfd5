// Everything that is drawn: snow, grooves, skis, ghost, measured track; one call draws a moment.

import * as THREE from "./three.module.min.js";
import { largest } from "./binary.js";
import { Follower } from "./cameras.js";
import { GHOST, roundAbove, TRACK } from "./colours.js";
import { grid } from "./grid.js";
import { deepest, groove, measuredTrack } from "./groove.js";
import { skis } from "./skis.js";
import { BACKGROUND, sky, surface } from "./snow.js";

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
    this.scene.add(sky(), this.space);
    this.#light();
    const runs = ghost ? [run, ghost] : [run];
    this.scales = {
      force: roundAbove(Math.max(...runs.map((each) => largest(each.arrays.force_per_length.values)))),
      depth: roundAbove(1000 * Math.max(...runs.map(deepest))) / 1000,
      staysNothing: deepest(run) < 1e-6,
    };
    this.#fill();
    this.follower = new Follower(run, this.space);
    this.space.updateMatrixWorld(true);
  }

  #light() {
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0xd6e2ec, 2.1));
    const sun = new THREE.DirectionalLight(0xffffff, 1.5);
    sun.position.set(-4, 6, 9);
    this.scene.add(sun);
  }

  #fill() {
    const { run, ghost } = this;
    this.skis = skis(run, { most: this.scales.force });
    this.groove = groove(run, { most: this.scales.depth, order: 4 });
    this.space.add(surface(run), grid(run), this.groove.mesh, this.skis.group);
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

  /** What is shown: groove, ghost and track, each true or false. */
  choose({ groove: grooves, ghost, track }) {
    this.groove.mesh.visible = grooves;
    if (this.ghost) {
      this.ghostSkis.group.visible = ghost;
      this.ghostGroove.mesh.visible = ghost && grooves;
    }
    if (this.track) this.track.mesh.visible = track;
    this.trackShown = track;
  }

  draw(time, exaggeration) {
    const pose = this.skis.show(time, exaggeration);
    this.groove.grow(time);
    if (this.ghost) {
      this.ghostSkis.show(time, exaggeration);
      this.ghostGroove.grow(time);
    }
    this.#mark(time);
    this.follower.follow(pose);
    this.renderer.render(this.scene, this.follower.camera);
    return pose;
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
