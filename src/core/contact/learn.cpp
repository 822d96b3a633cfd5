// Older tracks that the lines under one runner take over: as far across as the ski comes, when it comes there.
#include <algorithm>
#include <cmath>

#include "contact/contact.hpp"

namespace skisnow {

namespace {

constexpr double SPARE = 0.01;  // (m) beside a ski: no look of a step lies that far from the pose foreseen for it
constexpr int HEIGHTS = 9;      // places along a ski whose heights are looked at
constexpr double CLEAR = 0.05;  // their height (m) beyond twice its reach, on surfaces up to 60°

// How far a ski reaches across from its straight axis (m), however it is rolled.
double room_of(const Runner& runner, const Pose& pose) {
  double bent = 0.0;
  for (std::size_t i = 0; i < pose.beam.size(); i += 3) bent = std::max(bent, std::fabs(pose.beam[i]));
  return runner.reach + bent + SPARE;
}

// The two ends of the groove in a line.
struct GrooveEnds {
  std::int64_t number;
  Vector3 ends[2];
};

// A rectangle on the map.
struct Extent {
  double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};

  void add(const Vector3& place) {
    for (std::size_t a = 0; a < 2; a++) low[a] = std::min(low[a], place[a]), high[a] = std::max(high[a], place[a]);
  }
  bool meets(const Extent& other) const {
    for (std::size_t a = 0; a < 2; a++)
      if (low[a] > other.high[a] + THIN || other.low[a] > high[a] + THIN) return false;
    return true;
  }
};

Vector3 along(const Vector3& origin, const Vector3& lateral, double place) { return origin + place * lateral; }

std::vector<GrooveEnds> ends_of(const GrooveLines& lines) {
  std::vector<GrooveEnds> out;
  for (std::int64_t n = lines.first; n < lines.end; n++) {
    const int slot = lines.slot(n), knots = lines.knots[std::size_t(slot)];
    if (knots < 2) continue;
    const auto end = [&](int knot) {
      return along(lines.origin(slot), lines.lateral(slot), lines.place[std::size_t(lines.tile(slot, knot))]);
    };
    out.push_back({n, {end(0), end(knots - 1)}});
  }
  return out;
}

Extent extent_of(const GrooveLines& lines) {
  Extent out;
  for (std::int64_t n = lines.first; n < lines.end; n++) {
    const int slot = lines.slot(n), knots = lines.knots[std::size_t(slot)];
    if (knots < 2) continue;
    const Vector3 origin = lines.origin(slot), lateral = lines.lateral(slot);
    for (const int knot : {0, knots - 1})
      out.add(along(origin, lateral, lines.place[std::size_t(lines.tile(slot, knot))]));
  }
  return out;
}

// Whether a line, between two places across it, may cross the groove between two others.
bool may_cross(const GrooveEnds& before, const GrooveEnds& after, const Vector3& origin, const Vector3& lateral,
               const Vector3& ahead, double from, double to) {
  double along[2] = {1e300, -1e300}, across[2] = {1e300, -1e300};
  for (const GrooveEnds* each : {&before, &after})
    for (const Vector3& end : each->ends) {
      const Vector3 there = end - origin;
      const double x = dot(there, ahead), y = dot(there, lateral);
      along[0] = std::min(along[0], x), along[1] = std::max(along[1], x);
      across[0] = std::min(across[0], y), across[1] = std::max(across[1], y);
    }
  return along[0] <= THIN && along[1] >= -THIN && across[0] <= to && across[1] >= from;
}

}  // namespace

// The grooves in which other runners stand.
class SnowContact::Standing {
 public:
  Standing(const SnowContact& contact, int k) {
    now_ = contact.snow_->archive.time;
    for (int other = 0; other < contact.runners(); other++)
      if (other != k) runners_.push_back({&contact.lines(other), extent_of(contact.lines(other)), {}});
  }

