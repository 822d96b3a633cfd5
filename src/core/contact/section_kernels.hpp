// Where the base of a runner lies over each line.
#pragma once

#include <algorithm>

#include "contact/lane_loops.hpp"

namespace skisnow::SKISNOW_LANES {

template <class V>
inline V table_place(const Runner& runner, V station) {
  return within((station - runner.tail) * runner.places_per_metre(), 0.0, runner.places - 1.0);
}

// [give_share] The length of ski that belongs to each line: halfway to its neighbours, and no farther than tip and
// tail. Lines beyond the ends lie one spacing off.
template <class V>
void give_share(const Runner& runner, const GrooveLines& lines, Base& s) {
  double* station = s[STATION];
  const int first = std::max(s.index(lines.first), 0), end = std::min(s.index(lines.end), s.count());
  if (first >= end) {
    std::fill_n(s[SHARE], s.count(), 0.0);
    return;
  }
  const auto on_ski = [&](V place) { return within(place, runner.tail, runner.tip); };
  const double before = station[first] - lines.spacing(), behind = station[end - 1] + lines.spacing();
  if (first > 0) station[first - 1] = before;
  if (end < s.count()) station[end] = behind;
  double rear = 0.5 * (before + station[first]);
  for (int i = 0; i < s.count(); i += WIDTH<V>) {
    const V here = load<V>(station + i);
    const V next = i + WIDTH<V> < s.count() ? load<V>(station + i + 1) : from_lane_behind<V>(here, behind);
    const V to = on_ski(0.5 * (here + next)), from = from_lane_before<V>(to, on_ski(all<V>(rear))[0]);
    rear = 0.5 * (here[WIDTH<V> - 1] + next[WIDTH<V> - 1]);
    V share = maximum(to - from, V{});
    for (int lane = 0; lane < WIDTH<V>; lane++)
      if (i + lane < first || i + lane >= end) share[lane] = 0.0;
    store(s[SHARE] + i, share);
  }
  for (int i = 0; i < s.count(); i += WIDTH<V>) store(station + i, on_ski(load<V>(station + i)));
}

// Hermite's shapes at a place z of an element of length h, from its front.
template <class V>
struct Shapes {
  V front, front_slope, rear, rear_slope;

  Shapes(V z, V h) {
    const V y = 1.0 - z;
    front = y * y * (1.0 + 2.0 * z);
    front_slope = h * z * y * y;
    rear = z * z * (3.0 - 2.0 * z);
    rear_slope = -h * z * z * y;
  }
};

// The unbent base at one station of each lane: half width, its slope, height, its slope. The ski's table is linear
// between its places. Returns the places before the stations.
template <class V>
SKISNOW_INLINE WholeParts<V> read_table(const Runner& runner, V station, V (&shape)[ROW]) {
  const V place = table_place(runner, station);
  const WholeParts<V> at(minimum(place, all<V>(runner.places - 2.0)));
  const V beyond = place - at.value();
  Row rows[WIDTH<V>];
  for (int lane = 0; lane < WIDTH<V>; lane++) {
    const double* row = runner.table.data() + ROW * at[lane];
    const Row here = load<Row>(row);
    rows[lane] = here + beyond[lane] * (load<Row>(row + ROW) - here);
  }
  transpose<V>(rows, shape);
  return at;
}

// The base at one station of each lane, bent with the beam.
template <class V>
struct BentBase {
  V shape[ROW];                     // half width, its slope, height of the base, its slope
  V element, length, in_element;    // element of the beam, its length, place in it from the front
  V sine{}, cosine, twist_slope{};  // sine, cosine and slope of the twist

