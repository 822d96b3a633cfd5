// Pressure of the ground on each section.
#pragma once

#include <algorithm>

#include "contact/section_kernels.hpp"
#include "snow/hypoplastic.hpp"

namespace skisnow::SKISNOW_LANES {

// The ground that an edge has cut since the last accepted pose, under the base as it went away from it: as deep as the
// edge was when it passed. Between `from` and `to` in x, nothing where they are equal. It is straight from the edge, at
// `edge`, to where the edge was marked, at `mark`; `depth` at the edge, `slope` and 1/(mark - edge).
template <class V>
struct CutGround {
  V from{}, to{}, edge{}, mark{}, depth{}, slope{}, share{};

  CutGround() = default;

  // Of one edge of a base that is wet from `wet_from` to `wet_to`.
  CutGround(const GrooveLines& lines, int j, const Cut<V>& c, int k, V wet_from, V wet_to)
      : edge(c.x[k]), depth(c.depth[k]) {
    const auto before = [&](LineField left) { return load<V>(lines.values[of_edge(left, k)] + j); };
    const V deep = before(LEFT_MARK_DEPTH), way = before(LEFT_MARK) - (c.place + edge);
    const MaskOf<V> inwards = k == 0 ? way < 0.0 : way > 0.0;
    const MaskOf<V> cuts = was_in_snow(lines, j, k) & inwards;
    mark = edge + way;
    from = select(cuts, maximum(k == 0 ? mark : edge, wet_from), wet_from);
    to = select(cuts, minimum(k == 0 ? edge : mark, wet_to), wet_from);
    share = 1.0 / select(cuts, way, all<V>(1.0));
    slope = (deep - depth) * share;
  }

  static MaskOf<V> was_in_snow(const GrooveLines& lines, int j, int k) {
    return (load<V>(lines.values[MARKED] + j) > 0.5) & (load<V>(lines.values[of_edge(LEFT_MARK_DEPTH, k)] + j) > 0.0);
  }
  MaskOf<V> is_there() const { return from < to; }
  bool meets(V low, V high) const { return any((from < high) & (to > low) & is_there()); }
  V at(V x) const { return depth + slope * (x - edge); }
};

// Additional sums for the derivatives. Over the parts that bear on ground that was pressed deeper: minus the
// derivatives of its lift by the depth of the grip and by the fall of the depth, and that by the grip's place, each
// integrated with 1 and with x. And what virgin snow's pressure has more than the ground's, E lift at most, at the ends
// of each piece.
template <class V>
struct GrowthSums {
  V wet_from, wet_to;
  V depth0{}, depth1{}, fall0{}, fall1{}, place0{}, place1{};
  V ends0{}, ends1{}, at_from{}, at_to{};
};

// Integrals over the wet base of one line, in x from the grip. Virgin snow bears q = H (D + f x); where the ground was
// pressed deeper by a lift it bears q - E lift, where that pushes (E = k_u - H_V).
template <class V>
struct Pressure {
  V hardness, excess, depth, fall;
  V q0{}, q1{}, l0{}, l1{}, l2{};   // of 1 and x over what bears as virgin snow less all that was pressed deeper;
  V q2{};                           // of lift, lift x and lift² over what bears there
  GrowthSums<V>* growth = nullptr;  // optional

  // [press_piece] A straight piece of ground from a to b (within the wet base), its lift there `lift + slope x`. Ground
  // that was cut within the step is given.
  SKISNOW_INLINE void add(V a, V b, V lift, V slope, const CutGround<V>* cut, MaskOf<V> is_cut) {
    if (!any(a < b)) return;
    const auto [c, d, u, v] = pressed_part(a, b, depth, fall, lift, slope, hardness, excess, THIN);
    if (growth != nullptr) grow(a, b, lift, slope, u, v, cut, is_cut);
    const V width = v - u, covered = d - c, both = v + u, ends = d + c;
    q0 += width - covered;
    q1 += width * both - covered * ends;
    q2 += width * (both * both - u * v) - covered * (ends * ends - c * d);
    const V lift_u = lift + slope * u, lift_v = lift + slope * v;
    l0 += 0.5 * width * (lift_u + lift_v);
    l1 += width * (1.0 / 6.0) * (lift_u * (2.0 * u + v) + lift_v * (u + 2.0 * v));
    l2 += width * (1.0 / 3.0) * (lift_u * lift_u + lift_u * lift_v + lift_v * lift_v);
  }

