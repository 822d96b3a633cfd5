#include "dynamics/dynamics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace skisnow {

namespace {

// of Newton's method in a step under error control (with 12 twice as many steps of a slalom were rejected), and in a
// fixed one, which is rather halved
constexpr int MOST_ITERATIONS = 20, MOST_OF_FIXED = 12;
constexpr double SLOW = 0.5;         // contraction above which the matrix is made again within a step
constexpr double UNSEEN = 0.3;       // contraction to reckon with before it was seen
constexpr double LEAST_ERROR = 0.1;  // minimum of a step's own error, as a share of the tolerance
constexpr double OVERSHOOT = 0.3;    // work of the residual along a change, of the other sign, to go back for
constexpr double LEAST_SHARE_BACK = 0.1, MOST_SHARE_BACK = 0.9;  // shares of the change that may be kept
constexpr int MOST_BACKTRACKS = 2;                               // for one change
constexpr double FARTHEST = 1.0;  // way (m), turn (rad), bend beyond which a step has diverged
// work of what a step leaves of its equations, as a share of the energy exchanged, and at least (J)
constexpr double WORK_LEFT = 2e-5, LEAST_LEFT = 1e-5;
constexpr double MILNE = 0.35;  // error of BDF2 over its distance from the predictor, at equal steps 8/23

}  // namespace

Dynamics::Dynamics(Body body, SnowContact& contact, const StepRule& rule)
    : body_(std::move(body)), contact_(&contact), rule_(rule), layout_(body_.layout()), step_(rule.first) {
  body_.kernels = &contact.kernels().band;
  state = next_ = BodyState(layout_);
  rate_before_ = moved_ = increment_ = residual_ = change_ = difference_ = state.rate;
  system_ = BorderedSystem(layout_, contact.kernels().band);
  end_.poses.resize(body_.skis.size());
  end_.motions.resize(body_.skis.size());
  observe();
}

Dynamics::Formula Dynamics::formula(double h) const {
  const double w = last_step_ > 0.0 ? h / last_step_ : 0.0;
  const double newest = (1.0 + 2.0 * w) / (1.0 + w), before = w * w / (1.0 + w);
  return {h, h / newest, before / newest, newest / h, (1.0 + w) / h, before / h, w};
}

// [predict] Rates at the end, extrapolated by a share of the last change of the beams, and by `f.ratio` of the rest.
void Dynamics::predict(const Formula& f, double of_beams) {
  for (std::size_t i = 0; i < state.rate.size(); i++)
    next_.rate[i] = state.rate[i] + (i < BODY ? f.ratio : of_beams) * (state.rate[i] - rate_before_[i]);
  place(f);
}

// [place] Places at the end from the rates there: increments d = β v + (a₋/a₁) d₀, in the frame of the start.
void Dynamics::place(const Formula& f) {
  Numbers& d = increment_;
  for (std::size_t i = 3; i < d.size(); i++) d[i] = f.reach * next_.rate[i] + f.keep * moved_[i];
  const Vector3 velocity = rotated(d.data() + 3, next_.rate.data(), f.ratio > 0.0 ? 1.0 : 0.5);
  for (std::size_t a = 0; a < 3; a++) d[a] = f.reach * velocity[a] + f.keep * moved_[a];
  move(state, d, next_);
}

void Dynamics::fill_end() {
  for (std::size_t k = 0; k < body_.skis.size(); k++) {
    fill_pose(body_.skis[k], next_, layout_.first(int(k)), end_.poses[k]);
    fill_motion(body_.skis[k], next_, layout_.first(int(k)), end_.motions[k]);
  }
}

// Forces of the snow at the situation `end_`.
void Dynamics::add_snow(Numbers& out, bool with_tangent) {
  counts_.looks++;
  for (std::size_t k = 0; k < body_.skis.size(); k++) {
    const FlexibleSki& ski = body_.skis[k];
    const Wrench& snow = contact_->look(int(k), end_.poses[k], end_.motions[k], with_tangent);
    ski.add_wrench(snow.force, snow.moment, out);
    double* beam = out.data() + layout_.first(int(k));
    for (std::size_t j = 0; j < ski.unknown.size(); j++)
      for (int c = 0; c < 3 && ski.unknown[j] >= 0; c++) beam[ski.unknown[j] + c] += snow.beam[3 * j + std::size_t(c)];
  }
}

