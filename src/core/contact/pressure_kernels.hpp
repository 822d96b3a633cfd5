// Pressure of the ground on each section.
#pragma once

#include <algorithm>

#include "contact/section_kernels.hpp"
#include "snow/hypoplastic.hpp"

namespace skisnow::SKISNOW_LANES {

// Additional sums for the derivatives, over the parts that bear on ground that was pressed deeper: integrals of x and
// x²; of 1, x, x² and the ground's slope over ground from before the step; and what virgin snow's pressure has more
// than the ground's, E lift at most, at the ends of the pieces.
template <class V>
struct GrowthSums {
  V wet_from, wet_to;
  V x1{}, x2{}, old0{}, old1{}, old2{}, slope0{}, slope1{};
  V ends0{}, ends1{}, at_from{}, at_to{};
};

// Integrals over the wet base of one line, in x from the edge. Virgin snow bears q = H (D + f x); where the ground was
// pressed deeper by a lift it bears q - E lift, where that pushes (E = k_u - H_V).
template <class V>
struct Pressure {
  V hardness, excess, depth, fall;
  V q0{}, q1{}, l0{}, l1{}, l2{};   // of 1 and x over what bears as virgin snow less all that was pressed deeper;
  V q2{};                           // of lift, lift x and lift² over what bears there
  GrowthSums<V>* growth = nullptr;  // optional

  // [press_piece] A straight piece of ground from a to b (within the wet base), its lift there `lift + slope x`; `old`:
  // where it is ground from before the step.
  SKISNOW_INLINE void add(V a, V b, V lift, V slope, MaskOf<V> old) {
    if (!any(a < b)) return;
    const auto [c, d, u, v] = pressed_part(a, b, depth, fall, lift, slope, hardness, excess, THIN);
    if (growth != nullptr) grow(a, b, lift, slope, u, v, old);
    const V width = v - u, covered = d - c, both = v + u, ends = d + c;
    q0 += width - covered;
    q1 += width * both - covered * ends;
    q2 += width * (both * both - u * v) - covered * (ends * ends - c * d);
    const V lift_u = lift + slope * u, lift_v = lift + slope * v;
    l0 += 0.5 * width * (lift_u + lift_v);
    l1 += width * (1.0 / 6.0) * (lift_u * (2.0 * u + v) + lift_v * (u + 2.0 * v));
    l2 += width * (1.0 / 3.0) * (lift_u * lift_u + lift_u * lift_v + lift_v * lift_v);
  }

