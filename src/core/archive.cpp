#include "archive.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace skisnow {

namespace {

double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector3 minus(const Vector3& a, const Vector3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Vector3 along(const Vector3& origin, const Vector3& direction, double y) {
  return {origin[0] + y * direction[0], origin[1] + y * direction[1], origin[2] + y * direction[2]};
}

std::uint64_t square_of(double x, double y, double side) {
  const auto cell = [side](double v) { return std::uint64_t(std::uint32_t(std::int32_t(std::floor(v / side)))); };
  return cell(x) << 32 | cell(y);
}

// The groove between two tracks: straight from each share of one's width to the same share of the other's.
struct Strip {
  const Track &before, &after;

  struct Found {
    double ahead;  // from 0 at the one before to 1 at the one after
    double share;  // of the width there, inside from 0 to 1
  };

  Found find(const Vector3& point) const {
    const Vector3 from_before = minus(point, before.origin), from_after = minus(point, after.origin);
    const double past = dot(from_before, before.ahead), to_go = -dot(from_after, after.ahead);
    const double t = past / (past + to_go);
    const double y = (1.0 - t) * dot(from_before, before.lateral) + t * dot(from_after, after.lateral);
    const double low = (1.0 - t) * before.place[0] + t * after.place[0];
    const double width = (1.0 - t) * before.width() + t * after.width();
    return {t, (y - low) / width};
  }

  double depth(const Found& found) const {
    const double share = std::clamp(found.share, 0.0, 1.0), t = std::clamp(found.ahead, 0.0, 1.0);
    return (1.0 - t) * before.depth_at(share) + t * after.depth_at(share);
  }
};

constexpr int BISECTIONS = 40;
constexpr int PARTS = 4;  // between the places where either ground has a knot; a crossing groove is bilinear there

// Where a rising or falling quantity passes a value between two places.
template <class Quantity>
double crossing(const Quantity& quantity, double a, double b, double value) {
  const bool rises = quantity(b) > quantity(a);
  for (int i = 0; i < BISECTIONS; i++) {
    const double middle = 0.5 * (a + b);
    ((quantity(middle) < value) == rises ? a : b) = middle;
  }
  return 0.5 * (a + b);
}

// Cut the part [a, b] of a line down to where a quantity lies between 0 and 1; whether anything is left.
template <class Quantity>
bool clip(const Quantity& quantity, double& a, double& b) {
  const double at_a = quantity(a), at_b = quantity(b);
  if (!(std::isfinite(at_a) && std::isfinite(at_b))) return false;
  if ((at_a < 0.0 && at_b < 0.0) || (at_a > 1.0 && at_b > 1.0)) return false;
  const double whole_a = a, whole_b = b;
  if (at_a < 0.0 || at_a > 1.0) a = crossing(quantity, whole_a, whole_b, at_a < 0.0 ? 0.0 : 1.0);
  if (at_b < 0.0 || at_b > 1.0) b = crossing(quantity, whole_a, whole_b, at_b < 0.0 ? 0.0 : 1.0);
  return b - a > THIN;
}

void press_strip(const Strip& strip, const Vector3& origin, const Vector3& lateral, double a, double b,
                 Ground& ground) {
  const auto found = [&](double y) { return strip.find(along(origin, lateral, y)); };
  const auto ahead = [&](double y) { return found(y).ahead; };
  const auto share = [&](double y) { return found(y).share; };
  if (!clip(ahead, a, b) || !clip(share, a, b)) return;
  std::set<double> places{a, b};
  for (const Track* track : {&strip.before, &strip.after})
    for (int j = 1; j + 1 < track->count; j++) {
      const double at_knot = (track->place[j] - track->place[0]) / track->width();
      if ((share(a) - at_knot) * (share(b) - at_knot) < 0.0) places.insert(crossing(share, a, b, at_knot));
    }
  double previous = a, depth_before = strip.depth(found(a));
  for (double next : places) {
    const double start = previous;
    for (int part = 1; part <= PARTS && next > start; part++) {
      const double y = part == PARTS ? next : start + (next - start) * part / PARTS;
      const double depth = strip.depth(found(y));
      ground.press(previous, depth_before, y, depth);
      previous = y;
      depth_before = depth;
    }
  }
}

}  // namespace

double Track::depth_at(double share) const {
  const double where = place[0] + share * width();
  int j = 0;
  while (j + 2 < count && place[j + 1] <= where) j++;
  const double step = place[j + 1] - place[j];
  if (!(step > 0.0)) return std::max(depth[j], depth[j + 1]);
  return depth[j] + (depth[j + 1] - depth[j]) * std::clamp((where - place[j]) / step, 0.0, 1.0);
}

const Track* Archive::before(int later) const {
  const Track& track = tracks_[std::size_t(later)];
  for (int i = later - 1; i >= 0; i--) {
    const Track& other = tracks_[std::size_t(i)];
    if (other.strip == track.strip) return std::abs(other.number - track.number) == 1 ? &other : nullptr;
  }
  return nullptr;
}

void Archive::add(const Track& track, double energy) {
  energy_ += energy;
  if (track.count < 2 || !(track.width() > THIN)) return;
  tracks_.push_back(track);
  enter_squares(int(tracks_.size()) - 1);
}

void Archive::enter_squares(int later) {
  const Track* earlier = before(later);
  if (earlier == nullptr) return;
  const Track& track = tracks_[std::size_t(later)];
  double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
  for (const Track* each : {earlier, &track})
    for (double y : {each->place[0], each->place[each->count - 1]}) {
      const Vector3 corner = along(each->origin, each->lateral, y);
      for (int a = 0; a < 2; a++) {
        low[a] = std::min(low[a], corner[a]);
        high[a] = std::max(high[a], corner[a]);
      }
    }
  for (double x = std::floor(low[0] / SQUARE) * SQUARE + 0.5 * SQUARE; x < high[0] + SQUARE; x += SQUARE)
    for (double y = std::floor(low[1] / SQUARE) * SQUARE + 0.5 * SQUARE; y < high[1] + SQUARE; y += SQUARE) {
      squares_[square_of(x, y, SQUARE)].push_back(later);
      regions_.insert(square_of(x, y, REGION));
    }
}

void Archive::recall(const Vector3& origin, const Vector3& lateral, double from, double to, Ground& ground) const {
  if (tracks_.empty()) return;
  std::vector<int> near;
  std::uint64_t empty = 0;  // the region met last without any track, if any
  bool met_empty = false;
  const auto nothing_in = [&](double x, double y) {
    const std::uint64_t region = square_of(x, y, REGION);
    if (met_empty && region == empty) return true;
    if (regions_.count(region) > 0) return false;
    empty = region, met_empty = true;
    return true;
  };
  const int steps = int(std::ceil((to - from) / (0.5 * SQUARE)));
  for (int i = 0; i <= steps; i++) {
    const Vector3 point = along(origin, lateral, from + (to - from) * i / steps);
    for (double dx : {-0.25 * SQUARE, 0.25 * SQUARE})
      for (double dy : {-0.25 * SQUARE, 0.25 * SQUARE}) {
        if (nothing_in(point[0] + dx, point[1] + dy)) continue;
        const auto found = squares_.find(square_of(point[0] + dx, point[1] + dy, SQUARE));
        if (found != squares_.end()) near.insert(near.end(), found->second.begin(), found->second.end());
      }
  }
  std::sort(near.begin(), near.end());  // in the order in which they were left
  near.erase(std::unique(near.begin(), near.end()), near.end());
  for (int later : near) press_strip({*before(later), tracks_[std::size_t(later)]}, origin, lateral, from, to, ground);
}

void Archive::forget_since(const Mark& mark) {
  strips_ = mark.strips;
  energy_ = mark.energy;
  if (mark.tracks == tracks_.size()) return;
  tracks_.resize(mark.tracks);
  for (auto& [square, tracks] : squares_)
    tracks.erase(std::remove_if(tracks.begin(), tracks.end(), [&](int t) { return t >= int(mark.tracks); }),
                 tracks.end());
}

}  // namespace skisnow
