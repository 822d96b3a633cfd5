// Loops over the lanes of lines, and vectors of three.
#pragma once

#include "contact/sections.hpp"

namespace skisnow::SKISNOW_LANES {

// A loop over all lanes of the sections; i: place in the columns, j: slot of the line.
template <class V, class Body>
inline void for_lanes(const Base& s, const GrooveLines& lines, const Body& body) {
  for (int block = 0; block < s.blocks; block++) {
    const int slot = int((s.first_block + block) & (lines.blocks() - 1)) * BLOCK;
    for (int lane = 0; lane < BLOCK; lane += WIDTH<V>) body(block * BLOCK + lane, slot + lane);
  }
}

template <class V>
struct Vector {
  V x, y, z;
};

template <class V>
inline Vector<V> load3(const Base& s, BaseField first, int i) {
  return {load<V>(s[first] + i), load<V>(s[BaseField(first + 1)] + i), load<V>(s[BaseField(first + 2)] + i)};
}

template <class V>
inline void store3(Base& s, BaseField first, int i, const Vector<V>& v) {
  store(s[first] + i, v.x);
  store(s[BaseField(first + 1)] + i, v.y);
  store(s[BaseField(first + 2)] + i, v.z);
}

template <class V>
inline V dot(const Vector<V>& a, const Vector<V>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class V>
inline Vector<V> cross(const Vector<V>& a, const Vector<V>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class V>
inline Vector<V> scaled(const Vector<V>& a, V size) {
  return {a.x * size, a.y * size, a.z * size};
}

}  // namespace skisnow::SKISNOW_LANES
