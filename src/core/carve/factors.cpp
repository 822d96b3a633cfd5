#include <algorithm>
#include <cmath>
#include <utility>

#include "carve/equations.hpp"
#include "linear_algebra/banded.hpp"
#include "linear_algebra/dense.hpp"

namespace skisnow {

namespace {

// With the transposed matrices of `solve_dense` and `solve_band`.
void solve_dense_transposed(const double* factors, int n, int stride, const int* order, double* right) {
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < i; j++) right[i] -= factors[j * stride + i] * right[j];
    right[i] /= factors[i * stride + i];
  }
  for (int i = n - 1; i >= 0; i--)
    for (int j = i + 1; j < n; j++) right[i] -= factors[j * stride + i] * right[j];
  for (int k = n - 1; k >= 0; k--) std::swap(right[k], right[order[k]]);
}

void solve_band_transposed(const double* factors, double* x, int size) {
  for (int i = 0; i < size; i++) {
    const double* row = factors + BAND_WIDTH * i + BAND_HALF;
    x[i] *= row[0];
    for (int j = 1; j <= std::min(BAND_HALF, size - 1 - i); j++) x[i + j] -= row[j] * x[i];
  }
  for (int i = size - 1; i >= 0; i--) {
    const double* row = factors + BAND_WIDTH * i + BAND_HALF;
    for (int j = 1; j <= std::min(BAND_HALF, i); j++) x[i - j] -= row[-j] * x[i];
  }
}

}  // namespace

void CarveFactors::factor(const CarvedSki& ski, CarveEquations& system) {
  used_ = system.used();
  tiles_ = tiles_for(used_);
  room_ = system.residual.size();
  band_.swap(system.matrix);
  rows_.swap(system.rows);
  influence_.swap(system.columns);
  links_.swap(system.links);
  factor_band(band_.data(), ski.size);
  solve_tiles(ski, system);
  schur_.assign(std::size_t(used_ * tiles_ * BAND_TILE), 0.0);
  add_border(system);
  add_links();
  order_.resize(std::size_t(used_));
  factor_dense(schur_.data(), used_, tiles_ * BAND_TILE, order_.data());
}

// A link whose groove only stations behind the clamp meet does not act on the ski before the clamp.
void CarveFactors::solve_tiles(const CarvedSki& ski, const CarveEquations& system) {
  block_.assign(std::size_t(tiles_), {0, 0, ski.size});
  for (int t = 1; t < tiles_; t++) {
    int from = ski.size;
    for (int k = BAND_TILE * t; k < std::min(used_, BAND_TILE * (t + 1)); k++)
      from = std::min(from, system.link_from[std::size_t((k - CARVE_BORDER) / 2)]);
    block_[std::size_t(t)] = {from >= ski.front ? ski.front : 0, from, ski.size};
  }
  for (int t = 0; t < tiles_; t++) solve_band_tile(band_.data(), influence(t, 0), block_[std::size_t(t)]);
}

// The border's own rows, less what the beam takes up of them.
void CarveFactors::add_border(const CarveEquations& system) {
  const int stride = tiles_ * BAND_TILE;
  for (int a = 0; a < CARVE_BORDER; a++)
    for (int b = 0; b < CARVE_BORDER; b++) schur_[std::size_t(a * stride + b)] = system.corner[a][b];
  for (int k = 0; k < used_ - CARVE_BORDER; k++)
    for (int a = 0; a < 2; a++)
      schur_[std::size_t(a * stride + CARVE_BORDER + k)] = system.link_corner[std::size_t(2 * k + a)];
  for (int t = 0; t < tiles_; t++) {
    double taken[CARVE_BORDER][BAND_TILE] = {};
    for (int j = block_[std::size_t(t)].begin; j < block_[std::size_t(t)].end; j++) {
      const double *row = rows_.data() + BAND_TILE * j, *answer = influence(t, j);
      for (int a = 0; a < CARVE_BORDER; a++)
        for (int c = 0; c < BAND_TILE; c++) taken[a][c] += row[a] * answer[c];
    }
    for (int a = 0; a < CARVE_BORDER; a++)
      for (int c = 0; c < BAND_TILE; c++) schur_[std::size_t(a * stride + BAND_TILE * t + c)] -= taken[a][c];
  }
}

