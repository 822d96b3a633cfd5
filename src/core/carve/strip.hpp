// Snow pressure across one section of a carving ski, in closed form.
#pragma once

#include "snow/hypoplastic.hpp"

namespace skisnow {

// Growth of the integrals across a section with depth and groove; ξ: distance from the edge in the snow surface (m).
struct StripGrowth {
  double by_depth[3] = {};   // ∫∂p/∂ε ξⁿ: growth of the pressure with the depth of the base
  double by_groove[3] = {};  // ∫∂p/∂g ξⁿ: with the depth of the groove
  double by_angle[2] = {};   // ∫∂p/∂ϑ ξⁿ: with the edge angle, of a law from outside

  void grow(double x, double h, double growth_by_depth, double growth_by_groove) {
    const double power[3] = {h, h * (x + 0.5 * h), h * (x * x + x * h + h * h * (1.0 / 3.0))};
    for (int n = 0; n < 3; n++) {
      by_depth[n] += growth_by_depth * power[n];
      by_groove[n] += growth_by_groove * power[n];
    }
  }
};
struct WithoutGrowth {
  void grow(const auto&...) {}
};

// Integrals across a section on any kind of number: ∫p, ∫p ξ, and their growth.
template <class T, class Growth>
struct Strip : Growth {
  T force = 0.0, moment = 0.0;

  // [strip] An interval on which the depths of base (ε) and groove (g) are straight lines, given at both ends (m).
  void add_interval(const T& start, const T& length, const T& depth0, const T& depth1, const T& groove0,
                    const T& groove1, const T& hardness, const T& excess) {
    const T zero(0.0), lift0 = groove0 - depth0, lift1 = groove1 - depth1;
    if (!(lift0 > zero) && !(lift1 > zero))
      return add_linear(start, length, hardness * depth0, hardness * depth1, hardness, zero);
    const T fall = (depth1 - depth0) / length, slope = (lift1 - lift0) / length;
    const auto pressed = pressed_part<T>(zero, length, depth0, fall, lift0, slope, hardness, excess, 0.0);
    const auto add_virgin = [&](const T& a, const T& b) {
      if (b > a)
        add_linear(start + a, b - a, hardness * (depth0 + fall * a), hardness * (depth0 + fall * b), hardness, zero);
    };
    const auto pressure = [&](const T& x) { return hardness * (depth0 + fall * x) - excess * (lift0 + slope * x); };
    add_virgin(zero, pressed.from);
    add_virgin(pressed.to, length);
    const T u = pressed.bears_from, v = pressed.bears_to;
    if (v > u) add_linear(start + u, v - u, pressure(u), pressure(v), hardness + excess, -excess);
  }

 private:
  // A linear pressure as far as it is above zero.
  void add_linear(const T& start, const T& length, T p0, T p1, const T& growth_by_depth, const T& growth_by_groove) {
    const T zero(0.0);
    if (!(p0 > zero) && !(p1 > zero)) return;
    T low = zero, high = length;
    if (p0 < zero) {
      low = length * p0 / (p0 - p1);
      p0 = zero;
    } else if (p1 < zero) {
      high = length * p0 / (p0 - p1);
      p1 = zero;
    }
    const T x = start + low, h = high - low, part = T(0.5) * h * (p0 + p1);
    force += part;
    moment += x * part + h * h * (p0 + T(2.0) * p1) * T(1.0 / 6.0);
    this->grow(x, h, growth_by_depth, growth_by_groove);
  }
};
using StripSums = Strip<double, StripGrowth>;

}  // namespace skisnow
