// Banded linear systems with five places to each side of the diagonal: LU without exchanging rows, for matrices whose
// symmetric part is positive definite.
//
// Rows are 11 numbers, columns i - 5 to i + 5 of row i. Behind the last row five more must follow, all zeros, and five
// rows of zeros behind the right sides: so loops need no ends.
#pragma once

namespace skisnow {

constexpr int BAND_HALF = 5, BAND_WIDTH = 11, BAND_TILE = 4;

// Factor in place. The diagonal holds the inverse pivots, not finite where one was zero.
void factor_band(double* band, int size);

// Rows of a block that nothing binds to the rows before it; the right sides are zero before `from`.
struct BandBlock {
  int begin, from, end;
};

// Solve in place for one right side, or for `BAND_TILE` of them side by side in each row.
void solve_band(const double* factors, double* right, const BandBlock& block);
void solve_band_tile(const double* factors, double* right, const BandBlock& block);

}  // namespace skisnow
