// The slope's surface z(x, y) and what varies over it: planes, and smooth grids.
#pragma once

#include <vector>

namespace skisnow {

// Values over a rectangular grid, interpolated by Ferguson's patches (bicubic Hermite, no twist at the corners) with
// slopes from central differences: the value and its slopes are continuous. Beyond its border the nearest border's
// value goes on, along its slope if asked.
class Grid {
 public:
  Grid() = default;  // zero everywhere
  explicit Grid(double constant) : constant_(constant) {}
  Grid(double x0, double dx, int nx, double y0, double dy, int ny, std::vector<double> values, bool goes_on);

  struct Value {
    double value, slope_x, slope_y;
  };
  Value at(double x, double y) const;
  bool is_constant() const { return values_.empty(); }
  double constant() const { return constant_; }

  // All of it as numbers, and back.
  std::vector<double> numbers() const;
  static Grid of(const std::vector<double>& numbers);

 private:
  double node(int i, int j) const;
  double slope(int i, int j, bool along_x) const;
  Value inside(double x, double y) const;

  double constant_ = 0.0;
  double x0_ = 0.0, dx_ = 1.0, y0_ = 0.0, dy_ = 1.0;
  int nx_ = 1, ny_ = 1;
  std::vector<double> values_;  // (nx, ny)
  bool goes_on_ = false;
};

}  // namespace skisnow
