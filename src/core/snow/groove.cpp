#include "snow/groove.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace skisnow {

namespace {

constexpr double BEYOND = 1e300;  // beyond the last knot

// A polyline read from left to right; outside its knots it has no depth. Its mirror image has the same bits.
class Reader {
 public:
  // From a place on; `at`: the first knot there or behind.
  Reader(const double* place, const double* depth, int count, int at, double y)
      : place_(place), depth_(depth), count_(count), at_(at) {
    go_to(y);
  }

  int knot() const { return at_; }  // the next one
  double next() const { return at_ < count_ ? place_[at_] : BEYOND; }
  bool is_at_knot() const { return is_at_knot_; }
  double left() const { return left_; }    // depth on the left side of the place reached
  double right() const { return right_; }  // and on its right side

  // Up to a place, not beyond the next knot.
  void go_to(double y) {
    is_at_knot_ = next() == y;
    if (!is_at_knot_) {
      left_ = right_ = between(y);
      return;
    }
    left_ = at_ > 0 ? depth_[at_] : 0.0;
    while (next() == y) at_++;
    right_ = at_ < count_ ? depth_[at_ - 1] : 0.0;
  }

 private:
  const double *place_, *depth_;
  int count_, at_;
  double left_ = 0.0, right_ = 0.0;
  bool is_at_knot_ = false;

  double between(double y) const {
    if (at_ == 0 || at_ == count_) return 0.0;
    const double a = place_[at_ - 1], b = place_[at_];
    return (depth_[at_ - 1] * (b - y) + depth_[at_] * (y - a)) / (b - a);
  }
};

// Depths of the ground and of the polyline that is pressed into it, at one side of a place.
struct Both {
  double ground, pressed;

  double over() const { return pressed - ground; }
};

// Writes the deeper of both from left to right.
class Merge {
 public:
  // `depth`: of the ground on the left of the place where it starts.
  Merge(Ground& out, double y, double depth) : out_(out), y_(y), depth_(depth) {}

  bool changed() const { return changed_; }
  bool is_deeper() const { return is_deeper_; }  // whether the polyline is deeper than the ground somewhere
  bool is_above() const { return is_above_; }    // or less deep

  // Up to a place where either has a knot; whether the ground and the polyline have one at the place reached.
  void advance(double y, const Both& from, const Both& to, bool knot, bool pressed_knot) {
    const double over = from.over(), over_end = to.over();
    const bool any = over > THIN || over_end > THIN, all = over >= -THIN && over_end >= -THIN;
    const bool first = any && (all || over > 0.0), last = any && (all || over_end > 0.0);
    turn(first ? from.pressed : from.ground, first, first ? pressed_knot : knot);
    if (first != last) {
      const double apart = over - over_end;
      out_.append((y * over - y_ * over_end) / apart, (to.pressed * over - from.pressed * over_end) / apart);
    }
    changed_ = changed_ || (any && y - y_ > THIN), is_deeper_ = is_deeper_ || any, is_above_ = is_above_ || !all;
    is_pressed_ = last;
    depth_ = last ? to.pressed : to.ground;
    y_ = y;
  }

  // At the place reached: the depth on its right, whether that is the pressed polyline, and whether it has a knot here.
  void turn(double depth, bool is_pressed, bool knot) {
    if (!knot && is_pressed == is_pressed_ && depth == depth_) return;
    end();
    out_.append(y_, depth);
  }

  void end() {
    if (out_.count > 0) out_.append(y_, depth_);
  }

 private:
  Ground& out_;
  double y_, depth_;
  bool is_pressed_ = false, changed_ = false, is_deeper_ = false, is_above_ = false;
};

double triangle(const Ground& ground, int i, int j, int k) {
  const double* y = ground.place;
  const double* g = ground.depth;
  return 0.5 * std::fabs((y[j] - y[i]) * (g[k] - g[i]) - (y[k] - y[i]) * (g[j] - g[i]));
}

constexpr double ALIKE = 1e-4, TINY_AREA = 1e-24;  // (m²): of areas that are alike but for rounding

}  // namespace

Ground& Ground::operator=(const Ground& other) {
  if (this != &other) take(other, other.count);
  return *this;
}

