// Places across at which the groove of a carving ski is kept: functions of the question alone, not of its answer.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "carve/carve.hpp"

namespace skisnow {

constexpr double SHALLOWEST_WEDGE = 0.01;  // (rad) flatter than this the base is treated as flat
constexpr double CONTACT_SHARE = 0.9;      // share of the running length that a straight edge loads evenly

// Distance from the edge at which a straight edge, pressed into virgin snow, leaves the surface: its depth over tan ϑ
// (m). The depth e follows from load = H_V e²/(2 tan ϑ) × 0.9 running lengths.
inline double straight_waterline(const CarvedSki& ski, const CarveConditions& at) {
  const double tangent = std::tan(std::max(at.edge_angle, SHALLOWEST_WEDGE));
  return std::sqrt(2.0 * at.load / (at.hardness * CONTACT_SHARE * ski.running_length * tangent));
}

// ξ of the edge, of five shares of that distance, of the end of the base, of two places that divide the rest
// evenly in their logarithm, and of the hinges of a ground edge (m), rising. The edge of a stiff ski, that hard snow
// carries at its ends alone, is up to ten times as deep as a straight one. On snow so soft that the base drowns, the
// distance is 0.4 of its reach; it is never below a thousandth of that. `reach`: greatest width times cos ϑ; `hinges`:
// their distance from the edge times cos ϑ, 0 without one.
template <class T>
std::vector<T> places_across(T waterline, T reach, const T (&hinges)[EdgeShape::HINGES]) {
  using std::cbrt;
  const T line = std::max(std::min(waterline, T(0.4) * reach), T(1e-3) * reach), end = T(1.05) * reach,
          far = T(2.4) * line;
  std::vector<T> place = {T(0.0)};
  for (double share : {0.4, 0.8, 1.2, 1.6}) place.push_back(T(share) * line);
  for (const T& each : {far, cbrt(far * far * end), cbrt(far * end * end), end}) place.push_back(each);
  for (const T& each : hinges)
    if (each > T(0.0)) place.push_back(each);
  std::sort(place.begin(), place.end());
  place.erase(std::unique(place.begin(), place.end()), place.end());
  return place;
}

inline std::vector<double> places_across(const CarvedSki& ski, const CarveConditions& at) {
  const double cosine = std::cos(at.edge_angle);
  const EdgeShape edges = at.edges();
  const double bevel_end = at.bevel > 0.0 ? at.bevel_width * cosine : 0.0;
  return places_across(straight_waterline(ski, at), ski.greatest_width * cosine, {bevel_end, edges.width(1) * cosine});
}

}  // namespace skisnow
