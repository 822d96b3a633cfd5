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

// Add to a tangent what the sections' derivatives give, and the turning of the forces with the ski's axes.
void add_stiffness(const Runner& runner, const Sections& sections, const SectionDifferences& minus,
                   const Wrench& wrench, double weight, RunnerTangent& out);
// Add what friction gives: it grows with the sliding speed.
void add_friction_damping(const Runner& runner, const Sections& sections, double weight, RunnerTangent& out);

}  // namespace skisnow
