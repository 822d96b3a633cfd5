// Where the sledge and its skis are at any time: the moments that were kept, and straight between them.

/** The moment before a time, and the share of the way to the next: [index, share]. */
export function between(times, time) {
  const last = times.length - 1;
  if (last === 0 || time <= times[0]) return [0, 0];
  if (time >= times[last]) return [last - 1, 1];
  let low = 0;
  let high = last;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  return [low, (time - times[low]) / (times[high] - times[low])];
}

/** Row of a history at a place between two moments; `size` numbers in each row. */
export function row(values, [index, share], size) {
  const found = new Float64Array(size);
  const next = Math.min((index + 1) * size, values.length - size);
  for (let i = 0; i < size; i++) found[i] = (1 - share) * values[index * size + i] + share * values[next + i];
  return found;
}

/** Rotation matrix, nine numbers row by row, of a quaternion w, x, y, z of any length. */
export function rotation(quaternion) {
  const size = Math.hypot(...quaternion);
  const [w, x, y, z] = quaternion.map((part) => part / size);
  return [
    1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
    2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
    2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y),
  ];
}

/** Pose at a time: place, and the sledge's axes forward, left and up, each in space. */
export function poseAt(run, time) {
  const at = between(run.arrays.time.values, time);
  const r = rotation(row(run.arrays.attitude.values, at, 4));
  return {
    at,
    time,
    place: row(run.arrays.place.values, at, 3),
    forward: [r[0], r[3], r[6]],
    left: [r[1], r[4], r[7]],
    up: [r[2], r[5], r[8]],
  };
}

/** A boot's place and axes in space: forward, across the base to the left, away from the snow. */
export function bootPose(run, pose, ski) {
  const { boot_place: places, boot_attitude: attitudes, middle } = run.arrays;
  if (places) {
    const r = rotation(Array.from(row(attitudes.values, pose.at, 8).subarray(4 * ski, 4 * ski + 4)));
    const place = row(places.values, pose.at, 6).subarray(3 * ski, 3 * ski + 3);
    return { place, forward: [r[0], r[3], r[6]], across: [r[1], r[4], r[7]], away: [r[2], r[5], r[8]] };
  }
  const [cosine, sine] = [Math.cos(run.edge_angle), Math.sin(run.edge_angle)];
  const [ahead, aside, above] = middle.values.subarray(3 * ski, 3 * ski + 3);
  const { forward, left, up } = pose;
  return {
    place: pose.place.map((part, i) => part + ahead * forward[i] + aside * left[i] + above * up[i]),
    forward,
    across: left.map((part, i) => cosine * part - sine * up[i]),
    away: left.map((part, i) => sine * part + cosine * up[i]),
  };
}

/** Edge angle of a ski at a time (rad), positive: the left edge is down; of boots that move, against the snow. */
export function edgeAngle(run, ski, time) {
  if (!run.arrays.boot_place) return run.edge_angle;
  const { place, across, away } = bootPose(run, poseAt(run, time), ski);
  const normal = surfaceNormal(run, place[0], place[1]);
  const along = (axis) => axis.reduce((sum, part, i) => sum + part * normal[i], 0);
  return Math.atan2(-along(across), along(away));
}

/** Angle of the skis (rad), positive to the left: to the body, and to the path. */
export function yaws(run, pose) {
  const normal = surfaceNormal(run, pose.place[0], pose.place[1]);
  const skis = [0, 1].map((ski) => bootPose(run, pose, ski).forward);
  const heading = skis[0].map((part, i) => part + skis[1][i]);
  const [index] = pose.at;
  const { values } = run.arrays.place;
  const path = [0, 1, 2].map((axis) => (values.length > 3 ? values[3 * index + 3 + axis] - values[3 * index + axis] : 0));
  return { body: turned(pose.forward, heading, normal), path: turned(path, heading, normal) };
}

