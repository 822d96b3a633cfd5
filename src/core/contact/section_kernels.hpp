// Where the base of a runner lies over each line.
#pragma once

#include <algorithm>

#include "contact/lane_loops.hpp"

namespace skisnow::SKISNOW_LANES {

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
  store(s[TABLE_PLACE] + i, within((station - runner.tail) * runner.places_per_metre(), 0.0, runner.places - 1.0));
}

// [edge_side] From the ski's middle (0) to one of its edges (1, -1) as the edge angle grows to that of the blend. Of a
// level base it does not move as the base rolls: the hold of the snow would be drawn along, and a run straight down
// begin to swing by itself.
template <class V>
inline V edge_side_of(V tilt) {
  const V within_one = within(tilt, -1.0, 1.0), size = absolute(within_one);
  return within_one * size * (3.0 - 2.0 * size);
}

// [cross_axis] Where along the ski's straight axis each line passes.
template <class V>
void cross_axis(const Runner& runner, const Snow& snow, const GrooveLines& lines, Sections& s) {
  const double per_blend = 1.0 / snow.edge_blend_sine;
  for_lanes<V>(s, lines, [&](int i, int) {
    const Vector<V> from = load3<V>(s, FROM_BOOT_0, i), ahead = load3<V>(s, LINE_AHEAD_0, i);
    const V forwards = 1.0 / ahead.x;
    const V crossing = from.x + (from.y * ahead.y + from.z * ahead.z) * forwards;
    const V edge_side = edge_side_of<V>(-load<V>(s[LINE_NORMAL_1] + i) * per_blend);
    store(s[AXIS_CROSSING] + i, crossing);
    store(s[TOWARD_EDGE] + i, edge_side * ahead.y * forwards);
    store(s[UPWARD] + i, ahead.z * forwards);
    store_table_place<V>(runner, s, i, crossing);
  });
}

