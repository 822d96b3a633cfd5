#include "carve/strip.hpp"

#include "snow/hypoplastic.hpp"

namespace skisnow {

void StripSums::add_linear(double start, double length, double p0, double p1, double growth_by_depth,
                           double growth_by_groove) {
  if (p0 <= 0.0 && p1 <= 0.0) return;
  double low = 0.0, high = length;
  if (p0 < 0.0) {
    low = length * p0 / (p0 - p1);
    p0 = 0.0;
  } else if (p1 < 0.0) {
    high = length * p0 / (p0 - p1);
    p1 = 0.0;
  }
  const double x = start + low, h = high - low, part = 0.5 * h * (p0 + p1);
  force += part;
  moment += x * part + h * h * (p0 + 2.0 * p1) * (1.0 / 6.0);
  const double power[3] = {h, h * (x + 0.5 * h), h * (x * x + x * h + h * h * (1.0 / 3.0))};
  for (int n = 0; n < 3; n++) {
    by_depth[n] += growth_by_depth * power[n];
    by_groove[n] += growth_by_groove * power[n];
  }
}

// [strip]
void StripSums::add_interval(double start, double length, double depth0, double depth1, double groove0, double groove1,
                             double hardness, double excess) {
  const double lift0 = groove0 - depth0, lift1 = groove1 - depth1;
  if (lift0 <= 0.0 && lift1 <= 0.0) {
    add_linear(start, length, hardness * depth0, hardness * depth1, hardness, 0.0);
    return;
  }
  const double fall = (depth1 - depth0) / length, slope = (lift1 - lift0) / length;
  const auto pressed = pressed_part(0.0, length, depth0, fall, lift0, slope, hardness, excess, 0.0);
  const auto add_virgin = [&](double a, double b) {
    if (b > a)
      add_linear(start + a, b - a, hardness * (depth0 + fall * a), hardness * (depth0 + fall * b), hardness, 0.0);
  };
  const auto pressure = [&](double x) { return hardness * (depth0 + fall * x) - excess * (lift0 + slope * x); };
  add_virgin(0.0, pressed.from);
  add_virgin(pressed.to, length);
  const double u = pressed.bears_from, v = pressed.bears_to;
  if (v > u) add_linear(start + u, v - u, pressure(u), pressure(v), hardness + excess, -excess);
}

}  // namespace skisnow
