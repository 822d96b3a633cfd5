#include "snow/archive.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace skisnow {

namespace {

Vector3 minus(const Vector3& a, const Vector3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Vector3 along(const Vector3& origin, const Vector3& direction, double y) {
  return {origin[0] + y * direction[0], origin[1] + y * direction[1], origin[2] + y * direction[2]};
}

std::uint64_t key_of(int x, int y) { return std::uint64_t(std::uint32_t(x)) << 32 | std::uint32_t(y); }

// Key of a square. Eight by eight squares are a region; a region without any track is skipped.
std::uint64_t region_of(int x, int y) { return key_of(x >> 3, y >> 3); }

int cell_of(double v, double side) { return int(std::floor(v / side)); }

// All squares that a straight line passes, one after the other.
template <class Visit>
void walk_squares(const Vector3& from, const Vector3& to, double side, const Visit& visit) {
  int cell[2], way[2], left = 0;
  double next[2], step[2];  // share of the line to the next border, and from border to border
  for (int a = 0; a < 2; a++) {
    const double length = to[std::size_t(a)] - from[std::size_t(a)];
    cell[a] = cell_of(from[std::size_t(a)], side);
    way[a] = length < 0.0 ? -1 : 1;
    const double border = side * (cell[a] + (length < 0.0 ? 0 : 1));
    step[a] = std::fabs(length) > THIN ? side / std::fabs(length) : 1e300;
    next[a] = std::fabs(length) > THIN ? (border - from[std::size_t(a)]) / length : 1e300;
    left += std::abs(cell_of(to[std::size_t(a)], side) - cell[a]);
  }
  visit(cell[0], cell[1]);
  for (; left > 0; left--) {
    const int a = next[0] < next[1] ? 0 : 1;
    cell[a] += way[a];
    next[a] += step[a];
    visit(cell[0], cell[1]);
  }
}

// The groove between two tracks: straight from each share of one's width to the same share of the other's.
struct Strip {
  const Track &before, &after;

  struct Found {
    double ahead;  // from 0 at the one before to 1 at the one after
    double share;  // share of the width there, inside from 0 to 1
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

  double delayed(const Found& found) const {
    const double share = std::clamp(found.share, 0.0, 1.0), t = std::clamp(found.ahead, 0.0, 1.0);
    return (1.0 - t) * before.delayed_at(share) + t * after.delayed_at(share);
  }
};

constexpr double MOST_AREA = 1e4;  // (m²) around two neighbouring lines
constexpr int MOST_TRIES = 60;
constexpr double EXACT = 1e-14;     // (m)
constexpr double AT_BORDER = 1e-9;  // share of a strip that is rounding: a line along its border is inside
constexpr int PARTS = 4;  // between the places where either ground has a knot; a crossing groove is bilinear there

// Where a rising or falling quantity passes a value between two places: false position, with half the weight of an end
// that stays (the Illinois method, Dowell and Jarratt 1971).
template <class Quantity>
double crossing(const Quantity& quantity, double a, double b, double value) {
  double at_a = quantity(a) - value, at_b = quantity(b) - value, last = a;
  for (int i = 0; i < MOST_TRIES; i++) {
    const double at = (a * at_b - b * at_a) / (at_b - at_a), here = quantity(at) - value;
    if (here == 0.0 || !(std::fabs(at - last) > EXACT)) return at;
    if ((here > 0.0) == (at_b > 0.0)) {
      if (last == b) at_a *= 0.5;
      b = last = at, at_b = here;
    } else {
      if (last == a) at_b *= 0.5;
      a = last = at, at_a = here;
    }
  }
  return last;
}

// Cut the part [a, b] of a line down to where a quantity lies between 0 and 1; whether anything is left.
template <class Quantity>
bool clip(const Quantity& quantity, double& a, double& b) {
  const double at_a = quantity(a), at_b = quantity(b);
  if (!(std::isfinite(at_a) && std::isfinite(at_b))) return false;
  if ((at_a < -AT_BORDER && at_b < -AT_BORDER) || (at_a > 1.0 + AT_BORDER && at_b > 1.0 + AT_BORDER)) return false;
  const double whole_a = a, whole_b = b;
  const auto is_outside = [](double at) { return at < -AT_BORDER || at > 1.0 + AT_BORDER; };
  if (is_outside(at_a)) a = crossing(quantity, whole_a, whole_b, at_a < 0.0 ? 0.0 : 1.0);
  if (is_outside(at_b)) b = crossing(quantity, whole_a, whole_b, at_b < 0.0 ? 0.0 : 1.0);
  return b - a > THIN;
}

// The delayed depth of a strip at the places of a line between a and b, as it is by now.
void recall_delayed(const Strip& strip, const Vector3& origin, const Vector3& lateral, double a, double b, double now,
                    DelayedRecall& out) {
  const double spacing = out.ground.spacing;
  const long from = long(std::ceil(a / spacing)), to = long(std::floor(b / spacing)) + 1;
  const double left = std::exp(-std::max(now - strip.after.left_at, 0.0) / out.retardation);
  out.ground.cover(from, to);
  for (long n = from; n < to; n++) {
    const double depth = strip.delayed(strip.find(along(origin, lateral, double(n) * spacing)));
    out.ground.depth[std::size_t(n - out.ground.first)] = left * depth;
  }
}

void press_strip(const Strip& strip, const Vector3& origin, const Vector3& lateral, double a, double b, double now,
                 Ground& ground, DelayedRecall* delayed) {
  const auto found = [&](double y) { return strip.find(along(origin, lateral, y)); };
  const auto ahead = [&](double y) { return found(y).ahead; };
  const auto share = [&](double y) { return found(y).share; };
  if (!clip(ahead, a, b) || !clip(share, a, b)) return;
  if (delayed != nullptr) recall_delayed(strip, origin, lateral, a, b, now, *delayed);
  double places[2 + 2 * KNOTS] = {a, b};
  int count = 2;
  for (const Track* track : {&strip.before, &strip.after})
    for (int j = 1; j + 1 < track->count; j++) {
      const double at_knot = (track->place[j] - track->place[0]) / track->width();
      if ((share(a) - at_knot) * (share(b) - at_knot) < 0.0) places[count++] = crossing(share, a, b, at_knot);
    }
  std::sort(places, places + count);
  double previous = a, depth_before = strip.depth(found(a));
  for (int i = 1; i < count; i++) {
    const double start = previous, next = places[i];
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

double Track::at(const double* values, double share) const {
  const double where = place[0] + share * width();
  int j = 0;
  while (j + 2 < count && place[j + 1] <= where) j++;
  const double step = place[j + 1] - place[j];
  if (!(step > 0.0)) return std::max(values[j], values[j + 1]);
  return values[j] + (values[j + 1] - values[j]) * std::clamp((where - place[j]) / step, 0.0, 1.0);
}

void press_between(const Track& before, const Track& after, const Vector3& origin, const Vector3& lateral, double from,
                   double to, double now, Ground& ground, DelayedRecall* delayed) {
  press_strip({before, after}, origin, lateral, from, to, now, ground, delayed);
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
  numbers_.push_back(++added_);
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
  if ((high[0] - low[0]) * (high[1] - low[1]) > MOST_AREA) throw std::invalid_argument("a track is wider than a slope");
  for (int x = cell_of(low[0], SQUARE); x <= cell_of(high[0], SQUARE); x++)
    for (int y = cell_of(low[1], SQUARE); y <= cell_of(high[1], SQUARE); y++) {
      squares_[key_of(x, y)].push_back(later);
      regions_.insert(region_of(x, y));
    }
}

void UnseenTracks::add(const Track& before, const Track& after, const Vector3& origin, const Vector3& lateral,
                       double from, double to) {
  const Vector3 way = minus(after.origin, before.origin);
  // over the stretch a track that is less parallel comes to the next line
  if (!(std::fabs(dot(way, ahead)) * (to - from) < spacing * std::fabs(dot(way, lateral)))) return;
  double along_ski[2] = {1e300, -1e300}, across[2] = {1e300, -1e300};
  for (const Track* each : {&before, &after})
    for (const double y : {each->place[0], each->place[each->count - 1]}) {
      const Vector3 corner = minus(along(each->origin, each->lateral, y), origin);
      const double x = dot(corner, ahead), aside = dot(corner, lateral);
      along_ski[0] = std::min(along_ski[0], x), along_ski[1] = std::max(along_ski[1], x);
      across[0] = std::min(across[0], aside), across[1] = std::max(across[1], aside);
    }
  if (across[0] > to || across[1] < from) return;
  const bool is_ahead = along_ski[0] > 0.0 && along_ski[1] < spacing;
  const bool is_behind = along_ski[1] < 0.0 && along_ski[0] > -spacing;
  if (is_ahead || is_behind) widest = std::max(widest, along_ski[1] - along_ski[0]);
}

void Archive::recall(const Vector3& origin, const Vector3& lateral, double from, double to, Ground& ground,
                     DelayedRecall* delayed, UnseenTracks& unseen) const {
  if (tracks_.empty()) return;
  std::vector<int> near;
  std::optional<std::uint64_t> region;  // the region met last, and whether it has any track
  bool inhabited = false;
  walk_squares(along(origin, lateral, from), along(origin, lateral, to), SQUARE, [&](int x, int y) {
    const std::uint64_t here = region_of(x, y);
    if (here != region) region = here, inhabited = regions_.count(here) > 0;
    if (!inhabited) return;
    const auto found = squares_.find(key_of(x, y));
    if (found != squares_.end()) near.insert(near.end(), found->second.begin(), found->second.end());
  });
  std::sort(near.begin(), near.end());  // in the order in which they were left
  near.erase(std::unique(near.begin(), near.end()), near.end());
  for (int later : near) {
    const Strip strip{*before(later), tracks_[std::size_t(later)]};
    press_strip(strip, origin, lateral, from, to, time, ground, delayed);
    unseen.add(strip.before, strip.after, origin, lateral, from, to);
  }
}

void Archive::require_kept(const Mark& mark) const {
  if (mark.tracks > tracks_.size() || mark.last != last(mark.tracks))
    throw std::invalid_argument(
        "tracks of this state were forgotten when an earlier state was restored; go on from there");
}

void Archive::replace(Archive&& other) {
  for (std::int64_t& each : other.numbers_) each += added_;
  other.added_ += added_;
  other.strips_ = std::max(other.strips_, strips_);
  *this = std::move(other);
}

void Archive::forget_since(const Mark& mark) {
  require_kept(mark);
  strips_ = mark.strips;
  energy_ = mark.energy;
  time = mark.time;
  if (mark.tracks == tracks_.size()) return;
  tracks_.resize(mark.tracks);
  numbers_.resize(mark.tracks);
  for (auto& [square, tracks] : squares_)
    tracks.erase(std::remove_if(tracks.begin(), tracks.end(), [&](int t) { return t >= int(mark.tracks); }),
                 tracks.end());
}

}  // namespace skisnow
