#include "linear_algebra/banded.hpp"

#include <algorithm>

namespace skisnow {

void factor_band(double* band, int size) {
  for (int i = 0; i < size; i++) {
    double* pivot = band + BAND_WIDTH * i + BAND_HALF;
    *pivot = 1.0 / *pivot;
    for (int j = 1; j <= BAND_HALF; j++) {
      double* below = pivot + j * (BAND_WIDTH - 1);  // the same column, j rows down
      const double share = *below * *pivot;
      *below = share;
      if (share == 0.0) continue;
      for (int m = 1; m <= BAND_HALF; m++) below[m] -= share * pivot[m];
    }
  }
}

namespace {

template <int COLUMNS>
[[gnu::always_inline]] inline void take_off(double (&x)[COLUMNS], double factor, const double* other) {
  for (int c = 0; c < COLUMNS; c++) x[c] -= factor * other[c];
}

// The row before is kept at hand: each row waits for it.
template <int COLUMNS>
void solve(const double* factors, double* right, const BandBlock& block) {
  double x[COLUMNS] = {}, next[COLUMNS];
  for (int i = block.from; i < block.end; i++) {
    const double* at = factors + BAND_WIDTH * i + BAND_HALF;
    double* row = right + COLUMNS * i;
    std::copy_n(row, COLUMNS, next);
    for (int j = std::min(i - block.from, BAND_HALF); j > 1; j--) take_off(next, at[-j], row - j * COLUMNS);
    if (i > block.from) take_off(next, at[-1], x);
    std::copy_n(next, COLUMNS, x);
    std::copy_n(next, COLUMNS, row);
  }
  std::fill_n(x, COLUMNS, 0.0);
  for (int i = block.end - 1; i >= block.begin; i--) {
    const double* at = factors + BAND_WIDTH * i + BAND_HALF;
    double* row = right + COLUMNS * i;
    std::copy_n(row, COLUMNS, next);
    for (int j = BAND_HALF; j > 1; j--) take_off(next, at[j], row + j * COLUMNS);
    take_off(next, at[1], x);
    for (int c = 0; c < COLUMNS; c++) row[c] = x[c] = next[c] * at[0];
  }
}

}  // namespace

void solve_band(const double* factors, double* right, const BandBlock& block) { solve<1>(factors, right, block); }

void solve_band_tile(const double* factors, double* right, const BandBlock& block) {
  solve<BAND_TILE>(factors, right, block);
}

}  // namespace skisnow