// [residual] F(x, v) - K (u + c w) - M (a₁ v - (1 + ω) v₀ + a₋ v₋₁)/h at the end.
void Dynamics::find_residual(const Formula& f, bool with_tangent) {
  if (!motions_.empty()) return find_moving_residual(f.newest, f.now, f.before, with_tangent, residual_);
  std::fill(residual_.begin(), residual_.end(), 0.0);
  fill_end();
  add_snow(residual_, with_tangent);
  add_forces(body_, layout_, next_, residual_);
  add_stiffness(body_, layout_, next_.bend, next_.rate, -1.0, residual_);
  for (std::size_t i = 0; i < difference_.size(); i++)
    difference_[i] = f.newest * next_.rate[i] - f.now * state.rate[i] + f.before * rate_before_[i];
  add_mass(body_, layout_, difference_, -1.0, residual_);
}

// The rows of the beams: mass, stiffness and coupling by their weights, and the snow's tangent.
void Dynamics::fill_beams(const BeamWeights& weights) {
  const auto combine = body_.kernels->combine;
  for (std::size_t k = 0; k < body_.skis.size(); k++) {
    const FlexibleSki& ski = body_.skis[k];
    contact_->find_tangent(int(k), end_.poses[k], weights.snow_stiffness, weights.snow_damping, tangent_);
    BorderedSystem::Clamp& clamp = system_.clamp(int(k));
    std::copy_n(&tangent_.body[0][0], BODY * BORDER_ROW, &clamp.own[0][0]);
    ski.fill_freedoms(clamp.by_body);
    for (const int place : ski.held_places) tangent_.beam[std::size_t(place)] = 0.0;
    const double stiffness = weights.stiffness + weights.damping * ski.damping;
    for (const FlexibleSki::FreeNodes& nodes : ski.free) {
      const auto row = std::size_t(nodes.unknown), from = std::size_t(3 * nodes.node);
      const int rows = 3 * nodes.count;
      combine(ski.mass_rows.data() + BAND_ROW * row, weights.mass, ski.stiffness_rows.data() + BAND_ROW * row,
              stiffness, tangent_.beam.data() + BAND_ROW * from, BAND_ROW * rows, system_.band(int(k), nodes.unknown));
      const double* coupling = ski.clamp_coupling.data() + BORDER_ROW * row;
      combine(coupling, weights.coupling, coupling, 0.0, tangent_.beam_by_body.data() + BORDER_ROW * from,
              BORDER_ROW * rows, system_.border(int(k), nodes.unknown));
      combine(coupling, weights.coupling, coupling, 0.0, tangent_.body_by_beam.data() + BORDER_ROW * from,
              BORDER_ROW * rows, system_.border_column(int(k), nodes.unknown));
    }
  }
}

// [matrix] W = M + β (β + c) K + β² K_snow + β D_snow.
bool Dynamics::factor(double reach) {
  counts_.factored++;
  for (int a = 0; a < BODY; a++) {
    for (int b = 0; b < BODY; b++) system_.corner[a][b] = body_.inertia[a][b];
    system_.held[a] = held_;
  }
  fill_beams({.mass = 1.0,
              .stiffness = reach * reach,
              .damping = reach,
              .coupling = 1.0,
              .snow_stiffness = reach * reach,
              .snow_damping = reach});
  flown_ = flies() ? reach : 0.0;
  return system_.factor();
}

// Whether no ski was in the snow at the last evaluation: the matrix then depends on β alone, if no boot moves.
bool Dynamics::flies() const {
  for (int k = 0; k < int(body_.skis.size()); k++)
    if (contact_->touches(k)) return false;
  return motions_.empty();
}

// How far rates move the boots, ends a metre off that turn with them, and the beams, in a time (m).
double Dynamics::size_of(const Numbers& rates, double reach) const {
  double most = 0.0, sum = 0.0;
  for (double each : rates) sum += each;
  if (!std::isfinite(sum)) return std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < BODY; a++) most = std::max(most, std::fabs(rates[a]));
  for (int k = 0; k < layout_.beams(); k++)
    for (int i = 0; i < layout_.size(k); i += 3)
      most = std::max(most, std::fabs(rates[std::size_t(layout_.first(k) + i)]));
  return most * reach;
}

