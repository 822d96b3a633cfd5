#include "snow/surface.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace skisnow {

namespace {

// Cubic through two values with their slopes per cell, 0 ≤ f ≤ 1, and its slope.
struct Cubic {
  double value[4], slope[4];

  explicit Cubic(double f) {
    const double e = 1.0 - f;
    value[0] = e * e * (1.0 + 2.0 * f);
    value[1] = f * f * (3.0 - 2.0 * f);
    value[2] = f * e * e;
    value[3] = -f * f * e;
    slope[0] = -6.0 * f * e;
    slope[1] = 6.0 * f * e;
    slope[2] = e * (1.0 - 3.0 * f);
    slope[3] = f * (3.0 * f - 2.0);
  }
};

double sum(const double (&weight)[4], double a, double b, double slope_a, double slope_b) {
  return weight[0] * a + weight[1] * b + weight[2] * slope_a + weight[3] * slope_b;
}

}  // namespace

Grid::Grid(double x0, double dx, int nx, double y0, double dy, int ny, std::vector<double> values, bool goes_on)
    : x0_(x0), dx_(dx), y0_(y0), dy_(dy), nx_(nx), ny_(ny), values_(std::move(values)), goes_on_(goes_on) {}

std::vector<double> Grid::numbers() const {
  std::vector<double> out{constant_, x0_, dx_, double(nx_), y0_, dy_, double(ny_), goes_on_ ? 1.0 : 0.0};
  out.insert(out.end(), values_.begin(), values_.end());
  return out;
}

Grid Grid::of(const std::vector<double>& numbers) {
  constexpr std::size_t HEAD = 8;
  if (numbers.size() == HEAD) return Grid(numbers[0]);
  if (numbers.size() < HEAD || double(numbers.size() - HEAD) != numbers[3] * numbers[6])
    throw std::invalid_argument("a grid of the model's data has not as many numbers as it says");
  return Grid(numbers[1], numbers[2], int(numbers[3]), numbers[4], numbers[5], int(numbers[6]),
              {numbers.begin() + HEAD, numbers.end()}, numbers[7] != 0.0);
}

double Grid::node(int i, int j) const { return values_[std::size_t(i) * std::size_t(ny_) + std::size_t(j)]; }

// Per cell, by differences: central inside; at a border the parabola's through three values, or the chord's of two.
double Grid::slope(int i, int j, bool along_x) const {
  const int count = along_x ? nx_ : ny_, at = along_x ? i : j;
  const auto value = [&](int k) { return along_x ? node(k, j) : node(i, k); };
  if (count == 1) return 0.0;
  if (count == 2) return value(1) - value(0);
  if (at == 0) return 0.5 * (4.0 * value(1) - 3.0 * value(0) - value(2));
  if (at == count - 1) return 0.5 * (3.0 * value(at) - 4.0 * value(at - 1) + value(at - 2));
  return 0.5 * (value(at + 1) - value(at - 1));
}

Grid::Value Grid::inside(double x, double y) const {
  const int i = std::clamp(int(std::floor(x)), 0, std::max(nx_ - 2, 0)), k = std::min(i + 1, nx_ - 1);
  const int j = std::clamp(int(std::floor(y)), 0, std::max(ny_ - 2, 0)), l = std::min(j + 1, ny_ - 1);
  const Cubic along_x(std::clamp(x - i, 0.0, 1.0)), across_y(std::clamp(y - j, 0.0, 1.0));
  const auto row = [&](int a, const double (&weight)[4]) {
    return sum(weight, node(a, j), node(a, l), slope(a, j, false), slope(a, l, false));
  };
  const auto row_rise = [&](int a, const double (&weight)[4]) {  // slope along x; no twist at the corners
    return weight[0] * slope(a, j, true) + weight[1] * slope(a, l, true);
  };
  const auto both = [&](const double (&along)[4], const double (&across)[4]) {
    return sum(along, row(i, across), row(k, across), row_rise(i, across), row_rise(k, across));
  };
  return {both(along_x.value, across_y.value), both(along_x.slope, across_y.value) / dx_,
          both(along_x.value, across_y.slope) / dy_};
}

Grid::Value Grid::at(double x, double y) const {
  if (values_.empty()) return {constant_, 0.0, 0.0};
  const double u = (x - x0_) / dx_, v = (y - y0_) / dy_;
  const double inside_u = std::clamp(u, 0.0, double(nx_ - 1)), inside_v = std::clamp(v, 0.0, double(ny_ - 1));
  Value out = inside(inside_u, inside_v);
  if (!goes_on_) return out;
  out.value += (u - inside_u) * dx_ * out.slope_x + (v - inside_v) * dy_ * out.slope_y;
  return out;
}

}  // namespace skisnow