// The rows of the links: two for each.
void CarveFactors::add_links() {
  const int stride = tiles_ * BAND_TILE;
  for (std::size_t k = 0; k < links_.size(); k++) {
    const CarveLinkRow& link = links_[k];
    const int c = CARVE_BORDER + 2 * int(k);
    double *depth = schur_.data() + c * stride, *twist = depth + stride;
    depth[0] = -1.0;
    depth[1] = -link.place;
    depth[c] = twist[c + 1] = 1.0;
    for (int t = 0; t < tiles_; t++, depth += BAND_TILE, twist += BAND_TILE) {
      if (link.first + CarvedSki::HELD <= block_[std::size_t(t)].begin) continue;
      const double* answer = influence(t, link.first);
      for (int a = 0; a < 4; a++)
        for (int b = 0; b < BAND_TILE; b++) depth[b] -= link.deflection[a] * answer[BAND_TILE * BENDS[a] + b];
      for (int a = 0; a < 2; a++)
        for (int b = 0; b < BAND_TILE; b++) {
          depth[b] -= link.by_twist[a] * answer[BAND_TILE * TURNS[a] + b];
          twist[b] -= link.twist[a] * answer[BAND_TILE * TURNS[a] + b];
        }
    }
  }
}

// The border's correction, where the beam alone would move by u.
void CarveFactors::solve_border(const CarveEquations& system, const double* u) {
  border_.assign(std::size_t(tiles_ * BAND_TILE), 0.0);
  double* y = border_.data();
  for (int a = 0; a < CARVE_BORDER; a++) y[a] = -system.border_residual[a];
  double taken[BAND_TILE] = {};
  for (int j = 0; j < block_[0].end; j++)
    for (int a = 0; a < BAND_TILE; a++) taken[a] += rows_[std::size_t(BAND_TILE * j + a)] * u[j];
  for (int a = 0; a < CARVE_BORDER; a++) y[a] -= taken[a];
  for (std::size_t k = 0; k < links_.size(); k++) {
    const CarveLinkRow& link = links_[k];
    const double* at = u + link.first;
    double* right = y + CARVE_BORDER + 2 * k;
    for (int a = 0; a < 4; a++) right[0] -= link.deflection[a] * at[BENDS[a]];
    for (int a = 0; a < 2; a++) {
      right[0] -= link.by_twist[a] * at[TURNS[a]];
      right[1] -= link.twist[a] * at[TURNS[a]];
    }
  }
  solve_dense(schur_.data(), used_, tiles_ * BAND_TILE, order_.data(), y);
}

bool CarveFactors::correct(const CarvedSki& ski, const CarveEquations& system, CarveState& step) {
  double* u = step.u.data();
  for (int j = 0; j < ski.size; j++) u[j] = -system.residual[std::size_t(j)];
  std::fill(u + ski.size, u + step.u.size(), 0.0);
  solve_band(band_.data(), u, {0, 0, ski.size});
  solve_border(system, u);
  const double* y = border_.data();
  std::copy_n(y, CARVE_BORDER, step.border.begin());
  for (int t = 0; t < tiles_; t++, y += BAND_TILE)
    for (int j = block_[std::size_t(t)].begin; j < ski.size; j++) {
      const double* answer = influence(t, j);
      double part[BAND_TILE];
      for (int c = 0; c < BAND_TILE; c++) part[c] = answer[c] * y[c];
      u[j] -= (part[0] + part[1]) + (part[2] + part[3]);
    }
  const auto finite = [](double each) { return std::isfinite(each); };
  return std::all_of(border_.begin(), border_.begin() + used_, finite) && std::all_of(u, u + ski.size, finite);
}

// [transposed] With V = A⁻¹B, of the beam A, and S = D - C V: μ = S⁻ᵀ(h - Vᵀg), λ = A⁻ᵀ(g - Cᵀμ).
void CarveFactors::solve_transposed(const CarvedSki& ski, CarveState& right) {
  double* u = right.u.data();
  border_.assign(std::size_t(tiles_ * BAND_TILE), 0.0);
  double* y = border_.data();
  for (int t = 0; t < tiles_; t++)
    for (int j = block_[std::size_t(t)].begin; j < ski.size; j++)
      for (int c = 0; c < BAND_TILE; c++) y[BAND_TILE * t + c] -= influence(t, j)[c] * u[j];
  for (int a = 0; a < CARVE_BORDER; a++) y[a] += right.border[std::size_t(a)];
  solve_dense_transposed(schur_.data(), used_, tiles_ * BAND_TILE, order_.data(), y);
  for (int j = 0; j < ski.size; j++)
    for (int a = 0; a < CARVE_BORDER; a++) u[j] -= rows_[std::size_t(BAND_TILE * j + a)] * y[a];
  for (std::size_t k = 0; k < links_.size(); k++) {
    const CarveLinkRow& link = links_[k];
    double* at = u + link.first;
    const double* by = y + CARVE_BORDER + 2 * k;
    for (int a = 0; a < 4; a++) at[BENDS[a]] -= link.deflection[a] * by[0];
    for (int a = 0; a < 2; a++) at[TURNS[a]] -= link.by_twist[a] * by[0] + link.twist[a] * by[1];
  }
  solve_band_transposed(band_.data(), u, ski.size);
  std::copy_n(y, CARVE_BORDER, right.border.begin());
}

}  // namespace skisnow
