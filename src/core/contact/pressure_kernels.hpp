// What the ground under each section answers.
#pragma once

#include <algorithm>

#include "contact/section_kernels.hpp"
#include "snow/hypoplastic.hpp"

namespace skisnow::SKISNOW_LANES {

// Integrals over the wet base of one line, in x from the edge. Virgin snow bears q = H (D + f x); where the ground was
// pressed deeper by a lift it bears q - E lift, where that pushes (E = k_u - H_V).
template <class V>
struct Pressure {
  V hardness, excess, depth, fall;
  V q0{}, q1{}, l0{}, l1{}, l2{};  // of 1 and x over what bears as virgin snow less all that was pressed deeper;
  V q2{};                          // of lift, lift x and lift² over what bears there

  // [press_piece] A straight piece of ground from a to b (within the wet base), its lift there `lift + slope x`.
  void add(V a, V b, V lift, V slope) {
    if (!any(a < b)) return;
    const auto [c, d, u, v] = pressed_part(a, b, depth, fall, lift, slope, hardness, excess, THIN);
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

template <class V>
V inside(V x, V low, V high) {
  return minimum(maximum(x, low), high);
}

// Add a piece of ground between two places, over the base by `lift` at the edge and `rise` more for each metre; over
// the cut the deeper of both.
template <class V>
void add_piece(const CutGround<V>& cut, V low, V high, V lift, V rise, Pressure<V>& out) {
  if (!any((cut.from < high) & (cut.to > low) & (cut.from < cut.to))) {
    out.add(low, high, lift, rise);
    return;
  }
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
    a = b;
    if (any(low < high)) add_piece(cut, low, high, lift, rise, out);
  }
  if (cuts) cut_piece(a, cut.to);
}

// What the snow answers to the base on a line: force and its moment about the edge for each metre of ski, elastic
// energy.
template <class V>
struct Pressed {
  V force, moment, energy;

  Pressed(const Snow& snow, const GrooveLines& lines, int j, const Cut<V>& c) {
    const V wet_to = maximum(c.wet_to, c.wet_from);
    Pressure<V> sums;
    sums.hardness = load<V>(lines.values[HARDNESS] + j), sums.excess = load<V>(lines.values[EXCESS] + j);
    sums.depth = c.edge_depth, sums.fall = c.fall;
    if (snow.unloading_ratio > 1.0) add_ground(lines, j, c.place, c.wet_from, wet_to, sums);
    sums.resultants(c.wet_from, wet_to, force, moment, energy);
  }
};

// [shear_used] The share of the way to full strength by which the edge is displaced. It holds where it did before, else
// where it came through the surface since it was last looked at.
template <class V>
V shear_used(const Snow& snow, const GrooveLines& lines, int j, const Cut<V>& c) {
  const V above = load<V>(lines.values[DEPTH_ABOVE] + j), edge_above = load<V>(lines.values[EDGE_ABOVE] + j);
  const V through = c.place - c.deepest / (c.deepest - above) * (c.place - edge_above);
  const V anchor = select(load<V>(lines.values[ANCHORED] + j) > 0.5, load<V>(lines.values[ANCHOR] + j),
                          select(load<V>(lines.values[ABOVE] + j) > 0.5, through, c.place));
  return (anchor - c.place) / snow.shear_displacement;
}

// [strength_left] Of a strength, where an edge has slipped this far (m).
template <class V>
V strength_left(const ShearLaw& law, V slipped) {
  return 1.0 - (1.0 - law.residual_ratio) * minimum(slipped * (1.0 / law.weakening), all<V>(1.0));
}

// [press] What the snow answers to each section, and how far the shear at its edge is displaced.
template <class V>
void press(const Snow& snow, const GrooveLines& lines, Sections& s) {
  for_lanes<V>(s, lines, [&](int i, int j) {
    const V share = load<V>(s[SHARE] + i), none{};
    const Cut<V> c = Cut<V>::stored(s, i);
    const MaskOf<V> wet = (share > 0.0) & (c.deepest > 0.0);
    for (SectionField field : {FORCE, MOMENT, SNOW_ENERGY, SHEAR_USED, STRENGTH_LEFT, EDGE_STRENGTH, EDGE_THRUST})
      store(s[field] + i, none);
    if (!any(wet)) return;
    const Pressed<V> answer(snow, lines, j, c);
    store(s[FORCE] + i, select(wet, share * answer.force, none));
    store(s[MOMENT] + i, select(wet, share * answer.moment, none));
    store(s[SNOW_ENERGY] + i, select(wet, share * answer.energy, none));
    store(s[SHEAR_USED] + i, select(wet, shear_used(snow, lines, j, c), none));
    const V left = strength_left(snow.shear, load<V>(lines.values[SLIPPED] + j));
    store(s[STRENGTH_LEFT] + i, select(wet, left, none));
    store(s[EDGE_STRENGTH] + i, select(wet, snow.strength_share * load<V>(lines.values[STRENGTH] + j) * left, none));
  });
}

}  // namespace skisnow::SKISNOW_LANES