// [line search] Go back along the last change of the rates where it overshot. Along the change δ the work β g·δ of the
// residual g falls from `begun` > 0 to a negative number: the snow's pressure rises with depth, so the line has one
// zero, and the secant through both ends estimates it. `share` of the change has been made.
void Dynamics::limit_overshoot(const Formula& f, double begun, double share, bool with_tangent) {
  for (int tries = 0; tries < MOST_BACKTRACKS; tries++) {
    double left = 0.0;
    for (std::size_t i = 0; i < residual_.size(); i++) left += f.reach * residual_[i] * change_[i];
    if (!(begun > 0.0 && left < -OVERSHOOT * begun)) return;
    const double shorter = share * std::clamp(begun / (begun - left), LEAST_SHARE_BACK, MOST_SHARE_BACK);
    for (std::size_t i = 0; i < residual_.size(); i++) next_.rate[i] -= (share - shorter) * change_[i];
    share = shorter;
    place(f);
    find_residual(f, with_tangent);
  }
}

// [newton] The rates at the step's end; returns whether they were found. Each step has its own matrix, and another one
// where the iterates contract slowly.
bool Dynamics::solve_step(const Formula& f) {
  const double displacement = 0.1 * contact_->shear_displacement();
  double last = std::numeric_limits<double>::infinity(), begun = 0.0, share = 1.0;
  bool renew = true;
  const int most = rule_.fixed ? MOST_OF_FIXED : MOST_ITERATIONS;
  for (int iteration = 0; iteration < most; iteration++) {
    find_residual(f, renew);
    if (iteration > 0) limit_overshoot(f, begun, share, renew);
    if (renew && !(flown_ == f.reach && flies()) && !factor(f.reach)) return false;
    begun = find_change(f);
    const double size = size_of(change_, f.reach);
    if (!(size < FARTHEST)) return false;
    if (iteration > 0) contraction_ = std::min(size / last, 0.99);
    renew = iteration > 0 && contraction_ > SLOW;
    share = iteration > 1 && size > 0.9 * last ? 0.5 : 1.0;
    last = size;
    for (std::size_t i = 0; i < change_.size(); i++) next_.rate[i] += share * change_[i];
    place(f);
    const double contraction = iteration > 0 ? contraction_ : std::max(contraction_, UNSEEN);
    // the change that is left is small beside the step's own error, or beside the tolerance where that is smaller
    const double own = std::clamp(error(f), LEAST_ERROR * tolerance(), tolerance());
    const bool is_close = contraction / (1.0 - contraction) * size < std::min(rule_.closeness * own, displacement);
    if (is_close && work_left(f) < WORK_LEFT * exchanged_ + LEAST_LEFT) return true;
  }
  return false;
}

// [work left] Work (J) of the residual in the step. The changes of the rates can be small, and yet the forces, of which
// the account of energy is made, far from those that move the body: in snow that is stiff or has a strong dashpot.
double Dynamics::work_left(const Formula& f) const {
  double power = 0.0;
  for (std::size_t i = 0; i < residual_.size(); i++) power += residual_[i] * next_.rate[i];
  return f.reach * std::fabs(power);
}

// The change W⁻¹ β g of the rates; returns the work β g·δ of the residual along it.
double Dynamics::find_change(const Formula& f) {
  double work = 0.0;
  for (std::size_t i = 0; i < residual_.size(); i++) change_[i] = f.reach * residual_[i];
  system_.solve(change_);
  counts_.iterations++;
  for (std::size_t i = 0; i < residual_.size(); i++) work += f.reach * residual_[i] * change_[i];
  return work;
}

// [error] Of place and rotation (m, rad), by Milne's device: distance from the explicit step of the same order.
double Dynamics::error(const Formula& f) const {
  const double now = f.h * (1.0 + 0.5 * f.ratio), before = -0.5 * f.h * f.ratio;
  double foreseen[BODY], worst = 0.0;
  for (std::size_t a = 0; a < BODY; a++) foreseen[a] = now * state.rate[a] + before * rate_before_[a];
  const Vector3 way = rotated(foreseen + 3, foreseen, 0.5);
  for (std::size_t a = 0; a < 3; a++) {
    worst = std::max(worst, std::fabs(increment_[a] - way[a]));
    worst = std::max(worst, std::fabs(increment_[a + 3] - foreseen[a + 3]));
  }
  return MILNE * worst;
}

