// Snow pressure across one section of a carving ski, in closed form.
#pragma once

namespace skisnow {

// Integrals across a section. ξ: distance from the edge in the snow surface (m).
struct StripSums {
  double force = 0.0, moment = 0.0;  // ∫p, ∫p ξ
  double by_depth[3] = {};           // ∫∂p/∂ε ξⁿ: growth of the pressure with the depth of the base
  double by_groove[3] = {};          // ∫∂p/∂g ξⁿ: with the depth of the groove
  double by_angle[2] = {};           // ∫∂p/∂ϑ ξⁿ: with the edge angle, of a law from outside

  // An interval on which the depths of base (ε) and groove (g) are straight lines, given at both ends (m).
  void add_interval(double start, double length, double depth0, double depth1, double groove0, double groove1,
                    double hardness, double excess);

 private:
  // A linear pressure as far as it is above zero.
  void add_linear(double start, double length, double p0, double p1, double growth_by_depth, double growth_by_groove);
};

}  // namespace skisnow
