// Elimination and substitution in the rows of one beam, eight numbers of a row at once.
#pragma once

#include "linear_algebra/bordered.hpp"
#include "support/lanes.hpp"

namespace skisnow::SKISNOW_LANES {

using Eight = Lanes<BORDER_ROW>;

// [eliminate] L U of the band in place, inverse pivots on its diagonal; of border and corner what follows from it.
inline bool eliminate(const BeamRows& rows, double* corner) {
  Eight sums[BODY];
  for (int r = 0; r < BODY; r++) sums[r] = load<Eight>(corner + BORDER_ROW * r);
  for (int i = 0; i < rows.size; i++) {
    double* a = rows.band + BAND_ROW * i + HALF_BAND;
    double *b = rows.border + BORDER_ROW * i, *c = rows.column + BORDER_ROW * i;
    if (!(std::fabs(*a) > 0.0)) return false;
    const double inverse = 1.0 / *a;
    const Eight right = load<Eight>(a + 1), border = load<Eight>(b), column = load<Eight>(c) * inverse;
    store(c, column);
    for (int j = 1; j <= HALF_BAND; j++) {
      double* below = a + (BAND_ROW - 1) * j;
      const double share = *below * inverse;
      *below = share;
      store(below + 1, load<Eight>(below + 1) - share * right);
      store(b + BORDER_ROW * j, load<Eight>(b + BORDER_ROW * j) - share * border);
      store(c + BORDER_ROW * j, load<Eight>(c + BORDER_ROW * j) - column * a[j]);
    }
    for (int r = 0; r < BODY; r++) sums[r] -= column[r] * border;
    *a = inverse;
  }
  for (int r = 0; r < BODY; r++) store(corner + BORDER_ROW * r, sums[r]);
  return true;
}

// [solve] With L: the beam's right side in place, and its effect on the body's.
inline void substitute_forwards(const BeamRows& rows, double* x, double* right) {
  Eight sum = load<Eight>(right);
  for (int i = 0; i < rows.size; i++) {
    const double* lower = rows.band + BAND_ROW * i;
    double value = x[i];
    for (int j = std::min(HALF_BAND, i); j > 0; j--) value -= lower[HALF_BAND - j] * x[i - j];
    x[i] = value;
    sum -= load<Eight>(rows.column + BORDER_ROW * i) * value;
  }
  store(right, sum);
}

// [solve] With U, where the body's solution is known.
inline void substitute_backwards(const BeamRows& rows, const double* body, double* x) {
  const Eight known = load<Eight>(body);
  for (int i = rows.size - 1; i >= 0; i--) {
    const double* a = rows.band + BAND_ROW * i + HALF_BAND;
    const Eight p = load<Eight>(rows.border + BORDER_ROW * i) * known;
    double total = x[i] - (((p[0] + p[1]) + (p[2] + p[3])) + (p[4] + p[5]));
    for (int j = HALF_BAND; j > 0; j--) total -= a[j] * x[i + j];
    x[i] = total * a[0];
  }
}

inline void add_band(const BeamColumns& a, const double* x, const double* y, double share, double scale, double* out) {
  const auto both = [&](int i) { return load<Eight>(x + i) + share * load<Eight>(y + i); };
  for (int i = 0; i < a.size(); i += BORDER_ROW) {
    Eight total = load<Eight>(a[0] + i) * both(i);
    for (int m = 1; m <= HALF_BAND; m++)
      total += load<Eight>(a[m] + i) * both(i - m) + load<Eight>(a[m] + i + m) * both(i + m);
    store(out + i, load<Eight>(out + i) + scale * total);
  }
}

inline void add_coupling(const BeamColumns& columns, const double* body, double scale, double* out) {
  for (int i = 0; i < columns.size(); i += BORDER_ROW) {
    Eight total = load<Eight>(columns[0] + i) * body[0];
    for (int c = 1; c < BODY; c++) total += load<Eight>(columns[c] + i) * body[c];
    store(out + i, load<Eight>(out + i) + scale * total);
  }
}

inline void add_coupled(const BeamColumns& columns, const double* x, double* sums) {
  Eight total[BODY] = {};
  for (int i = 0; i < columns.size(); i += BORDER_ROW)
    for (int c = 0; c < BODY; c++) total[c] += load<Eight>(columns[c] + i) * load<Eight>(x + i);
  for (int c = 0; c < BODY; c++) {
    const Eight& p = total[c];
    sums[c] += ((p[0] + p[1]) + (p[2] + p[3])) + ((p[4] + p[5]) + (p[6] + p[7]));
  }
}

inline void combine(const double* a, double share_a, const double* b, double share_b, const double* c, int count,
                    double* out) {
  for (int i = 0; i < count; i += BORDER_ROW)
    store(out + i, share_a * load<Eight>(a + i) + share_b * load<Eight>(b + i) + load<Eight>(c + i));
}

inline void add_congruent(const double* own, const double* by, double* out) {
  Eight half[BODY];
  for (int m = 0; m < BODY; m++) {
    half[m] = own[BORDER_ROW * m] * load<Eight>(by);
    for (int n = 1; n < BODY; n++) half[m] += own[BORDER_ROW * m + n] * load<Eight>(by + BORDER_ROW * n);
  }
  for (int a = 0; a < BODY; a++) {
    Eight total = load<Eight>(out + BORDER_ROW * a);
    for (int m = 0; m < BODY; m++) total += by[BORDER_ROW * m + a] * half[m];
    store(out + BORDER_ROW * a, total);
  }
}

}  // namespace skisnow::SKISNOW_LANES
