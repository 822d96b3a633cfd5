// How the snow's forces on one runner change with its pose and motion, section by section.
#pragma once

#include <vector>

#include "contact/sections.hpp"

namespace skisnow {

// Minus the derivatives of the forces on a runner by its unknowns, weighted sums of stiffness and damping. The body's
// six: force, and moment about the boot, by a way of the boot and a rotation about it, all in the ski's axes. The
// beam's: three to each node. Rows as those of a `BorderedSystem`.
struct RunnerTangent {
  double body[BODY][BORDER_ROW];
  Column body_by_beam, beam_by_body;  // (3 nodes, 8): six in use, both with a row for each unknown of the beam
  Column beam;                        // (3 nodes, 16): columns row - 5 to row + 5

  void clear(int nodes);
  // Forces stay where they are in space as the ski's axes turn, and as the boot goes away from them.
  void add_turning(const Wrench& wrench, double weight);
};

}  // namespace skisnow
