#include "dynamics/boots.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace skisnow {

namespace {

// A vector of the carrier's frame in a ski's axes.
Vector3 in_axes(const Vector3* axes, const Vector3& v) { return {dot(axes[0], v), dot(axes[1], v), dot(axes[2], v)}; }

// Angular velocity in the turned axes, of a rotation vector and its rate: the right Jacobian of the exponential.
Vector3 angular_velocity(const Vector3& turn, const Vector3& rate) {
  const double square = dot(turn, turn), angle = std::sqrt(square);
  const double once = angle > 1e-4 ? (1.0 - std::cos(angle)) / square : 0.5 - square / 24.0;
  const double twice = angle > 1e-4 ? (angle - std::sin(angle)) / (square * angle) : 1.0 / 6.0 - square / 120.0;
  const Vector3 first = cross(turn, rate);
  return rate - once * first + twice * cross(turn, first);
}

// Its inverse, for an angular velocity and turns well below 2 π.
Vector3 rate_of_turn(const Vector3& turn, const Vector3& spin) {
  const double angle = std::sqrt(dot(turn, turn));
  const double twice = angle > 1e-3 ? 1.0 / (angle * angle) - 0.5 / (angle * std::tan(0.5 * angle)) : 1.0 / 12.0;
  const Vector3 first = cross(turn, spin);
  return spin + 0.5 * first + twice * cross(turn, first);
}

// Linear, square and cubic coefficient of a cubic that goes a way within a span (s), with its rates at both ends.
void fill_cubic(double span, const Vector3& way, const Vector3& rate, const Vector3& rate_end, Vector3* out) {
  const Vector3 mean = (1.0 / span) * way;
  out[0] = rate;
  out[1] = (1.0 / span) * (3.0 * mean - 2.0 * rate - rate_end);
  out[2] = (1.0 / (span * span)) * (rate + rate_end - 2.0 * mean);
}

}  // namespace

// [boots] p = Σ pᵢ τⁱ and A = A₀ exp [Σ φᵢ τⁱ]×, with their rates.
void BootMotion::set(double time, FlexibleSki& stage) const {
  const double t = time - start;
  stage.boot = place[0] + t * (place[1] + t * (place[2] + t * place[3]));
  stage.velocity = place[1] + t * (2.0 * place[2] + t * 3.0 * place[3]);
  const Vector3 angle = t * (turn[0] + t * (turn[1] + t * turn[2]));
  const Vector3 rate = turn[0] + t * (2.0 * turn[1] + t * 3.0 * turn[2]);
  double turned[3][3];
  rotation_matrix(angle, turned);
  for (std::size_t c = 0; c < 3; c++)
    for (std::size_t a = 0; a < 3; a++) {
      stage.axes[c][a] = 0.0;
      for (std::size_t m = 0; m < 3; m++) stage.axes[c][a] += axes[m][a] * turned[m][c];
    }
  stage.turning = stage.in_body(angular_velocity(angle, rate));
}

BootMotion BootMotion::between(double start, double end, const BootPose& first, const BootPose& last) {
  BootMotion out{start, {first[0]}, {}, {}};
  double by[3][3];  // rotation from the first axes to the last, in the first
  for (std::size_t c = 0; c < 3; c++)
    for (std::size_t a = 0; a < 3; a++) out.axes[c][a] = first[1 + c][a], by[c][a] = dot(first[1 + c], last[1 + a]);
  const Vector3 twist = 0.5 * Vector3{by[2][1] - by[1][2], by[0][2] - by[2][0], by[1][0] - by[0][1]};
  const double sine = std::sqrt(dot(twist, twist));
  const double angle = std::atan2(sine, 0.5 * (by[0][0] + by[1][1] + by[2][2] - 1.0));
  if (!(angle <= 1.0 && start < end)) throw std::invalid_argument("a boot turns by more than a radian in a step");
  const Vector3 turn = (sine > 1e-12 ? angle / sine : 1.0) * twist;
  fill_cubic(end - start, last[0] - first[0], first[4], last[4], out.place + 1);
  const Vector3 rate = in_axes(&first[1], first[5]), rate_end = rate_of_turn(turn, in_axes(&last[1], last[5]));
  fill_cubic(end - start, turn, rate, rate_end, out.turn);
  return out;
}

void carry_rates(const FlexibleSki& stage, const Numbers& rates, double* out) {
  const Vector3 v = vector_at(rates.data()), o = vector_at(rates.data() + 3);
  const Vector3 a = in_axes(stage.axes, v + cross(o, stage.boot) + stage.velocity);
  const Vector3 b = in_axes(stage.axes, o + stage.turning);
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
  state_.position = carrier.position + carrier.in_space(stage.boot);
  for (std::size_t c = 0; c < 3; c++) {
    const Vector3 axis = carrier.in_space(stage.axes[c]);
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
  const Vector3 v = in_axes(stage.axes, stage.velocity), o = in_axes(stage.axes, stage.turning);
  double taken = 0.0;
  for (std::size_t a = 0; a < 3; a++) taken += residual_[a] * v[a] + residual_[a + 3] * o[a];
  return -taken;
}

void MovingSki::add_to(Body& carrier, const FlexibleSki& stage, double sign) const {
  double by[BODY][BORDER_ROW], half[BODY][BODY] = {};
  stage.fill_freedoms(by);
  for (int a = 0; a < BODY; a++)
    for (int b = 0; b < BODY; b++)
      for (int m = 0; m < BODY; m++) half[a][b] += body_.inertia[a][m] * by[m][b];
  for (int a = 0; a < BODY; a++)
    for (int b = 0; b < BODY; b++)
      for (int m = 0; m < BODY; m++) carrier.inertia[a][b] += sign * by[m][a] * half[m][b];
  carrier.mass += sign * body_.mass;
  carrier.first_moment = carrier.first_moment + sign * (stage.in_body(body_.first_moment) + body_.mass * stage.boot);
}

}  // namespace skisnow
