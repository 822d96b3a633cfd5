// An equilibrium of a carving ski, refined, and the derivatives of its outputs by everything that it depends on.
//
// Equations: docs/methods/carved-turn.md.
#pragma once

#include <memory>
#include <vector>

#include "carve/residual.hpp"

namespace skisnow {

// Growth of an output with what the equations contain; the ski's unknowns of the adjoint state λ.
struct CarveGradient {
  // one for each station: its place, length, width, base height, deflection; and its load normal to the base (N)
  std::vector<double> place, weight, width, base_height, deflection, normal;
  double edge_angle = 0.0, hardness = 0.0, excess = 0.0, load = 0.0, moment = 0.0, side_force = 0.0, bevel = 0.0,
         bevel_width = 0.0, pitch_of_force = 0.0, pitch_of_shear = 0.0, running_length = 0.0, greatest_width = 0.0,
         side = 0.0, radius = 0.0;
  CarveState adjoint;
};

// Output as its growth with the beam's unknowns, and with depth (m) and force (N/m) at the stations.
struct CarveSeed {
  Column u;
  std::vector<double> depth, force;
};

// Groove along the edge, no laws from outside.
class CarvePoint {
 public:
  // Near a state; `place`: places across, or empty for the usual ones. Refines it until the corrections stop falling.
  CarvePoint(const CarvedSki& ski, const CarveConditions& conditions, std::vector<double> place, CarveState near);
  ~CarvePoint();

  const CarvedSki& ski() const { return ski_; }
  const CarveState& state() const { return state_; }
  const std::vector<double>& depth() const { return at_.depth; }
  const std::vector<double>& force() const { return at_.force; }
  double last_correction() const { return last_correction_; }  // (m) root mean square over the edge

  CarveGradient gradient(const CarveSeed& seed);
  // How the equilibrium moves along a direction, the growth of whose state is set; depth, force and kink with it.
  CarveGrowth growth(CarveDirection& along);

 private:
  struct Passed;

  const CarvedSki& ski_;
  CarveConditions conditions_;
  std::vector<double> place_;
  CarveState state_;
  CarveEquations at_;
  CarveFactors factors_;
  double last_correction_ = 0.0;
  std::unique_ptr<Passed> passed_;

  void refine();
  void factor();
};

}  // namespace skisnow
