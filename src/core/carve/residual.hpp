// The equations of a carving ski on any kind of number: with derivatives in some directions (`Slopes`), or in more
// digits (long double). Groove along the edge, snow of the core's law.
//
// Equations: docs/methods/carved-turn.md.
#pragma once

#include <cmath>
#include <vector>

#include "carve/equations.hpp"

namespace skisnow {

// A number with its derivatives in N directions.
template <int N>
struct Slopes {
  double value = 0.0, by[N] = {};

  Slopes() = default;
  Slopes(double given) : value(given) {}  // NOLINT: a number has no derivative
  static Slopes along(double value, int direction) {
    Slopes out(value);
    out.by[direction] = 1.0;
    return out;
  }
  // f of a number: its value and its derivative f'
  Slopes mapped(double to, double growth) const {
    Slopes out(to);
    for (int n = 0; n < N; n++) out.by[n] = growth * by[n];
    return out;
  }
  Slopes operator-() const { return mapped(-value, -1.0); }
  Slopes& operator+=(const Slopes& b) {
    value += b.value;
    for (int n = 0; n < N; n++) by[n] += b.by[n];
    return *this;
  }
  Slopes& operator-=(const Slopes& b) {
    value -= b.value;
    for (int n = 0; n < N; n++) by[n] -= b.by[n];
    return *this;
  }
  Slopes& operator*=(const Slopes& b) {
    for (int n = 0; n < N; n++) by[n] = by[n] * b.value + value * b.by[n];
    value *= b.value;
    return *this;
  }
  Slopes& operator/=(const Slopes& b) {
    const double inverse = 1.0 / b.value;
    value *= inverse;
    for (int n = 0; n < N; n++) by[n] = (by[n] - value * b.by[n]) * inverse;
    return *this;
  }
  friend Slopes operator+(Slopes a, const Slopes& b) { return a += b; }
  friend Slopes operator-(Slopes a, const Slopes& b) { return a -= b; }
  friend Slopes operator*(Slopes a, const Slopes& b) { return a *= b; }
  friend Slopes operator/(Slopes a, const Slopes& b) { return a /= b; }
  friend bool operator<(const Slopes& a, const Slopes& b) { return a.value < b.value; }
  friend bool operator>(const Slopes& a, const Slopes& b) { return a.value > b.value; }
  friend bool operator==(const Slopes& a, const Slopes& b) { return a.value == b.value; }
  friend Slopes sin(const Slopes& a) { return a.mapped(std::sin(a.value), std::cos(a.value)); }
  friend Slopes cbrt(const Slopes& a) {
    const double root = std::cbrt(a.value);
    return a.mapped(root, 1.0 / (3.0 * root * root));
  }
  friend Slopes cos(const Slopes& a) { return a.mapped(std::cos(a.value), -std::sin(a.value)); }
  friend Slopes tan(const Slopes& a) {
    const double tangent = std::tan(a.value);
    return a.mapped(tangent, 1.0 + tangent * tangent);
  }
};

// Each is one number for `pressed_part`.
template <int N>
inline constexpr int WIDTH<Slopes<N>> = 1;
template <>
inline constexpr int WIDTH<long double> = 1;

// Residual of all equations, depth and force in more digits than they are solved in, rounded at the end into `system`.
void refine_residual(const CarvedSki& ski, const CarveConditions& conditions, const std::vector<double>& place,
                     const CarveState& at, CarveEquations& system);

// Direction in which all numbers of the equations change at once.
struct CarveDirection {
  // at each station, empty for none; `stretch`: growth of its element's length over that length
  std::vector<double> place, weight, width, base_height, stretch;
  Column bent;  // growth of the beam's elastic forces at the same unknowns
  double edge_angle = 0.0, hardness = 0.0, excess = 0.0, load = 0.0, moment = 0.0, side_force = 0.0, bevel = 0.0,
         bevel_width = 0.0, pitch_of_force = 0.0, pitch_of_shear = 0.0, running_length = 0.0, greatest_width = 0.0,
         side = 0.0, radius = 0.0;
  CarveState state;  // empty for none
};

// Growth along a direction; `kink`: least |φ|/|φ'| of the events φ = 0 at which a station touches or leaves the snow,
// or another becomes the source of the groove.
struct CarveGrowth {
  Column residual;
  double border[CARVE_BORDER];
  std::vector<double> depth, force;
  double kink;
};
CarveGrowth growth_along(const CarvedSki& ski, const CarveConditions& conditions, const std::vector<double>& own_place,
                         const CarveState& at, const CarveDirection& along);

}  // namespace skisnow
