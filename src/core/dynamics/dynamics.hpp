// Motion of a body on flexible skis over snow: BDF2 with any ratio of steps, Newton's method at the step's end, error
// control over a ladder of steps, and the static equilibrium from which a run starts.
#pragma once

#include <optional>

#include "beam/along.hpp"
#include "contact/contact.hpp"
#include "dynamics/body.hpp"
#include "dynamics/boots.hpp"
#include "dynamics/snow_account.hpp"

namespace skisnow {

struct StepRule {
  double first = 1e-4;  // step (s), with `fixed` every step
  bool fixed = false;
  double tolerance = 1e-6;                 // error of place (m) of one step, by its own estimate
  double shortest = 1e-7, longest = 6e-3;  // (s)
  double closeness = 0.2;                  // share of a step's own error to which Newton's method solves it
};

enum class Advance { REACHED = 0, STEP_TOO_SMALL = 1, NOT_FINITE = 2, PAUSED = 3 };

struct Counts {
  long steps = 0, rejected = 0, looks = 0, factored = 0, iterations = 0;
};

// Energy (J) that was taken since the start by shear, friction, air and the skis' damping, and given to the base by the
// snow's normal force; what of it the snow's dashpot took; and what whoever moves the boots and pushes the body gave.
struct Work {
  double shear = 0.0, friction = 0.0, normal = 0.0, drag = 0.0, damping = 0.0, snow_damping = 0.0;
  double boots = 0.0, push = 0.0;

  double taken() const { return shear + friction - normal + drag + damping - boots - push; }  // from the body and skis
  static constexpr double Work::* PARTS[] = {&Work::shear,   &Work::friction,     &Work::normal, &Work::drag,
                                             &Work::damping, &Work::snow_damping, &Work::boots,  &Work::push};
};

class Dynamics {
 public:
  Dynamics(Body body, SnowContact& contact, const StepRule& rule);

  BodyState state;
  double time = 0.0;

  const Body& body() const { return body_; }
  const StepRule& rule() const { return rule_; }
  void set_contact(SnowContact& contact) { contact_ = &contact; }  // a copy of the same
  const Layout& layout() const { return layout_; }
  const Counts& counts() const { return counts_; }
  const Work& work() const { return work_; }
  double next_step() const { return step_; }
  // Depth and forces of the snow along one ski at the last moment that `advance` or `begin` reached.
  const Along& along(int k) const { return along_[std::size_t(k)]; }
  const SnowStore& snow_store() const { return store_; }      // after the last step
  const SnowAccount& snow_losses() const { return losses_; }  // since `begin`
  bool touches() const { return touches_; }                   // whether any ski is in the snow

  // Boots: each ski's inertia about its boot, in its own axes, (6, 6), lets what it does to its boot be known, and lets
  // the boots move. Then, before each `advance`, which may not go beyond their ends, their motions can be set again.
  void set_skis(const std::vector<double>& inertia);
  void move_boots(std::vector<BootMotion> motions);
  // The body stays as it is; with boots that move, they alone carry the skis.
  void hold_body() { held_ = true; }
  void set_push(const Vector3& force, const Vector3& at);
  // Force and moment of a ski on its boot, about it in its axes, at the last moment that `advance` or `begin` reached
  // (6); null where the inertia of the skis is unknown.
  const Vector3* boot_wrench(int k) const { return boot_.empty() ? nullptr : boot_[std::size_t(k)].data(); }
  Energies total_energies() const;
  const FlexibleSki& stage(int k) const { return body_.skis[std::size_t(k)]; }

  // Move to static equilibrium in height, roll, pitch and bend; place and heading are held. Newton's last step (m).
  double settle();
  // The run begins at the present state: the snow remembers it.
  void begin();
  // Steps until a time (s); paused after `most` steps, or after a while.
  Advance advance(double until, long most);

  // All that the next step hangs on, but for the contact, as bytes, and back into one of the same body; what was
  // observed comes with the next moment reached. Throws std::invalid_argument, and may then have changed some of it.
  void write(ByteWriter& out) const;
  void read(ByteReader& in);

