// The groove that stays behind, growing as the boots pass, the path in dashes, and a measured track.

import { depthColour, TRACK } from "./colours.js";
import { largest } from "./binary.js";
import { between, edgeAngle, surfaceHeight, surfaceNormal } from "./motion.js";
import { relief } from "./relief.js";
import { hills, ribbon } from "./snow.js";

const PATH = [64, 84, 106];
const PATH_WIDTH = 0.025; // m

/** The deepest groove that stays in a run (m). */
export const deepest = (run) => Math.max(0, largest(run.arrays.groove_residual_depth.values));

/**
 * A run's groove as a mesh with `grow(time)`: in relief and coloured by the depth that stays, or flat in one `colour` for
 * a ghost. `deepen(times)` draws depth and width so often.
 */
export function groove(run, { most, colour = null, order = 3 }) {
  const beside = neighbours(run.arrays.groove_ski.values);
  const pieces = Array.from(run.arrays.groove_time.values, (_, i) => piece(run, i, beside[i], most, colour));
  const hidden = hills(run);
  const mesh = colour
    ? ribbon(pieces, { least: 1.6, order, hidden })
    : relief(pieces, { least: 2.4, order, hidden });
  const times = run.arrays.groove_time.values; // rising
  return {
    mesh,
    grow(time) {
      mesh.geometry.setDrawRange(0, 6 * made(times, time));
    },
    deepen(factor) {
      if (!colour) mesh.material.uniforms.times.value = factor;
    },
  };
}

/** How many of rising times are not after a time. */
export function made(times, time) {
  let low = 0;
  let high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** For each piece the pieces of the same ski just before and after it. */
function neighbours(skis) {
  const found = Array.from(skis, (_, i) => [i, i]);
  const last = [-1, -1];
  skis.forEach((ski, i) => {
    const before = last[Math.round(ski)];
    if (before >= 0) {
      found[i][0] = before;
      found[before][1] = i;
    }
    last[Math.round(ski)] = i;
  });
  return found;
}

function piece(run, i, beside, most, colour) {
  const { groove_middle: middle, groove_left: left, groove_width: width, groove_residual_depth: depth } = run.arrays;
  const across = left.values.subarray(3 * i, 3 * i + 3);
  return {
    middle: middle.values.subarray(3 * i, 3 * i + 3),
    beside: Array.from(across, (part) => (part * width.values[i]) / 2),
    along: reach(run, across, beside.map((j) => middle.values.subarray(3 * j, 3 * j + 3)), middle.values.subarray(3 * i, 3 * i + 2)),
    deep: depth.values[i],
    edgeAngle: edgeAngle(run, Math.round(run.arrays.groove_ski.values[i]), run.arrays.groove_time.values[i]),
    colour: colour ?? depthColour(depth.values[i], most, run.colours),
  };
}

/** Half of a piece's length ahead: towards its neighbours, or straight across its own line where they lie elsewhere. */
function reach(run, across, [before, after], place) {
  const way = [0, 1, 2].map((axis) => after[axis] - before[axis]);
  const [long, aside] = [Math.hypot(...way), way.reduce((sum, part, axis) => sum + part * across[axis], 0)];
  const half = run.groove_spacing / 2;
  if (long > half && long < 8 * half && Math.abs(aside) < 0.3 * long) {
    return way.map((part) => (part * half) / Math.sqrt(long * long - aside * aside));
  }
  const normal = surfaceNormal(run, ...place);
  return [0, 1, 2].map((axis) => {
    const [j, k] = [(axis + 1) % 3, (axis + 2) % 3];
    return half * (across[j] * normal[k] - across[k] * normal[j]);
  });
}

/** A measured track as a line, and `placeAt(time)`, null where its times are not known. */
export function measuredTrack(run) {
  const place = run.arrays.track_place.values;
  const points = Array.from({ length: place.length / 3 }, (_, i) => Array.from(place.subarray(3 * i, 3 * i + 3)));
  const times = run.arrays.track_time?.values ?? null;
  const mesh = ribbon(points.slice(1).map((end, i) => dash(points[i], end)), { least: 3, order: 4, hidden: hills(run) });
  return {
    mesh,
    placeAt(time) {
      if (!times) return null;
      const [index, share] = between(times, time);
      const next = points[Math.min(index + 1, points.length - 1)];
      return points[index].map((part, axis) => (1 - share) * part + share * next[axis]);
    },
  };
}

/** The way of the middle between the boots, behind and ahead: a dash on the snow begins each metre. */
export function path(run) {
  const place = run.arrays.place.values;
  const at = (i, share) => {
    const [x, y] = [0, 1].map((axis) => (1 - share) * place[3 * i + axis] + share * place[3 * i + 3 + axis]);
    return [x, y, surfaceHeight(run, x, y)];
  };
  const pieces = [];
  let [gone, start] = [0, null];
  for (let i = 0; i < place.length / 3 - 1; i++) {
    const step = Math.hypot(...[0, 1, 2].map((axis) => place[3 * i + 3 + axis] - place[3 * i + axis]));
    let next = (Math.floor(2 * gone) + 1) / 2; // m: dashes and gaps of half a metre end by turns
    for (; next <= gone + step; next += 0.5) {
      const here = at(i, (next - gone) / step);
      if (start) pieces.push(dash(start, here, PATH, PATH_WIDTH));
      start = start ? null : here;
    }
    gone += step;
  }
  return ribbon(pieces, { least: 1.5, order: 2.5, hidden: hills(run) });
}

function dash(start, end, colour = TRACK, width = 0.02) {
  const way = [0, 1, 2].map((axis) => (end[axis] - start[axis]) / 2);
  const size = Math.hypot(way[0], way[1]) || 1;
  return {
    middle: start.map((part, axis) => part + way[axis]),
    beside: [(-0.5 * width * way[1]) / size, (0.5 * width * way[0]) / size, 0],
    along: way,
    colour,
  };
}