  // Ground from before the step stays: its lift falls by 1 with the depth, by x with the fall, and grows by the
  // ground's slope with the place. Of ground that is cut the share t = (x - edge)/(mark - edge) stays: its lift falls
  // by t with the depth, by t mark with the fall, and grows by t slope with the place.
  void grow(V a, V b, V lift, V slope, V u, V v, const CutGround<V>* cut, MaskOf<V> is_cut) {
    GrowthSums<V>& g = *growth;
    const V none{}, width = v - u, both = v + u, first = 0.5 * width * both;
    const V second = (1.0 / 3.0) * width * (both * both - u * v), ground = slope + fall;
    V depth0 = width, depth1 = first, fall0 = first, fall1 = second, place0 = ground * width, place1 = ground * first;
    if (cut != nullptr) {
      const V t0 = cut->share * (first - cut->edge * width), t1 = cut->share * (second - cut->edge * first);
      const auto choose = [&](V of_cut, V& of_ground) { of_ground = select(is_cut, of_cut, of_ground); };
      choose(t0, depth0), choose(t1, depth1), choose(cut->mark * t0, fall0), choose(cut->mark * t1, fall1);
      choose(cut->slope * t0, place0), choose(cut->slope * t1, place1);
    }
    g.depth0 += depth0, g.depth1 += depth1, g.fall0 += fall0, g.fall1 += fall1, g.place0 += place0, g.place1 += place1;
    const auto missing = [&](V x) {
      return minimum(excess * maximum(lift + slope * x, none), hardness * (depth + fall * x));
    };
    const MaskOf<V> is_piece = a < b;
    const V at_a = select(is_piece, missing(a), none), at_b = select(is_piece, missing(b), none);
    g.ends0 += at_b - at_a, g.ends1 += at_b * b - at_a * a;
    g.at_from = select(is_piece & (a == g.wet_from), at_a, g.at_from);
    g.at_to = select(is_piece & (b == g.wet_to), at_b, g.at_to);
  }

  // [resultants] Force and moment about the grip for each metre of ski, and elastic energy, of a base wet from a to b.
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

template <class V>
V inside(V x, V low, V high) {
  return minimum(maximum(x, low), high);
}

// The ground that both edges have cut; the left one's lies to the left of the right one's.
template <class V>
struct CutGrounds {
  CutGround<V> of[2];

  CutGrounds() = default;
  CutGrounds(const GrooveLines& lines, int j, const Cut<V>& c, V wet_from, V wet_to) {
    for (int k = 0; k < 2; k++)
      if (any(CutGround<V>::was_in_snow(lines, j, k))) of[k] = CutGround<V>(lines, j, c, k, wet_from, wet_to);
    const MaskOf<V> both = of[0].is_there() & of[1].is_there() & (of[0].from < of[1].to);
    if (!any(both)) return;
    const V middle = 0.5 * (of[0].from + of[1].to);
    of[0].from = select(both, middle, of[0].from), of[1].to = select(both, middle, of[1].to);
  }
};

// Straight pieces of ground next to each other, each over the base by `lift` at the grip and `rise` more for each
// metre.
template <class V>
struct GroundPieces {
  static constexpr int MOST = 9;
  V end, from[MOST], lift[MOST], rise[MOST];
  const CutGround<V>* cut[MOST];
  MaskOf<V> is_cut[MOST];
  int count = 0;

