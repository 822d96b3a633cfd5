// Newton's method with damping by the natural monotonicity test, on the bordered banded system.
//
// Source of the test: P. Deuflhard (2004), Newton methods for nonlinear problems, section 3.3: a step is accepted when
// the simplified Newton correction that follows it is smaller than the step's own, however the equations are scaled.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "carve/equations.hpp"

namespace skisnow {

namespace {

constexpr double TOLERANCE = 1e-11;  // (m) last correction to the edge depth
constexpr int MOST_ITERATIONS = 60;
constexpr double STRESS_AS_DEPTH = 1e-3;  // (m) that a change of the shear stress by its whole counts like
constexpr double SMALLEST_DAMPING = 1e-4;
constexpr double STALL_TOLERANCE = 1e-6;  // correction at which rounding may end the iteration, of the greatest depth
constexpr double FORCE_TOLERANCE = 1e-8;  // force left unbalanced, of the load

}  // namespace

CarveNewton::CarveNewton(const CarvedSki& ski, std::function<void()> asked)
    : at(ski), ski_(ski), asked_(std::move(asked)), spare_(ski) {
  state.u.assign(at.residual.size(), 0.0);
  step_ = trial_ = trial_step_ = state;
}

double depth_change(const CarvedSki& ski, const CarveConditions& conditions, const CarveState& step) {
  const double cosine = std::cos(conditions.edge_angle);
  double total = 0.0;
  for (const CarveStation& s : ski.stations) {
    const double* u = step.u.data() + s.first;
    double change = step.border[0] + step.border[1] * s.place;
    for (int a = 0; a < 4; a++) change -= cosine * s.deflection[a] * u[BENDS[a]];
    if (conditions.twists)
      for (int a = 0; a < 2; a++) change += s.half_width * cosine * s.twist[a] * u[TURNS[a]];
    total += change * change;
  }
  return std::sqrt(total / double(ski.stations.size()));
}

// Length of a step: of the edge depth (m), and of the shear stress as a depth.
double CarveNewton::length_of(const CarveConditions& conditions, const CarveState& step) const {
  const double by_stress = STRESS_AS_DEPTH * step.border[2] / std::max(std::fabs(state.border[2]), 1.0);
  const double by_depth = depth_change(ski_, conditions, step);
  return std::sqrt(by_depth * by_depth + by_stress * by_stress);
}

std::optional<double> CarveNewton::damped_step(const CarveConditions& conditions, CarveGroove& groove, double length,
                                               double& damping) {
  double following = std::numeric_limits<double>::infinity();
  while (damping > SMALLEST_DAMPING) {
    trial_ = state;
    trial_.add(step_, damping);
    assemble(ski_, conditions, groove, trial_, spare_);
    if (factors_.correct(ski_, spare_, trial_step_)) following = length_of(conditions, trial_step_);
    const bool at_rounding = std::max(length, following) < 100.0 * TOLERANCE;
    if (following <= (1.0 - 0.25 * damping) * length || at_rounding) {
      std::swap(state, trial_);
      std::swap(at, spare_);
      return following;
    }
    damping *= 0.5;
  }
  return {};
}

bool CarveNewton::solve(const CarveConditions& conditions, CarveGroove& groove) {
  assemble(ski_, conditions, groove, state, at);
  double damping = 1.0;
  for (int iteration = 0; iteration < MOST_ITERATIONS; iteration++) {
    asked_();
    factors_.factor(ski_, at);
    if (!factors_.correct(ski_, at, step_)) return false;
    const double length = length_of(conditions, step_);
    damping = std::min(1.0, 2.0 * damping);
    const auto following = damped_step(conditions, groove, length, damping);
    if (!following) return false;
    iterations++;
    const bool balanced = std::fabs(at.border_residual[0]) <= FORCE_TOLERANCE * conditions.load;
    // a fine mesh has its rounding floor above the tolerance: there the corrections no longer fall
    const double floor = STALL_TOLERANCE * at.deepest();
    const bool stalled = *following > 0.5 * length && std::max(length, *following) < floor;
    if (damping == 1.0 && (*following < roughness * at.deepest() || stalled)) return true;
    if (damping < 1.0 || *following >= TOLERANCE || !balanced) continue;
    state.add(trial_step_, 1.0);  // the correction that follows is known already
    assemble(ski_, conditions, groove, state, at, false);
    return true;
  }
  return false;
}

}  // namespace skisnow
