// The length of the steps: by their own error and the balance of energy, or fixed.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "dynamics/dynamics.hpp"

namespace skisnow {

namespace {

constexpr double LEAST_SHARE = 1.0 / 64;                 // smallest part of a fixed step that is not solved whole
constexpr double SAFETY = 0.85, UP = 1.35, DOWN = 0.93;  // safety and hysteresis of the choice of steps
constexpr std::chrono::milliseconds LONGEST_STAY(50);    // within the core, before it pauses to hear an interrupt
constexpr double ROUNDING = 1e-9;                        // share of a step's length
constexpr double LEAD = 0.25;  // share of their last change by which the beams' rates lead where grooves follow them
// share of the energy exchanged by which a balance may be open before steps get shorter; the least open energy (J)
constexpr double MOST_OPEN = 2e-3, LEAST_OPEN = 0.01;
constexpr double STEP_OPEN = 2e-4;  // of the energy exchanged, open after one step, which is repeated shorter
constexpr double SHORT = 5.0;       // steps that are not repeated, over the shortest
constexpr int MOST_NARROWED = 12;   // rungs by which steps get shorter: three octaves
// iterations of Newton's method for each simulated second that do not count, and those beyond, after which a run ends,
// since it would take hours: more than a million a second in very strong and soft snow, 10,000 to 50,000 otherwise
constexpr double FREE_ITERATIONS = 1e5, MOST_ITERATIONS_BEYOND = 1e4;

}  // namespace

Dynamics::EnergyBalance Dynamics::energy_balance() const {
  const double taken = work_.taken(), open = std::fabs(now_.sum() - start_.sum() + taken);
  return {open, start_.kinetic + std::max(taken, 0.0) + std::max(start_.potential - now_.potential, 0.0)};
}

// [balance] BDF2 damps vibrations that its steps do not resolve. The open balance of energy shows by how much. Where it
// exceeds its share of the energy exchanged, steps get shorter by a rung of the ladder; they get longer again where it
// is well below.
void Dynamics::follow_balance(const EnergyBalance& balance) {
  const double most = MOST_OPEN * balance.exchanged + LEAST_OPEN;
  if (balance.open > most)
    narrowed_ = std::min(narrowed_ + 1, MOST_NARROWED);
  else if (balance.open < 0.5 * most)
    narrowed_ = std::max(narrowed_ - 1, 0);
}

// [step balance] Whether a step leaves much of the energy open: one that passes over a vibration or a strong dashpot.
bool Dynamics::loses_energy(const Formula& f) {
  if (!motions_.empty() || f.h < SHORT * rule_.shortest) return false;
  weighed_ = {work_of_step(f), energies(body_, layout_, next_)};
  const double open = weighed_->end.sum() - now_.sum() + weighed_->work.taken();
  return std::fabs(open) > STEP_OPEN * exchanged_ + LEAST_OPEN;
}

double Dynamics::tolerance() const { return rule_.tolerance * std::exp2(-0.75 * narrowed_); }

double Dynamics::longest() const { return rule_.longest * std::exp2(-0.25 * narrowed_); }

double Dynamics::on_ladder(double h) const {
  return rule_.longest * std::exp2(0.25 * std::floor(4.0 * std::log2(h / rule_.longest) + 1e-6));
}

// Take back the step that was tried.
void Dynamics::reject() {
  contact_->take_back();
  weighed_.reset();
  counts_.rejected++;
}

// After a fixed step: halved where it was not solved, and so on.
Dynamics::Tried Dynamics::after_fixed(bool solved) {
  if (solved) {
    share_ = std::min(1.0, 2.0 * share_);
    return Tried::TAKEN;
  }
  reject();
  share_ *= 0.5;
  return share_ < LEAST_SHARE ? Tried::GIVEN_UP : Tried::AGAIN;
}

// After a step h under error control: the next one's length.
Dynamics::Tried Dynamics::after_controlled(const Formula& f, double h, bool solved) {
  double wanted = solved ? SAFETY * std::cbrt(tolerance() / std::max(error(f), 1e-30)) : 0.5;
  if (solved && wanted >= SAFETY && loses_energy(f)) wanted = 0.5;
  if (wanted < SAFETY) {
    reject();
    step_ = on_ladder(h * std::clamp(wanted, 0.1, 0.8));
    return step_ < rule_.shortest ? Tried::GIVEN_UP : Tried::AGAIN;
  }
  free_ = std::min(free_ + FREE_ITERATIONS * step_, double(counts_.iterations));
  if (h * wanted > UP * step_)
    step_ = std::min(longest(), on_ladder(step_ * 1.19));
  else if (h * wanted < DOWN * step_)
    step_ = on_ladder(h * wanted);
  step_ = std::min(step_, longest());
  return Tried::TAKEN;
}

Advance Dynamics::advance(double until, long most) {
  const auto entered = std::chrono::steady_clock::now();
  now_ = total_energies();
  exchanged_ = energy_balance().exchanged;
  for (long tries = 0; time < until; tries++) {
    if (tries == most) return Advance::PAUSED;
    if (tries > 0 && std::chrono::steady_clock::now() - entered > LONGEST_STAY) return Advance::PAUSED;
    if (!rule_.fixed && double(counts_.iterations) - free_ > MOST_ITERATIONS_BEYOND) return Advance::STEP_TOO_SMALL;
    const double left = until - time;  // is divided into equal steps
    double h = left / std::max(1.0, std::ceil(left / step_ - ROUNDING));
    if (std::fabs(h - last_step_) < ROUNDING * h) h = last_step_;
    h *= share_;
    const Formula f = formula(h);
    place_boots(time + h);
    // Steps under error control do not resolve vibrations of the beams: their rates change less evenly than the body's.
    predict(f, rule_.fixed ? f.ratio : LEAD * std::min(f.ratio, 1.0));
    fill_end();
    end_.dt = h;
    contact_->begin(end_);
    predict(f, f.ratio);
    const bool solved = solve_step(f) && is_sound(h);
    const Tried tried = rule_.fixed ? after_fixed(solved) : after_controlled(f, h, solved);
    if (tried == Tried::GIVEN_UP) return rule_.fixed ? Advance::NOT_FINITE : Advance::STEP_TOO_SMALL;
    if (tried == Tried::AGAIN) continue;
    const bool reached = h >= left * (1.0 - ROUNDING);
    time = reached ? until : time + h;
    accept(f, reached);
  }
  return Advance::REACHED;
}

}  // namespace skisnow