  void recall(const Vector3& origin, const Vector3& lateral, const Vector3& ahead, double from, double to,
              Ground& ground, DelayedRecall* delayed) {
    Extent line;
    line.add(along(origin, lateral, from)), line.add(along(origin, lateral, to));
    for (auto& [lines, extent, grooves] : runners_) {
      if (!extent.meets(line)) continue;
      if (grooves.empty()) grooves = ends_of(*lines);
      for (std::size_t i = 1; i < grooves.size(); i++) {
        const GrooveEnds &before = grooves[i - 1], &after = grooves[i];
        if (after.number == before.number + 1 && may_cross(before, after, origin, lateral, ahead, from, to))
          press_between(lines->track(before.number, 0, now_), lines->track(after.number, 0, now_), origin, lateral,
                        from, to, now_, ground, delayed);
      }
    }
  }

 private:
  struct Other {
    const GrooveLines* lines;
    Extent extent;
    std::vector<GrooveEnds> grooves;  // found when a line meets the extent
  };
  std::vector<Other> runners_;
  double now_;
};

// Whether a runner is so high at the end of a step that it needs no lines: no look of the step comes down to the snow.
bool SnowContact::is_clear(int k, const Situation& at) const {
  const Runner& runner = this->runner(k);
  const Pose& pose = at.poses[std::size_t(k)];
  const double least = CLEAR + 2.0 * room_of(runner, pose), apart = (runner.tip - runner.tail) / (HEIGHTS - 1);
  for (int i = 0; i < HEIGHTS; i++) {
    const Vector3 place = pose.position + (runner.tail + i * apart) * pose.axis(0);
    if (place[2] - snow_->surface.at(place[0], place[1]).value < least) return false;
  }
  return at.dt > 0.0;
}

// Lay the lines that a runner will meet, and look for the tracks that it comes to.
void SnowContact::prepare(int k, GrooveLines& lines, const Pose& pose) {
  lines.lay_ahead(runner(k), pose, *snow_);
  const double room = room_of(runner(k), pose);
  if (!kernels_->find_unknown(lines, pose, room, scratch_.data())) return;
  std::optional<Standing> standing;
  for (std::int64_t n = lines.first; n < lines.end; n++) {
    if (scratch_[std::size_t(lines.slot(n))] == 0.0) continue;
    double from[2], to[2];
    const int slot = lines.slot(n), stretches = lines.unknown(slot, pose, room, from, to);
    if (stretches == 0) continue;
    if (!standing) standing.emplace(*this, k);
    for (int i = 0; i < stretches; i++) learn(lines, slot, from[i], to[i], *standing);
  }
}

// Grooves of older tracks enter a line's ground; the energy that they took is not this runner's.
void SnowContact::learn(GrooveLines& lines, int slot, double from, double to, Standing& standing) {
  auto& v = lines.values;
  const Vector3 ahead{v[AHEAD_X][slot], v[AHEAD_Y][slot], v[AHEAD_Z][slot]};
  const Vector3 origin = lines.origin(slot), lateral = lines.lateral(slot);
  const bool known = v[KNOWN_FROM][slot] < v[KNOWN_TO][slot];
  v[KNOWN_FROM][slot] = known ? std::min(from, v[KNOWN_FROM][slot]) : from;
  v[KNOWN_TO][slot] = known ? std::max(to, v[KNOWN_TO][slot]) : to;
  Ground older;
  DelayedRecall recalled{snow_->rate.retardation, {snow_->rate.spacing}};
  DelayedRecall* delayed = snow_->rate.is_delayed() ? &recalled : nullptr;
  UnseenTracks unseen{ahead, lines.spacing()};
  snow_->archive.recall(origin, lateral, from, to, older, delayed, unseen);
  unseen_width_ = std::max(unseen_width_, unseen.widest);
  standing.recall(origin, lateral, ahead, from, to, older, delayed);
  if (delayed != nullptr) lines.delayed[std::size_t(slot)].take_over(recalled.ground);
  if (older.empty()) return;
  older.simplify(0.0, KNOTS);
  lines.press_older(slot, older);
}

}  // namespace skisnow
