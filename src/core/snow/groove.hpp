// The ground of one transverse line of snow: piecewise linear depth over the place across.
//
// History variable of the snow: the greatest depth that each place was ever pressed to. Outside its knots the snow is
// virgin. Two knots at one place are a wall.
#pragma once

#include <algorithm>

namespace skisnow {

constexpr int KNOTS = 16;       // that a line keeps
constexpr double THIN = 1e-12;  // width or depth (m) that counts as zero

struct Ground {
  static constexpr int ROOM = 4 * KNOTS;
  int count = 0;
  double place[ROOM];
  double depth[ROOM];

  Ground() { std::fill_n(place, KNOTS, 0.0), std::fill_n(depth, KNOTS, 0.0); }  // `take` copies all of these
  Ground(const Ground& other) { *this = other; }
  Ground& operator=(const Ground& other);

  void clear() { count = 0; }
  bool empty() const { return count < 2; }
  double first() const { return place[0]; }
  double last() const { return place[count - 1]; }

  // Append a knot, unless it repeats the last one.
  void append(double at, double deep);

  // Press the segment from (a, depth_a) to (b, depth_b), a < b: keep the deeper of both. Whether anything changed.
  bool press(double a, double depth_a, double b, double depth_b);
  // The same with a polyline from left to right.
  bool press(const double* at, const double* deep, int knots);

  // Drop knots whose triangle with their neighbours is below an area (m²), and the smallest ones above `most` knots.
  void simplify(double area, int most);

  // ∫ depth² over the place (m³).
  double squared() const;

 private:
  void take(const Ground& other, int knots);
  int before(double at) const;
  Ground replaced(const double* at, const double* deep, int knots, int kept) const;
  void drop(int knot, double* size);
};

}  // namespace skisnow
