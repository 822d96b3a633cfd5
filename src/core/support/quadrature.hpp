#pragma once

#include <vector>

namespace skisnow {

// Gauss's points and weights between -1 and 1: of three, exact for powers up to the fifth; of five, up to the ninth.
template <int N>
struct Gauss;

template <>
struct Gauss<3> {
  static constexpr double POINT[3] = {-0.7745966692414834, 0.0, 0.7745966692414834};
  static constexpr double WEIGHT[3] = {5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
};

template <>
struct Gauss<5> {
  static constexpr double POINT[5] = {-0.906179845938664, -0.5384693101056831, 0.0, 0.5384693101056831,
                                      0.906179845938664};
  static constexpr double WEIGHT[5] = {0.23692688505618908, 0.47862867049936647, 0.5688888888888889,
                                       0.47862867049936647, 0.23692688505618908};
};

// Where a straight line over x passes zero strictly between two places.
inline void add_zero(double at_zero, double slope, double from, double to, std::vector<double>& out) {
  const double x = -at_zero / slope;
  if (x > from && x < to) out.push_back(x);
}

}  // namespace skisnow
