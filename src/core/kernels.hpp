// Sections, pressure and forces over lanes of lines. Compiled once for each instruction set.
//
// Equations: docs/methods/contact.md; the names in brackets there are those of the functions here.
#pragma once

#include <algorithm>

#include "sections.hpp"

namespace skisnow::SKISNOW_LANES {

// A loop over all lanes of the sections; i: place in the columns, j: slot of the line.
template <class V, class Body>
inline void for_lanes(const Sections& s, const GrooveLines& lines, const Body& body) {
  for (int block = 0; block < s.blocks; block++) {
    const int slot = int((s.first_block + block) & (lines.blocks() - 1)) * BLOCK;
    for (int lane = 0; lane < BLOCK; lane += WIDTH<V>) body(block * BLOCK + lane, slot + lane);
  }
}

template <class V>
struct Vector {
  V x, y, z;
};

template <class V>
inline Vector<V> load3(const Sections& s, SectionField first, int i) {
  return {load<V>(s[first] + i), load<V>(s[SectionField(first + 1)] + i), load<V>(s[SectionField(first + 2)] + i)};
}

template <class V>
inline void store3(Sections& s, SectionField first, int i, const Vector<V>& v) {
  store(s[first] + i, v.x);
  store(s[SectionField(first + 1)] + i, v.y);
  store(s[SectionField(first + 2)] + i, v.z);
}

template <class V>
inline V dot(const Vector<V>& a, const Vector<V>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class V>
inline Vector<V> cross(const Vector<V>& a, const Vector<V>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class V>
inline Vector<V> scaled(const Vector<V>& a, V size) {
  return {a.x * size, a.y * size, a.z * size};
}

// ---- sections -----------------------------------------------------------------------------------------------------

// [take_lines] Lines in the ski's axes.
template <class V>
void take_lines(const Pose& pose, const GrooveLines& lines, Sections& s) {
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
    Vector<V> origin = line3(ORIGIN_X, j);
    origin = {origin.x - c[0], origin.y - c[1], origin.z - c[2]};
    const Vector<V> ahead = turned(line3(AHEAD_X, j)), normal = turned(line3(NORMAL_X, j));
    store3(s, FROM_BOOT_0, i, turned(origin));
    store3(s, LINE_AHEAD_0, i, ahead);
    store3(s, LINE_NORMAL_0, i, normal);
    store3(s, LINE_LEFT_0, i, cross(normal, ahead));
  });
}

template <class V>
inline void store_table_place(const Runner& runner, Sections& s, int i, V station) {
  store(s[TABLE_PLACE] + i,
        within((station - runner.tail) * runner.places_per_metre(), 0.0, runner.places - 1.000001));
}

// [cross_axis] Where along the ski's straight axis each line passes.
template <class V>
void cross_axis(const Runner& runner, const Snow& snow, const GrooveLines& lines, Sections& s) {
  const double per_blend = 1.0 / snow.edge_blend_sine;
  for_lanes<V>(s, lines, [&](int i, int) {
    const Vector<V> from = load3<V>(s, FROM_BOOT_0, i), ahead = load3<V>(s, LINE_AHEAD_0, i);
    const V forwards = 1.0 / ahead.x;
    const V crossing = from.x + (from.y * ahead.y + from.z * ahead.z) * forwards;
    const V edge_side = within(-load<V>(s[LINE_NORMAL_1] + i) * per_blend, -1.0, 1.0);
    store(s[AXIS_CROSSING] + i, crossing);
    store(s[TOWARD_EDGE] + i, edge_side * ahead.y * forwards);
    store(s[UPWARD] + i, ahead.z * forwards);
    store_table_place<V>(runner, s, i, crossing);
  });
}

inline double looked_up(const Runner& runner, const Sections& s, int i, int column) {
  const int row = int(s[TABLE_PLACE][i]);
  const double part = s[TABLE_PLACE][i] - row;
  const double* table = runner.table.data() + 4 * row;
  return table[column] + part * (table[4 + column] - table[column]);
}

// [cross_edge] Where the deeper edge passes: two steps from the axis, whose error falls with the flare of the side.
template <class V>
void cross_edge(const Runner& runner, const GrooveLines& lines, Sections& s) {
  for (int step = 0; step < 2; step++) {
    for (int i = 0; i < s.count(); i++) {
      s[HALF_WIDTH][i] = looked_up(runner, s, i, 0);
      s[BASE_HEIGHT][i] = looked_up(runner, s, i, 2);
    }
    for_lanes<V>(s, lines, [&](int i, int) {
      const V station = load<V>(s[AXIS_CROSSING] + i) - load<V>(s[TOWARD_EDGE] + i) * load<V>(s[HALF_WIDTH] + i) -
                        load<V>(s[UPWARD] + i) * load<V>(s[BASE_HEIGHT] + i);
      store(s[STATION] + i, station);
      store_table_place<V>(runner, s, i, station);
    });
  }
}

// [give_share] The length of ski that each line stands for: its spacing, less at tip and tail.
template <class V>
void give_share(const Runner& runner, const GrooveLines& lines, Sections& s) {
  const double spacing = lines.spacing(), per_spacing = 1.0 / spacing;
  for_lanes<V>(s, lines, [&](int i, int) {
    const V station = load<V>(s[STATION] + i);
    const V from_tail = (station - runner.tail) * per_spacing + 0.5, from_tip = (runner.tip - station) * per_spacing + 0.5;
    store(s[SHARE] + i, within(from_tail, 0.0, 1.0) * within(from_tip, 0.0, 1.0) * spacing);
    store(s[STATION] + i, within(station, runner.tail, runner.tip));
  });
  for (int i = 0; i < s.count(); i++)
    if (s.line(i) < lines.first || s.line(i) >= lines.end) s[SHARE][i] = 0.0;
}

// [look_up] Shape of the base and nodes of the beam at each section.
inline void look_up(const Runner& runner, const Pose& pose, Sections& s) {
  constexpr SectionField shape[4] = {HALF_WIDTH, FLARE, BASE_HEIGHT, BASE_RISE};
  const bool bends = !pose.beam.empty();
  for (int i = 0; i < s.count(); i++) {
    for (int column = 0; column < 4; column++) s[shape[column]][i] = looked_up(runner, s, i, column);
    int e = runner.element[std::size_t(s[TABLE_PLACE][i])];
    const double* node = runner.node.data();
    if (s[STATION][i] > node[e] && e > 0) e--;
    s[ELEMENT][i] = e;
    s[ELEMENT_LENGTH][i] = node[e] - node[e + 1];
    s[IN_ELEMENT][i] = (node[e] - s[STATION][i]) / (node[e] - node[e + 1]);
    for (int k = 0; k < 6; k++) s[SectionField(FRONT_DEFLECTION + k)][i] = bends ? pose.beam[std::size_t(3 * e + k)] : 0.0;
  }
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

// [bend] Height and slope of the bent base; sine and cosine of its twist.
template <class V>
void bend(const GrooveLines& lines, Sections& s) {
  for_lanes<V>(s, lines, [&](int i, int) {
    const V z = load<V>(s[IN_ELEMENT] + i), h = load<V>(s[ELEMENT_LENGTH] + i), y = 1.0 - z, per_length = 1.0 / h;
    const V w = load<V>(s[FRONT_DEFLECTION] + i), a = load<V>(s[FRONT_SLOPE] + i), t = load<V>(s[FRONT_TWIST] + i);
    const V v = load<V>(s[REAR_DEFLECTION] + i), b = load<V>(s[REAR_SLOPE] + i), u = load<V>(s[REAR_TWIST] + i);
    const Shapes<V> shape(z, h);
    const V deflection = shape.front * w + shape.front_slope * a + shape.rear * v + shape.rear_slope * b;
    const V rise = 6.0 * z * y * per_length * (w - v) - y * (1.0 - 3.0 * z) * a - z * (3.0 * z - 2.0) * b;
    const V twist = y * t + z * u, q = twist * twist;
    store(s[BASE_HEIGHT] + i, load<V>(s[BASE_HEIGHT] + i) + deflection);
    store(s[BASE_RISE] + i, load<V>(s[BASE_RISE] + i) + rise);
    store(s[TWIST_SLOPE] + i, (t - u) * per_length);
    // series: the next terms are below 1e-9 at 0.3 rad
    store(s[TWIST_COSINE] + i, 1.0 - q * (0.5 - q * (1.0 / 24.0 - q * (1.0 / 720.0))));
    store(s[TWIST_SINE] + i, twist * (1.0 - q * (1.0 / 6.0 - q * (1.0 / 120.0 - q * (1.0 / 5040.0)))));
  });
}

// The section of one line through the base, as it is worked out.
template <class V>
struct Cut {
  V station, half, height, rise, sp, cp, twist_slope;
  Vector<V> from, ahead, normal, left;
  V sine, middle, deepest, side, reach, edge_depth, edge_left, edge_up;
  Vector<V> along;  // of the edge, 1 ahead
  V steep, normal_ahead, fall, place;

  // [edge] The deeper edge: where it is, how deep, and its direction.
  void find_edge(V flare, double per_blend) {
    middle = (from.x - station) * normal.x + from.y * normal.y + (from.z - height) * normal.z;
    sine = sp * normal.z - cp * normal.y;
    deepest = middle + half * absolute(sine);
    side = within(sine * per_blend, -1.0, 1.0);
    reach = side * half;
    edge_depth = middle + reach * sine;
    edge_left = reach * cp;
    edge_up = height - reach * sp;
    const V outwards = flare * side, twisting = reach * twist_slope;
    along = {all<V>(1.0), outwards * cp - twisting * sp, rise - outwards * sp - twisting * cp};
    normal_ahead = twisting - rise * cp;
    steep = 1.0 / (normal_ahead * normal.x + sp * normal.y + cp * normal.z);
    fall = (normal_ahead * left.x + sp * left.y + cp * left.z) * steep;
  }

  // [edge_place] Where it crosses the line; beyond tip and tail it goes on along its own direction.
  void find_place() {
    const V beyond = (from.x - station) * ahead.x + (from.y - edge_left) * ahead.y + (from.z - edge_up) * ahead.z;
    place = (station - from.x) * left.x + (edge_left - from.y) * left.y + (edge_up - from.z) * left.z +
            beyond * dot(along, left) / dot(along, ahead);
  }
};

constexpr double LEVEL = 1e-12;  // fall of the depth across below which a base is level

// [cut_base] The plane section of the base over each line: the deeper edge, directions, where the base is wet.
template <class V>
void cut_base(const Snow& snow, const GrooveLines& lines, Sections& s) {
  const double per_blend = 1.0 / snow.edge_blend_sine;
  for_lanes<V>(s, lines, [&](int i, int) {
    Cut<V> c;
    c.station = load<V>(s[STATION] + i), c.half = load<V>(s[HALF_WIDTH] + i), c.height = load<V>(s[BASE_HEIGHT] + i);
    c.rise = load<V>(s[BASE_RISE] + i), c.sp = load<V>(s[TWIST_SINE] + i), c.cp = load<V>(s[TWIST_COSINE] + i);
    c.twist_slope = load<V>(s[TWIST_SLOPE] + i);
    c.from = load3<V>(s, FROM_BOOT_0, i), c.ahead = load3<V>(s, LINE_AHEAD_0, i);
    c.normal = load3<V>(s, LINE_NORMAL_0, i), c.left = load3<V>(s, LINE_LEFT_0, i);
    c.find_edge(load<V>(s[FLARE] + i), per_blend);
    c.find_place();
    const V widening = c.cp * c.left.y - c.sp * c.left.z + c.fall * c.sine;
    const V right_end = -(c.half + c.reach) / widening, left_end = (c.half - c.reach) / widening;
    const V down = select(absolute(c.fall) > LEVEL, c.fall, all<V>(LEVEL)), water = -c.edge_depth / down;
    const Vector<V> raw = cross(c.normal, c.along);
    const V size = 1.0 / root(dot(raw, raw));
    const Vector<V> across = scaled(raw, size), along = cross(across, c.normal);
    store(s[EDGE_SINE] + i, c.sine), store(s[DEEPEST] + i, c.deepest), store(s[EDGE_DEPTH] + i, c.edge_depth);
    store(s[EDGE_REACH] + i, c.reach), store(s[EDGE_LEFT] + i, c.edge_left), store(s[EDGE_UP] + i, c.edge_up);
    store(s[EDGE_PLACE] + i, c.place), store(s[DEPTH_FALL] + i, c.fall), store(s[BASE_WIDENING] + i, widening);
    store(s[WET_FROM] + i, select(down > 0.0, maximum(right_end, water), right_end));
    store(s[WET_TO] + i, select(down > 0.0, left_end, minimum(left_end, water)));
    store3(s, ACROSS_0, i, across);
    store3(s, ALONG_0, i, along);
    store(s[ALONG_SIZE] + i, size);
    store(s[DEPTH_CLIMB] + i, (c.normal_ahead * along.x + c.sp * along.y + c.cp * along.z) * c.steep);
  });
}

template <class V>
void find_sections(const Runner& runner, const Pose& pose, const Snow& snow, const GrooveLines& lines, Sections& s) {
  s.prepare(lines);
  take_lines<V>(pose, lines, s);
  cross_axis<V>(runner, snow, lines, s);
  cross_edge<V>(runner, lines, s);
  give_share<V>(runner, lines, s);
  look_up(runner, pose, s);
  bend<V>(lines, s);
  cut_base<V>(snow, lines, s);
}

// ---- pressure -----------------------------------------------------------------------------------------------------

// Integrals over the wet base of one line, in x from the edge. Virgin snow bears q = H (D + f x); where the ground was
// pressed deeper by a lift it bears q - E lift, where that pushes (E = k_u - H_V).
template <class V>
struct Pressure {
  V hardness, excess, depth, fall;
  V q0{}, q1{}, l0{}, l1{}, l2{};  // of 1 and x over what bears as virgin snow less all that was pressed deeper;
  V q2{};                          // of lift, lift x and lift² over what bears there

  // [press_piece] A straight piece of ground from a to b (within the wet base), its lift there `lift + slope x`.
  void add(V a, V b, V lift, V slope) {
    const V zero = -lift / select(absolute(slope) > 1e-30, slope, all<V>(1e-30));
    const MaskOf<V> at_a = lift + slope * a > THIN, at_b = lift + slope * b > THIN;
    const V middle = minimum(maximum(zero, a), b);
    const V c = select(at_a, a, select(at_b, middle, b)), d = select(at_b, b, select(at_a, middle, b));
    // what bears: the pressure r there is above zero from u to v
    const V r = hardness * depth - excess * lift, r_slope = hardness * fall - excess * slope;
    V none = -r / select(absolute(r_slope) > 1e-30, r_slope, all<V>(1e-30));
    none = minimum(maximum(none, c), d);
    const MaskOf<V> at_c = r + r_slope * c > 0.0, at_d = r + r_slope * d > 0.0;
    const V u = select(at_c, c, select(at_d, none, d)), v = select(at_d, d, select(at_c, none, d));
    const V width = v - u, covered = d - c, both = v + u, ends = d + c;
    q0 += width - covered;
    q1 += width * both - covered * ends;
    q2 += width * (both * both - u * v) - covered * (ends * ends - c * d);
    const V lift_u = lift + slope * u, lift_v = lift + slope * v;
    l0 += 0.5 * width * (lift_u + lift_v);
    l1 += width * (1.0 / 6.0) * (lift_u * (2.0 * u + v) + lift_v * (u + 2.0 * v));
    l2 += width * (1.0 / 3.0) * (lift_u * lift_u + lift_u * lift_v + lift_v * lift_v);
  }

  // [resultants] Force and moment about the edge for each metre of ski, and elastic energy, of a base wet from a to b.
  void resultants(V a, V b, V& force, V& moment, V& energy) const {
    const V width = b - a, both = b + a;
    const V m0 = q0 + width, m1 = 0.5 * (q1 + width * both), m2 = (q2 + width * (both * both - b * a)) * (1.0 / 3.0);
    force = hardness * (depth * m0 + fall * m1) - excess * l0;
    moment = hardness * (depth * m1 + fall * m2) - excess * l1;
    const V squared = depth * depth * m0 + 2.0 * depth * fall * m1 + fall * fall * m2;
    const V crossed = 2.0 * hardness * excess * (depth * l0 + fall * l1);
    energy = 0.5 * (hardness * hardness * squared - crossed + excess * excess * l2) / (hardness + excess);
  }
};

// The ground that an edge has cut since the last accepted pose as it went away from its base: as deep as the edge was
// when it passed. `from` to `to` in x, none where they are equal.
template <class V>
struct CutGround {
  V from, to, slope;

  CutGround(const GrooveLines& lines, int j, V edge, V depth, V wet_from, V wet_to) {
    const V before = load<V>(lines.values[EDGE_MARKED] + j) - edge;
    const MaskOf<V> marked = load<V>(lines.values[MARKED] + j) > 0.5;
    const MaskOf<V> to_left = marked & (before > 0.0) & (wet_from == 0.0);
    const MaskOf<V> to_right = marked & (before < 0.0) & (wet_to == 0.0);
    const V none{};
    from = select(to_right, maximum(before, wet_from), none);
    to = select(to_left, minimum(before, wet_to), none);
    slope = (load<V>(lines.values[DEPTH_MARKED] + j) - depth) / select(to_left | to_right, before, all<V>(1.0));
  }
};

// [press_line] Pressure of the ground's pieces; what was cut within the step counts where it lies deeper.
template <class V>
void add_ground(const GrooveLines& lines, int j, V edge, V wet_from, V wet_to, Pressure<V>& out) {
  const CutGround<V> cut(lines, j, edge, out.depth, wet_from, wet_to);
  int most = 0;
  for (int lane = 0; lane < WIDTH<V>; lane++) most = std::max<int>(most, lines.knots[std::size_t(j + lane)]);
  const double* place = lines.place.data() + lines.tile(j, 0);
  const double* depth = lines.depth.data() + lines.tile(j, 0);
  const double* slope = lines.slope.data() + lines.tile(j, 0);
  // over the cut: the part before the ground's first knot, the pieces, the part behind the last one
  const auto inside = [](V x, V low, V high) { return minimum(maximum(x, low), high); };
  const auto cut_piece = [&](V a, V b) {
    const V low = inside(a, cut.from, cut.to), high = inside(b, cut.from, cut.to);
    out.add(low, maximum(low, high), V{}, cut.slope - out.fall);
  };
  const bool cuts = any(cut.to > cut.from);
  V a = load<V>(place) - edge;
  if (most < 2) {
    if (cuts) cut_piece(cut.from, cut.to);
    return;
  }
  if (cuts) cut_piece(cut.from, a);
  for (int k = 0; k + 1 < most; k++) {
    const V b = load<V>(place + BLOCK * (k + 1)) - edge, ground = load<V>(slope + BLOCK * k);
    const V lift = load<V>(depth + BLOCK * k) - ground * a - out.depth, rise = ground - out.fall;
    const V low = inside(a, wet_from, wet_to), high = inside(b, wet_from, wet_to);
    if (!cuts) {
      out.add(low, high, lift, rise);
    } else {
      // beside the cut the ground as it was, over it the deeper of both
      const V first = inside(cut.from, low, high), last = inside(cut.to, low, high);
      const V cut_rise = cut.slope - out.fall, apart = rise - cut_rise;
      V meet = -lift / select(absolute(apart) > 1e-30, apart, all<V>(1e-30));
      meet = inside(meet, first, last);
      const V at_first = 0.5 * (first + meet), at_last = 0.5 * (meet + last);
      const MaskOf<V> old_first = lift + apart * at_first > 0.0, old_last = lift + apart * at_last > 0.0;
      out.add(low, first, lift, rise);
      out.add(first, meet, select(old_first, lift, V{}), select(old_first, rise, cut_rise));
      out.add(meet, last, select(old_last, lift, V{}), select(old_last, rise, cut_rise));
      out.add(last, high, lift, rise);
    }
    a = b;
  }
  if (cuts) cut_piece(a, cut.to);
}

// [press] What the snow answers to each section, and how far the shear at its edge is displaced.
template <class V>
void press(const Snow& snow, const GrooveLines& lines, Sections& s) {
  for_lanes<V>(s, lines, [&](int i, int j) {
    const V share = load<V>(s[SHARE] + i), deepest = load<V>(s[DEEPEST] + i), none{};
    const MaskOf<V> wet = (share > 0.0) & (deepest > 0.0);
    for (SectionField field : {FORCE, MOMENT, SNOW_ENERGY, SHEAR_USED, EDGE_STRENGTH, EDGE_THRUST}) store(s[field] + i, none);
    if (!any(wet)) return;
    const V edge = load<V>(s[EDGE_PLACE] + i), wet_from = load<V>(s[WET_FROM] + i);
    const V wet_to = maximum(load<V>(s[WET_TO] + i), wet_from);
    Pressure<V> sums;
    sums.hardness = load<V>(lines.values[HARDNESS] + j), sums.excess = load<V>(lines.values[EXCESS] + j);
    sums.depth = load<V>(s[EDGE_DEPTH] + i), sums.fall = load<V>(s[DEPTH_FALL] + i);
    if (snow.unloading_ratio > 1.0) add_ground(lines, j, edge, wet_from, wet_to, sums);
    V force, moment, energy;
    sums.resultants(wet_from, wet_to, force, moment, energy);
    store(s[FORCE] + i, select(wet, share * force, none));
    store(s[MOMENT] + i, select(wet, share * moment, none));
    store(s[SNOW_ENERGY] + i, select(wet, share * energy, none));
    // the edge holds where it did before, else where it came through the surface since it was last looked at
    const V above = load<V>(lines.values[DEPTH_ABOVE] + j), edge_above = load<V>(lines.values[EDGE_ABOVE] + j);
    const V through = edge - deepest / (deepest - above) * (edge - edge_above);
    const V anchor = select(load<V>(lines.values[ANCHORED] + j) > 0.5, load<V>(lines.values[ANCHOR] + j),
                            select(load<V>(lines.values[ABOVE] + j) > 0.5, through, edge));
    store(s[SHEAR_USED] + i, select(wet, (anchor - edge) / snow.shear_displacement, none));
    store(s[EDGE_STRENGTH] + i, select(wet, load<V>(lines.values[STRENGTH] + j), none));
  });
}

// ---- what acts along and across the edge --------------------------------------------------------------------------

// Motion of the boot in the ski's axes.
struct BootMotion {
  double v[3], o[3];

  BootMotion(const Motion& motion, const Pose& pose) {
    for (int a = 0; a < 3; a++) {
      v[a] = o[a] = 0.0;
      for (int b = 0; b < 3; b++) {
        v[a] += pose.rotation[b][a] * motion.velocity[std::size_t(b)];
        o[a] += pose.rotation[b][a] * motion.turning[std::size_t(b)];
      }
    }
  }
};

// The centre of pressure of a section: where it lies, and how far across the base from the ski's middle.
template <class V>
struct Centre {
  Vector<V> at;
  V arm;

  Centre(const Sections& s, int i) {
    const V force = load<V>(s[FORCE] + i), moment = load<V>(s[MOMENT] + i), fall = load<V>(s[DEPTH_FALL] + i);
    const V off = moment / select(force > 0.0, force, all<V>(1.0));
    const Vector<V> left = load3<V>(s, LINE_LEFT_0, i), normal = load3<V>(s, LINE_NORMAL_0, i);
    at = {load<V>(s[STATION] + i) + off * (left.x - fall * normal.x),
          load<V>(s[EDGE_LEFT] + i) + off * (left.y - fall * normal.y),
          load<V>(s[EDGE_UP] + i) + off * (left.z - fall * normal.z)};
    arm = load<V>(s[EDGE_REACH] + i) + off * load<V>(s[BASE_WIDENING] + i);
  }
};

// Rates of the beam at a section: of its deflection and of its twist.
inline void beam_rates(const Motion& motion, const Sections& s, int i, double& deflection, double& twist) {
  deflection = twist = 0.0;
  if (motion.beam.empty()) return;
  typedef LaneTypes<2>::Value Pair;
  const double z = s[IN_ELEMENT][i];
  const double* rate = motion.beam.data() + 3 * int(s[ELEMENT][i]);
  const Shapes<Pair> shape(all<Pair>(z), all<Pair>(s[ELEMENT_LENGTH][i]));
  deflection = shape.front[0] * rate[0] + shape.front_slope[0] * rate[1] + shape.rear[0] * rate[3] +
               shape.rear_slope[0] * rate[4];
  twist = (1.0 - z) * rate[2] + z * rate[5];
}

// [slide] Speed along the edge at the centre of pressure, and the law's μ.
template <class V>
void slide(const Motion& motion, const Pose& pose, const Snow& snow, Sections& s) {
  const BootMotion m(motion, pose);
  const FrictionLaw& law = snow.friction;
  const double fade = law.fade_speed * law.fade_speed;
  for (int i = 0; i < s.count(); i++) beam_rates(motion, s, i, s[BEAM_FORCE][i], s[BEAM_MOMENT][i]);
  for (int i = 0; i < s.count(); i += WIDTH<V>) {
    const Centre<V> centre(s, i);
    const V sp = load<V>(s[TWIST_SINE] + i), cp = load<V>(s[TWIST_COSINE] + i);
    const V deflecting = load<V>(s[BEAM_FORCE] + i), turning = load<V>(s[BEAM_MOMENT] + i) * centre.arm;
    const Vector<V> velocity{m.v[0] + m.o[1] * centre.at.z - m.o[2] * centre.at.y,
                             m.v[1] + m.o[2] * centre.at.x - m.o[0] * centre.at.z - sp * turning,
                             m.v[2] + m.o[0] * centre.at.y - m.o[1] * centre.at.x + deflecting - cp * turning};
    const V sliding = dot(velocity, load3<V>(s, ALONG_0, i)), speed = absolute(sliding);
    const V mu = law.constant + speed * (law.linear + law.square * speed) + law.film / (1.0 + speed / law.film_speed);
    store(s[SLIDING] + i, sliding);
    store(s[FRICTION] + i, mu * sliding / root(sliding * sliding + fade));
  }
}

// [push] All forces of the sections, summed to the wrench on the boot and the loads of the beam.
template <class V>
void push(const Motion&, const Pose&, const Snow& snow, Sections& s, Wrench& out) {
  Sum f[3], g[3];
  const double compaction = snow.compaction_resistance ? 1.0 : 0.0;
  for (int i = 0; i < s.count(); i += WIDTH<V>) {
    const int lane = i % BLOCK;
    const V share = load<V>(s[SHARE] + i), deepest = load<V>(s[DEEPEST] + i), none{};
    const MaskOf<V> wet = (share > 0.0) & (deepest > 0.0);
    const Centre<V> centre(s, i);
    const V force = load<V>(s[FORCE] + i), sine = load<V>(s[EDGE_SINE] + i);
    const V by_twist = load<V>(s[TWIST_SLOPE] + i) * load<V>(s[MOMENT] + i) / (1.0 - sine * sine) * load<V>(s[ALONG_SIZE] + i);
    const V resistance = (force * load<V>(s[DEPTH_CLIMB] + i) + by_twist) * compaction;
    const V along = select(wet, resistance - load<V>(s[FRICTION] + i) * force, none);
    const V used = within(load<V>(s[SHEAR_USED] + i), -1.0, 1.0), area = deepest * share;
    const V shear = select(wet, load<V>(s[EDGE_STRENGTH] + i) * area * used, none);
    const V thrust = select(wet, load<V>(s[EDGE_THRUST] + i) * area * absolute(used), none);
    const Vector<V> n = load3<V>(s, LINE_NORMAL_0, i), t = load3<V>(s, ALONG_0, i);
    const Vector<V> a{force * n.x + along * t.x, force * n.y + along * t.y, force * n.z + along * t.z};
    const Vector<V> across = load3<V>(s, ACROSS_0, i);
    const Vector<V> z{shear * across.x + thrust * n.x, shear * across.y + thrust * n.y, shear * across.z + thrust * n.z};
    const Vector<V> edge{load<V>(s[STATION] + i), load<V>(s[EDGE_LEFT] + i), load<V>(s[EDGE_UP] + i)};
    const Vector<V> moment = cross(centre.at, a), edge_moment = cross(edge, z);
    const V sp = load<V>(s[TWIST_SINE] + i), cp = load<V>(s[TWIST_COSINE] + i);
    f[0].add(lane, select(wet, a.x + z.x, none)), f[1].add(lane, select(wet, a.y + z.y, none)), f[2].add(lane, select(wet, a.z + z.z, none));
    g[0].add(lane, select(wet, moment.x + edge_moment.x, none));
    g[1].add(lane, select(wet, moment.y + edge_moment.y, none));
    g[2].add(lane, select(wet, moment.z + edge_moment.z, none));
    store(s[SHEAR] + i, shear);
    store(s[PUSH] + i, along);
    store(s[BEAM_FORCE] + i, select(wet, a.z + z.z, none));
    store(s[BEAM_MOMENT] + i, select(wet, -centre.arm * (sp * a.y + cp * a.z) - load<V>(s[EDGE_REACH] + i) * (sp * z.y + cp * z.z), none));
  }
  for (int a = 0; a < 3; a++) out.force[a] = f[a].total(), out.moment[a] = g[a].total();
}

extern const Kernels SET;

}  // namespace skisnow::SKISNOW_LANES
