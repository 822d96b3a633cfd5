// Lines of snow without the base above them: which of them need a search for older tracks, and their grooves' energy.
#pragma once

#include <algorithm>

#include "contact/lane_loops.hpp"

namespace skisnow::SKISNOW_LANES {

// A loop over all lanes of the laid lines; n: number of the first line in the lanes, j: its slot.
template <class V, class Body>
inline void for_line_lanes(const GrooveLines& lines, const Body& body) {
  for (std::int64_t n = lines.first & ~std::int64_t(BLOCK - 1); n < lines.end; n += WIDTH<V>) body(n, lines.slot(n));
}

// [unknown] Lines across which a ski may reach farther than older tracks were searched for: 1 by slot, else 0. Returns
// whether there is one; GrooveLines::unknown decides where to search.
template <class V>
bool find_unknown(const GrooveLines& lines, const Pose& pose, double room, double* is_unknown) {
  constexpr double ROUNDING = 1e-9;  // (m)
  const auto& R = pose.rotation;
  const auto& c = pose.position;
  const auto line3 = [&](LineField first, int j) -> Vector<V> {
    return {load<V>(lines.values[first] + j), load<V>(lines.values[LineField(first + 1)] + j),
            load<V>(lines.values[LineField(first + 2)] + j)};
  };
  const Vector<V> ski{all<V>(R[0][0]), all<V>(R[1][0]), all<V>(R[2][0])};
  bool found = false;
  for_line_lanes<V>(lines, [&](std::int64_t n, int j) {
    const Vector<V> from = line3(ORIGIN_X, j), ahead = line3(AHEAD_X, j), lateral = cross(line3(NORMAL_X, j), ahead);
    const Vector<V> there{c[0] - from.x, c[1] - from.y, c[2] - from.z};
    const V aside = dot(there, lateral) - dot(there, ahead) * dot(ski, lateral) / dot(ski, ahead);
    const V known_from = load<V>(lines.values[KNOWN_FROM] + j), known_to = load<V>(lines.values[KNOWN_TO] + j);
    const MaskOf<V> unknown =
        (known_from >= known_to) | (aside - room < known_from + ROUNDING) | (aside + room > known_to - ROUNDING);
    store(is_unknown + j, select(unknown, all<V>(1.0), V{}));
    for (int lane = 0; lane < WIDTH<V>; lane++)
      found = found || (unknown[lane] != 0 && n + lane >= lines.first && n + lane < lines.end);
  });
  return found;
}

// ∫ depth² over each line's ground (m³), by slot.
template <class V>
void square_depths(const GrooveLines& lines, double* out) {
  for_line_lanes<V>(lines, [&](std::int64_t, int j) {
    int most = 0;
    for (int lane = 0; lane < WIDTH<V>; lane++) most = std::max<int>(most, lines.knots[std::size_t(j + lane)]);
    V total{};
    if (most > 1) {
      const double* place = lines.place.data() + lines.tile(j, 0);
      const double* depth = lines.depth.data() + lines.tile(j, 0);
      V at = load<V>(place), a = load<V>(depth);
      for (int k = 1; k < most; k++) {
        const V next = load<V>(place + BLOCK * k), b = load<V>(depth + BLOCK * k);
        total += (next - at) * (a * a + a * b + b * b);
        at = next, a = b;
      }
    }
    store(out + j, total / 3.0);
  });
}

}  // namespace skisnow::SKISNOW_LANES
