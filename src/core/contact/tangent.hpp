// How the snow's forces on one runner change with its pose and motion, section by section.
#pragma once

#include <algorithm>
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

  void clear(int nodes) {
    for (auto& row : body) std::fill(std::begin(row), std::end(row), 0.0);
    body_by_beam.assign(std::size_t(3 * BORDER_ROW * nodes), 0.0);
    beam_by_body = body_by_beam;
    beam.assign(std::size_t(3 * BAND_ROW * nodes), 0.0);
  }

  // Forces stay where they are in space as the ski's axes turn, and as the boot goes away from them.
  void add_turning(const Wrench& wrench, double weight) {
    for (int c = 0; c < 3; c++) {
      const int p = (c + 1) % 3, q = (c + 2) % 3;  // axis c × (axis p, axis q) = (axis q, - axis p)
      body[q][3 + c] += weight * wrench.force[p], body[p][3 + c] -= weight * wrench.force[q];
      body[3 + q][3 + c] += weight * wrench.moment[p], body[3 + p][3 + c] -= weight * wrench.moment[q];
      body[3 + q][c] += weight * wrench.force[p], body[3 + p][c] -= weight * wrench.force[q];
    }
  }
};

}  // namespace skisnow
