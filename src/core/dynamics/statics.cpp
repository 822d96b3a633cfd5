// Static equilibrium: depth, roll, pitch and bend, place and heading held. Newton's method with the whole tangent,
// plus a share of the mass matrix while the way is long (pseudo-transient continuation).
#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/dynamics.hpp"

namespace skisnow {

namespace {

constexpr int MOST_STEPS = 300;
constexpr double LONGEST = 0.02;       // step (m)
constexpr double SETTLED = 1e-11;      // last step (m) that counts as equilibrium
constexpr double ROUNDING = 1e-8;      // a step (m) below this that does not shrink is rounding
constexpr double FIRST_INERTIA = 1e4;  // factor of the mass matrix (1/s²)
constexpr double LEAST_INERTIA = 1e-6, LITTLE_INERTIA = 1.0, MOST_INERTIA = 1e12;
constexpr double LIFT = 1e-3, LIFT_EXACT = 1e-9;  // (m) of the search for the height at which rigid skis bear
constexpr bool HELD[BODY] = {true, true, false, false, false, true};

// How far (m) an unknown moves the base, about: angles have their arms.
double arm(std::size_t place, const Layout& layout) {
  if (place < BODY) return place < 3 ? 1.0 : 0.5;
  std::size_t beam = 0;
  while (int(beam) + 1 < layout.beams() && int(place) >= layout.first(int(beam) + 1)) beam++;
  constexpr double ARMS[3] = {1.0, 0.05, 0.03};
  return ARMS[(place - std::size_t(layout.first(int(beam)))) % 3];
}

}  // namespace

double Dynamics::static_length(const Numbers& step) const {
  double most = 0.0;
  for (std::size_t i = 0; i < step.size(); i++) {
    if (!std::isfinite(step[i])) return std::numeric_limits<double>::infinity();
    most = std::max(most, std::fabs(step[i] * arm(i, layout_)));
  }
  return most;
}

// Forces that are left over at rest.
void Dynamics::static_residual(const BodyState& at, Numbers& out) {
  next_.position = at.position;
  std::copy(&at.rotation[0][0], &at.rotation[0][0] + 9, &next_.rotation[0][0]);
  next_.bend = at.bend;
  std::fill(next_.rate.begin(), next_.rate.end(), 0.0);
  std::fill(out.begin(), out.end(), 0.0);
  if (!motions_.empty()) {
    find_moving_residual(0.0, 0.0, 0.0, true, out);
  } else {
    fill_end();
    add_snow(out, true);
    add_forces(body_, layout_, next_, out);
    add_stiffness(body_, layout_, next_.bend, next_.rate, -1.0, out);
  }
  for (std::size_t a = 0; a < BODY; a++)
    if (HELD[a] || held_) out[a] = 0.0;
}

// [static matrix] K + K_snow, the turning of gravity with the body, and a trace of inertia; held unknowns stay.
bool Dynamics::factor_static(double inertia) {
  for (int a = 0; a < BODY; a++) {
    for (int b = 0; b < BODY; b++) system_.corner[a][b] = inertia * body_.inertia[a][b];
    system_.held[a] = HELD[a] || held_;
  }
  fill_beams(
      {.mass = inertia, .stiffness = 1.0, .damping = 0.0, .coupling = 0.0, .snow_stiffness = 1.0, .snow_damping = 0.0});
  // a rotation δ of the body turns gravity by g × δ as the body sees it: minus the derivative of its forces
  const Vector3 g = next_.in_body(body_.gravity);
  const double turned[3][3] = {{0.0, -g[2], g[1]}, {g[2], 0.0, -g[0]}, {-g[1], g[0], 0.0}};  // [g]×
  const Vector3& c = body_.first_moment;
  const double lever[3][3] = {{0.0, -c[2], c[1]}, {c[2], 0.0, -c[0]}, {-c[1], c[0], 0.0}};
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) {
      system_.corner[a][b + 3] -= body_.mass * turned[a][b];
      for (int m = 0; m < 3; m++) system_.corner[a + 3][b + 3] -= lever[a][m] * turned[m][b];
    }
  for (std::size_t k = 0; k < body_.skis.size(); k++) {
    const FlexibleSki& ski = body_.skis[k];
    double pull[3] = {};  // gravity in the ski's axes
    for (int c = 0; c < 3; c++)
      for (std::size_t a = 0; a < 3; a++) pull[c] += ski.axes[c][a] * g[a];
    for (int i = 0; i < ski.size(); i++)
      for (int b = 0; b < 3; b++) {
        const int p = (b + 1) % 3, q = (b + 2) % 3;
        const double* own = ski.clamp_coupling.data() + BORDER_ROW * i;
        system_.border(int(k), i)[b + 3] -= own[p] * pull[q] - own[q] * pull[p];
      }
  }
  flown_ = 0.0;
  return system_.factor();
}

