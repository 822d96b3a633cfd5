// Penetration laws from outside: the pressure at points of the ground, integrated over each section.
//
// Equations: docs/methods/contact.md, "A penetration law from outside".
#pragma once

#include <functional>
#include <vector>

#include "contact/sections.hpp"

namespace skisnow {

using Values = std::vector<double>;

// The answers of a law for many points at once.
struct PenetrationLaw {
  // depth (m) at which a place bears nothing any more, by the deepest that it was pressed to
  std::function<Values(const Values& deepest)> residual;
  // pressure (Pa) of all points, then energy that they would give back (J/m²); edge angles in rad
  std::function<Values(const Values& depth, const Values& deepest, const Values& edge_angle)> bear;
  std::function<Values(const Values& deepest)> lost;  // energy (J/m²) that a groove has cost
  Values bends;                                       // depths (m) at which the law bends
  bool along_base_normal = false;                     // the pressure's part across is then the strength of the edge
};

// A part of a line over which depth of the base and deepest depth of the ground are straight and the law is smooth.
struct BearingPart {
  int owner;                               // to whose sums it belongs
  double from, to;                         // in x from the edge (m)
  double depth, fall, deepest, deepening;  // at x = 0, and growth with x
  bool lifted;                             // whether the ground was pressed deeper before
};

class Bearing {
 public:
  explicit Bearing(PenetrationLaw law) : law_(std::move(law)) {}

  // Force, moment and elastic energy of all sections that touch.
  void press(const GrooveLines& lines, Sections& s);
  // As the kernel of that name.
  void differ(const Snow& snow, const GrooveLines& lines, const Sections& s, double step, double sense,
              SectionDifferences& out);
  // Energy (J) lost in a ground, for each metre of ski.
  double lost(const Ground& ground) const;

 private:
  struct Sums {
    double edge_angle, force, moment, energy;
  };

  PenetrationLaw law_;
  std::vector<BearingPart> parts_;
  std::vector<Sums> sums_;
  Values cuts_, depth_, deepest_, angle_;

  template <class Cut>
  void add_base(const GrooveLines& lines, int slot, const Cut& base);
  void add_straight(const BearingPart& part);
  void keep_what_bears();
  void add_up();
};

}  // namespace skisnow
