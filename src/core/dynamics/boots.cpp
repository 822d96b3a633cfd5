#include "dynamics/boots.hpp"

#include <algorithm>
#include <cmath>

namespace skisnow {

namespace {

Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// A vector of the carrier's frame in the ski's axes.
Vector3 in_axes(const FlexibleSki& ski, const Vector3& v) {
  Vector3 out{};
  for (std::size_t c = 0; c < 3; c++)
    for (std::size_t a = 0; a < 3; a++) out[c] += ski.axes[c][a] * v[a];
  return out;
}

Vector3 out_of_axes(const FlexibleSki& ski, const Vector3& v) {
  Vector3 out{};
  for (std::size_t c = 0; c < 3; c++)
    for (std::size_t a = 0; a < 3; a++) out[a] += ski.axes[c][a] * v[c];
  return out;
}

// The ski's rates, in its own axes, by its carrier's: [ski][carrier].
void carried(const FlexibleSki& ski, double (&by)[BODY][BODY]) {
  for (std::size_t c = 0; c < 3; c++) {
    const Vector3 turning = cross(ski.boot, ski.axes[c]);
    for (std::size_t a = 0; a < 3; a++) {
      by[c][a] = by[c + 3][a + 3] = ski.axes[c][a];
      by[c][a + 3] = turning[a];
      by[c + 3][a] = 0.0;
    }
  }
}

// Angular velocity in the turned axes, of a rotation vector and its rate: the right Jacobian of the exponential.
Vector3 angular_velocity(const Vector3& turn, const Vector3& rate) {
  const double square = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2], angle = std::sqrt(square);
  const double once = angle > 1e-4 ? (1.0 - std::cos(angle)) / square : 0.5 - square / 24.0;
  const double twice = angle > 1e-4 ? (angle - std::sin(angle)) / (square * angle) : 1.0 / 6.0 - square / 120.0;
  const Vector3 first = cross(turn, rate), second = cross(turn, first);
  return {rate[0] - once * first[0] + twice * second[0], rate[1] - once * first[1] + twice * second[1],
          rate[2] - once * first[2] + twice * second[2]};
}

}  // namespace

// [boots] p = Σ pᵢ τⁱ and A = A₀ exp [Σ φᵢ τⁱ]×, with their rates.
void BootMotion::set(double time, FlexibleSki& stage) const {
  const double t = time - start;
  Vector3 angle{}, rate{};
  for (std::size_t a = 0; a < 3; a++) {
    stage.boot[a] = place[0][a] + t * (place[1][a] + t * (place[2][a] + t * place[3][a]));
    stage.velocity[a] = place[1][a] + t * (2.0 * place[2][a] + t * 3.0 * place[3][a]);
    angle[a] = t * (turn[0][a] + t * (turn[1][a] + t * turn[2][a]));
    rate[a] = turn[0][a] + t * (2.0 * turn[1][a] + t * 3.0 * turn[2][a]);
  }
  double turned[3][3];
  rotation_matrix(angle, turned);
  for (std::size_t c = 0; c < 3; c++)
    for (std::size_t a = 0; a < 3; a++) {
      stage.axes[c][a] = 0.0;
      for (std::size_t m = 0; m < 3; m++) stage.axes[c][a] += axes[m][a] * turned[m][c];
    }
  stage.turning = out_of_axes(stage, angular_velocity(angle, rate));
}

void carry_rates(const FlexibleSki& stage, const Numbers& rates, double* out) {
  const Vector3 v{rates[0], rates[1], rates[2]}, o{rates[3], rates[4], rates[5]}, by = cross(o, stage.boot);
  const Vector3 velocity{v[0] + by[0] + stage.velocity[0], v[1] + by[1] + stage.velocity[1],
                         v[2] + by[2] + stage.velocity[2]};
  const Vector3 turning{o[0] + stage.turning[0], o[1] + stage.turning[1], o[2] + stage.turning[2]};
  const Vector3 a = in_axes(stage, velocity), b = in_axes(stage, turning);
  std::copy(a.begin(), a.end(), out);
  std::copy(b.begin(), b.end(), out + 3);
}

