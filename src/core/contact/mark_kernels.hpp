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

// Keep where an edge in the snow holds, not farther off than its full displacement. Returns how far it slips; `eased`:
// share of the displacement by which it was eased, see [ease].
template <class V>
SKISNOW_INLINE V keep_anchor(const Snow& snow, GrooveLines& lines, int j, int k, MaskOf<V> in_snow, V edge, V depth,
                             V eased) {
  const double reach = snow.shear_displacement;
  const V anchor = anchor_before(lines, j, k, edge, depth) + reach * eased;
  const V kept = minimum(maximum(anchor, edge - reach), edge + reach);
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
      V slipped{};
      for (int k = 0; k < 2; k++) {
        const V edge = load<V>(s[GRIP_PLACE] + i) + load<V>(s[of_edge(LEFT_X, k)] + i);
        const V depth = load<V>(s[of_edge(LEFT_DEPTH, k)] + i);
        const V eased_by = eased == nullptr ? none : load<V>((*eased)[of_edge(LEFT_EASED, k)] + i);
        const MaskOf<V> in_snow = on_ski & (depth > 0.0);
        if (any(in_snow)) slipped = maximum(slipped, keep_anchor(snow, lines, j, k, in_snow, edge, depth, eased_by));
        put(lines, of_edge(LEFT_MARK, k), j, on_ski, edge), put(lines, of_edge(LEFT_MARK_DEPTH, k), j, on_ski, depth);
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

}  // namespace skisnow::SKISNOW_LANES
