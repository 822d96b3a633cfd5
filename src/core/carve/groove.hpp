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
  void across(const CarveSection& section, int station, CarvePressure& pressure, StripSums& sums,
              CarveLinks& links) const;
  void pass(const CarveSection& section, int station);

 private:
  std::vector<double> depth_, by_angle_;  // and its growth with the twist of the station that left it
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