// Sum of squares of the forces that are left, moments over their arms (N²).
double Dynamics::static_square(const Numbers& left) const {
  double total = 0.0;
  for (std::size_t i = 0; i < left.size(); i++) total += left[i] * left[i] / (arm(i, layout_) * arm(i, layout_));
  return total;
}

// Lift or lower the body along its own normal, its skis as they are bent, to where the snow bears its weight.
void Dynamics::find_height(Numbers& left) {
  const auto lifted = [&](double height) {
    BodyState out = state;
    for (std::size_t a = 0; a < 3; a++) out.position[a] += height * state.rotation[a][2];
    return out;
  };
  const auto surplus = [&](double height) {
    static_residual(lifted(height), left);
    return left[2];
  };
  double low = 0.0, high = 0.0, way = LIFT;
  if (surplus(0.0) > 0.0) {
    for (; surplus(high) > 0.0 && way < 1.0; way *= 2.0) low = high, high += way;
  } else {
    for (; surplus(low) <= 0.0 && way < 1.0; way *= 2.0) high = low, low -= way;
  }
  while (high - low > LIFT_EXACT) (surplus(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
  state.position = lifted(0.5 * (low + high)).position;
}

double Dynamics::settle() {
  const double last = find_equilibrium();
  contact_->take_back();
  return last;
}

// Meet the snow at rest in the present pose.
void Dynamics::stand() {
  next_ = state;
  fill_end();
  end_.dt = 0.0;
  contact_->begin(end_);
}

// A step of Newton's from the forces left, with an inertia (1/s²) against it; its length (m) before it is cut to the
// longest, infinite where the matrix cannot be factored, NaN where the step is not a number.
double Dynamics::static_step(double inertia, Numbers& left, Numbers& step) {
  if (!factor_static(inertia)) return std::numeric_limits<double>::infinity();
  step = left;
  system_.solve(step);
  const double length = static_length(step);
  if (!std::isfinite(length)) return std::numeric_limits<double>::quiet_NaN();
  const double share = std::min(1.0, LONGEST / std::max(length, 1e-300));
  for (double& each : step) each *= share;
  return length;
}

double Dynamics::find_equilibrium() {
  Numbers left = state.rate, step = state.rate;
  BodyState trial = state;
  double longest = std::numeric_limits<double>::infinity(), inertia = FIRST_INERTIA;
  place_boots(time);
  for (FlexibleSki& each : body_.skis) each.velocity = each.turning = {};  // at rest
  stand();
  if (!held_) find_height(left);
  for (int tries = 0; tries < MOST_STEPS && inertia < MOST_INERTIA; tries++) {
    stand();
    static_residual(state, left);
    const double square = static_square(left), before = longest;
    const double length = static_step(inertia, left, step);
    if (std::isinf(length)) return length;
    double change = std::numeric_limits<double>::infinity();
    if (!std::isnan(length)) {
      move(state, step, trial);
      static_residual(trial, left);
      change = std::sqrt(static_square(left) / std::max(square, 1e-300));
    }
    if (!(change < 2.0) && !(length <= ROUNDING)) {
      inertia *= 4.0;
      continue;
    }
    longest = length;
    inertia = std::max(LEAST_INERTIA, inertia * std::clamp(0.7 * change, 0.05, 1.4));
    std::swap(state.position, trial.position);
    std::copy(&trial.rotation[0][0], &trial.rotation[0][0] + 9, &state.rotation[0][0]);
    state.bend = trial.bend;
    const bool rests = longest < SETTLED || (longest < ROUNDING && longest > 0.5 * before);
    if (rests && inertia < LITTLE_INERTIA) break;
  }
  contact_->take_back();
  return inertia < MOST_INERTIA ? longest : std::numeric_limits<double>::infinity();
}

}  // namespace skisnow
