// The snow's history under a runner that passes: line by line, along the way between two poses.
#include <algorithm>
#include <cmath>
#include <optional>

#include "contact/contact.hpp"

#define SKISNOW_LANES alone
#include "contact/section_kernels.hpp"

namespace skisnow {

void SnowContact::Before::put_back(GrooveLines& into) const {
  into.first = first, into.end = end;
  for (const GrooveLines::Line& line : lines) into.put_back(line);
}

namespace {

constexpr double MOST_PARTS = 1e4;  // into which a way is divided

// The polyline that a section presses into its line: the base where it is wet, and the way of its edge since it was
// marked last. Both are straight and meet at the edge, so that one of them is the deeper wherever both are.
struct Pressing {
  double place[alone::BasePieces<double>::COUNT + 1], depth[alone::BasePieces<double>::COUNT + 1];
  int count = 0;

  double edge = 0.0, deep = 0.0, sense = 1.0;  // place and depth from which numbers count, to the left or the right

  // The base from a to b, the way from the edge to `w`; depths are `fall` and `way_fall` times them deeper than the
  // edge. A nearly level base may be wet only next to its edge.
  void fill(double a, double b, double fall, double w, double way_fall) {
    if (a > 0.0 || b < 0.0) return add(a, fall * a), add(b, fall * b);
    const bool way_is_deeper = w > 0.0 && way_fall > fall;
    if (a < 0.0) add(a, fall * a);
    if (a == 0.0 || way_is_deeper) add(0.0, 0.0);
    if (way_is_deeper) {
      add(w, way_fall * w);
      if (b > w) add(w, fall * w), add(b, fall * b);
    } else {
      add(b, fall * b);
      if (w > b) add(b, way_fall * b), add(w, way_fall * w);
    }
  }

  // The wet part of a base as it is ground.
  static Pressing ground(const alone::Cut<double>& c) {
    const alone::BasePieces<double> pieces(c);
    Pressing out;
    for (int k = 0; k < pieces.COUNT; k++) {
      const double from = std::max(pieces.place[k], c.wet_from), to = std::min(pieces.place[k + 1], c.wet_to);
      if (!(from < to)) continue;
      if (out.count == 0) out.add(c.place + from, pieces.depth(k, from));
      out.add(c.place + to, pieces.depth(k, to));
    }
    return out;
  }

 private:
  void add(double at, double deeper) {
    place[count] = edge + sense * at;
    depth[count++] = deep + deeper;
  }
};

constexpr long MOST_PLACES = 24;  // places of a delayed depth that are pressed into a ground, which keeps fewer knots

// Press into a ground what of the depths is not delayed.
bool press_undelayed(const Pressing& pressing, const DelayedGround& delayed, Ground& ground) {
  if (delayed.empty()) return ground.press(pressing.place, pressing.depth, pressing.count);
  std::vector<double> place, depth;
  const double span = pressing.place[pressing.count - 1] - pressing.place[0];
  const long every = 1 + long(span / delayed.spacing) / MOST_PLACES;
  const double spacing = double(every) * delayed.spacing;  // places that are the same in the mirror image
  const auto add = [&](double at, double deep) { place.push_back(at), depth.push_back(deep - delayed.depth_at(at)); };
  for (int j = 0; j < pressing.count; j++) {
    add(pressing.place[j], pressing.depth[j]);
    if (j + 1 == pressing.count) break;
    const double a = pressing.place[j], width = pressing.place[j + 1] - a;
    const double growth = pressing.depth[j + 1] - pressing.depth[j];
    for (long n = long(std::floor(a / spacing)) + 1; double(n) * spacing < a + width; n++)
      add(double(n) * spacing, pressing.depth[j] + growth * (double(n) * spacing - a) / width);
  }
  return ground.press(place.data(), depth.data(), int(place.size()));
}

// Update of a section when its pose is accepted.
struct Touch {
  const Base& s;
  int i;
  const GrooveLines& lines;
  int slot;
  double to_end;  // see `press_deepest`

