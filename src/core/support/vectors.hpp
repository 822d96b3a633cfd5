// Vectors of three numbers, and their turns.
#pragma once

#include <array>

namespace skisnow {

using Vector3 = std::array<double, 3>;

inline Vector3 operator+(const Vector3& a, const Vector3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vector3 operator-(const Vector3& a, const Vector3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vector3 operator*(double size, const Vector3& a) { return {size * a[0], size * a[1], size * a[2]}; }

inline double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Three numbers out of many.
inline Vector3 vector_at(const double* numbers) { return {numbers[0], numbers[1], numbers[2]}; }

}  // namespace skisnow
