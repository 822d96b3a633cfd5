// The edges of a ski as they are ground.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "support/lanes.hpp"

namespace skisnow {

// A strip of the base along each edge is ground up by the base bevel, and the corner of base and side is rounded: its
// chord replaces the round. Both raise the base near the edge in proportion to the way from their inner end, a hinge.
//
// Equations: docs/methods/ski.md.
template <class T>
class GroundEdge {
 public:
  static constexpr double SQUARE = 0.5 * std::numbers::pi;  // a side at right angles to the base (rad)
  static constexpr int HINGES = 2;  // at the inner ends of strip and rounding; the rounding is narrower

  GroundEdge() = default;
  // Angle (rad) and width (m) of the strip; angle between base and side (rad); radius of the corner (m).
  GroundEdge(T bevel, T strip, T side, T radius)
      : given_{bevel, strip, side, radius}, bevel_(strip > T(0.0) ? bevel : T(0.0)), width_{strip, T(0.0)} {
    using std::cos;
    using std::sin;
    using std::tan;
    sine_ = sin(bevel_), cosine_ = cos(bevel_), half_tangent_ = tan(T(0.5) * (side + bevel_));
    width_[1] = radius / half_tangent_;
  }

  const std::array<T, 4>& given() const { return given_; }  // the numbers that it was made of
  bool acts() const { return bevel_ > T(0.0) || width_[1] > T(0.0); }
  T bevel() const { return bevel_; }
  T width(int hinge) const { return width_[hinge]; }  // of base, from the edge (m)

  // What is lost of the depth for each metre of base from a hinge to the edge, at the edge's angle in the snow.
  template <class V>
  SKISNOW_INLINE void find_rises(V sine, V cosine, V (&out)[HINGES]) const {
    const V strip_sine = sine * cosine_ - cosine * sine_, strip_cosine = cosine * cosine_ + sine * sine_;
    out[0] = sine - strip_sine;
    out[1] = maximum(V(strip_sine - (1.0 - strip_cosine) * half_tangent_), V{});
  }

  // How these grow with the angle.
  void find_growth(double sine, double cosine, double (&out)[HINGES]) const {
    const double strip_sine = sine * cosine_ - cosine * sine_, strip_cosine = cosine * cosine_ + sine * sine_;
    out[0] = cosine - strip_cosine;
    const bool is_raised = strip_sine - (1.0 - strip_cosine) * half_tangent_ > 0.0;
    out[1] = is_raised ? strip_cosine - strip_sine * half_tangent_ : 0.0;
  }

  // Loss of depth at the edge itself (m).
  template <class V>
  SKISNOW_INLINE V lost(V sine, V cosine) const {
    V rises[HINGES];
    find_rises(sine, cosine, rises);
    return width_[0] * rises[0] + width_[1] * rises[1];
  }

 private:
  std::array<T, 4> given_{0.0, 0.0, SQUARE, 0.0};
  T bevel_ = 0.0, sine_ = 0.0, cosine_ = 1.0, half_tangent_ = 1.0, width_[HINGES] = {};
};
using EdgeShape = GroundEdge<double>;

}  // namespace skisnow
