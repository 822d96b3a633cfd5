// The groove that the stations of a carving ski find and leave, and which station ahead left it where.
#pragma once

#include <algorithm>
#include <vector>

#include "carve/carve.hpp"
#include "carve/strip.hpp"

namespace skisnow {

constexpr double FAR_ABOVE = -1e3;  // depth (m) that marks untouched snow

// One section of the ski in the snow, on any kind of number. ξ: distance from the edge in the snow surface (m).
template <class T>
struct SnowSection {
  T half;                   // half its width
  T sine, cosine, tangent;  // functions of its edge angle, twist included
  T corner;                 // depth that an edge would have that is not ground
  T depth;                  // depth of the edge (m)
  T reach;                  // reach of the base across (m)
  T height, angle;          // of its base above the boot's, the ski's bend included (m); its edge angle
  const GroundEdge<T>* edge = nullptr;
  T rise[EdgeShape::HINGES] = {};  // see `GroundEdge`

  void grind(const GroundEdge<T>& shape) {
    edge = &shape;
    shape.find_rises(sine, cosine, rise);
    depth = base_depth(T(0.0));
  }
  // Depth ε of the base: a straight line except for the ground strip along the edge.
  T base_depth(const T& xi) const {
    T out = corner - xi * tangent;
    if (edge == nullptr) return out;
    const T far = xi / cosine;
    for (int h = 0; h < EdgeShape::HINGES; h++) out -= std::max(T(0.0), edge->width(h) - far) * rise[h];
    return out;
  }
  // Depth of the other edge; the bevel there is not counted.
  T other_depth() const { return corner - T(2.0) * half * sine; }
};

// The same with its derivatives.
struct CarveSection : SnowSection<double> {
  double rise_by_angle[EdgeShape::HINGES] = {};

  void grind(const EdgeShape& shape) {
    SnowSection::grind(shape);
    shape.find_growth(sine, cosine, rise_by_angle);
  }
  // Derivative of that depth by the edge angle α, the corner held: -ξ/cos² α, and for each hinge at a distance b from
  // the edge that ξ lies before also ξ sin α/cos² α · rise - (b - ξ/cos α) ∂rise/∂α.
  double base_by_angle(double xi) const {
    double out = -xi * (1.0 + tangent * tangent);
    for (int h = 0; edge != nullptr && h < EdgeShape::HINGES; h++)
      if (const double left = edge->width(h) - xi / cosine; left > 0.0)
        out += xi * sine / (cosine * cosine) * rise[h] - left * rise_by_angle[h];
    return out;
  }
  // Derivative of the edge's depth by the edge angle, the middle of the section held.
  double edge_by_angle() const {
    double out = half * cosine;
    for (int h = 0; edge != nullptr && h < EdgeShape::HINGES; h++) out -= edge->width(h) * rise_by_angle[h];
    return out;
  }
};

// A stretch between two places across on which the base is in the snow.
template <class T>
struct SnowStretch {
  std::size_t place;         // number of the first one
  bool cut;                  // whether it ends with the base
  T start, length, spacing;  // `spacing`: to the next place (m)
  T depth[2], groove[2];     // of base and groove at both ends (m)
};

// Depths of the base at places across.
template <class T>
void find_depths(const SnowSection<T>& section, const std::vector<T>& place, std::vector<T>& out) {
  out.resize(place.size());
  for (std::size_t k = 0; k < place.size(); k++) out[k] = section.base_depth(place[k]);
}

// [across] Take each stretch; `depth`, `groove`: of base and groove at each place, between which they are straight.
template <class T>
void each_stretch(const SnowSection<T>& section, const std::vector<T>& place, const std::vector<T>& depth,
                  const std::vector<T>& groove, const auto& take) {
  const T zero(0.0);
  for (std::size_t k = 0; k + 1 < place.size(); k++) {
    const bool cut = section.reach < place[k + 1];
    const T spacing = place[k + 1] - place[k], length = cut ? section.reach - place[k] : spacing;
    if (!(length > zero)) return;
    const T far = cut ? section.base_depth(section.reach) : depth[k + 1];
    if (!(depth[k] > zero) && !(far > zero)) continue;
    const T end = cut ? groove[k] + length / spacing * (groove[k + 1] - groove[k]) : groove[k + 1];
    take(SnowStretch<T>{k, cut, place[k], length, spacing, {depth[k], far}, {groove[k], end}});
  }
}

// Deepen the groove where the base is deeper; `take`: the number of each such place.
template <class T>
void deepen(const std::vector<T>& depth, std::vector<T>& groove, const auto& take) {
  for (std::size_t k = 0; k < depth.size(); k++)
    if (!(depth[k] < groove[k])) groove[k] = depth[k], take(k);
}

// How the force on a section and ∫p ξ grow with depth and twist of a station ahead, by the groove that it cut.
struct CarvePull {
  double force_by_depth = 0.0, moment_by_depth = 0.0, force_by_twist = 0.0, moment_by_twist = 0.0;
};

// The stations whose groove carries a station behind them: depth and twist of each are separate unknowns.
class CarveLinks {
 public:
  explicit CarveLinks(std::size_t stations) : number_(stations, -1) {}

  std::vector<int> station;      // one for each link
  std::vector<CarvePull> pulls;  // of links on the present section

  void clear();
  void next_section() { std::fill(pulls.begin(), pulls.end(), CarvePull{}); }
  // Effect of a deeper groove; `by_angle`: growth of its depth with the twist of the station that left it.
  void pull(int source, double by_angle, double force, double moment);

 private:
  std::vector<int> number_;  // number of the link of a station, or -1
};

// The groove under the edge of the stations that follow: its depth at some places ξ, each of one station.
struct GrooveAlongEdge {
  std::vector<double> place;  // rising from 0

  void clear();
  void across(const CarveSection& section, int station, CarvePressure& pressure, StripSums& sums, CarveLinks& links);
  void pass(const CarveSection& section, int station);  // the one that `across` had

 private:
  std::vector<double> depth_, by_angle_;  // and its growth with the twist of the station that left it
  std::vector<double> base_;              // depth of the section at the places
  std::vector<int> source_;
};

// The groove along a path, beside which the edge of each station lies by its offset (m, towards the inside): steps from
// left to right, each as deep as one station's base reaches, as the depth that this base would have at the path. The
// bases are taken parallel to each other there.
struct GrooveAlongPath {
  std::vector<double> offset;  // one for each station
  double tangent = 0.0;        // tangent of the edge angle of the boot

  void clear() { steps_.clear(); }
  void across(const CarveSection& section, int station, CarvePressure& pressure, StripSums& sums,
              CarveLinks& links) const;
  void pass(const CarveSection& section, int station);

 private:
  struct Step {
    double left, depth;
    int source;
  };
  std::vector<Step> steps_;
};

}  // namespace skisnow
