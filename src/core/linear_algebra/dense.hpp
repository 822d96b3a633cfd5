// Dense linear systems of n unknowns: LU with row pivots. Rows lie `stride` numbers apart.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

namespace skisnow {

// Factor in place; `order` gets n row numbers. Not finite where the matrix is singular.
inline void factor_dense(double* matrix, int n, int stride, int* order) {
  for (int k = 0; k < n; k++) {
    double* row = matrix + k * stride;
    int best = k;
    for (int i = k + 1; i < n; i++)
      if (std::fabs(matrix[i * stride + k]) > std::fabs(matrix[best * stride + k])) best = i;
    order[k] = best;
    if (best != k) std::swap_ranges(row, row + n, matrix + best * stride);
    const double pivot = 1.0 / row[k];
    for (int i = k + 1; i < n; i++) {
      double* below = matrix + i * stride;
      const double ratio = below[k] * pivot;
      below[k] = ratio;
      if (ratio == 0.0) continue;
      for (int j = k + 1; j < n; j++) below[j] -= ratio * row[j];
    }
  }
}

// Replace a right side by the solution.
inline void solve_dense(const double* factors, int n, int stride, const int* order, double* right) {
  for (int k = 0; k < n; k++) std::swap(right[k], right[order[k]]);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++) right[i] -= factors[i * stride + j] * right[j];
  for (int i = n - 1; i >= 0; i--) {
    for (int j = i + 1; j < n; j++) right[i] -= factors[i * stride + j] * right[j];
    right[i] /= factors[i * stride + i];
  }
}

}  // namespace skisnow
