// The groove in relief: a shader finds where a look meets the groove's cross section below the snow.

import * as THREE from "./three.module.min.js";
import { quads } from "./quads.js";
import { flat, shades, SUN } from "./snow.js";

const WIDEST = 0.1; // m

const SHADER = {
  vertex: `
    attribute vec3 beside;   // half the width, to the left
    attribute vec3 along;    // half the length, ahead
    attribute vec2 corner;   // -1 or 1 across, and ahead
    attribute vec3 tint;
    attribute float deep;    // m
    uniform float height;    // height of the picture in pixels
    uniform float least;     // width in pixels
    uniform float times;     // depth and width are drawn so often
    uniform float widest;    // maximum half width (m) of exaggerated shapes
    attribute float lowest;  // where it is deepest: -1 right edge, 1 left edge
    attribute float level;   // 1: a flat ski's, with a level floor
    uniform vec3 sun;        // world
    varying vec3 hue;
    varying vec3 look;       // from the eye: left, up
    varying vec2 light;      // to the sun: left, up
    varying float away;
    varying float place;     // from the middle to the left (m)
    varying float half_width;
    varying float depth;
    varying float bottom;
    varying float boxed;
    void main() {
      bottom = lowest;
      boxed = level;
      vec4 middle = modelViewMatrix * vec4(position, 1.0);
      float pixel = 2.0 * max(-middle.z, 0.01) / (projectionMatrix[1][1] * height);
      float size = max(length(beside), 1e-9);
      float wide = max(clamp(widest / size, 1.0, times), 0.5 * least * pixel / size);
      vec3 centre = position + (1.0 - wide) * bottom * beside; // the deepest line stays where it is
      vec4 world = modelMatrix * vec4(centre + corner.x * wide * beside + corner.y * along, 1.0);
      vec3 left = normalize(mat3(modelMatrix) * beside);
      vec3 up = normalize(cross(mat3(modelMatrix) * along, left));
      vec3 from = world.xyz - cameraPosition;
      look = vec3(dot(from, left), dot(from, up), 0.0);
      light = vec2(dot(sun, left), dot(sun, up));
      hue = tint;
      half_width = wide * size;
      depth = deep * max(wide, times);
      place = corner.x * half_width;
      vec4 seen = viewMatrix * world;
      away = -seen.z;
      gl_Position = projectionMatrix * seen;
    }`,
  fragment: `
    precision highp float;
    uniform vec3 horizon;
    uniform vec3 snow;
    varying vec3 hue;
    varying vec3 look;
    varying vec2 light;
    varying float away;
    varying float place;
    varying float half_width;
    varying float depth;
    varying float bottom;
    varying float boxed;
    float floor_at(float u) { // depth, as a share of the deepest, at u from -1 to 1
      float wall = u < bottom ? (u + 1.0) / (bottom + 1.0) : (1.0 - u) / (1.0 - bottom);
      return clamp(boxed > 0.5 ? 10.0 * (1.0 - abs(u)) : wall, 0.0, 1.0);
    }
    void main() {
      float aside = look.x / max(-look.y, 0.02 * length(look.xy)) * depth / half_width; // of u, for the whole depth
      float u = place / half_width;
      float down = 0.0;
      float before = 0.0;
      float gap = 0.0; // above the floor
      for (int i = 1; i <= 10; i++) {
        float next = 0.1 * float(i);
        float clear = floor_at(u + aside * next) - next;
        if (clear <= 0.0) {
          down = mix(before, next, gap / max(gap - clear, 1e-6));
          break;
        }
        before = next;
        gap = clear;
        down = next;
      }
      float hit = clamp(u + aside * down, -1.0, 1.0);
      float rise = (floor_at(hit + 0.02) - floor_at(hit - 0.02)) / 0.04 * depth / half_width; // down to the left
      vec2 normal = normalize(vec2(rise, 1.0));
      float sunny = max(dot(normal, light), 0.0);
      float rim = hit + sign(light.x) * down * abs(light.x) / max(light.y, 0.05) * depth / half_width;
      sunny *= 1.0 - smoothstep(1.0, 1.25, abs(rim)); // in the shade of the rim
      vec3 tone = mix(snow, hue, 0.75) * (0.6 + 0.66 * sunny);
      float far = clamp((away - 25.0) / 125.0, 0.0, 1.0);
      gl_FragColor = vec4(mix(tone, horizon, far), 1.0);
    }`,
};

/**
 * Pieces of a groove as rectangles on the snow in which one looks down to the floor: middle, half across to the left,
 * half ahead, depth and colour. Its `edgeAngle` (rad, positive: the left edge is down) says where it is deepest.
 */
export function relief(pieces, { least, order, hidden }) {
  const own = pieces.map((piece) => ({
    ...piece, lowest: deepestAt(piece.edgeAngle), level: isFlat(piece.edgeAngle) ? 1 : 0,
  }));
  const material = new THREE.ShaderMaterial({
    vertexShader: SHADER.vertex,
    fragmentShader: SHADER.fragment,
    uniforms: {
      ...shades(), height: { value: 720 }, least: { value: least }, times: { value: 1 }, widest: { value: WIDEST },
      sun: { value: SUN },
    },
    side: THREE.DoubleSide,
    depthWrite: false,
    depthTest: hidden,
  });
  return flat(new THREE.Mesh(quads(own, ["deep", "lowest", "level"]), material), order);
}

const isFlat = (angle) => Math.abs(Math.sin(angle)) < 0.05;

/** Between the base's print, cos² of the width, and the wall's, sin²: from -1, the right rim, to 1, the left one. */
export function deepestAt(angle) {
  return isFlat(angle) ? 0 : Math.sign(angle) * (1 - 2 * Math.sin(angle) ** 2);
}