  // The element of a place in the table is also that of the stations behind it; in front of that element's first node
  // they are in the one before.
  SKISNOW_INLINE BentBase(const Runner& runner, const Pose& pose, V station) : cosine(all<V>(1.0)) {
    const WholeParts<V> at = read_table(runner, station, shape);
    int number[WIDTH<V>];
    Row nodes[WIDTH<V>], front[WIDTH<V>], rear[WIDTH<V>];
    const auto take_element = [&](int lane, int e) {
      number[lane] = e, nodes[lane] = load<Row>(runner.element_rows.data() + ROW * e);
    };
    for (int lane = 0; lane < WIDTH<V>; lane++) take_element(lane, runner.element[std::size_t(at[lane])]);
    V row[ROW];
    transpose<V>(nodes, row);
    if (any(station > row[0])) {
      for (int lane = 0; lane < WIDTH<V>; lane++)
        if (station[lane] > nodes[lane][0] && number[lane] > 0) take_element(lane, number[lane] - 1);
      transpose<V>(nodes, row);
    }
    length = row[1], in_element = (row[0] - station) * row[2], element = row[3];
    if (pose.beam.empty()) return;
    for (int lane = 0; lane < WIDTH<V>; lane++) {
      const double* beam =
          pose.beam.data() + 3 * number[lane];  // rows of four overlap: twist in front, the node behind
      front[lane] = load<Row>(beam), rear[lane] = load<Row>(beam + 2);
    }
    bend(front, rear, row[2]);
  }

 private:
  // [bend] By Hermite's cubics; sine and cosine of the twist by series whose next terms are below 1e-9 at 0.3 rad.
  SKISNOW_INLINE void bend(const Row* front, const Row* rear, V per_length) {
    V first[ROW], second[ROW];
    transpose<V>(front, first), transpose<V>(rear, second);
    const V &w = first[0], &a = first[1], &t = first[2], &v = second[1], &b = second[2], &u = second[3];
    const V z = in_element, y = 1.0 - z;
    const Shapes<V> by(z, length);
    shape[2] += by.front * w + by.front_slope * a + by.rear * v + by.rear_slope * b;
    shape[3] += 6.0 * z * y * per_length * (w - v) - y * (1.0 - 3.0 * z) * a - z * (3.0 * z - 2.0) * b;
    const V twist = y * t + z * u, q = twist * twist;
    twist_slope = (t - u) * per_length;
    cosine = 1.0 - q * (0.5 - q * (1.0 / 24.0 - q * (1.0 / 720.0)));
    sine = twist * (1.0 - q * (1.0 / 6.0 - q * (1.0 / 120.0 - q * (1.0 / 5040.0))));
  }
};

// [grip_side] Where between the edges the snow holds the base on a line, over the half width: the mean of both edges by
// their depths in the snow. It is 1 (left) or -1 where one edge alone is in it, and above the snow where one comes
// first. The base at the station is taken as a plane through its middle.
template <class V>
SKISNOW_INLINE V grip_side(const BentBase<V>& base, V station, const Vector<V>& from, const Vector<V>& ahead,
                           const Vector<V>& normal) {
  const V rise = base.shape[3], height = base.shape[2], x = from.x - station, z = from.z - height;
  const V climb = (normal.x + rise * normal.z) / (ahead.x + rise * ahead.z);
  const V middle =
      x * normal.x + from.y * normal.y + z * normal.z - climb * (x * ahead.x + from.y * ahead.y + z * ahead.z);
  const V tilt = base.sine * normal.z - base.cosine * normal.y + climb * (base.cosine * ahead.y - base.sine * ahead.z);
  const V left = maximum(V(middle + base.shape[0] * tilt), V{}), right = maximum(V(middle - base.shape[0] * tilt), V{});
  const MaskOf<V> wet = left + right > 0.0;
  const V first = select(tilt > 0.0, all<V>(1.0), select(tilt < 0.0, all<V>(-1.0), V{}));
  return select(wet, (left - right) / select(wet, left + right, all<V>(1.0)), first);
}

// [take_lines] Lines in the ski's axes.
template <class V>
void take_lines(const Pose& pose, const GrooveLines& lines, Base& s) {
  const auto& R = pose.rotation;
  const auto& c = pose.position;
  const auto turned = [&](const Vector<V>& a) -> Vector<V> {
    return {R[0][0] * a.x + R[1][0] * a.y + R[2][0] * a.z, R[0][1] * a.x + R[1][1] * a.y + R[2][1] * a.z,
            R[0][2] * a.x + R[1][2] * a.y + R[2][2] * a.z};
  };
  const auto line3 = [&](LineField first, int j) -> Vector<V> {
    return {load<V>(lines.values[first] + j), load<V>(lines.values[LineField(first + 1)] + j),
            load<V>(lines.values[LineField(first + 2)] + j)};
  };
  for_lanes<V>(s, lines, [&](int i, int j) {
    if (!s.wants(Base::STATIONS, i)) return;
    const Vector<V> origin = line3(ORIGIN_X, j), from = turned({origin.x - c[0], origin.y - c[1], origin.z - c[2]});
    const Vector<V> ahead = turned(line3(AHEAD_X, j)), normal = turned(line3(NORMAL_X, j));
    store3(s, FROM_BOOT_0, i, from);
    store3(s, LINE_AHEAD_0, i, ahead);
    store3(s, LINE_NORMAL_0, i, normal);
    store3(s, LINE_LEFT_0, i, cross(normal, ahead));
  });
}

// One of the two edges of a section: across from the ski's middle, to the left and upwards from the boot (m); the unit
// vector in the surface across its direction.
template <class V>
struct Edge {
  V reach, left, up;
  Vector<V> across;
};

template <class V>
struct BasePieces;

// The section of one line through the base.
template <class V>
struct Cut {
  // bent base: the section's place along the ski, half width and its slope, height and its slope, sine and
  // cosine of the twist and its slope; how far its middle lies to the left of the ski's axis (for differences)
  V station, half, flare, height, rise, sp, cp, twist_slope, aside{};
  V side;                               // the grip's place across, over the half width
  Vector<V> from, ahead, normal, left;  // the line
  V sine, deepest, reach, grip_depth, grip_left, grip_up, place;
  V depth[2], x[2];  // depth and place of the left and the right edge
  V fall, climb, widening, wet_from, wet_to;
  Vector<V> across, along;
  V size;  // one over the length of `along` before it was made a unit
  const EdgeShape* shape;

