#include "contact/tangent.hpp"

#include <algorithm>

namespace skisnow {

void RunnerTangent::clear(int nodes) {
  for (auto& row : body) std::fill(std::begin(row), std::end(row), 0.0);
  body_by_beam.assign(std::size_t(3 * BORDER_ROW * nodes), 0.0);
  beam_by_body = body_by_beam;
  beam.assign(std::size_t(3 * BAND_ROW * nodes), 0.0);
}

void RunnerTangent::add_turning(const Wrench& wrench, double weight) {
  for (int c = 0; c < 3; c++) {
    const int p = (c + 1) % 3, q = (c + 2) % 3;  // axis c × (axis p, axis q) = (axis q, - axis p)
    body[q][3 + c] += weight * wrench.force[p], body[p][3 + c] -= weight * wrench.force[q];
    body[3 + q][3 + c] += weight * wrench.moment[p], body[3 + p][3 + c] -= weight * wrench.moment[q];
    body[3 + q][c] += weight * wrench.force[p], body[3 + p][c] -= weight * wrench.force[q];
  }
}

}  // namespace skisnow
