#include "groove.hpp"

#include <algorithm>
#include <cmath>

namespace skisnow {

namespace {

struct Segment {
  double a, depth_a, b, depth_b, slope;

  Segment(double from, double depth_from, double to, double depth_to)
      : a(from), depth_a(depth_from), b(to), depth_b(depth_to), slope((depth_to - depth_from) / (to - from)) {}

  double at(double where) const { return where == b ? depth_b : depth_a + slope * (where - a); }
};

double triangle(const Ground& ground, int i, int j, int k) {
  const double* y = ground.place;
  const double* g = ground.depth;
  return 0.5 * std::fabs((y[j] - y[i]) * (g[k] - g[i]) - (y[k] - y[i]) * (g[j] - g[i]));
}

// The deeper of both between two neighbouring knots of the old ground; whether that is the pressed one anywhere.
bool merge_piece(const Ground& old, int j, const Segment& pressed, Ground& out) {
  const double a = old.place[j], b = old.place[j + 1];
  const double from = std::max(a, pressed.a), to = std::min(b, pressed.b);
  if (b - a < 1e-15 || to <= from) return false;
  const double slope = (old.depth[j + 1] - old.depth[j]) / (b - a);
  const double old_from = old.depth[j] + slope * (from - a), old_to = old.depth[j] + slope * (to - a);
  const double over_from = pressed.at(from) - old_from, over_to = pressed.at(to) - old_to;
  if (over_from <= THIN && over_to <= THIN) return false;
  if (from > a) out.append(from, old_from);
  if (from > a && over_from > THIN) out.append(from, pressed.at(from));
  if (over_from < -THIN || over_to < -THIN) {
    const double cross = from + (to - from) * over_from / (over_from - over_to);
    out.append(cross, pressed.at(cross));
  }
  if (to < b && over_to > THIN) out.append(to, pressed.at(to));
  if (to < b) out.append(to, old_to);
  return true;
}

// A segment apart from the ground: nothing has touched what lies between, no depth.
void join_apart(const Ground& old, const Segment& pressed, Ground& out) {
  const auto copy = [&] {
    for (int j = 0; j < old.count; j++) out.append(old.place[j], old.depth[j]);
  };
  const bool before = pressed.b < old.first();
  if (!before) copy(), out.append(old.last(), 0.0), out.append(pressed.a, 0.0);
  out.append(pressed.a, pressed.depth_a), out.append(pressed.b, pressed.depth_b);
  if (before) out.append(pressed.b, 0.0), out.append(old.first(), 0.0), copy();
}

// A segment over part of the ground, or beyond one of its ends; whether it is the deeper anywhere.
bool join(const Ground& old, const Segment& pressed, Ground& out) {
  bool deeper = false;
  int j = 0;
  while (j < old.count && old.place[j] < pressed.a) j++;
  std::copy_n(old.place, j, out.place), std::copy_n(old.depth, j, out.depth);
  out.count = j;
  if (j > 0) {
    deeper = j < old.count && merge_piece(old, j - 1, pressed, out);
  } else if (pressed.a < old.first()) {
    deeper = pressed.a < old.first() - THIN;
    out.append(pressed.a, pressed.depth_a), out.append(old.first(), pressed.at(old.first()));
  }
  for (; j < old.count && old.place[j] <= pressed.b; j++) {
    // at an end of the segment a knot keeps its own depth to the outside: there may be a wall
    const double where = old.place[j], own = old.depth[j];
    if (where == pressed.a) out.append(where, own);
    out.append(where, std::max(own, pressed.at(where)));
    if (where == pressed.b) out.append(where, own);
    if (j + 1 < old.count && merge_piece(old, j, pressed, out)) deeper = true;
  }
  if (j < old.count) out.append(old.place[j], old.depth[j]), j++;
  for (; j < old.count && out.count < Ground::ROOM; j++, out.count++)
    out.place[out.count] = old.place[j], out.depth[out.count] = old.depth[j];
  for (; j < old.count; j++) out.append(old.place[j], old.depth[j]);
  if (pressed.b > old.last()) {
    deeper = deeper || pressed.b > old.last() + THIN;
    out.append(old.last(), pressed.at(old.last())), out.append(pressed.b, pressed.depth_b);
  }
  return deeper;
}

constexpr double ALIKE = 1.0 + 1e-4, TINY_AREA = 1e-24;  // (m²): of areas that are alike but for rounding

}  // namespace

Ground& Ground::operator=(const Ground& other) {
  count = other.count;
  std::copy_n(other.place, count, place);
  std::copy_n(other.depth, count, depth);
  return *this;
}

void Ground::append(double at, double deep) {
  if (count > 0 && std::fabs(place[count - 1] - at) < THIN && std::fabs(depth[count - 1] - deep) < THIN) return;
  if (count == ROOM) simplify(0.0, ROOM - 1);
  place[count] = at;
  depth[count] = deep;
  count++;
}

double Ground::at(double where, bool from_right) const {
  int j = 0;
  while (j + 2 < count && (from_right ? place[j + 1] <= where : place[j + 1] < where)) j++;
  const double width = place[j + 1] - place[j];
  if (!(width > 0.0)) return from_right ? depth[j + 1] : depth[j];
  return depth[j] + (depth[j + 1] - depth[j]) * (where - place[j]) / width;
}

bool Ground::press(double a, double depth_a, double b, double depth_b) {
  if (!(b - a > THIN)) return false;
  const Segment pressed(a, depth_a, b, depth_b);
  if (empty()) {
    clear();
    append(a, depth_a), append(b, depth_b);
    return true;
  }
  Ground out;
  if (b < first() || a > last()) {
    join_apart(*this, pressed, out);
  } else if (!join(*this, pressed, out)) {
    return false;
  }
  *this = out;
  return true;
}

// Two that are alike but for rounding go together, the outermost first: the mirror image is simplified as its original.
void Ground::simplify(double area, int most) {
  double size[ROOM];
  const auto smallest = [&] {
    double least = size[1];
    for (int j = 2; j + 1 < count; j++) least = std::min(least, size[j]);
    return least;
  };
  for (int j = 1; j + 1 < count; j++) size[j] = triangle(*this, j - 1, j, j + 1);
  while (count > 2) {
    const double least = smallest(), alike = least * ALIKE + TINY_AREA;
    if (least > area && count <= most) break;
    int first = 1, last = count - 2;
    while (size[first] > alike) first++;
    while (size[last] > alike) last--;
    if (last - first < 2) {
      drop(size[last] < size[first] ? last : first, size);
    } else {
      drop(last, size);
      drop(first, size);
    }
  }
}

// Drop a knot; `size` are the triangles of the knots with their neighbours.
void Ground::drop(int knot, double* size) {
  for (int j = knot; j + 1 < count; j++) {
    place[j] = place[j + 1];
    depth[j] = depth[j + 1];
    size[j] = size[j + 1];
  }
  count--;
  if (knot > 1) size[knot - 1] = triangle(*this, knot - 2, knot - 1, knot);
  if (knot + 1 < count) size[knot] = triangle(*this, knot - 1, knot, knot + 1);
}

double Ground::squared() const {
  double total = 0.0;
  for (int j = 0; j + 1 < count; j++) {
    const double a = depth[j], b = depth[j + 1];
    total += (place[j + 1] - place[j]) * (a * a + a * b + b * b) / 3.0;
  }
  return total;
}

}  // namespace skisnow