 private:
  Body body_;
  SnowContact* contact_;
  StepRule rule_;
  Layout layout_;
  Counts counts_;
  Work work_, last_work_;  // last_work_: work of only the last step
  double step_;

  // the last accepted step: rates before it, its increments in the frame of its end, its length (s)
  Numbers rate_before_, moved_;
  double last_step_ = 0.0;
  double share_ = 1.0;  // share of a fixed step, less than 1 if Newton's method has failed
  // energies at the start, now, and in the snow; rungs of the ladder by which steps are shorter for the balance of
  // energy
  Energies start_{0.0, 0.0, 0.0}, now_{0.0, 0.0, 0.0};
  struct Weighed {  // work and energies of a step that is tried
    Work work;
    Energies end;
  };
  std::optional<Weighed> weighed_;
  SnowStore store_;
  SnowAccount losses_;
  double exchanged_ = 0.0;  // energy (J) until the last step
  int narrowed_ = 0;
  double free_ = 0.0;  // iterations that do not count against a run
  // skis as separate bodies; boots that move; the body without skis
  std::vector<MovingSki> skis_;
  std::vector<BootMotion> motions_;
  Body trunk_;
  bool held_ = false;
  std::vector<std::array<Vector3, 2>> boot_;
  // observations at the last moment reached
  std::vector<Along> along_;
  bool touches_ = false;
  // the step in the making
  BodyState next_;
  Numbers increment_, residual_, change_, difference_;
  Situation end_;
  BorderedSystem system_;
  RunnerTangent tangent_;
  double contraction_ = 0.5;  // of Newton's method in its last iteration
  double flown_ = 0.0;        // β of the matrix that is factored, if no ski was in the snow; else 0

  template <class Stream, class Motion>
  static void pass(Stream& stream, Motion& of);  // to or from bytes

  struct Formula {
    double h, reach, keep;       // β = h/a₁; share of the last increments
    double newest, now, before;  // weights of the rates: a₁, 1 + ω, a₋, over h
    double ratio;                // ω, 0 for Euler's step
  };
  Formula formula(double h) const;
  void predict(const Formula& f, double of_beams);
  void place(const Formula& f);
  void fill_end();
  void add_snow(Numbers& out, bool with_tangent);
  void find_residual(const Formula& f, bool with_tangent);
  void find_moving_residual(double newest, double now, double before, bool with_tangent, Numbers& out);
  void place_boots(double when);
  void follow_skis();
  void feel_boots(double newest, double now, double before);
  bool factor(double reach);
  bool flies() const;
  struct BeamWeights {
    double mass, stiffness, damping, coupling, snow_stiffness, snow_damping;
  };
  void fill_beams(const BeamWeights& weights);
  double size_of(const Numbers& rates, double reach) const;
  double find_change(const Formula& f);
  double work_left(const Formula& f) const;
  void limit_overshoot(const Formula& f, double begun, double share, bool with_tangent);
  bool solve_step(const Formula& f);
  double error(const Formula& f) const;
  void accept(const Formula& f, bool observed);
  void observe();
  Work work_of_step(const Formula& f) const;
  bool loses_energy(const Formula& f);
  void add_losses(double pressure, double shear, double friction);
  struct EnergyBalance {
    double open, exchanged;  // (J)
  };
  EnergyBalance energy_balance() const;
  void follow_balance(const EnergyBalance& balance);
  double tolerance() const;
  double longest() const;
  bool is_sound(double h) const;
  double on_ladder(double h) const;
  enum class Tried { TAKEN, AGAIN, GIVEN_UP };
  void reject();
  Tried after_fixed(bool solved);
  Tried after_controlled(const Formula& f, double h, bool solved);
  double static_length(const Numbers& step) const;
  bool factor_static(double inertia);
  double static_square(const Numbers& left) const;
  void find_height(Numbers& left);
  double find_equilibrium();
  void stand();
  double static_step(double inertia, Numbers& left, Numbers& step);
  void static_residual(const BodyState& at, Numbers& out);
};

}  // namespace skisnow
