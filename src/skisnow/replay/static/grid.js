// A grid of metres on the slope, as lines drawn for themselves: a picture of them on the whole surface costs more.

import { surfaceHeight } from "./motion.js";
import { extent, flat, hills, shade, shades } from "./snow.js";
import * as THREE from "./three.module.min.js";

const FINE = { every: 1, width: 0.012, colour: [214, 225, 235], reach: 18, gone: 45 };
const COARSE = { every: 5, width: 0.02, colour: [184, 202, 218], reach: 60, gone: 150 };

// Lines on the snow, smooth at their edges and as faint as they are thin: over the snow that is there.
const LINES = {
  vertex: `
    attribute vec3 beside;   // half the width, across
    attribute vec2 corner;   // -1 or 1 across
    uniform float height;    // height of the picture in pixels
    varying float across;    // from the line's middle (m)
    varying float away;
    void main() {
      vec4 middle = modelViewMatrix * vec4(position, 1.0);
      float pixel = 2.0 * max(-middle.z, 0.01) / (projectionMatrix[1][1] * height);
      float half_width = length(beside);
      float drawn = half_width + 2.0 * pixel;
      across = corner.x * drawn;
      away = -middle.z;
      vec3 place = position + corner.x * (drawn / half_width) * beside;
      gl_Position = projectionMatrix * modelViewMatrix * vec4(place, 1.0);
    }`,
  fragment: `
    precision highp float;
    uniform vec3 colour;
    uniform vec3 snow;
    uniform vec2 fades;
    uniform float half_width;
    varying float across;
    varying float away;
    void main() {
      float pixel = fwidth(across);
      float wide = half_width / pixel;
      float covered = clamp(wide + 0.7 - abs(across) / pixel, 0.0, 1.0) * min(1.0, 2.0 * wide + 0.3);
      float there = 1.0 - clamp((away - fades.x) / (fades.y - fades.x), 0.0, 1.0);
      gl_FragColor = vec4(mix(vec3(1.0), colour / snow, covered * there), 1.0); // the snow is multiplied with it
    }`,
};

/** A grid of metres on the surface around a run: lines of 1 m near by, of 5 m farther out. */
export function grid(run) {
  const found = new THREE.Group();
  found.add(lines(run, FINE), lines(run, COARSE));
  return found;
}

function lines(run, kind) {
  const place = run.arrays.place.values;
  const [[x0, x1], [y0, y1]] = [0, 1].map((axis) => {
    const [low, high] = extent(place, axis);
    return [Math.floor((low - kind.gone) / 5) * 5, Math.ceil((high + kind.gone) / 5) * 5];
  });
  const own = (at) => kind.every === COARSE.every || at % COARSE.every !== 0;
  const chains = steps(y0, y1, kind.every).filter(own).map((y) => steps(x0, x1, hills(run) ? 0.5 : 5).map((x) => [x, y]));
  const aside = run.arrays.terrain_height ? 0.5 : 5; // a profile is straight across
  for (const x of steps(x0, x1, kind.every).filter(own)) chains.push(steps(y0, y1, aside).map((y) => [x, y]));
  const mesh = chained(run, chains, kind);
  mesh.material = new THREE.ShaderMaterial({
    vertexShader: LINES.vertex,
    fragmentShader: LINES.fragment,
    uniforms: {
      snow: shades().snow, colour: shade(kind.colour), height: { value: 720 },
      half_width: { value: kind.width / 2 }, fades: { value: new THREE.Vector2(kind.reach, kind.gone) },
    },
    blending: THREE.CustomBlending,
    blendSrc: THREE.ZeroFactor,
    blendDst: THREE.SrcColorFactor,
    side: THREE.DoubleSide,
    depthWrite: false,
    depthTest: hills(run),
  });
  return flat(mesh, kind === FINE ? 1.2 : 1.4);
}

const steps = (from, to, every) => Array.from({ length: Math.round((to - from) / every) + 1 }, (_, i) => from + i * every);

/** Chains of places as strips of rectangles. */
function chained(run, chains, { width }) {
  const names = { position: [], beside: [], corner: [] };
  const indices = [];
  for (const chain of chains) {
    const sideways = chain[0][1] === chain[1][1] ? [0, width / 2, 0] : [width / 2, 0, 0];
    chain.forEach(([x, y], i) => {
      const first = names.position.length / 3;
      for (const side of [-1, 1]) {
        names.position.push(x, y, surfaceHeight(run, x, y));
        names.beside.push(...sideways);
        names.corner.push(side, 0);
      }
      if (i > 0) indices.push(first - 2, first - 1, first, first, first - 1, first + 1);
    });
  }
  const geometry = new THREE.BufferGeometry();
  for (const [name, values] of Object.entries(names)) {
    geometry.setAttribute(name, new THREE.Float32BufferAttribute(values, name === "corner" ? 2 : 3));
  }
  geometry.setIndex(indices);
  return new THREE.Mesh(geometry);
}
