// How the snow's forces on one runner change with its pose and motion, section by section.
#pragma once

#include <vector>

#include "sections.hpp"

namespace skisnow {

// Minus the derivatives of the forces on a runner by its unknowns, weighted sums of stiffness and damping. The body's
// six: force, and moment about the boot, by a way of the boot and a rotation about it, all in the ski's axes. The
// beam's: three to each node.
struct RunnerTangent {
  double body[6][6];
  std::vector<double> body_by_beam, beam_by_body;  // (3 nodes, 6), both with a row for each unknown of the beam
  std::vector<double> beam;                        // (3 nodes, 11): columns row - 5 to row + 5

  void clear(int nodes);
};

// Derivatives of a section's eight answers (force, moment about the boot, force and moment on the beam) by ten changes:
// way of the boot, rotation, and what the beam does there (deflection, rise, twist, its slope).
struct SectionDifferences {
  static constexpr int ANSWERS = 8, CHANGES = 10;
  std::vector<double> values;  // [change][answer][section]
  int count = 0;

  void resize(int sections);
  double* column(int change, int answer) {
    return values.data() + (std::size_t(change) * ANSWERS + std::size_t(answer)) * std::size_t(count);
  }
};

// The pose after one of the ten changes.
Pose changed(const Pose& pose, int change, double step);
// Way to the left, roll, yaw, twist and its slope.
inline bool turns_in_mirror(int change) { return change == 1 || change == 3 || change == 5 || change >= 8; }

// Add to a tangent what the sections' derivatives give.
void add_stiffness(const Runner& runner, const Sections& sections, SectionDifferences& minus, double weight,
                   RunnerTangent& out);
// Add what friction gives: it grows with the sliding speed.
void add_friction_damping(const Runner& runner, const Sections& sections, double weight, RunnerTangent& out);

}  // namespace skisnow