// [powers] Each work W is integrated with the formula of the motion, a₁ W₁ - (1 + ω) W₀ + a₋ W₋₁ = h P₁. The power P
// jumps where a base meets the snow. The trapezoidal rule would count half of a jump before the motion feels it.
Work Dynamics::work_of_step(const Formula& f) const {
  Work power;
  for (std::size_t k = 0; k < body_.skis.size(); k++) {
    const ContactPower snow = contact_->power(int(k), end_.poses[k], end_.motions[k]);
    power.shear -= snow.shear;
    power.friction -= snow.friction;
    power.normal += snow.normal;
    power.snow_damping += snow.damping;
  }
  power.drag = drag_power(body_, next_);
  power.damping = damping_power(body_, layout_, next_);
  power.push = push_power(body_, next_);
  for (std::size_t k = 0; k < skis_.size() && !motions_.empty(); k++) power.boots += skis_[k].power(body_.skis[k]);
  Work out;
  for (double Work::* each : Work::PARTS) out.*each = f.reach * power.*each + f.keep * last_work_.*each;
  return out;
}

// Losses to the snow in the step that was accepted last: what its forces took less what the snow has stored of that.
// `pressure`, `shear`, `friction`: energies (J) that are stored at its end.
void Dynamics::add_losses(double pressure, double shear, double friction) {
  const SnowStore now{pressure, shear, friction, contact_->delayed_stored(), contact_->delayed_energy()},
      &before = store_;
  const double by_rate = last_work_.snow_damping + now.delayed_taken - before.delayed_taken;
  losses_.add(-last_work_.normal - (pressure - before.pressure) - by_rate, last_work_.shear - (shear - before.shear),
              by_rate - (now.delayed - before.delayed), pressure + shear);
  losses_.add_friction(last_work_.friction - (friction - before.friction));
  store_ = now;
}

void Dynamics::observe() {
  along_.clear();
  touches_ = false;
  for (int k = 0; k < int(body_.skis.size()); k++) {
    along_.push_back(along_nodes(contact_->runner(k), contact_->sections(k)));
    touches_ = touches_ || contact_->touches(k);
  }
}

void Dynamics::accept(const Formula& f, bool observed) {
  if (observed || !motions_.empty())
    feel_boots(f.newest, f.now, f.before);
  else
    follow_skis();
  last_work_ = weighed_ ? weighed_->work : work_of_step(f);
  for (double Work::* each : Work::PARTS) work_.*each += last_work_.*each;
  const double pressure = contact_->elastic_energy(), shear = contact_->held_energy();
  const double friction = contact_->stuck_energy();
  if (observed) observe();
  fill_end();
  contact_->accept(end_);
  add_losses(pressure, shear, friction);
  rate_before_ = state.rate;
  std::swap(state, next_);
  moved_ = increment_;
  const Vector3 way = rotated(increment_.data() + 3, increment_.data(), -1.0);
  for (std::size_t a = 0; a < 3; a++) moved_[a] = way[a];
  last_step_ = f.h;
  counts_.steps++;
  for (MovingSki& each : skis_) each.accept();
  now_ = weighed_ ? weighed_->end : total_energies();
  weighed_.reset();
  const EnergyBalance balance = energy_balance();
  exchanged_ = balance.exchanged;
  if (!rule_.fixed) follow_balance(balance);
}

bool Dynamics::is_sound(double h) const {
  double total = 0.0, farthest = 0.0;
  for (std::size_t a = 0; a < BODY; a++) farthest = std::max(farthest, std::fabs(h * next_.rate[a]));
  for (double each : next_.bend) total += each, farthest = std::max(farthest, std::fabs(each));
  for (double each : next_.rate) total += each;
  return std::isfinite(total) && farthest <= FARTHEST;
}

void Dynamics::begin() {
  place_boots(0.0);
  next_ = state;
  fill_end();
  end_.dt = 0.0;
  contact_->begin(end_);
  residual_.assign(residual_.size(), 0.0);
  add_snow(residual_, false);
  feel_boots(0.0, 0.0, 0.0);
  for (MovingSki& each : skis_) each.begin();
  observe();
  store_ = {contact_->elastic_energy(), contact_->held_energy(), contact_->stuck_energy(), 0.0, 0.0};
  contact_->accept(end_);
  store_.delayed = contact_->delayed_stored(), store_.delayed_taken = contact_->delayed_energy();
  work_ = last_work_ = Work();
  losses_ = SnowAccount();
  start_ = total_energies();
  narrowed_ = 0;
  counts_ = Counts();
  last_step_ = free_ = 0.0;
  time = 0.0;
  share_ = 1.0;
  step_ = rule_.fixed ? rule_.first : on_ladder(rule_.first);
}

}  // namespace skisnow