  // The base as it is bent, not yet cut.
  Cut(const Base& s, int i) : shape(&s.edge_shape) {
    station = load<V>(s[STATION] + i), half = load<V>(s[HALF_WIDTH] + i), flare = load<V>(s[FLARE] + i);
    height = load<V>(s[BASE_HEIGHT] + i), rise = load<V>(s[BASE_RISE] + i);
    sp = load<V>(s[TWIST_SINE] + i), cp = load<V>(s[TWIST_COSINE] + i), twist_slope = load<V>(s[TWIST_SLOPE] + i);
    from = load3<V>(s, FROM_BOOT_0, i), ahead = load3<V>(s, LINE_AHEAD_0, i);
    normal = load3<V>(s, LINE_NORMAL_0, i), left = load3<V>(s, LINE_LEFT_0, i);
    side = load<V>(s[GRIP_REACH] + i) / half;
  }

  // The bent base at a place, before any section of this line was cut.
  Cut(const BentBase<V>& bent, V place_along, const Base& s, int i) : shape(&s.edge_shape) {
    station = place_along, half = bent.shape[0], flare = bent.shape[1], height = bent.shape[2], rise = bent.shape[3];
    sp = bent.sine, cp = bent.cosine, twist_slope = bent.twist_slope;
    from = load3<V>(s, FROM_BOOT_0, i), ahead = load3<V>(s, LINE_AHEAD_0, i);
    normal = load3<V>(s, LINE_NORMAL_0, i), left = load3<V>(s, LINE_LEFT_0, i);
    side = load<V>(s[GRIP_REACH] + i);
  }

  // A section that was cut and stored.
  SKISNOW_INLINE static Cut stored(const Base& s, int i) {
    Cut c(s, i);
    c.sine = load<V>(s[EDGE_SINE] + i), c.deepest = load<V>(s[DEEPEST] + i), c.reach = load<V>(s[GRIP_REACH] + i);
    c.grip_depth = load<V>(s[GRIP_DEPTH] + i), c.grip_left = load<V>(s[GRIP_LEFT] + i);
    c.grip_up = load<V>(s[GRIP_UP] + i), c.place = load<V>(s[GRIP_PLACE] + i), c.fall = load<V>(s[DEPTH_FALL] + i);
    c.climb = load<V>(s[DEPTH_CLIMB] + i), c.widening = load<V>(s[BASE_WIDENING] + i);
    c.wet_from = load<V>(s[WET_FROM] + i), c.wet_to = load<V>(s[WET_TO] + i);
    for (int k = 0; k < 2; k++)
      c.depth[k] = load<V>(s[of_edge(LEFT_DEPTH, k)] + i), c.x[k] = load<V>(s[of_edge(LEFT_X, k)] + i);
    c.across = load3<V>(s, ACROSS_0, i), c.along = load3<V>(s, ALONG_0, i), c.size = load<V>(s[ALONG_SIZE] + i);
    return c;
  }

