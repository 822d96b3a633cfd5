// Marks of a base on its lines, kept when a pose is accepted: where its edges were, where they hold, where it sticks.
#pragma once

#include "contact/force_kernels.hpp"

namespace skisnow::SKISNOW_LANES {

// Set a field of lines in some lanes only.
template <class V>
SKISNOW_INLINE void put(GrooveLines& lines, LineField field, int j, MaskOf<V> where, V value) {
  double* to = lines.values[field] + j;
  store(to, select(where, value, load<V>(to)));
}

// How far the place of an edge on a line moves as the line moves ahead by one.
template <class V>
SKISNOW_INLINE V edge_skew(const Cut<V>& c, int k) {
  const Vector<V> along = c.direction(all<V>(k == 0 ? 1.0 : -1.0));
  return dot(along, c.left) / dot(along, c.ahead);
}

// [turning_place] Where across an edge turned back since its mark. Over the way w from 0 to 1 its place is a parabola
// y₀ + (y₁ - y₀) w + b w (1 - w), b half the way along the ski times the change of the skew. Where the vertex at 1 - u
// lies on the way, it is u² b beyond y₁. Elsewhere y₁.
template <class V>
SKISNOW_INLINE V turning_place(const GrooveLines& lines, int j, const Cut<V>& c, int k) {
  const auto before = [&](LineField left) { return load<V>(lines.values[of_edge(left, k)] + j); };
  const V edge = c.place + c.x[k], way = edge - before(LEFT_MARK), none{};
  const V bend =
      0.5 * (load<V>(lines.values[MARK_STATION] + j) - c.station) * (edge_skew(c, k) - before(LEFT_MARK_SKEW));
  const MaskOf<V> turns = (load<V>(lines.values[MARKED] + j) > 0.5) & (before(LEFT_MARK_DEPTH) > 0.0) &
                          (c.depth[k] > 0.0) & (absolute(way) < absolute(bend));
  const V u = 0.5 - 0.5 * way / select(turns, bend, all<V>(1.0));
  return edge + select(turns, V(bend * u * u), none);
}

// An anchor that an edge drags along where it is farther off than the full displacement.
template <class V>
SKISNOW_INLINE V dragged(const Snow& snow, V anchor, V edge) {
  return minimum(maximum(anchor, edge - snow.shear_displacement), edge + snow.shear_displacement);
}

// Keep where an edge in the snow holds, on its way and at its end. Returns how far it slips; `eased`: share of the
// displacement by which it was eased, see [ease].
template <class V>
SKISNOW_INLINE V keep_anchor(const Snow& snow, GrooveLines& lines, int j, const Cut<V>& c, int k, MaskOf<V> in_snow,
                             V eased) {
  const V edge = c.place + c.x[k];
  const V anchor = anchor_before(lines, j, k, edge, c.depth[k]) + snow.shear_displacement * eased;
  const V kept = dragged(snow, dragged(snow, anchor, turning_place(lines, j, c, k)), edge);
  put(lines, of_edge(LEFT_ANCHOR, k), j, in_snow, kept);
  return select(in_snow, absolute(V(kept - anchor)), V{});
}

// Keep where friction is 0: not farther off than the way to full friction, on a line that comes under the base here.
template <class V>
SKISNOW_INLINE void keep_stuck(const Snow& snow, const Base& s, int i, GrooveLines& lines, int j, MaskOf<V> touches) {
  const auto at_zero = [&](LineField field) { return load<V>(lines.values[field] + j); };
  const Cut<V> c = Cut<V>::stored(s, i);
  const V from = at_zero(STUCK_STATION), place = at_zero(STUCK_PLACE), arm = at_zero(STUCK_ARM), none{};
  const Way<V> way(c, aside_of(c, snow), from, place, arm);
  const V far = snow.friction.is_vector ? root(V(way.ahead * way.ahead + way.aside * way.aside)) : absolute(way.ahead);
  const MaskOf<V> stuck = at_zero(STUCK) > 0.5;
  const V stick = all<V>(snow.friction.stick), most = select(stuck, V(stick / maximum(far, stick)), none);
  const V over = select(stuck, V(c.place + (arm - c.reach) / c.widening - place), none);
  const V station = Way<V>::station_of(c);
  put(lines, STUCK_STATION, j, touches, V(station + most * (from - station)));
  put(lines, STUCK_PLACE, j, touches, V(c.place - most * over));
  put(lines, STUCK_ARM, j, touches, c.reach);
}

// Keep all of these for the lines that `of` (by slot) has 1 for, or null for all of them; `eased` null: no edge was.
template <class V>
void mark(const Snow& snow, const Base& s, const double* of, const EdgeHold* eased, GrooveLines& lines) {
  const V none{}, one = all<V>(1.0);
  for_lanes<V>(s, lines, [&](int i, int j) {
    const MaskOf<V> chosen = of == nullptr ? all_lanes<V>(true) : load<V>(of + j) > 0.5;
    if (!any(chosen)) return;
    const MaskOf<V> on_ski = chosen & (load<V>(s[SHARE] + i) > 0.0), touches = on_ski & (load<V>(s[DEEPEST] + i) > 0.0);
    if (any(on_ski)) {
      const Cut<V> c = Cut<V>::stored(s, i);
      V slipped{};
      for (int k = 0; k < 2; k++) {
        const V eased_by = eased == nullptr ? none : load<V>((*eased)[of_edge(LEFT_EASED, k)] + i);
        const MaskOf<V> in_snow = on_ski & (c.depth[k] > 0.0);
        if (any(in_snow)) slipped = maximum(slipped, keep_anchor(snow, lines, j, c, k, in_snow, eased_by));
        put(lines, of_edge(LEFT_MARK, k), j, on_ski, V(c.place + c.x[k]));
        put(lines, of_edge(LEFT_MARK_SKEW, k), j, on_ski, edge_skew(c, k));
        put(lines, of_edge(LEFT_MARK_DEPTH, k), j, on_ski, c.depth[k]);
      }
      store(lines.values[SLIPPED] + j, load<V>(lines.values[SLIPPED] + j) + slipped);
      if (any(touches)) keep_stuck<V>(snow, s, i, lines, j, touches);
    }
    put(lines, MARK_STATION, j, on_ski, load<V>(s[STATION] + i));
    put(lines, MARK_CLIMB, j, touches, load<V>(s[DEPTH_CLIMB] + i));
    put(lines, STUCK, j, chosen, select(touches, one, none));
    put(lines, MARKED, j, chosen, select(on_ski, one, none));
  });
}

// [drag_anchors] Edges of these lines drag their anchors along on the way since their marks.
template <class V>
void drag_anchors(const Snow& snow, const Base& s, const double* of, GrooveLines& lines) {
  for_lanes<V>(s, lines, [&](int i, int j) {
    const MaskOf<V> drags =
        (load<V>(of + j) > 0.5) & (load<V>(s[SHARE] + i) > 0.0) & (load<V>(lines.values[MARKED] + j) > 0.5);
    if (!any(drags)) return;
    const Cut<V> c = Cut<V>::stored(s, i);
    V slipped{};
    for (int k = 0; k < 2; k++) {
      const V before = load<V>(lines.values[of_edge(LEFT_ANCHOR, k)] + j), at = turning_place(lines, j, c, k);
      const MaskOf<V> turns = drags & (at != c.place + c.x[k]);
      const V anchor = select(turns, dragged(snow, before, at), before);
      store(lines.values[of_edge(LEFT_ANCHOR, k)] + j, anchor);
      slipped = maximum(slipped, absolute(V(anchor - before)));
    }
    store(lines.values[SLIPPED] + j, load<V>(lines.values[SLIPPED] + j) + slipped);
  });
}

// [deepest] Where a base was deepest since it was marked last. Over the way w from 0 to 1 the depth at each share of
// the width is a parabola d₀ + (d₁ - d₀) w + b w (1 - w), b half the way times the change of the climb. Where its
// vertex is at a w = 1 - u between 0 and 1, it is u² b deeper than d₁. Without it the ground misses b/6 in the mean.
// The slope at the end is that of the base there: past a kink, after which the base is straight, there is no vertex. So
// the chord counts as much deeper as the unbent base is higher at the mark than here beyond the mean of both slopes: 0
// for a parabola. By slot, 2 u + d₁ - d₀ of a line with a vertex on the way, else NO_VERTEX.
template <class V>
void find_vertices(const Runner& runner, const Base& s, const GrooveLines& lines, double* out) {
  for_lanes<V>(s, lines, [&](int i, int j) {
    if (!s.wants(Base::SECTIONS, i)) return;
    const auto before = [&](LineField field) { return load<V>(lines.values[field] + j); };
    const V depth[2] = {load<V>(s[LEFT_DEPTH] + i), load<V>(s[RIGHT_DEPTH] + i)};
    const V deep[2] = {before(LEFT_MARK_DEPTH), before(RIGHT_MARK_DEPTH)};
    const MaskOf<V> on_left = depth[0] > depth[1];
    const V at_mark = before(MARK_STATION), here = load<V>(s[STATION] + i);
    const V bend = 0.5 * (at_mark - here) * (load<V>(s[DEPTH_CLIMB] + i) - before(MARK_CLIMB));
    const MaskOf<V> bends = (before(MARKED) > 0.5) & (select(on_left, deep[0], deep[1]) > 0.0) &
                            (maximum(depth[0], depth[1]) > 0.0) & (bend > 0.0);
    store(out + j, all<V>(NO_VERTEX));
    if (!any(bends)) return;
    V then[ROW], now[ROW];
    read_table(runner, at_mark, then), read_table(runner, here, now);
    const V rise = then[2] - now[2] - 0.5 * (at_mark - here) * (then[3] + now[3]);
    const V to_end = bend + load<V>(s[LINE_NORMAL_2] + i) * rise;
    const V u[2] = {0.5 * (to_end + deep[0] - depth[0]), 0.5 * (to_end + deep[1] - depth[1])};
    const MaskOf<V> is_on_way = bends & (maximum(u[0], u[1]) > 0.0) & (minimum(u[0], u[1]) < bend);
    store(out + j, select(is_on_way, to_end, all<V>(NO_VERTEX)));
  });
}

}  // namespace skisnow::SKISNOW_LANES
