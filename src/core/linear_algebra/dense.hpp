// Dense linear systems of n unknowns: LU with row pivots. Rows lie `stride` numbers apart.
#pragma once

namespace skisnow {

// Factor in place; `order` gets n row numbers. Not finite where the matrix is singular.
void factor_dense(double* matrix, int n, int stride, int* order);
// Replace a right side by the solution.
void solve_dense(const double* factors, int n, int stride, const int* order, double* right);

}  // namespace skisnow