/** Angle (rad) about a normal from one direction to another. */
function turned(from, to, normal) {
  const dot = (one, other) => one.reduce((sum, part, i) => sum + part * other[i], 0);
  const cross = [0, 1, 2].map((i) => from[(i + 1) % 3] * to[(i + 2) % 3] - from[(i + 2) % 3] * to[(i + 1) % 3]);
  return Math.atan2(dot(cross, normal), dot(from, to) - dot(from, normal) * dot(to, normal));
}

/**
 * Cross sections of a ski: at each station the middle of the base, and unit vectors across it to the left and away from
 * the snow, as skisnow.replay.shapes has them. Nine numbers each, in space.
 */
export function sections(run, pose, ski, exaggeration) {
  const { station, base_height: base, bending, twist } = run.arrays;
  const count = station.values.length;
  const bent = row(bending.values, pose.at, 2 * count);
  const twisted = row(twist.values, pose.at, 2 * count);
  const boot = bootPose(run, pose, ski);
  const found = new Float64Array(9 * count);
  for (let j = 0; j < count; j++) {
    const height = base.values[j] + exaggeration * bent[ski * count + j];
    const angle = exaggeration * twisted[ski * count + j];
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    for (let axis = 0; axis < 3; axis++) {
      const [across, away] = [boot.across[axis], boot.away[axis]];
      found[9 * j + axis] = boot.place[axis] + station.values[j] * boot.forward[axis] + height * away;
      found[9 * j + 3 + axis] = c * across - s * away;
      found[9 * j + 6 + axis] = s * across + c * away;
    }
  }
  return found;
}

/** Both edges of a ski's base: [left, right], each three numbers a station. */
export function edges(run, time, ski, exaggeration) {
  const found = sections(run, poseAt(run, time), ski, exaggeration);
  const half = run.arrays.half_width.values;
  return [1, -1].map((side) =>
    Array.from(half, (width, j) => [0, 1, 2].map((axis) => found[9 * j + axis] + side * width * found[9 * j + 3 + axis])),
  );
}

const distances = new WeakMap(); // x of the profile, computed once

/** Height of the snow's surface at x and y. */
export function surfaceHeight(run, x, y) {
  if (run.arrays.terrain_height) return terrainHeight(run, x, y);
  const profile = run.arrays.profile?.values;
  if (!profile) return 0;
  if (!distances.has(run)) distances.set(run, profile.filter((_, i) => i % 2 === 0));
  const [index, share] = between(distances.get(run), x);
  return (1 - share) * profile[2 * index + 1] + share * profile[2 * index + 3];
}

/** Straight between the places of a terrain; beyond them with its mean grade. */
function terrainHeight(run, x, y) {
  const { terrain_x: xs, terrain_y: ys, terrain_height: heights } = run.arrays;
  const [i, u] = between(xs.values, x);
  const [j, v] = between(ys.values, y);
  const at = (k, m) => heights.values[(i + k) * ys.values.length + j + m];
  const near = (1 - u) * ((1 - v) * at(0, 0) + v * at(0, 1)) + u * ((1 - v) * at(1, 0) + v * at(1, 1));
  const beyond = (places, place) => place - Math.min(Math.max(place, places[0]), places.at(-1));
  return near + run.terrain_grade[0] * beyond(xs.values, x) + run.terrain_grade[1] * beyond(ys.values, y);
}

/** dz/dx and dz/dy of the snow's surface, over `reach` m to each side. */
export function surfaceGrade(run, x, y, reach = 0.1) {
  return [
    (surfaceHeight(run, x + reach, y) - surfaceHeight(run, x - reach, y)) / (2 * reach),
    (surfaceHeight(run, x, y + reach) - surfaceHeight(run, x, y - reach)) / (2 * reach),
  ];
}

/** Unit vector out of the snow. */
export function surfaceNormal(run, x, y, reach = 0.1) {
  const [ahead, aside] = surfaceGrade(run, x, y, reach);
  const size = Math.hypot(1, ahead, aside);
  return [-ahead / size, -aside / size, 1 / size];
}