  void store_at(Base& s, int i) const {
    store(s[EDGE_SINE] + i, sine), store(s[DEEPEST] + i, deepest), store(s[GRIP_REACH] + i, reach);
    store(s[GRIP_DEPTH] + i, grip_depth), store(s[GRIP_LEFT] + i, grip_left), store(s[GRIP_UP] + i, grip_up);
    store(s[GRIP_PLACE] + i, place), store(s[DEPTH_FALL] + i, fall), store(s[DEPTH_CLIMB] + i, climb);
    store(s[BASE_WIDENING] + i, widening), store(s[WET_FROM] + i, wet_from), store(s[WET_TO] + i, wet_to);
    for (int k = 0; k < 2; k++) store(s[of_edge(LEFT_DEPTH, k)] + i, depth[k]), store(s[of_edge(LEFT_X, k)] + i, x[k]);
    store3(s, ACROSS_0, i, across), store3(s, ALONG_0, i, along), store(s[ALONG_SIZE] + i, size);
    store(s[GRIP_SKEW] + i, skew_);
  }

  // A stored section after the base has moved by a small way to the left, or off the snow. The wet base ends where it
  // did: the snow bears nothing at the water line.
  void move(const Base& s, int i, bool to_left, double way) {
    const V skew = load<V>(s[GRIP_SKEW] + i), rise = to_left ? normal.y : normal.z;
    (to_left ? grip_left : grip_up) += way;
    deepest -= way * rise, grip_depth -= way * rise, depth[0] -= way * rise, depth[1] -= way * rise;
    place += way * (to_left ? left.y - skew * ahead.y : left.z - skew * ahead.z);
  }

  // [grip] Where it is, how deep; the fall of the depth to the left.
  void find_grip() {
    const V middle = (from.x - station) * normal.x + (from.y - aside) * normal.y + (from.z - height) * normal.z;
    sine = sp * normal.z - cp * normal.y;
    reach = side * half;
    grip_depth = middle + reach * sine;
    grip_left = aside + reach * cp;
    grip_up = height - reach * sp;
    raw_ = direction(side);
    normal_ahead_ = reach * twist_slope - rise * cp;
    steep_ = 1.0 / (normal_ahead_ * normal.x + sp * normal.y + cp * normal.z);
    fall = (normal_ahead_ * left.x + sp * left.y + cp * left.z) * steep_;
  }

  // Along the base at a place across, over the half width: 1 ahead.
  Vector<V> direction(V across) const {
    const V outwards = flare * across, twisting = across * half * twist_slope;
    return {all<V>(1.0), outwards * cp - twisting * sp, rise - outwards * sp - twisting * cp};
  }

  // [edge_places] Where grip and edges cross the line; beyond tip and tail each goes on along its own direction.
  void find_places() {
    const V beyond = (from.x - station) * ahead.x + (from.y - grip_left) * ahead.y + (from.z - grip_up) * ahead.z;
    skew_ = dot(raw_, left) / dot(raw_, ahead);
    const V on_grip = beyond * skew_;
    place = (station - from.x) * left.x + (grip_left - from.y) * left.y + (grip_up - from.z) * left.z + on_grip;
    const V aside_left = cp * left.y - sp * left.z, aside_ahead = cp * ahead.y - sp * ahead.z;
    for (int k = 0; k < 2; k++) {
      const double to = k == 0 ? 1.0 : -1.0;
      const V off = to * half - reach;
      const Vector<V> along_edge = direction(all<V>(to));
      const V skew = dot(along_edge, left) / dot(along_edge, ahead);
      x[k] = off * aside_left + ((beyond - off * aside_ahead) * skew - on_grip);
      depth[k] = grip_depth + fall * x[k];
    }
    deepest = maximum(depth[0], depth[1]);
    if (!shape->acts()) return;
    for (int k = 0; k < 2; k++) depth[k] -= shape->lost(k == 0 ? sine : V(-sine), cosine());
  }

  V cosine() const { return root(V(maximum(V(1.0 - sine * sine), V{}))); }