  // A piece between two places that a cut meets; over what both edges have cut the deeper of both.
  SKISNOW_INLINE GroundPieces(const CutGrounds<V>& cuts, V low, V high, V lift, V rise, const Pressure<V>& on) {
    end = high;
    for (int k = 1; k >= 0; k--) {
      const CutGround<V>& each = cuts.of[k];
      if (!each.meets(low, high)) continue;
      // up to where the left edge's cut begins the right edge's counts
      const V border = k == 0 ? high : select(cuts.of[0].is_there(), inside(cuts.of[0].from, low, high), high);
      add_cut(each, low, border, lift, rise, on);
      low = border;
    }
  }

 private:
  void add(V at, V over, V more) {
    from[count] = at, lift[count] = over, rise[count] = more, cut[count] = nullptr, is_cut[count] = all_lanes<V>(false);
    count++;
  }

  void add_cut(const CutGround<V>& each, V low, V high, V over, V more, const Pressure<V>& on) {
    const V first = inside(each.from, low, high), last = inside(each.to, low, high);
    const V cut_rise = each.slope - on.fall, cut_lift = each.at(V{}) - on.depth, apart = more - cut_rise;
    const V meet = inside(V((cut_lift - over) / select(absolute(apart) > 1e-30, apart, all<V>(1e-30))), first, last);
    const V ends[] = {first, meet, last};
    add(low, over, more);
    for (int part = 0; part < 2; part++) {
      const MaskOf<V> deeper = over - cut_lift + apart * (0.5 * (ends[part] + ends[part + 1])) <= 0.0;
      add(ends[part], select(deeper, cut_lift, over), select(deeper, cut_rise, more));
      cut[count - 1] = &each, is_cut[count - 1] = deeper;
    }
    add(last, over, more);
  }
};

// [press_line] Pressure of the ground's pieces; what was cut within the step counts where it lies deeper, also before
// the first knot and behind the last one, where the snow is virgin.
template <class V>
SKISNOW_INLINE void add_ground(const GrooveLines& lines, int j, V edge, V wet_from, V wet_to, const CutGrounds<V>& cuts,
                               Pressure<V>& out) {
  constexpr double VIRGIN = -1.0;  // lift (m) of ground that bears nothing
  int most = 0;
  for (int lane = 0; lane < WIDTH<V>; lane++) most = std::max<int>(most, lines.knots[std::size_t(j + lane)]);
  const double* place = lines.place.data() + lines.tile(j, 0);
  const double* depth = lines.depth.data() + lines.tile(j, 0);
  const double* slope = lines.slope.data() + lines.tile(j, 0);
  const bool is_cut = any(cuts.of[0].is_there()) || any(cuts.of[1].is_there());
  if (most < 2) most = 0;
  V a = wet_from;
  for (int k = -1; k < most || (k < 0 && most == 0); k++) {
    const bool is_virgin = k < 0 || k + 1 >= most;
    const V b = k + 1 < most ? V(load<V>(place + BLOCK * (k + 1)) - edge) : wet_to;
    const V low = inside(a, wet_from, wet_to), high = inside(b, wet_from, wet_to), from = a;
    a = b;
    if ((is_virgin && !is_cut) || !any(low < high)) continue;
    V lift = all<V>(VIRGIN), rise{};
    if (!is_virgin) {
      const V ground = load<V>(slope + BLOCK * k);
      lift = load<V>(depth + BLOCK * k) - ground * from - out.depth, rise = ground - out.fall;
    }
    if (!cuts.of[0].meets(low, high) && !cuts.of[1].meets(low, high)) {
      out.add(low, high, lift, rise, nullptr, all_lanes<V>(false));
      continue;
    }
    const GroundPieces<V> pieces(cuts, low, high, lift, rise, out);
    for (int n = 0; n < pieces.count; n++)
      out.add(pieces.from[n], n + 1 < pieces.count ? pieces.from[n + 1] : pieces.end, pieces.lift[n], pieces.rise[n],
              pieces.cut[n], pieces.is_cut[n]);
  }
}

// [pressed growth] Derivatives of force F = ∫ p and moment M = ∫ p x for each metre of ski, p = H q - E lift with
// q = D + f x, by the depth D at the grip, the fall f, the grip's place y across the line and the ends of the wet base.
// The pieces' ends move by -1 with y.
template <class V>
struct PressedGrowth {
  static constexpr int COUNT = 8;
  V force_depth{}, force_fall{}, force_place{}, moment_depth{}, moment_fall{}, moment_place{};
  V force_from{}, force_to{};

