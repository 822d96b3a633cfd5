// The slope: one light surface in the sun that fades into the sky, and flat drawings on it.

import { surfaceHeight } from "./motion.js";
import { quads } from "./quads.js";
import { snowTile } from "./snow_tile.js";
import * as THREE from "./three.module.min.js";

/** Towards the sun, in the world's axes: low and from the side, so that ripples and grooves show. */
export const SUN = new THREE.Vector3(-0.5, 0.72, 0.56).normalize();

const FAR = 260; // m that the surface reaches beyond the run
const HORIZON = new THREE.Color(0xdfe9f1);
const LOWEST_SKY = 0.12; // rad below the horizontal: under it all is snow, or the colour of the horizon

/** What is behind everything. */
export const BACKGROUND = HORIZON;

const SNOW = [241, 245, 249];
// Most of the picture is snow: without a graphics card each operation per pixel counts, and the snow is plain.
const SURFACE = {
  // Its depth is a little larger: drawings on it are complete, and things behind a crest are hidden.
  vertex: `
    varying float away;
    varying vec2 depth;
    varying vec2 at;
    void main() {
      vec4 seen = modelViewMatrix * vec4(position, 1.0);
      away = -seen.z;
      at = position.xy;
      depth = vec2(projectionMatrix[2][2], projectionMatrix[3][2]);
      gl_Position = projectionMatrix * seen;
    }`,
  fragment: `
    precision highp float;
    uniform vec3 horizon;
    uniform vec3 snow;
    uniform float lit;
    uniform float squares;   // how dark every second one is
    uniform sampler2D tile;
    varying float away;
    varying vec2 depth;
    varying vec2 at;
    void main() {
      vec3 tone = snow;
      vec2 square = step(0.5, fract(0.5 * at));
      float there = squares * clamp((60.0 - away) / 45.0, 0.0, 1.0) * abs(square.x - square.y);
      tone -= vec3(0.1, 0.07, 0.042) * there;
      if (lit > 0.5) {
        float near = texture2D(tile, at * 0.37).r - 0.5;
        float wide = texture2D(tile, at.yx * 0.041 + 0.3).r - 0.5;
        tone *= 1.0 + vec3(0.22, 0.17, 0.12) * near + vec3(0.1, 0.08, 0.06) * wide; // shaded snow is bluer
      }
      gl_FragColor = vec4(mix(tone, horizon, clamp((away - 25.0) / 125.0, 0.0, 1.0)), 1.0);
      #ifdef HILLS
        float farther = 1.01 * away + 0.05; // m
        gl_FragDepth = 0.5 + 0.5 * (depth.y / farther - depth.x);
      #endif
    }`,
};

const RIBBON = {
  vertex: `
    attribute vec3 beside;   // half the width, across
    attribute vec3 along;    // half the length, ahead
    attribute vec2 corner;   // -1 or 1 across, and ahead
    attribute vec3 tint;
    uniform float height;    // height of the picture in pixels
    uniform float least;     // width in pixels
    varying vec3 hue;
    void main() {
      vec4 middle = modelViewMatrix * vec4(position, 1.0);
      float pixel = 2.0 * max(-middle.z, 0.01) / (projectionMatrix[1][1] * height);
      float half_width = length(beside);
      float wide = max(half_width, 0.5 * least * pixel) / max(half_width, 1e-9);
      vec3 place = position + corner.x * wide * beside + corner.y * along;
      hue = tint;
      gl_Position = projectionMatrix * modelViewMatrix * vec4(place, 1.0);
    }`,
  fragment: `
    precision highp float;
    varying vec3 hue;
    void main() {
      gl_FragColor = vec4(hue, 1.0);
    }`,
};

/** Whether a slope may hide something of itself. */
export const hills = (run) => Boolean(run.arrays.profile ?? run.arrays.terrain_height);

/** The surface of a run's slope, drawn behind everything. */
export function surface(run) {
  const geometry = new THREE.BufferGeometry();
  const { positions, indices } = woven(...(run.arrays.terrain_height ? terrainPlaces(run) : slopePlaces(run)));
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(positions, 3));
  geometry.setIndex(indices);
  const material = new THREE.ShaderMaterial({
    vertexShader: SURFACE.vertex,
    fragmentShader: SURFACE.fragment,
    uniforms: { ...shades(), lit: { value: 1 }, squares: { value: 1 }, tile: { value: snowTile() } },
    defines: hills(run) ? { HILLS: 1 } : {},
    side: THREE.DoubleSide,
    depthWrite: hills(run),
    depthTest: hills(run), // a plane hides nothing, and drawing is quicker so
  });
  return flat(new THREE.Mesh(geometry, material), 1);
}

