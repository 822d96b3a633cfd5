// Laws of snow from outside in a steady carve: the pressure across its sections, and the strength along its edge.
//
// Equations: docs/methods/carved-turn.md.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "carve/strip.hpp"

namespace skisnow {

// Answers of laws for many points at once; depths in m, angles of the edge in rad.
struct CarveLaws {
  using Values = std::vector<double>;

  // pressure (Pa); none: the core's law
  std::function<Values(const Values& depth, const Values& deepest, const Values& edge_angle)> pressure;
  // depth at which a place bears nothing any more, by the deepest that it was pressed to
  std::function<Values(const Values& deepest)> residual;
  Values bends;  // depths at which the pressure bends
  // failure stress over one that they all have in common; none: the same everywhere
  std::function<Values(const Values& depth, const Values& edge_angle)> strength;
};

// A stretch across a section on which the depths of base (ε) and groove (g) are straight lines.
struct CarveInterval {
  double start, length;                     // from the edge (m)
  double depth0, depth1, groove0, groove1;  // at both ends (m)
  double sine;                              // sine of the edge angle of the section
};

// Pressure across all sections of a pass, by the core's law, by one from outside, or by both in shares.
//
// A law from outside is asked once for a whole pass: its intervals are gathered first, and then added in the same
// order.
class CarvePressure {
 public:
  // Begin a pass: `share` of the law from outside, `memory`: share of the groove's lead that it sees.
  void begin(const CarveLaws* laws, double share, double memory, double hardness, double excess);
  bool gathers() const { return share_ > 0.0; }
  void ask();

  // Pressure of the core's own law at a place (Pa).
  double at(double depth, double groove) const {
    return std::max(0.0, hardness_ * depth - excess_ * std::max(0.0, groove - depth));
  }
  void add(const CarveInterval& interval, StripSums& sums) {
    if (share_ > 0.0)
      add_by_law(interval, sums);
    else
      sums.add_interval(interval.start, interval.length, interval.depth0, interval.depth1, interval.groove0,
                        interval.groove1, hardness_, excess_);
  }

 private:
  // Of an interval, as far as the law is smooth; depths at its start and their growth.
  struct Part {
    double from, to;  // from the interval's start (m)
    double start, depth, fall, groove, deepening;
    double angle;
    bool lifted;  // whether the ground was pressed deeper before
    int dry;      // the base leaves the snow at the start (-1), at the end (1) or nowhere (0)

    // One of Gauss's points; towards where the base leaves the snow they lie as squares, for roots of the depth.
    double point(int which) const;
    double weight(int which) const;
  };
  struct Place {
    std::size_t part;
    double x;
  };
  // Where a part ends to bear: there the base is below the residual depth on one side, above it on the other.
  struct Bracket {
    std::size_t part;
    bool rises;                      // whether the part lies behind
    double low, high, below, above;  // places, and how far above the residual depth the base is there
    int last_under = -1;

    double guess() const;
    bool take(double x, double value);
  };
  enum Change { NONE, DEEPER, LESS_DEEP, DEEPER_GROOVE, LESS_DEEP_GROOVE, STEEPER, CHANGES };

  const CarveLaws* laws_ = nullptr;
  double share_ = 0.0, memory_ = 1.0, hardness_ = 0.0, excess_ = 0.0;
  bool gathering_ = false;
  std::vector<Part> parts_;
  std::vector<std::size_t> ends_;  // end of the parts of each interval
  std::size_t interval_ = 0, part_ = 0;
  CarveLaws::Values cuts_, depth_, deepest_, angle_, found_;

  void add_by_law(const CarveInterval& at, StripSums& sums);
  void divide(const CarveInterval& at);
  double told(double depth, double groove) const { return depth + memory_ * (groove - depth); }
  CarveLaws::Values over_residual(const std::vector<Place>& places) const;
  void keep_what_bears();
  void narrow(std::vector<Bracket>& open);
  void push(const Part& part, double x, Change change);
  void add_part(const Part& part, std::size_t first, StripSums& sums) const;
};

}  // namespace skisnow
