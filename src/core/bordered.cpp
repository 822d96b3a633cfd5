#include "bordered.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace skisnow {

Layout::Layout(const std::vector<int>& sizes) : size_(sizes) {
  for (int size : sizes) {
    first_.push_back(length_);
    length_ += (size + HALF_BAND + BORDER_ROW - 1) / BORDER_ROW * BORDER_ROW;
  }
}

BorderedSystem::BorderedSystem(const Layout& layout) : layout_(layout) {
  const auto rows = std::size_t(layout.length() + BORDER_ROW);
  band_.resize(BAND_ROW * rows);
  border_.resize(BORDER_ROW * rows);
  column_.resize(BORDER_ROW * rows);
  clear();
}

void BorderedSystem::clear() {
  for (auto& row : corner) std::fill(std::begin(row), std::end(row), 0.0);
  for (Column* each : {&band_, &border_, &column_}) std::fill(each->begin(), each->end(), 0.0);
}

bool BorderedSystem::eliminate(int beam) {
  for (int i = 0; i < layout_.size(beam); i++) {
    double* a = band(beam, i) + HALF_BAND;
    double* b = border(beam, i);
    double* c = border_column(beam, i);
    if (!(std::fabs(*a) > 0.0)) return false;
    const double inverse = 1.0 / *a;
    for (int r = 0; r < BORDER_ROW; r++) c[r] *= inverse;
    for (int j = 1; j <= HALF_BAND; j++) {
      double* below = band(beam, i + j) + HALF_BAND - j;
      const double share = *below * inverse, right = a[j];
      *below = share;
      for (int m = 1; m <= HALF_BAND; m++) below[m] -= share * a[m];
      double* border_below = border(beam, i + j);
      double* column_right = border_column(beam, i + j);
      for (int r = 0; r < BORDER_ROW; r++) border_below[r] -= share * b[r];
      for (int r = 0; r < BORDER_ROW; r++) column_right[r] -= c[r] * right;
    }
    for (int r = 0; r < BODY; r++)
      for (int s = 0; s < BODY; s++) corner[r][s] -= c[r] * b[s];
    *a = inverse;
  }
  return true;
}

bool BorderedSystem::factor_corner() {
  for (int i = 0; i < BODY; i++) order_[i] = i;
  for (int i = 0; i < BODY; i++) {
    int best = i;
    for (int r = i + 1; r < BODY; r++)
      if (std::fabs(corner[r][i]) > std::fabs(corner[best][i])) best = r;
    if (!(std::fabs(corner[best][i]) > 0.0)) return false;
    std::swap(order_[i], order_[best]);
    for (int c = 0; c < BODY; c++) std::swap(corner[i][c], corner[best][c]);
    for (int r = i + 1; r < BODY; r++) {
      corner[r][i] /= corner[i][i];
      for (int c = i + 1; c < BODY; c++) corner[r][c] -= corner[r][i] * corner[i][c];
    }
  }
  return true;
}

bool BorderedSystem::factor() {
  for (int beam = 0; beam < layout_.beams(); beam++)
    if (!eliminate(beam)) return false;
  return factor_corner();
}

void BorderedSystem::solve_corner(double* right) const {
  double x[BODY];
  for (int i = 0; i < BODY; i++) {
    x[i] = right[order_[i]];
    for (int c = 0; c < i; c++) x[i] -= corner[i][c] * x[c];
  }
  for (int i = BODY - 1; i >= 0; i--) {
    for (int c = i + 1; c < BODY; c++) x[i] -= corner[i][c] * x[c];
    x[i] /= corner[i][i];
  }
  std::copy_n(x, BODY, right);
}

void BorderedSystem::solve(Numbers& vector) const {
  double right[BORDER_ROW] = {};
  std::copy_n(vector.data(), BODY, right);
  for (int beam = 0; beam < layout_.beams(); beam++)
    for (int i = 0; i < layout_.size(beam); i++) {
      const auto row = at(beam, i);
      double* x = vector.data() + row;
      for (int j = 1; j <= HALF_BAND; j++) x[j] -= band_[BAND_ROW * (row + std::size_t(j)) + HALF_BAND - j] * *x;
      for (int r = 0; r < BORDER_ROW; r++) right[r] -= column_[BORDER_ROW * row + std::size_t(r)] * *x;
    }
  solve_corner(right);
  std::copy_n(right, BODY, vector.data());
  for (int beam = 0; beam < layout_.beams(); beam++)
    for (int i = layout_.size(beam) - 1; i >= 0; i--) {
      const auto row = at(beam, i);
      double* x = vector.data() + row;
      const double* a = band_.data() + BAND_ROW * row + HALF_BAND;
      double total = *x;
      for (int r = 0; r < BODY; r++) total -= border_[BORDER_ROW * row + std::size_t(r)] * right[r];
      for (int j = 1; j <= HALF_BAND; j++) total -= a[j] * x[j];
      *x = total * a[0];
    }
}

}  // namespace skisnow
