// Boots with a prescribed motion against the body, and the force of each ski on its boot.
//
// Each ski is a separate body with its origin at its boot. Its velocities follow from those of the body that carries it
// and from the boot's own motion, which is given over time; what is left over of its equations of motion is what it
// does to its boot.
#pragma once

#include "contact/sections.hpp"
#include "dynamics/body.hpp"

namespace skisnow {

// A boot in the body's frame: its place, axes ahead, left and off the base, velocity and angular velocity.
using BootPose = std::array<Vector3, 6>;

// Motion of a boot against the body, in the body's frame: its place, and the rotation vector from its axes at the
// beginning, in those axes, are cubics in the time since then.
struct BootMotion {
  double start = 0.0;      // (s)
  Vector3 place[4] = {};   // coefficients, constant first (m, m/s, …)
  Vector3 turn[3] = {};    // linear first (rad/s, …)
  double axes[3][3] = {};  // at the beginning, rows ahead, left and up

  void set(double time, FlexibleSki& stage) const;  // boot, axes and their rates
  // From one pose to another, which it meets with their rates. Throws std::invalid_argument beyond a turn of 1 rad.
  static BootMotion between(double start, double end, const BootPose& first, const BootPose& last);
};

// From the rates of a body to those of a ski on it, in the ski's axes.
void carry_rates(const FlexibleSki& stage, const Numbers& rates, double* out);

class MovingSki {
 public:
  // `stage`: as it is clamped to its carrier; `inertia`: of the undeformed ski about its boot, in its own axes.
  MovingSki(const FlexibleSki& stage, const double* inertia, const Body& carrier);

  const Body& body() const { return body_; }
  const Layout& layout() const { return layout_; }
  const BodyState& state() const { return state_; }
  const Numbers& residual() const { return residual_; }

  // Be where the carrier takes it; its beam's numbers begin there at `first`.
  void follow(const FlexibleSki& stage, const BodyState& carrier, int first);
  // What is left over of its equations of motion under the snow's wrench; by rates of the end, the start and the start
  // before, with these weights (1/s).
  void find_residual(const Wrench& snow, double newest, double now, double before);
  void begin() { now_ = before_ = state_.rate; }
  void accept();  // the next step starts where it is
  // Power (W) of whoever moves the boot against its carrier.
  double power(const FlexibleSki& stage) const;
  // Adds the undeformed ski, in its pose on its carrier, to a body, or with -1 takes it out.
  void add_to(Body& carrier, const FlexibleSki& stage, double sign) const;
  template <class Stream, class Ski>
  static void pass(Stream& stream, Ski& ski);  // to or from bytes

 private:
  Body body_;
  Layout layout_;
  BodyState state_;
  Numbers now_, before_, difference_, residual_;
};

}  // namespace skisnow