  // [wet_base] Where on the line the base is in the snow.
  void find_wet() {
    widening = cp * left.y - sp * left.z + fall * sine;
    const V down = select(absolute(fall) > LEVEL, fall, all<V>(LEVEL)), water = -grip_depth / down;
    wet_from = select(down > 0.0, maximum(x[1], water), x[1]);
    wet_to = select(down > 0.0, x[0], minimum(x[0], water));
    if (shape->acts()) BasePieces<V>(*this).find_wet(deepest, wet_from, wet_to);
  }

  // [edge_directions] In the surface: across the edge and along it; how fast the depth grows along it.
  void find_directions() {
    const Vector<V> raw = cross(normal, raw_);
    size = 1.0 / root(dot(raw, raw));
    across = scaled(raw, size), along = cross(across, normal);
    climb = (normal_ahead_ * along.x + sp * along.y + cp * along.z) * steep_;
  }

  // One of the edges: the left one (0) or the right one (1).
  Edge<V> edge(int k) const {
    const double to = k == 0 ? 1.0 : -1.0;
    const V off = to * half - reach;
    const Vector<V> raw = cross(normal, direction(all<V>(to)));
    return {to * half, grip_left + off * cp, grip_up - off * sp, scaled(raw, 1.0 / root(dot(raw, raw)))};
  }

  // Whether not the grip alone is an edge in the snow.
  MaskOf<V> is_between() const { return (minimum(depth[0], depth[1]) > 0.0) | (absolute(side) != 1.0); }

  // How far the grip's crossing with the line lies ahead of the section, along the ski.
  V way_to_line() const {
    const V beyond = (from.x - station) * ahead.x + (from.y - grip_left) * ahead.y + (from.z - grip_up) * ahead.z;
    return beyond / dot(raw_, ahead);
  }

  SKISNOW_INLINE void cut() {
    find_grip();
    find_places();
    find_wet();
    find_directions();
  }

 private:
  static constexpr double LEVEL = 1e-12;  // fall of the depth across below which a base is level
  Vector<V> raw_;                         // along the grip, 1 ahead
  V normal_ahead_, steep_, skew_;         // skew: way of the grip across the line per way ahead of it
};

// [base_pieces] The base of a section as it is ground: straight pieces from the right edge to the left one. Between
// the inner hinges it is the plane; towards an edge it is raised from each hinge on.
template <class V>
struct BasePieces {
  static constexpr int COUNT = 2 * EdgeShape::HINGES + 1;
  V place[COUNT + 1];             // ends of the pieces in x
  V at_grip[COUNT], fall[COUNT];  // depth that each piece has if it goes on to the grip, its fall to the left

  explicit BasePieces(const Cut<V>& c) {
    constexpr int HINGES = EdgeShape::HINGES, MIDDLE = HINGES;
    at_grip[MIDDLE] = c.grip_depth, fall[MIDDLE] = c.fall;
    place[0] = c.x[1], place[COUNT] = c.x[0];
    const V cosine = c.cosine(), half = 0.5 * (c.x[0] - c.x[1]);
    for (int k = 0; k < 2; k++) {
      const double to = k == 0 ? 1.0 : -1.0;
      V rises[HINGES];
      c.shape->find_rises(V(to * c.sine), cosine, rises);
      for (int hinge = 0; hinge < HINGES; hinge++) {
        const int inner = MIDDLE + (k == 0 ? hinge : -hinge), outer = inner + (k == 0 ? 1 : -1);
        const V width = minimum(V(c.shape->width(hinge) / c.widening), half), at = c.x[k] - to * width;
        const V rise = to * rises[hinge] * c.widening;
        place[k == 0 ? outer : inner] = at;
        fall[outer] = fall[inner] - rise, at_grip[outer] = at_grip[inner] + rise * at;
      }
    }
  }

  V depth(int piece, V x) const { return at_grip[piece] + fall[piece] * x; }
  // Depth at an end of pieces.
  V end_depth(int end) const { return depth(std::min(end, COUNT - 1), place[end]); }