  PressedGrowth(const Pressure<V>& sums, const GrowthSums<V>& g) {
    const V from = g.wet_from, to = g.wet_to, hardness = sums.hardness, excess = sums.excess;
    const V width = to - from, both = to + from;
    const V m0 = sums.q0 + width, m1 = 0.5 * (sums.q1 + width * both);
    const V m2 = (sums.q2 + width * (both * both - from * to)) * (1.0 / 3.0);
    force_depth = hardness * m0 + excess * g.depth0;
    moment_depth = hardness * m1 + excess * g.depth1;
    force_fall = hardness * m1 + excess * g.fall0;
    moment_fall = hardness * m2 + excess * g.fall1;
    force_place = g.ends0 - g.at_to + g.at_from - excess * g.place0;
    moment_place = g.ends1 - g.at_to * to + g.at_from * from - excess * g.place1;
    force_to = hardness * (sums.depth + sums.fall * to) - g.at_to;
    force_from = g.at_from - hardness * (sums.depth + sums.fall * from);
  }

  PressedGrowth() = default;

  // The growth of pieces of one base that follow each other, whose pressure is continuous: the wet base's own ends
  // alone are ends.
  void add(const PressedGrowth& piece, MaskOf<V> begins, MaskOf<V> ends) {
    force_depth += piece.force_depth, force_fall += piece.force_fall, force_place += piece.force_place;
    moment_depth += piece.moment_depth, moment_fall += piece.moment_fall, moment_place += piece.moment_place;
    force_from += select(begins, piece.force_from, V{}), force_to += select(ends, piece.force_to, V{});
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
    const V depth = other.grip_depth - c.grip_depth, fall = other.fall - c.fall, place = other.place - c.place;
    const V by_from = force_from * (other.wet_from - from);
    const V by_to = force_to * (maximum(other.wet_to, other.wet_from) - to);
    force = force_depth * depth + force_fall * fall + force_place * place + by_from + by_to;
    moment = moment_depth * depth + moment_fall * fall + moment_place * place + by_from * from + by_to * to;
  }

  // The same where only the depth and the place of the edge differ.
  void between_moved(const Cut<V>& c, const Cut<V>& other, V& force, V& moment) const {
    const V depth = other.grip_depth - c.grip_depth, place = other.place - c.place;
    force = force_depth * depth + force_place * place, moment = moment_depth * depth + moment_place * place;
  }
};

// Pressure of the snow on the base over a line: force and its moment about the edge for each metre of ski, elastic
// energy.
template <class V>
struct Pressed {
  V force{}, moment{}, energy{};