MovingSki::MovingSki(const FlexibleSki& stage, const double* inertia, const Body& carrier) {
  std::copy_n(inertia, BODY * BODY, &body_.inertia[0][0]);
  body_.mass = inertia[0];
  body_.first_moment = {inertia[BODY * 5 + 1], inertia[BODY * 3 + 2], inertia[BODY * 4 + 0]};
  body_.gravity = carrier.gravity;
  body_.kernels = carrier.kernels;
  FlexibleSki alone = stage;
  alone.boot = alone.velocity = alone.turning = {};
  for (std::size_t c = 0; c < 3; c++)
    for (std::size_t a = 0; a < 3; a++) alone.axes[c][a] = c == a ? 1.0 : 0.0;
  for (int i = 0; i < stage.size(); i++)
    std::copy_n(stage.clamp_coupling.data() + BORDER_ROW * i, BODY, alone.coupling.data() + BODY * i);
  alone.prepare();
  body_.skis = {alone};
  layout_ = body_.layout();
  state_ = BodyState(layout_);
  now_ = before_ = difference_ = residual_ = state_.rate;
}

void MovingSki::follow(const FlexibleSki& stage, const BodyState& carrier, int first) {
  const Vector3 boot = carrier.in_space(stage.boot);
  for (std::size_t a = 0; a < 3; a++) state_.position[a] = carrier.position[a] + boot[a];
  for (std::size_t c = 0; c < 3; c++) {
    const Vector3 axis = carrier.in_space({stage.axes[c][0], stage.axes[c][1], stage.axes[c][2]});
    for (std::size_t a = 0; a < 3; a++) state_.rotation[a][c] = axis[a];
  }
  carry_rates(stage, carrier.rate, state_.rate.data());
  const int n = layout_.size(0), own = layout_.first(0);
  std::copy_n(carrier.bend.data() + first, n, state_.bend.data() + own);
  std::copy_n(carrier.rate.data() + first, n, state_.rate.data() + own);
}

void MovingSki::find_residual(const Wrench& snow, double newest, double now, double before) {
  const FlexibleSki& ski = body_.skis[0];
  std::fill(residual_.begin(), residual_.end(), 0.0);
  std::copy_n(snow.force, 3, residual_.begin());
  std::copy_n(snow.moment, 3, residual_.begin() + 3);
  double* beam = residual_.data() + layout_.first(0);
  for (std::size_t j = 0; j < ski.unknown.size(); j++)
    for (int c = 0; c < 3 && ski.unknown[j] >= 0; c++) beam[ski.unknown[j] + c] += snow.beam[3 * j + std::size_t(c)];
  add_forces(body_, layout_, state_, residual_);
  add_stiffness(body_, layout_, state_.bend, state_.rate, -1.0, residual_);
  for (std::size_t i = 0; i < difference_.size(); i++)
    difference_[i] = newest * state_.rate[i] - now * now_[i] + before * before_[i];
  add_mass(body_, layout_, difference_, -1.0, residual_);
}

void MovingSki::accept() {
  std::swap(before_, now_);
  now_ = state_.rate;
}

double MovingSki::power(const FlexibleSki& stage) const {
  const Vector3 v = in_axes(stage, stage.velocity), o = in_axes(stage, stage.turning);
  double taken = 0.0;
  for (std::size_t a = 0; a < 3; a++) taken += residual_[a] * v[a] + residual_[a + 3] * o[a];
  return -taken;
}

void MovingSki::add_to(Body& carrier, const FlexibleSki& stage, double sign) const {
  double by[BODY][BODY], half[BODY][BODY] = {};
  carried(stage, by);
  for (int a = 0; a < BODY; a++)
    for (int b = 0; b < BODY; b++)
      for (int m = 0; m < BODY; m++) half[a][b] += body_.inertia[a][m] * by[m][b];
  for (int a = 0; a < BODY; a++)
    for (int b = 0; b < BODY; b++)
      for (int m = 0; m < BODY; m++) carrier.inertia[a][b] += sign * by[m][a] * half[m][b];
  const Vector3 centre = out_of_axes(stage, body_.first_moment);
  carrier.mass += sign * body_.mass;
  for (std::size_t a = 0; a < 3; a++) carrier.first_moment[a] += sign * (centre[a] + body_.mass * stage.boot[a]);
}

}  // namespace skisnow
