// Snow that remembers, at a point: pressed to a depth ε it bears H ε; where it was pressed deeper before, by a lift of
// the base above that, it bears H ε - E lift (E = k_u - H) as far as that pushes, else nothing. Stated once, for runs
// (pressure_kernels.hpp) and for the steady carve (carve/strip.hpp).
#pragma once

#include "support/lanes.hpp"

namespace skisnow {

// Parts of a straight piece of base: where the ground was pressed deeper before, and where it bears there.
template <class V>
struct Pressed {
  V from, to, bears_from, bears_to;
};

// [hypoplastic] From a to b; there the depth is `depth + fall x`, the lift `lift + slope x`, and a lift up to `thin`
// counts for none.
template <class V>
SKISNOW_INLINE Pressed<V> pressed_part(V a, V b, V depth, V fall, V lift, V slope, V hardness, V excess, double thin) {
  const V zero = -lift / select(absolute(slope) > 1e-30, slope, all<V>(1e-30));
  const MaskOf<V> at_a = lift + slope * a > thin, at_b = lift + slope * b > thin;
  const V middle = minimum(maximum(zero, a), b);
  const V c = select(at_a, a, select(at_b, middle, b)), d = select(at_b, b, select(at_a, middle, b));
  // the part that bears: the pressure r there is above zero
  const V r = hardness * depth - excess * lift, r_slope = hardness * fall - excess * slope;
  V none = -r / select(absolute(r_slope) > 1e-30, r_slope, all<V>(1e-30));
  none = minimum(maximum(none, c), d);
  const MaskOf<V> at_c = r + r_slope * c > 0.0, at_d = r + r_slope * d > 0.0;
  return {c, d, select(at_c, c, select(at_d, none, d)), select(at_d, d, select(at_c, none, d))};
}

}  // namespace skisnow