/** Triangles between rows of places x and columns of places y; `height(x, y)` of the snow. */
function woven(xs, ys, height) {
  const positions = [];
  const indices = [];
  xs.forEach((x, i) => {
    ys.forEach((y, j) => {
      positions.push(x, y, height(x, y));
      const [here, next] = [i * ys.length + j, (i + 1) * ys.length + j];
      if (i + 1 < xs.length && j + 1 < ys.length) indices.push(here, next, here + 1, here + 1, next, next + 1);
    });
  });
  return { positions, indices };
}

/** A terrain's own places, and far out. */
function terrainPlaces(run) {
  const reach = (places) => [places[0] - FAR, ...places, places.at(-1) + FAR];
  const [xs, ys] = ["terrain_x", "terrain_y"].map((name) => reach(Array.from(run.arrays[name].values)));
  return [xs, ys, (x, y) => surfaceHeight(run, x, y)];
}

/** A plane's or a profile's: the same height all along y. */
function slopePlaces(run) {
  const points = new Map(profilePoints(run));
  const [low, high] = extent(run.arrays.place.values, 1);
  return [[...points.keys()], [low - FAR, high + FAR], (x) => points.get(x)];
}

export const shade = (colour) => ({ value: new THREE.Vector3(...colour).divideScalar(255) });
/** Colours that a shader of the surface starts from. */
export const shades = () => ({ horizon: { value: HORIZON.clone().convertLinearToSRGB() }, snow: shade(SNOW) });

function profilePoints(run) {
  const profile = run.arrays.profile?.values;
  if (profile) {
    const points = Array.from({ length: profile.length / 2 }, (_, i) => [profile[2 * i], profile[2 * i + 1]]);
    return [goneOn(points[0], points[1]), ...points, goneOn(points.at(-1), points.at(-2))];
  }
  const [low, high] = extent(run.arrays.place.values, 0);
  return [[low - FAR, 0], [high + FAR, 0]];
}

/** A point far out on the line from one through another. */
function goneOn([x, z], [towardX, towardZ]) {
  const way = FAR * Math.sign(x - towardX);
  return [x + way, z + (way * (z - towardZ)) / (x - towardX)];
}

/** Lowest and highest of one coordinate of places. */
export function extent(values, axis) {
  let [low, high] = [Infinity, -Infinity];
  for (let i = axis; i < values.length; i += 3) {
    low = Math.min(low, values[i]);
    high = Math.max(high, values[i]);
  }
  return [low, high];
}

/** Drawn in this order, wherever it is. */
export function flat(mesh, order) {
  mesh.renderOrder = order;
  mesh.frustumCulled = false;
  return mesh;
}

/** The sky: light at the horizon, a little bluer above. */
export function sky() {
  const geometry = new THREE.SphereGeometry(400, 24, 12, 0, 2 * Math.PI, 0, Math.PI / 2 + LOWEST_SKY);
  const colours = [];
  const above = new THREE.Color(0xa9c6de);
  const positions = geometry.attributes.position;
  for (let i = 0; i < positions.count; i++) {
    // a sphere of three.js has its poles on y; here z is up
    const mixed = HORIZON.clone().lerp(above, Math.min(1, Math.max(0, (2.2 * positions.getY(i)) / 400)));
    colours.push(mixed.r, mixed.g, mixed.b);
  }
  geometry.setAttribute("color", new THREE.Float32BufferAttribute(colours, 3));
  geometry.rotateX(Math.PI / 2);
  const material = new THREE.MeshBasicMaterial({
    vertexColors: true, side: THREE.BackSide, depthWrite: false, depthTest: false,
  });
  return flat(new THREE.Mesh(geometry, material), 0);
}

/**
 * Pieces lying on the snow, each a rectangle: middle, half across, half ahead, colour (0 to 255). It is never narrower
 * than `least` pixels, so that a groove of millimetres is seen from above.
 */
export function ribbon(pieces, { least = 2, order = 3, hidden = false } = {}) {
  const material = new THREE.ShaderMaterial({
    vertexShader: RIBBON.vertex,
    fragmentShader: RIBBON.fragment,
    uniforms: { height: { value: 720 }, least: { value: least } },
    side: THREE.DoubleSide,
    depthWrite: false,
    depthTest: hidden, // by hills; else drawn in the order given, before the skis
  });
  return flat(new THREE.Mesh(quads(pieces), material), order);
}