  // With `grows`, `keep_growth` gets the derivatives.
  template <class Keep>
  Pressed(const Snow& snow, const GrooveLines& lines, int j, const Cut<V>& c, bool grows, const Keep& keep_growth) {
    const V wet_to = maximum(c.wet_to, c.wet_from);
    const bool remembers = snow.unloading_ratio > 1.0;
    const CutGrounds<V> cuts = remembers ? CutGrounds<V>(lines, j, c, c.wet_from, wet_to) : CutGrounds<V>();
    // a straight piece of the base
    const auto bear = [&](V from, V to, V depth, V fall, V& pressed, V& turned, V& stored) {
      GrowthSums<V> more{from, to};
      Pressure<V> sums;
      sums.hardness = load<V>(lines.values[HARDNESS] + j), sums.excess = load<V>(lines.values[EXCESS] + j);
      sums.depth = depth, sums.fall = fall, sums.growth = grows ? &more : nullptr;
      if (remembers) add_ground(lines, j, c.place, from, to, cuts, sums);
      sums.resultants(from, to, pressed, turned, stored);
      return grows ? PressedGrowth<V>(sums, more) : PressedGrowth<V>();
    };
    if (!c.shape->acts()) {
      const PressedGrowth<V> growth = bear(c.wet_from, wet_to, c.grip_depth, c.fall, force, moment, energy);
      if (grows) keep_growth(growth);
      return;
    }
    const BasePieces<V> pieces(c);
    PressedGrowth<V> growth;
    for (int k = 0; k < BasePieces<V>::COUNT; k++) {
      const V from = inside(pieces.place[k], c.wet_from, wet_to), to = inside(pieces.place[k + 1], c.wet_from, wet_to);
      if (!any(from < to)) continue;
      V pressed, turned, stored;
      const PressedGrowth<V> more = bear(from, to, pieces.at_grip[k], pieces.fall[k], pressed, turned, stored);
      force += pressed, moment += turned, energy += stored;
      growth.add(more, (from < to) & (from == c.wet_from), (from < to) & (to == wet_to));
    }
    if (grows) keep_growth(growth);
  }
};

// Where an edge in the snow holds (m, across): where it did before, else where it came through the surface since it was
// last looked at.
template <class V>
SKISNOW_INLINE V anchor_before(const GrooveLines& lines, int j, int k, V place, V depth) {
  const auto before = [&](LineField left) { return load<V>(lines.values[of_edge(left, k)] + j); };
  const V deep = before(LEFT_MARK_DEPTH);
  const MaskOf<V> marked = load<V>(lines.values[MARKED] + j) > 0.5, enters = marked & (deep <= 0.0);
  V anchor = select(marked, before(LEFT_ANCHOR), place);
  if (any(enters)) {
    const V fallen = depth - deep, per_fallen = depth / select(fallen > 0.0, fallen, all<V>(1.0));
    anchor = select(enters, V(place - per_fallen * (place - before(LEFT_MARK))), anchor);
  }
  return anchor;
}

// [shear_used] The share of the way to full strength by which an edge is displaced.
template <class V>
SKISNOW_INLINE V shear_used(const Snow& snow, const GrooveLines& lines, int j, const Cut<V>& c, int k) {
  const V place = c.place + c.x[k];
  return (anchor_before(lines, j, k, place, c.depth[k]) - place) / snow.shear_displacement;
}

// [eased] An edge that holds stores ½ S e u_y u² for each metre of its length. A strength S that rises must not add to
// this energy: the share u of the displacement shrinks so that the force stays. And the thrust of a cut presses on the
// same face as the shear: an edge that rises by z leaves that face by z times thrust over shear.
template <class V>
SKISNOW_INLINE V eased(const Snow& snow, const GrooveLines& lines, int j, int k, V used, V strength, V thrust,
                       V depth) {
  const auto kept = [&](LineField left) { return load<V>(lines.values[of_edge(left, k)] + j); };
  const double per_reach = 1.0 / snow.shear_displacement;
  const V before = load<V>(lines.values[STRENGTH_HELD] + j), risen = kept(LEFT_DEPTH_HELD) - depth, none{};
  if (!any(before > 0.0)) return used;
  const MaskOf<V> marked = load<V>(lines.values[MARKED] + j) > 0.5;
  const MaskOf<V> holds = (before > 0.0) & (strength > 0.0) & marked & (kept(LEFT_MARK_DEPTH) > 0.0);
  const V per_strength = 1.0 / select(strength > 0.0, strength, all<V>(1.0));
  const V rest = used + kept(LEFT_SHEAR_HELD) * per_reach * (minimum(before * per_strength, all<V>(1.0)) - 1.0);
  const V left = maximum(V(thrust * per_strength * risen * per_reach), none);
  const V size = maximum(V(absolute(rest) - left), none);
  return select(holds, select(rest < 0.0, V(none - size), size), used);
}

// [strength_left] Of a strength, where an edge has slipped this far (m).
template <class V>
V strength_left(const ShearLaw& law, V slipped) {
  return 1.0 - (1.0 - law.residual_ratio) * minimum(slipped * (1.0 / law.weakening), all<V>(1.0));
}

// [loaded_share] Of a wedge with the force F the upper part alone bears F over the force of virgin snow: a height whose
// square is in that proportion.
template <class V>
V loaded_share(const GrooveLines& lines, int j, const Cut<V>& c, V force) {
  const BasePieces<V> pieces(c);
  const V wet_to = maximum(c.wet_to, c.wet_from);
  V virgin{};
  for (int k = 0; k < BasePieces<V>::COUNT; k++) {
    const V from = inside(pieces.place[k], c.wet_from, wet_to), to = inside(pieces.place[k + 1], c.wet_from, wet_to);
    virgin += (to - from) * (pieces.at_grip[k] + 0.5 * pieces.fall[k] * (to + from));
  }
  virgin = load<V>(lines.values[HARDNESS] + j) * virgin;
  return root(within(V(force / select(virgin > 0.0, virgin, all<V>(1.0))), 0.0, 1.0));
}

// [press] What the snow answers to each section, and how far the shear at its edges is displaced; how the answers grow,
// where that is wanted.
template <class V>
void press(const Snow& snow, const GrooveLines& lines, const Base& base, bool grows, Pressures& pressure,
           EdgeHold& edge) {
  for_lanes<V>(base, lines, [&](int i, int j) {
    const V share = load<V>(base[SHARE] + i), none{};
    const MaskOf<V> wet = (share > 0.0) & (load<V>(base[DEEPEST] + i) > 0.0);
    for (const EdgeField field : {EDGE_THRUST, LEFT_USED, RIGHT_USED, LEFT_EASED, RIGHT_EASED})
      store(edge[field] + i, none);
    if (!any(wet)) {
      for (const PressureField field : {FORCE, MOMENT, SNOW_ENERGY}) store(pressure[field] + i, none);
      for (const EdgeField field : {STRENGTH_LEFT, EDGE_STRENGTH}) store(edge[field] + i, none);
      return;
    }
    const Cut<V> c = Cut<V>::stored(base, i);
    const Pressed<V> answer(snow, lines, j, c, grows, [&](const PressedGrowth<V>& growth) {
      growth.store_at(pressure, i, select(wet, share, none));
    });
    store(pressure[FORCE] + i, select(wet, share * answer.force, none));
    store(pressure[MOMENT] + i, select(wet, share * answer.moment, none));
    store(pressure[SNOW_ENERGY] + i, select(wet, share * answer.energy, none));
    for (int k = 0; k < 2; k++) {
      const MaskOf<V> holds = wet & (c.depth[k] > 0.0);
      if (any(holds)) store(edge[of_edge(LEFT_USED, k)] + i, select(holds, shear_used(snow, lines, j, c, k), none));
    }
    if (snow.shear.loaded_only) store(edge[LOADED] + i, select(wet, loaded_share(lines, j, c, answer.force), none));
    const V left = strength_left(snow.shear, load<V>(lines.values[SLIPPED] + j));
    store(edge[STRENGTH_LEFT] + i, select(wet, left, none));
    store(edge[EDGE_STRENGTH] + i, select(wet, snow.strength_share * load<V>(lines.values[STRENGTH] + j) * left, none));
  });
}

}  // namespace skisnow::SKISNOW_LANES
