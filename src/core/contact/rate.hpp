// Snow that takes time: p = p_e + c ε', where p_e is what the core's own law answers to ε - ε₂, and ε₂ the depth of a
// Kelvin element in series with it, p_e = H₂ ε₂ + c₂ ε₂'. Neither pulls.
//
// Equations: docs/methods/snow-options.md.
#pragma once

#include <vector>

#include "contact/sections.hpp"

namespace skisnow {

// A step of the Kelvin element while its stress goes straight from that before to that now:
// ε₂ = keep ε₂_before + before p_before + now p_now.
struct KelvinStep {
  double keep = 1.0, before = 0.0, now = 0.0;

  KelvinStep() = default;
  KelvinStep(const RateLaw& law, double hardness, double dt);
};

// How the boot and the beam under a section move, in the ski's axes.
struct BaseMotion {
  double velocity[3] = {}, turning[3] = {}, deflecting = 0.0, twisting = 0.0;
};

// One runner over snow that takes time: pressure of its sections instead of the kernels', and its delayed depth.
class RatedBase {
 public:
  // Force, moment, elastic energy of all sections that touch, and the power (W) that c takes.
  void press(const Snow& snow, const GrooveLines& lines, const Pose& pose, const Motion& motion, double dt,
             Sections& s);
  // As the kernel of that name; and by local rates instead of movements, the effect of the boot's motion.
  void differ(const Snow& snow, const GrooveLines& lines, const Sections& s, double step, double sense,
              SectionDifferences& out) const;
  void differ_rates(const Snow& snow, const GrooveLines& lines, const Sections& s, double sense,
                    SectionDifferences& out) const;

 private:
  std::vector<BaseMotion> moving_;  // at the sections that were looked at last
  double dt_ = 0.0;                 // of that step (s)
};

// The delayed depth of a runner's lines at the end of a step, for which the sections stand; energy (J) that it took.
double advance_delayed(const Snow& snow, const Sections& s, double dt, GrooveLines& lines);

}  // namespace skisnow