// Take the first knots of another ground. No branch depends on the number of the few that a line keeps.
void Ground::take(const Ground& other, int knots) {
  count = knots;
  std::memcpy(place, other.place, KNOTS * sizeof *place), std::memcpy(depth, other.depth, KNOTS * sizeof *depth);
  for (int j = KNOTS; j < count; j++) place[j] = other.place[j], depth[j] = other.depth[j];
}

// Number of knots before a place, without branches as well.
int Ground::before(double at) const {
  int out = 0;
  for (int j = 0; j < KNOTS; j++) out += int(j < count) & int(place[j] < at);
  for (int j = KNOTS; j < count; j++) out += place[j] < at;
  return out;
}

void Ground::append(double at, double deep) {
  if (count > 0 && std::fabs(place[count - 1] - at) < THIN && std::fabs(depth[count - 1] - deep) < THIN) {
    depth[count - 1] = std::max(depth[count - 1], deep);
    return;
  }
  if (count == ROOM) simplify(0.0, ROOM - 1);
  place[count] = at;
  depth[count] = deep;
  count++;
}

bool Ground::press(double a, double depth_a, double b, double depth_b) {
  const double at[2] = {a, b}, deep[2] = {depth_a, depth_b};
  return press(at, deep, 2);
}

// The ground with a polyline instead of everything between its ends.
Ground Ground::replaced(const double* at, const double* deep, int knots, int kept) const {
  const double from = at[0], to = at[knots - 1];
  Ground out;
  out.take(*this, kept);
  if (kept > 0 && kept == count) out.append(last(), 0.0);  // apart: what lies between has no depth
  if (kept > 0) out.append(from, Reader(place, depth, count, kept, from).left());
  for (int j = 0; j < knots; j++) out.append(at[j], deep[j]);
  int rest = kept;
  while (rest < count && place[rest] <= to) rest++;
  if (rest < count) out.append(to, Reader(place, depth, count, rest, to).left());
  if (rest == 0 && count > 0) out.append(first(), 0.0);
  for (int j = rest; j < count; j++) out.append(place[j], depth[j]);
  return out;
}

bool Ground::press(const double* at, const double* deep, int knots) {
  const double from = at[0], to = at[knots - 1];
  if (!(to - from > THIN)) return false;
  const int kept = before(from);
  Ground out;
  out.take(*this, kept);
  if (kept > 0 && kept == count) out.append(last(), 0.0);  // apart: what lies between has no depth
  Reader ground(place, depth, count, kept, from), pressed(at, deep, knots, 0, from);
  Merge merge(out, from, ground.left());
  for (double y = from; y < to;) {
    const Both here{ground.right(), pressed.right()};
    const bool knot = ground.is_at_knot(), pressed_knot = pressed.is_at_knot();
    y = std::min(ground.next(), pressed.next());
    ground.go_to(y), pressed.go_to(y);
    merge.advance(y, here, {ground.left(), pressed.left()}, knot, pressed_knot);
  }
  if (merge.is_deeper() && !merge.is_above()) {
    *this = replaced(at, deep, knots, kept);
    return true;
  }
  if (!merge.changed()) return false;
  const bool knot = ground.is_at_knot();
  const double right = ground.right();
  const int rest = ground.knot();
  if (rest == count) {
    merge.end();
  } else {
    merge.turn(right, false, knot || rest == 0);
    if (rest == 0) out.append(first(), 0.0);
  }
  for (int j = rest; j < count; j++) out.append(place[j], depth[j]);
  *this = out;
  return true;
}

// Two that are alike but for rounding go together, the outermost first: the mirror image is simplified as its original.
void Ground::simplify(double area, int most) {
  double size[ROOM];
  for (int j = 1; j + 1 < count; j++) size[j] = triangle(*this, j - 1, j, j + 1);
  while (count > 2) {
    double least = size[1];
    for (int j = 2; j + 1 < count; j++) least = std::min(least, size[j]);
    const double alike = least * (1.0 + ALIKE) + TINY_AREA;
    if (least > area && count <= most) break;
    int first = 1, last = count - 2;
    while (size[first] > alike) first++;
    while (size[last] > alike) last--;
    if (last - first == 1) {  // one at their middle
      place[first] = 0.5 * (place[first] + place[last]), depth[first] = 0.5 * (depth[first] + depth[last]);
      drop(last, size);
      if (first > 1) size[first - 1] = triangle(*this, first - 2, first - 1, first);
      continue;
    }
    drop(last, size);
    if (first < last) drop(first, size);
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