  double edge_place(int k) const { return s[GRIP_PLACE][i] + s[of_edge(LEFT_X, k)][i]; }
  double edge_depth(int k) const { return s[of_edge(LEFT_DEPTH, k)][i]; }
  double of_line(LineField left, int k) const { return lines.values[of_edge(left, k)][slot]; }
  // Whether an edge was in the snow at the last accepted pose.
  bool was_in_snow(int k) const { return lines.values[MARKED][slot] > 0.5 && of_line(LEFT_MARK_DEPTH, k) > 0.0; }

  // The base where it was deepest since it was marked last: [deepest] of the kernels, with b and `to_end` as there.
  bool press_deepest(Ground& ground) const {
    if (to_end == NO_VERTEX) return false;
    const double bend =
        0.5 * (lines.values[MARK_STATION][slot] - s[STATION][i]) * (s[DEPTH_CLIMB][i] - lines.values[MARK_CLIMB][slot]);
    double u[2], aside[2];
    for (int k = 0; k < 2; k++)
      u[k] = 0.5 * (to_end + of_line(LEFT_MARK_DEPTH, k) - edge_depth(k)),
      aside[k] = of_line(LEFT_MARK, k) - edge_place(k);
    u[0] /= bend, u[1] /= bend;
    const double left = s[LEFT_X][i], right = s[RIGHT_X][i], per_width = 1.0 / (left - right);
    const auto at = [&](const double* of, double x) { return (of[0] * (x - right) + of[1] * (left - x)) * per_width; };
    const auto place_of = [&](double v) { return ((v - u[1]) * left + (u[0] - v) * right) / (u[0] - u[1]); };
    const double low = std::max(s[WET_FROM][i], std::min(place_of(0.0), place_of(1.0)));
    const double high = std::min(s[WET_TO][i], std::max(place_of(0.0), place_of(1.0)));
    if (!(high - low > THIN)) return false;
    std::optional<alone::BasePieces<double>> pieces;
    if (s.edge_shape.acts()) pieces.emplace(alone::Cut<double>::stored(s, i));
    Pressing out;
    for (; out.count < 5; out.count++) {
      const double x = 0.25 * (low * (4 - out.count) + high * out.count), share = at(u, x);
      double depth = s[GRIP_DEPTH][i] + s[DEPTH_FALL][i] * x;
      for (int piece = 0; pieces && piece < pieces->COUNT; piece++)  // the least, since a base rises towards its edges
        depth = std::min(depth, pieces->depth(piece, x));
      out.place[out.count] = s[GRIP_PLACE][i] + x + share * at(aside, x);
      out.depth[out.count] = depth + share * share * bend;
    }
    return press_undelayed(out, lines.delayed[std::size_t(slot)], ground);
  }

  // The wet base and the way of one of its edges in the snow since it was marked last.
  Pressing base_and_way(int k) const {
    const double fall = s[DEPTH_FALL][i], x = s[of_edge(LEFT_X, k)][i];
    const double from = s[WET_FROM][i] - x, to = std::max(s[WET_TO][i], s[WET_FROM][i]) - x;
    const double way = was_in_snow(k) ? of_line(LEFT_MARK, k) - edge_place(k) : 0.0;
    const double risen = was_in_snow(k) ? of_line(LEFT_MARK_DEPTH, k) - edge_depth(k) : 0.0;
    const double way_fall = std::fabs(way) > THIN ? risen / std::fabs(way) : 0.0;
    Pressing out;
    out.edge = edge_place(k), out.deep = edge_depth(k);
    if (!(way < 0.0)) {
      out.fill(from, to, fall, way, way_fall);
      return out;
    }
    out.sense = -1.0;
    out.fill(-to, -from, -fall, -way, way_fall);
    std::reverse(out.place, out.place + out.count), std::reverse(out.depth, out.depth + out.count);
    return out;
  }

  // The way of one edge up to where it left the snow.
  Pressing way_of(int k) const {
    const double mark = of_line(LEFT_MARK, k), before = of_line(LEFT_MARK_DEPTH, k), depth = edge_depth(k);
    const double left_at = mark + before / (before - std::min(depth, 0.0)) * (edge_place(k) - mark);
    const double edge = depth < 0.0 ? left_at : edge_place(k), deep = std::max(depth, 0.0);
    return mark < edge ? Pressing{{mark, edge}, {before, deep}, 2} : Pressing{{edge, mark}, {deep, before}, 2};
  }