  // The deepest place, and the stretch that is in the snow: nothing at the deepest place if that is above it.
  void find_wet(V& deepest, V& from, V& to) const {
    V deep = end_depth(0), at = place[0];
    for (int end = 1; end <= COUNT; end++) {
      const V next = end_depth(end);
      at = select(next > deep, place[end], at), deep = maximum(next, deep);
    }
    deepest = deep, from = to = at;
    for (int end = 0; end < COUNT; end++) {
      const V a = end_depth(end), b = end_depth(end + 1), width = place[end + 1] - place[end];
      const MaskOf<V> crosses = (a > 0.0) != (b > 0.0);
      const V water = place[end] + width * (a / select(crosses, V(a - b), all<V>(1.0)));
      from = select(crosses & (b > 0.0), water, from), to = select(crosses & (a > 0.0), water, to);
    }
    const MaskOf<V> wet = deep > 0.0;
    from = select(wet & (end_depth(0) > 0.0), place[0], from);
    to = select(wet & (end_depth(COUNT) > 0.0), place[COUNT], to);
  }
};

// [cross_grip] The station at which the bent base's grip passes each line, by Newton's method from the crossing of the
// ski's straight axis. A section that misses its line by m leaves the place of a curved edge wrong by ½ κ m², and its
// rate by m dκ/dt: a shovel or tail that ploughs would gain energy from the shear. A line farther off than
// LONGEST keeps the crossing: one across the ski has no other. GRIP_REACH is over the half width until the base is cut.
template <class V>
void cross_grip(const Runner& runner, const Pose& pose, Base& s) {
  constexpr double LONGEST = 0.1;  // correction (m)
  constexpr int STEPS = 2;
  for (int step = 0; step < STEPS; step++)  // outside: lines next to each other wait for no result of each other
    for (int i = 0; i < s.count(); i += WIDTH<V>) {
      if (!s.wants(Base::STATIONS, i)) continue;
      const Vector<V> from = load3<V>(s, FROM_BOOT_0, i), ahead = load3<V>(s, LINE_AHEAD_0, i);
      const V crossing = from.x + (from.y * ahead.y + from.z * ahead.z) / ahead.x;
      const V on_ski = within(step == 0 ? crossing : load<V>(s[STATION] + i), runner.tail, runner.tip);
      const BentBase<V> base(runner, pose, on_ski);
      Cut<V> c(base, on_ski, s, i);
      c.side = grip_side(base, on_ski, c.from, c.ahead, c.normal);
      c.find_grip();
      const V way = c.way_to_line(), station = on_ski + within(way, -LONGEST, LONGEST);
      const bool is_last = step + 1 == STEPS;
      store(s[STATION] + i, is_last ? select(absolute(way) < LONGEST, station, crossing) : station);
      store(s[GRIP_REACH] + i, c.side);
    }
}

// [cut_base] The bent base over each line and its plane section: grip and edges, directions, where the base is wet.
template <class V>
void cut_base(const Runner& runner, const Pose& pose, const GrooveLines& lines, Base& s) {
  for_lanes<V>(s, lines, [&](int i, int) {
    if (!s.wants(Base::SECTIONS, i)) return;
    if (!any(load<V>(s[SHARE] + i) > 0.0)) {
      store(s[DEEPEST] + i, V{});
      return;
    }
    const V station = load<V>(s[STATION] + i);
    const BentBase<V> base(runner, pose, station);
    store(s[HALF_WIDTH] + i, base.shape[0]), store(s[FLARE] + i, base.shape[1]);
    store(s[BASE_HEIGHT] + i, base.shape[2]), store(s[BASE_RISE] + i, base.shape[3]);
    store(s[ELEMENT] + i, base.element), store(s[ELEMENT_LENGTH] + i, base.length);
    store(s[IN_ELEMENT] + i, base.in_element), store(s[TWIST_SLOPE] + i, base.twist_slope);
    store(s[TWIST_SINE] + i, base.sine), store(s[TWIST_COSINE] + i, base.cosine);
    Cut<V> c(base, station, s, i);
    c.cut();
    c.store_at(s, i);
  });
}

template <class V>
void find_sections(const Runner& runner, const Pose& pose, const GrooveLines& lines, const double* of, Base& s) {
  s.cover(lines, of);
  s.edge_shape = runner.edge_shape;
  take_lines<V>(pose, lines, s);
  cross_grip<V>(runner, pose, s);
  give_share<V>(runner, lines, s);
  cut_base<V>(runner, pose, lines, s);
}

}  // namespace skisnow::SKISNOW_LANES