inline double looked_up(const Runner& runner, const Sections& s, int i, int column) {
  const int row = std::min(int(s[TABLE_PLACE][i]), runner.places - 2);
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

// [give_share] The length of ski that each line stands for: halfway to its neighbours, and no farther than tip and
// tail.
template <class V>
void give_share(const Runner& runner, const GrooveLines& lines, Sections& s) {
  const double half = 0.5 * lines.spacing();
  const double* station = s[STATION];
  const int first = std::max(s.index(lines.first), 0), end = std::min(s.index(lines.end), s.count());
  const auto on_ski = [&](double place) { return std::min(std::max(place, runner.tail), runner.tip); };
  for (int i = 0; i < s.count(); i++) s[SHARE][i] = 0.0;
  double rear = first < end ? on_ski(station[first] - half) : 0.0;
  for (int i = first; i < end; i++) {
    const double front = on_ski(i + 1 < end ? 0.5 * (station[i] + station[i + 1]) : station[i] + half);
    s[SHARE][i] = std::max(front - rear, 0.0);
    rear = front;
  }
  for_lanes<V>(s, lines,
               [&](int i, int) { store(s[STATION] + i, within(load<V>(s[STATION] + i), runner.tail, runner.tip)); });
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
    for (int k = 0; k < 6; k++)
      s[SectionField(FRONT_DEFLECTION + k)][i] = bends ? pose.beam[std::size_t(3 * e + k)] : 0.0;
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

// The section of one line through the base.
template <class V>
struct Cut {
  // of the bent base: the section's place along the ski, half width and its slope, height and its slope, sine and
  // cosine of the twist and its slope; how far its middle lies to the left of the ski's axis (for differences)
  V station, half, flare, height, rise, sp, cp, twist_slope, aside{};
  Vector<V> from, ahead, normal, left;  // the line
  V sine, deepest, reach, edge_depth, edge_left, edge_up, place;
  V fall, climb, widening, wet_from, wet_to;
  Vector<V> across, along;
  V size;  // one over the length of `along` before it was made a unit

  // The base as it is bent, not yet cut.
  Cut(const Sections& s, int i) {
    station = load<V>(s[STATION] + i), half = load<V>(s[HALF_WIDTH] + i), flare = load<V>(s[FLARE] + i);
    height = load<V>(s[BASE_HEIGHT] + i), rise = load<V>(s[BASE_RISE] + i);
    sp = load<V>(s[TWIST_SINE] + i), cp = load<V>(s[TWIST_COSINE] + i), twist_slope = load<V>(s[TWIST_SLOPE] + i);
    from = load3<V>(s, FROM_BOOT_0, i), ahead = load3<V>(s, LINE_AHEAD_0, i);
    normal = load3<V>(s, LINE_NORMAL_0, i), left = load3<V>(s, LINE_LEFT_0, i);
  }

  // A section that was cut and stored.
  static Cut stored(const Sections& s, int i) {
    Cut c(s, i);
    c.sine = load<V>(s[EDGE_SINE] + i), c.deepest = load<V>(s[DEEPEST] + i), c.reach = load<V>(s[EDGE_REACH] + i);
    c.edge_depth = load<V>(s[EDGE_DEPTH] + i), c.edge_left = load<V>(s[EDGE_LEFT] + i);
    c.edge_up = load<V>(s[EDGE_UP] + i), c.place = load<V>(s[EDGE_PLACE] + i), c.fall = load<V>(s[DEPTH_FALL] + i);
    c.climb = load<V>(s[DEPTH_CLIMB] + i), c.widening = load<V>(s[BASE_WIDENING] + i);
    c.wet_from = load<V>(s[WET_FROM] + i), c.wet_to = load<V>(s[WET_TO] + i);
    c.across = load3<V>(s, ACROSS_0, i), c.along = load3<V>(s, ALONG_0, i), c.size = load<V>(s[ALONG_SIZE] + i);
    return c;
  }

  void store_at(Sections& s, int i) const {
    store(s[EDGE_SINE] + i, sine), store(s[DEEPEST] + i, deepest), store(s[EDGE_REACH] + i, reach);
    store(s[EDGE_DEPTH] + i, edge_depth), store(s[EDGE_LEFT] + i, edge_left), store(s[EDGE_UP] + i, edge_up);
    store(s[EDGE_PLACE] + i, place), store(s[DEPTH_FALL] + i, fall), store(s[DEPTH_CLIMB] + i, climb);
    store(s[BASE_WIDENING] + i, widening), store(s[WET_FROM] + i, wet_from), store(s[WET_TO] + i, wet_to);
    store3(s, ACROSS_0, i, across), store3(s, ALONG_0, i, along), store(s[ALONG_SIZE] + i, size);
  }

  // [edge] The deeper edge: where it is, how deep; the fall of the depth to the left.
  void find_edge(double per_blend) {
    const V middle = (from.x - station) * normal.x + (from.y - aside) * normal.y + (from.z - height) * normal.z;
    sine = sp * normal.z - cp * normal.y;
    deepest = middle + half * absolute(sine);
    const V side = edge_side_of<V>(sine * per_blend);
    reach = side * half;
    edge_depth = middle + reach * sine;
    edge_left = aside + reach * cp;
    edge_up = height - reach * sp;
    const V outwards = flare * side, twisting = reach * twist_slope;
    raw_ = {all<V>(1.0), outwards * cp - twisting * sp, rise - outwards * sp - twisting * cp};
    normal_ahead_ = twisting - rise * cp;
    steep_ = 1.0 / (normal_ahead_ * normal.x + sp * normal.y + cp * normal.z);
    fall = (normal_ahead_ * left.x + sp * left.y + cp * left.z) * steep_;
  }

  // [edge_place] Where it crosses the line; beyond tip and tail it goes on along its own direction.
  void find_place() {
    const V beyond = (from.x - station) * ahead.x + (from.y - edge_left) * ahead.y + (from.z - edge_up) * ahead.z;
    place = (station - from.x) * left.x + (edge_left - from.y) * left.y + (edge_up - from.z) * left.z +
            beyond * dot(raw_, left) / dot(raw_, ahead);
  }

  // [wet_base] Where on the line the base is in the snow.
  void find_wet() {
    widening = cp * left.y - sp * left.z + fall * sine;
    const V right_end = -(half + reach) / widening, left_end = (half - reach) / widening;
    const V down = select(absolute(fall) > LEVEL, fall, all<V>(LEVEL)), water = -edge_depth / down;
    wet_from = select(down > 0.0, maximum(right_end, water), right_end);
    wet_to = select(down > 0.0, left_end, minimum(left_end, water));
  }

  // [edge_directions] In the surface: across the edge and along it; how fast the depth grows along it.
  void find_directions() {
    const Vector<V> raw = cross(normal, raw_);
    size = 1.0 / root(dot(raw, raw));
    across = scaled(raw, size), along = cross(across, normal);
    climb = (normal_ahead_ * along.x + sp * along.y + cp * along.z) * steep_;
  }

  void cut(const Snow& snow) {
    find_edge(1.0 / snow.edge_blend_sine);
    find_place();
    find_wet();
    find_directions();
  }

 private:
  static constexpr double LEVEL = 1e-12;  // fall of the depth across below which a base is level
  Vector<V> raw_;                         // along the edge, 1 ahead
  V normal_ahead_, steep_;
};

// [cut_base] The plane section of the base over each line: the deeper edge, directions, where the base is wet.
template <class V>
void cut_base(const Snow& snow, const GrooveLines& lines, Sections& s) {
  for_lanes<V>(s, lines, [&](int i, int) {
    Cut<V> c(s, i);
    c.cut(snow);
    c.store_at(s, i);
  });
}

template <class V>
void find_sections(const Runner& runner, const Pose& pose, const Snow& snow, const GrooveLines& lines,
                   std::int64_t first, Sections& s) {
  s.prepare(lines, first);
  take_lines<V>(pose, lines, s);
  cross_axis<V>(runner, snow, lines, s);
  cross_edge<V>(runner, lines, s);
  give_share<V>(runner, lines, s);
  look_up(runner, pose, s);
  bend<V>(lines, s);
  cut_base<V>(snow, lines, s);
}

}  // namespace skisnow::SKISNOW_LANES
