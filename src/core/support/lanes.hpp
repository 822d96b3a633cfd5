// Several lines of snow in one instruction: a vector of 2, 4 or 8 doubles that reads like one number.
//
// Written on the vector types of GCC and Clang. Nothing here fuses or reorders: a lane's result has the same bits
// whatever the number of lanes, and sums over lines go through eight partial sums in a fixed order (`Sum`).
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#ifdef __AVX__
#include <immintrin.h>
#endif

// Each instruction set has these for itself: a function that is not part of its caller would be shared between them.
#define SKISNOW_INLINE inline __attribute__((always_inline))

namespace skisnow {

constexpr int BLOCK = 8;  // lines that lie side by side in memory; a multiple of every number of lanes

template <int N>
struct LaneTypes {
  typedef double Value __attribute__((vector_size(N * 8)));
  typedef std::int64_t Mask __attribute__((vector_size(N * 8)));
  typedef std::int32_t Indices __attribute__((vector_size(N * 4)));
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
SKISNOW_INLINE MaskOf<V> all_lanes(bool value) {
  return all<V>(value ? 1.0 : 0.0) > 0.5;
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
#ifdef __AVX__
  if constexpr (sizeof(M) == 32) return _mm256_movemask_pd((__m256d)mask) != 0;
#endif
#ifdef __AVX512DQ__
  if constexpr (sizeof(M) == 64) return _mm512_movepi64_mask((__m512i)mask) != 0;
#endif
  std::int64_t found = 0;
  for (unsigned i = 0; i < sizeof(M) / 8; i++) found |= mask[i];
  return found != 0;
}

// Whole parts of numbers that are not negative, one for each lane.
template <class V>
struct WholeParts {
  using Indices = typename LaneTypes<WIDTH<V>>::Indices;
  Indices index;

  explicit WholeParts(V value) : index(__builtin_convertvector(value, Indices)) {}
  int operator[](int lane) const { return index[lane]; }
  V value() const { return __builtin_convertvector(index, V); }
};

// Numbers side by side in memory, one row for each lane.
constexpr int ROW = 4;
using Row = Lanes<ROW>;

// Columns of four rows: the first number of every row, the second, …
SKISNOW_INLINE void transpose(const Row* rows, Row (&out)[ROW]) {
  const Row a = __builtin_shufflevector(rows[0], rows[1], 0, 4, 2, 6);
  const Row b = __builtin_shufflevector(rows[0], rows[1], 1, 5, 3, 7);
  const Row c = __builtin_shufflevector(rows[2], rows[3], 0, 4, 2, 6);
  const Row d = __builtin_shufflevector(rows[2], rows[3], 1, 5, 3, 7);
  out[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5), out[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  out[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7), out[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

// The same of as many rows as V has lanes.
template <class V>
SKISNOW_INLINE void transpose(const Row* rows, V (&out)[ROW]) {
  if constexpr (WIDTH<V> == 1) {
    for (int c = 0; c < ROW; c++) out[c] = rows[0][c];
  } else if constexpr (WIDTH<V> == 2) {
    for (int c = 0; c < ROW; c++) out[c] = V{rows[0][c], rows[1][c]};
  } else if constexpr (WIDTH<V> == ROW) {
    transpose(rows, out);
  } else {
    Row low[ROW], high[ROW];
    transpose(rows, low), transpose(rows + ROW, high);
    for (int c = 0; c < ROW; c++) out[c] = __builtin_shufflevector(low[c], high[c], 0, 1, 2, 3, 4, 5, 6, 7);
  }
}

// Eight rows of eight in place: pairs, fours, then halves change places.
SKISNOW_INLINE void transpose(Lanes<8> (&rows)[8]) {
  Lanes<8> pairs[8], fours[8];
  for (int i = 0; i < 8; i += 2) {
    pairs[i] = __builtin_shufflevector(rows[i], rows[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    pairs[i + 1] = __builtin_shufflevector(rows[i], rows[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int i = 0; i < 8; i += 4)
    for (int j = 0; j < 2; j++) {
      fours[i + j] = __builtin_shufflevector(pairs[i + j], pairs[i + j + 2], 0, 1, 8, 9, 4, 5, 12, 13);
      fours[i + j + 2] = __builtin_shufflevector(pairs[i + j], pairs[i + j + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  for (int j = 0; j < 4; j++) {
    rows[j] = __builtin_shufflevector(fours[j], fours[j + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    rows[j + 4] = __builtin_shufflevector(fours[j], fours[j + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

// Each lane has the number of the lane before it, the first lane another number; and the other way round.
template <class V>
SKISNOW_INLINE V from_lane_before(V value, double first) {
  V out = value;
  for (int lane = WIDTH<V> - 1; lane > 0; lane--) out[lane] = value[lane - 1];
  out[0] = first;
  return out;
}

template <class V>
SKISNOW_INLINE V from_lane_behind(V value, double last) {
  V out = value;
  for (int lane = 0; lane + 1 < WIDTH<V>; lane++) out[lane] = value[lane + 1];
  out[WIDTH<V> - 1] = last;
  return out;
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
