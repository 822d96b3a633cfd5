#include "linear_algebra/bordered.hpp"

#include <algorithm>
#include <cmath>

#include "linear_algebra/dense.hpp"

namespace skisnow {

Layout::Layout(const std::vector<int>& sizes) : size_(sizes) {
  for (int size : sizes) {
    first_.push_back(length_);
    // whole rows, and one more: the last of them reaches HALF_BAND beyond its end
    length_ += (size + BORDER_ROW - 1) / BORDER_ROW * BORDER_ROW + BORDER_ROW;
  }
}

BeamColumns::BeamColumns(const std::vector<double>& rows)
    : size_(int(rows.size()) / BODY), stride_((size_ + BORDER_ROW - 1) / BORDER_ROW * BORDER_ROW + BORDER_ROW) {
  numbers_.assign(std::size_t(BODY * stride_), 0.0);
  for (int i = 0; i < size_; i++)
    for (int c = 0; c < BODY; c++) numbers_[std::size_t(c * stride_ + i)] = rows[std::size_t(BODY * i + c)];
}

BorderedSystem::BorderedSystem(const Layout& layout, const BandKernels& kernels) : layout_(layout), kernels_(&kernels) {
  const auto rows = std::size_t(layout.length() + BORDER_ROW);
  band_.resize(BAND_ROW * rows);
  border_.resize(BORDER_ROW * rows);
  column_.resize(BORDER_ROW * rows);
  clamps_.resize(std::size_t(layout.beams()));
  clear();
}

void BorderedSystem::clear() {
  for (auto& row : corner) std::fill(std::begin(row), std::end(row), 0.0);
  for (Column* each : {&band_, &border_, &column_}) std::fill(each->begin(), each->end(), 0.0);
}

BeamRows BorderedSystem::rows(int beam) const {
  auto* self = const_cast<BorderedSystem*>(this);
  return {layout_.size(beam), self->band(beam, 0), self->border(beam, 0), self->border_column(beam, 0)};
}

bool BorderedSystem::factor() {
  for (int beam = 0; beam < layout_.beams(); beam++) {
    Clamp& clamp = clamps_[std::size_t(beam)];
    if (!kernels_->eliminate(rows(beam), &clamp.own[0][0])) return false;
    kernels_->add_congruent(&clamp.own[0][0], &clamp.by_body[0][0], &corner[0][0]);
  }
  for (int a = 0; a < BODY; a++)
    for (int b = 0; b < BODY && held[a]; b++) corner[a][b] = corner[b][a] = a == b ? 1.0 : 0.0;
  factor_dense(&corner[0][0], BODY, BORDER_ROW, order_);
  for (int a = 0; a < BODY; a++)
    if (!(std::fabs(corner[a][a]) > 0.0)) return false;
  return true;
}

void BorderedSystem::solve(Numbers& vector) const {
  double right[BORDER_ROW] = {};
  std::copy_n(vector.data(), BODY, right);
  for (int beam = 0; beam < layout_.beams(); beam++) {
    double at_clamp[BORDER_ROW] = {};
    kernels_->substitute_forwards(rows(beam), vector.data() + layout_.first(beam), at_clamp);
    const auto& by = clamps_[std::size_t(beam)].by_body;
    for (int a = 0; a < BODY; a++)
      for (int m = 0; m < BODY; m++) right[a] += by[m][a] * at_clamp[m];
  }
  for (int a = 0; a < BODY; a++)
    if (held[a]) right[a] = 0.0;
  solve_dense(&corner[0][0], BODY, BORDER_ROW, order_, right);
  std::copy_n(right, BODY, vector.data());
  for (int beam = 0; beam < layout_.beams(); beam++) {
    double at_clamp[BORDER_ROW] = {};
    const auto& by = clamps_[std::size_t(beam)].by_body;
    for (int m = 0; m < BODY; m++)
      for (int a = 0; a < BODY; a++) at_clamp[m] += by[m][a] * right[a];
    kernels_->substitute_backwards(rows(beam), at_clamp, vector.data() + layout_.first(beam));
  }
}

}  // namespace skisnow