  // A ground takes the base that touches its line: everything under it, and the ways of its edges. A base with both
  // edges in the snow is pressed one edge after the other: left and right then have the same bits.
  bool press_base(Ground& ground) const {
    const DelayedGround& delayed = lines.delayed[std::size_t(slot)];
    const double at = s[GRIP_PLACE][i], from = s[WET_FROM][i], to = std::max(s[WET_TO][i], from);
    const bool both = edge_depth(0) > 0.0 && edge_depth(1) > 0.0;
    const int first = edge_depth(0) > 0.0 ? 0 : 1;
    const bool is_plane = !s.edge_shape.acts();
    const Pressing base = !is_plane ? Pressing::ground(alone::Cut<double>::stored(s, i))
                          : both    ? Pressing{{at + from, at + to}, {edge_depth(1), edge_depth(0)}, 2}
                                    : base_and_way(first);
    bool changed = base.count > 1 && press_undelayed(base, delayed, ground);
    changed = press_deepest(ground) || changed;
    for (int k = 0; k < 2; k++)
      if (was_in_snow(k) && (both || !is_plane || k != first))
        changed = press_undelayed(way_of(k), delayed, ground) || changed;
    return changed;
  }
};

}  // namespace

// The ground of a line takes the base that touches it, or the base only where it was deepest since its mark.
void SnowContact::press(int k, std::int64_t line, GrooveLines& lines, bool only_deepest) const {
  const Base& s = sections(k).base;
  const int i = s.index(line), slot = lines.slot(line);
  if (!s.touches(i)) return;
  const Touch touch{s, i, lines, slot, scratch_[std::size_t(slot)]};
  if (only_deepest && touch.to_end == NO_VERTEX) return;
  Ground ground = lines.ground(slot);
  if (!(only_deepest ? touch.press_deepest(ground) : touch.press_base(ground))) return;
  ground.simplify(snow_->knot_area * s[DEEPEST][i] * std::max(s[WET_TO][i] - s[WET_FROM][i], 0.0), KNOTS);
  lines.keep(slot, ground);
}

// All grounds take the base; then the marks follow it.
void SnowContact::remember(int k, GrooveLines& lines, bool is_eased) {
  const Sections& s = sections(k);
  kernels_->find_vertices(runner(k), s.base, lines, scratch_.data());
  for (std::int64_t n = lines.first; n < lines.end; n++) press(k, n, lines, false);
  kernels_->mark(*snow_, s.base, nullptr, is_eased ? &s.edge : nullptr, lines);
}

// Number of parts of the way from the accepted pose; 1 if it took no time.
int SnowContact::parts(int k, const Situation& at) const {
  if (!(at.dt > 0.0)) return 1;
  const Pose& to = at.poses[std::size_t(k)];
  const Pose& from = state_.accepted[std::size_t(k)];
  double most = 1.0;
  for (const double station : {runner(k).tip, runner(k).tail}) {
    const Vector3 way = to.position - from.position + station * (to.axis(0) - from.axis(0));
    const double along = dot(way, from.axis(0)), across = std::sqrt(std::max(dot(way, way) - along * along, 0.0));
    most = std::max({most, std::fabs(along) / snow_->part_along, across / snow_->part_across});
  }
  return int(std::ceil(std::min(most, MOST_PARTS) - 1e-9));
}

// The history of all lines along the way, up to but without its end.
void SnowContact::march(int k, GrooveLines& lines, const Situation& to) {
  if (state_.accepted.empty()) return;
  const int parts = this->parts(k, to);
  for (int part = 1; part < parts; part++) {
    interpolate(state_.accepted[std::size_t(k)], to.poses[std::size_t(k)], nullptr, to.dt, double(part) / parts,
                on_way_);
    kernels_->find_sections(runner(k), on_way_, lines, nullptr, sections_[std::size_t(k)].base);
    remember(k, lines, false);
  }
}

// Lines whose ground depends on the way between two poses, not on its ends alone: on untouched snow that the base comes
// to, where the base passes its deepest place or did so less than the way before, and where an edge slips unless all of
// the edge that comes to the line slips to the same side.
void SnowContact::find_needed(const GrooveLines& lines, double way, const Runner& runner, const Pose& to) {
  const auto& v = lines.values;
  const double most = snow_->shear_displacement - THIN;  // a slip leaves the anchor as far off, but for rounding
  const auto over = std::int64_t(std::ceil(way / lines.spacing()));
  for (Column* each : {&is_needed_, &scratch_}) std::fill(each->begin(), each->end(), 0.0);
  Column& marked_depth = scratch_;             // by slot; 0 where the ski was not in the snow
  std::int64_t foremost = lines.first - over;  // line in the snow
  int side[2] = {}, alike[2] = {};  // of each edge: whether it slips to the left, 1, or to the right, -1; lines before
  for (std::int64_t n = lines.first; n < lines.end; n++) {
    const auto slot = std::size_t(lines.slot(n));
    const bool is_marked = v[MARKED][slot] > 0.5;
    if (is_marked) marked_depth[slot] = std::max({v[LEFT_MARK_DEPTH][slot], v[RIGHT_MARK_DEPTH][slot], 0.0});
    if (marked_depth[slot] > 0.0) foremost = n;
    for (int k = 0; k < 2; k++) {
      const double slipped = v[of_edge(LEFT_MARK, k)][slot] - v[of_edge(LEFT_ANCHOR, k)][slot];
      const bool slips = is_marked && v[of_edge(LEFT_MARK_DEPTH, k)][slot] > 0.0 && std::fabs(slipped) > most;
      const int here = !slips ? 0 : slipped > 0.0 ? 1 : -1;
      alike[k] = here == side[k] ? alike[k] + 1 : 0, side[k] = here;
      if (here != 0 && alike[k] <= over) is_needed_[slot] = 1.0;
    }
  }
  const auto depth = [&](std::int64_t n) {
    return n >= lines.first && n < lines.end ? marked_depth[std::size_t(lines.slot(n))] : 0.0;
  };
  const double reach = runner.tip + lines.spacing();  // lines that the tip does not reach stay as they are
  needed_.clear();
  std::int64_t deepest = lines.end + over + 1;
  for (std::int64_t n = lines.end - 1; n >= lines.first; n--) {
    const auto slot = std::size_t(lines.slot(n));
    const double rear = depth(n - over - 1), here = depth(n - over), front = depth(n - over + 1);
    if (std::min({rear, here, front}) > 0.0 && here >= std::max(rear, front)) deepest = n - over;
    const bool ahead = n > foremost && n <= foremost + over, passes = n >= deepest - over && n <= deepest + over;
    if ((ahead || passes) && !(lines.station(n, to) > reach)) is_needed_[slot] = 1.0;
    if (is_needed_[slot] > 0.0) needed_.push_back(n);
  }
}

// [march] As `march`, for the lines that need it. They also take the deepest place on the way to the end, and the
// places where edges turn back.
void SnowContact::march_where_needed(int k, const Situation& to) {
  GrooveLines& lines = state_.lines[std::size_t(k)];
  if (state_.accepted.empty()) return;
  const Pose &from = state_.accepted[std::size_t(k)], &end = to.poses[std::size_t(k)];
  const int parts = this->parts(k, to);
  if (parts < 2) return;
  const Vector3 way = end.position - from.position;
  find_needed(lines, std::sqrt(dot(way, way)), runner(k), end);
  if (needed_.empty()) return;
  Before& before = before_[std::size_t(k)];
  for (const std::int64_t n : needed_) before.lines.emplace_back(lines, lines.slot(n));
  Sections& s = sections_[std::size_t(k)];
  for (int part = 1; part < parts; part++) {
    interpolate(from, end, &to.motions[std::size_t(k)], to.dt, double(part) / parts, on_way_);
    kernels_->find_sections(runner(k), on_way_, lines, is_needed_.data(), s.base);
    kernels_->find_vertices(runner(k), s.base, lines, scratch_.data());
    for (const std::int64_t n : needed_) press(k, n, lines, false);
    kernels_->mark(*snow_, s.base, is_needed_.data(), nullptr, lines);
  }
  kernels_->find_sections(runner(k), end, lines, is_needed_.data(), s.base);
  kernels_->find_vertices(runner(k), s.base, lines, scratch_.data());
  for (const std::int64_t n : needed_) press(k, n, lines, true);
  kernels_->drag_anchors(*snow_, s.base, is_needed_.data(), lines);
}

}  // namespace skisnow