  void grow(V a, V b, V lift, V slope, V u, V v, MaskOf<V> old) {
    GrowthSums<V>& g = *growth;
    const V none{}, width = v - u, both = v + u, first = 0.5 * width * both;
    const V second = (1.0 / 3.0) * width * (both * both - u * v), ground = slope + fall;
    g.x1 += first, g.x2 += second;
    g.old0 += select(old, width, none), g.old1 += select(old, first, none), g.old2 += select(old, second, none);
    g.slope0 += select(old, ground * width, none), g.slope1 += select(old, ground * first, none);
    const auto missing = [&](V x) {
      return minimum(excess * maximum(lift + slope * x, none), hardness * (depth + fall * x));
    };
    const MaskOf<V> is_piece = a < b;
    const V at_a = select(is_piece, missing(a), none), at_b = select(is_piece, missing(b), none);
    g.ends0 += at_b - at_a, g.ends1 += at_b * b - at_a * a;
    g.at_from = select(is_piece & (a == g.wet_from), at_a, g.at_from);
    g.at_to = select(is_piece & (b == g.wet_to), at_b, g.at_to);
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
  V from, to, slope, before;  // before: where the edge was marked

  CutGround(const GrooveLines& lines, int j, V edge, V depth, V wet_from, V wet_to) {
    before = load<V>(lines.values[EDGE_MARKED] + j) - edge;
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
SKISNOW_INLINE void add_piece(const CutGround<V>& cut, V low, V high, V lift, V rise, Pressure<V>& out) {
  const MaskOf<V> old = all_lanes<V>(true);
  if (!any((cut.from < high) & (cut.to > low) & (cut.from < cut.to))) {
    out.add(low, high, lift, rise, old);
    return;
  }
  const V first = inside(cut.from, low, high), last = inside(cut.to, low, high);
  const V cut_rise = cut.slope - out.fall, apart = rise - cut_rise;
  V meet = -lift / select(absolute(apart) > 1e-30, apart, all<V>(1e-30));
  meet = inside(meet, first, last);
  const V at_first = 0.5 * (first + meet), at_last = 0.5 * (meet + last);
  const MaskOf<V> old_first = lift + apart * at_first > 0.0, old_last = lift + apart * at_last > 0.0;
  const MaskOf<V> is_old[] = {old, old_first, old_last, old};
  const V ends[] = {low, first, meet, last, high};
  for (int part = 0; part < 4; part++)
    out.add(ends[part], ends[part + 1], select(is_old[part], lift, V{}), select(is_old[part], rise, cut_rise),
            is_old[part]);
}

// [press_line] Pressure of the ground's pieces; what was cut within the step counts where it lies deeper.
template <class V>
SKISNOW_INLINE void add_ground(const GrooveLines& lines, int j, V edge, V wet_from, V wet_to, const CutGround<V>& cut,
                               Pressure<V>& out) {
  int most = 0;
  for (int lane = 0; lane < WIDTH<V>; lane++) most = std::max<int>(most, lines.knots[std::size_t(j + lane)]);
  const double* place = lines.place.data() + lines.tile(j, 0);
  const double* depth = lines.depth.data() + lines.tile(j, 0);
  const double* slope = lines.slope.data() + lines.tile(j, 0);
  // over the cut: the part before the ground's first knot, the pieces, the part behind the last one
  const auto cut_piece = [&](V a, V b) {
    const V low = inside(a, cut.from, cut.to), high = inside(b, cut.from, cut.to);
    out.add(low, maximum(low, high), V{}, cut.slope - out.fall, all_lanes<V>(false));
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

// [pressed growth] Derivatives of force F = ∫ p and moment M = ∫ p x for each metre of ski, p = H q - E lift with
// q = D + f x, by the depth D at the edge, the fall f, the edge's place y across the line and the ends of the wet base.
// Where p bears on old ground, ∂lift/∂D = -1, ∂lift/∂f = -x and ∂lift/∂y is the ground's slope; the pieces' ends move
// by -1 with y. Ground that is cut within the step rises by `cut.slope` from the edge to where it was marked, at
// `before`: there ∂lift/∂D = -x/before and ∂lift/∂y = slope x/before.
template <class V>
struct PressedGrowth {
  static constexpr int COUNT = 8;
  V force_depth, force_fall, force_place, moment_depth, moment_fall, moment_place, force_from, force_to;

  PressedGrowth(const Pressure<V>& sums, const GrowthSums<V>& g, const CutGround<V>& cut) {
    const V none{}, from = g.wet_from, to = g.wet_to, hardness = sums.hardness, excess = sums.excess;
    const V width = to - from, both = to + from;
    const V m0 = sums.q0 + width, m1 = 0.5 * (sums.q1 + width * both);
    const V m2 = (sums.q2 + width * (both * both - from * to)) * (1.0 / 3.0);
    const MaskOf<V> cuts = cut.from < cut.to;
    const V share = select(cuts, 1.0 / select(cuts, cut.before, all<V>(1.0)), none), steep = cut.slope * share;
    const V cut1 = g.x1 - g.old1, cut2 = g.x2 - g.old2;
    force_depth = hardness * m0 + excess * (g.old0 + share * cut1);
    moment_depth = hardness * m1 + excess * (g.old1 + share * cut2);
    force_fall = hardness * m1 + excess * g.x1;
    moment_fall = hardness * m2 + excess * g.x2;
    force_place = g.ends0 - g.at_to + g.at_from - excess * (g.slope0 + steep * cut1);
    moment_place = g.ends1 - g.at_to * to + g.at_from * from - excess * (g.slope1 + steep * cut2);
    force_to = hardness * (sums.depth + sums.fall * to) - g.at_to;
    force_from = g.at_from - hardness * (sums.depth + sums.fall * from);
  }

  PressedGrowth(const Pressures& pressure, int i) {
    V* const to[COUNT] = {&force_depth, &force_fall,   &force_place, &moment_depth,
                          &moment_fall, &moment_place, &force_from,  &force_to};
    for (int k = 0; k < COUNT; k++) *to[k] = load<V>(pressure[PressureField(FORCE_BY_DEPTH + k)] + i);
  }

  void store_at(Pressures& pressure, int i, V share) const {
    const V* const from[COUNT] = {&force_depth, &force_fall,   &force_place, &moment_depth,
                                  &moment_fall, &moment_place, &force_from,  &force_to};
    for (int k = 0; k < COUNT; k++) store(pressure[PressureField(FORCE_BY_DEPTH + k)] + i, share * *from[k]);
  }

  // Growth of force and moment from one section to another that is close to it.
  void between(const Cut<V>& c, const Cut<V>& other, V& force, V& moment) const {
    const V from = c.wet_from, to = maximum(c.wet_to, from);
    const V depth = other.edge_depth - c.edge_depth, fall = other.fall - c.fall, place = other.place - c.place;
    const V by_from = force_from * (other.wet_from - from);
    const V by_to = force_to * (maximum(other.wet_to, other.wet_from) - to);
    force = force_depth * depth + force_fall * fall + force_place * place + by_from + by_to;
    moment = moment_depth * depth + moment_fall * fall + moment_place * place + by_from * from + by_to * to;
  }

  // The same where only the depth and the place of the edge differ.
  void between_moved(const Cut<V>& c, const Cut<V>& other, V& force, V& moment) const {
    const V depth = other.edge_depth - c.edge_depth, place = other.place - c.place;
    force = force_depth * depth + force_place * place, moment = moment_depth * depth + moment_place * place;
  }
};

// Pressure of the snow on the base over a line: force and its moment about the edge for each metre of ski, elastic
// energy.
template <class V>
struct Pressed {
  V force, moment, energy;

  // With `grows`, `keep_growth` gets the derivatives.
  template <class Keep>
  Pressed(const Snow& snow, const GrooveLines& lines, int j, const Cut<V>& c, bool grows, const Keep& keep_growth) {
    const V wet_to = maximum(c.wet_to, c.wet_from);
    GrowthSums<V> more{c.wet_from, wet_to};
    Pressure<V> sums;
    sums.hardness = load<V>(lines.values[HARDNESS] + j), sums.excess = load<V>(lines.values[EXCESS] + j);
    sums.depth = c.edge_depth, sums.fall = c.fall, sums.growth = grows ? &more : nullptr;
    const CutGround<V> cut(lines, j, c.place, c.edge_depth, c.wet_from, wet_to);
    if (snow.unloading_ratio > 1.0) add_ground(lines, j, c.place, c.wet_from, wet_to, cut, sums);
    sums.resultants(c.wet_from, wet_to, force, moment, energy);
    if (grows) keep_growth(PressedGrowth<V>(sums, more, cut));
  }
};

// [material_edge] Place across of the point of the base at which the shear acted at the last accepted pose. While a
// nearly level base rolls, the blend moves the shear to another point. This motion is not one of the base.
template <class V>
SKISNOW_INLINE V material_edge(const GrooveLines& lines, int j, const Cut<V>& c) {
  const V moved = c.half * load<V>(lines.values[EDGE_SIDE] + j) - c.reach;
  return any(absolute(moved) > 0.0) ? c.place + moved / c.widening : c.place;
}

// [shear_used] The share of the way to full strength by which the edge is displaced. It holds where it did before, else
// where it came through the surface since it was last looked at.
template <class V>
SKISNOW_INLINE V shear_used(const Snow& snow, const GrooveLines& lines, int j, const Cut<V>& c) {
  const V place = material_edge(lines, j, c);
  const V anchored = load<V>(lines.values[ANCHORED] + j);
  const MaskOf<V> enters = (anchored <= 0.5) & (load<V>(lines.values[ABOVE] + j) > 0.5);
  V anchor = select(anchored > 0.5, load<V>(lines.values[ANCHOR] + j), place);
  if (any(enters)) {
    const V above = load<V>(lines.values[DEPTH_ABOVE] + j), edge_above = load<V>(lines.values[EDGE_ABOVE] + j);
    anchor = select(enters, V(place - c.deepest / (c.deepest - above) * (place - edge_above)), anchor);
  }
  return (anchor - place) / snow.shear_displacement;
}

// [eased] An edge that holds stores ½ S e u_y u² for each metre of its length. A strength S that rises must not add to
// this energy: the share u of the displacement shrinks so that the force stays. And the thrust of a cut presses on the
// same face as the shear: an edge that rises by z leaves that face by z times thrust over shear.
template <class V>
SKISNOW_INLINE V eased(const Snow& snow, const GrooveLines& lines, int j, V used, V strength, V thrust, V edge_depth) {
  const auto kept = [&](LineField field) { return load<V>(lines.values[field] + j); };
  const double per_reach = 1.0 / snow.shear_displacement;
  const V before = kept(STRENGTH_HELD), risen = kept(DEPTH_HELD) - edge_depth, none{};
  if (!any(before > 0.0)) return used;
  const MaskOf<V> holds = (before > 0.0) & (strength > 0.0) & (kept(ANCHORED) > 0.5);
  const V per_strength = 1.0 / select(strength > 0.0, strength, all<V>(1.0));
  const V rest = used + kept(SHEAR_HELD) * per_reach * (minimum(before * per_strength, all<V>(1.0)) - 1.0);
  const V left = maximum(V(thrust * per_strength * risen * per_reach), none);
  const V size = maximum(V(absolute(rest) - left), none);
  return select(holds, select(rest < 0.0, V(none - size), size), used);
}

// [strength_left] Of a strength, where an edge has slipped this far (m).
template <class V>
V strength_left(const ShearLaw& law, V slipped) {
  return 1.0 - (1.0 - law.residual_ratio) * minimum(slipped * (1.0 / law.weakening), all<V>(1.0));
}

// [press] What the snow answers to each section, and how far the shear at its edge is displaced; how the answers grow,
// where that is wanted.
template <class V>
void press(const Snow& snow, const GrooveLines& lines, const Base& base, bool grows, Pressures& pressure,
           EdgeHold& edge) {
  for_lanes<V>(base, lines, [&](int i, int j) {
    const V share = load<V>(base[SHARE] + i), none{};
    const MaskOf<V> wet = (share > 0.0) & (load<V>(base[DEEPEST] + i) > 0.0);
    store(edge[EDGE_THRUST] + i, none), store(edge[SHEAR_EASED] + i, none);
    if (!any(wet)) {
      for (const PressureField field : {FORCE, MOMENT, SNOW_ENERGY}) store(pressure[field] + i, none);
      for (const EdgeField field : {SHEAR_USED, STRENGTH_LEFT, EDGE_STRENGTH}) store(edge[field] + i, none);
      return;
    }
    const Cut<V> c = Cut<V>::stored(base, i);
    const Pressed<V> answer(snow, lines, j, c, grows, [&](const PressedGrowth<V>& growth) {
      growth.store_at(pressure, i, select(wet, share, none));
    });
    store(pressure[FORCE] + i, select(wet, share * answer.force, none));
    store(pressure[MOMENT] + i, select(wet, share * answer.moment, none));
    store(pressure[SNOW_ENERGY] + i, select(wet, share * answer.energy, none));
    store(edge[SHEAR_USED] + i, select(wet, shear_used(snow, lines, j, c), none));
    const V left = strength_left(snow.shear, load<V>(lines.values[SLIPPED] + j));
    store(edge[STRENGTH_LEFT] + i, select(wet, left, none));
    store(edge[EDGE_STRENGTH] + i, select(wet, snow.strength_share * load<V>(lines.values[STRENGTH] + j) * left, none));
  });
}

}  // namespace skisnow::SKISNOW_LANES
