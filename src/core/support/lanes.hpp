// Several lines of snow in one instruction: a vector of 2, 4 or 8 doubles that reads like one number.
//
// Written on the vector types of GCC and Clang. Nothing here fuses or reorders: a lane's result has the same bits
// whatever the number of lanes, and sums over lines go through eight partial sums in a fixed order (`Sum`).
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

// Each instruction set has these for itself: a function that is not part of its caller would be shared between them.
#define SKISNOW_INLINE inline __attribute__((always_inline))

namespace skisnow {

constexpr int BLOCK = 8;  // lines that lie side by side in memory; a multiple of every number of lanes

template <int N>
struct LaneTypes {
  typedef double Value __attribute__((vector_size(N * 8)));
  typedef std::int64_t Mask __attribute__((vector_size(N * 8)));
};

template <>
struct LaneTypes<1> {  // a number alone
  using Value = double;
  using Mask = bool;
};

template <int N>
using Lanes = typename LaneTypes<N>::Value;
template <int N>
using Mask = typename LaneTypes<N>::Mask;

template <class V>
inline constexpr int WIDTH = sizeof(V) / sizeof(double);
template <class V>
using MaskOf = Mask<WIDTH<V>>;

template <class V>
SKISNOW_INLINE V load(const double* from) {
  V value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

template <class V>
SKISNOW_INLINE void store(double* to, V value) {
  std::memcpy(to, &value, sizeof value);
}

template <class V>
SKISNOW_INLINE V all(double value) {
  return V{} + value;
}

template <class V>
SKISNOW_INLINE V select(MaskOf<V> mask, V yes, V no) {
  return mask ? yes : no;
}

template <class V>
SKISNOW_INLINE V minimum(V a, V b) {
  return a < b ? a : b;
}

template <class V>
SKISNOW_INLINE V maximum(V a, V b) {
  return a > b ? a : b;
}

template <class V>
SKISNOW_INLINE V within(V value, double low, double high) {
  return minimum(maximum(value, all<V>(low)), all<V>(high));
}

template <class V>
SKISNOW_INLINE V absolute(V value) {
  return maximum(value, -value);
}

template <class V>
SKISNOW_INLINE V root(V value) {
  for (int i = 0; i < WIDTH<V>; i++) value[i] = __builtin_sqrt(value[i]);
  return value;
}

SKISNOW_INLINE double root(double value) { return __builtin_sqrt(value); }

SKISNOW_INLINE bool any(bool mask) { return mask; }

template <class M>
SKISNOW_INLINE bool any(M mask) {
  std::int64_t found = 0;
  for (unsigned i = 0; i < sizeof(M) / 8; i++) found |= mask[i];
  return found != 0;
}

// Eight partial sums, added up in one order: a total does not depend on the number of lanes.
struct Sum {
  double part[BLOCK] = {};

  template <class V>
  SKISNOW_INLINE void add(int lane, V value) {
    store(part + lane, load<V>(part + lane) + value);
  }

  double total() const {
    return ((part[0] + part[1]) + (part[2] + part[3])) + ((part[4] + part[5]) + (part[6] + part[7]));
  }
};

}  // namespace skisnow
