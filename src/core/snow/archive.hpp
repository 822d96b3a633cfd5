// Tracks left behind: lines that a runner has left, joined into strips, found again by place.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "snow/delayed.hpp"
#include "snow/groove.hpp"
#include "support/bytes.hpp"
#include "support/vectors.hpp"

namespace skisnow {

// A line that was left: where it lies, and its ground.
struct Track {
  Vector3 origin, ahead, lateral;
  int strip;            // of lines that were left one after the other
  std::int64_t number;  // within the strip
  int count;
  double place[KNOTS], depth[KNOTS];
  double delayed[KNOTS] = {}, left_at = 0.0;  // delayed depth (m) when it was left (s)

  double width() const { return place[count - 1] - place[0]; }
  double depth_at(double share) const { return at(depth, share); }  // share of the width, from 0 to 1
  double delayed_at(double share) const { return at(delayed, share); }

 private:
  double at(const double* values, double share) const;
};

// Delayed depth that a line takes over from older tracks. It springs back after they were left.
struct DelayedRecall {
  double retardation;  // (s)
  DelayedGround ground;
};

// Tracks beside a line that neither it nor its neighbours cross: so nearly parallel to them, and so narrow, that they
// lie between two of them all the way. Their greatest width is found (m).
struct UnseenTracks {
  Vector3 ahead;   // direction in which the neighbours follow
  double spacing;  // spacing of the lines (m)
  double widest = 0.0;

  void add(const Track& before, const Track& after, const Vector3& origin, const Vector3& lateral, double from,
           double to);
};

// Press the groove between two tracks, as far as a line crosses it between two places across it (m), into its ground.
void press_between(const Track& before, const Track& after, const Vector3& origin, const Vector3& lateral, double from,
                   double to, double now, Ground& ground, DelayedRecall* delayed);

class Archive {
 public:
  int new_strip() { return strips_++; }
  void add(const Track& track, double energy);

  // Press the older tracks that a line crosses, between two places across it (m), into its ground.
  void recall(const Vector3& origin, const Vector3& lateral, double from, double to, Ground& ground,
              DelayedRecall* delayed, UnseenTracks& unseen) const;
  double time = 0.0;  // to which the contacts have come (s)

  const std::vector<Track>& tracks() const { return tracks_; }
  double energy() const { return energy_; }

  // Forget what was added since (for a contact that goes back to a state). Throws std::invalid_argument, and changes
  // nothing, where tracks of that time were forgotten themselves.
  struct Mark {
    std::size_t tracks;
    int strips;
    double energy, time;
    std::int64_t last;  // number of the last track
  };
  Mark mark() const { return {tracks_.size(), strips_, energy_, time, last(tracks_.size())}; }
  void forget_since(const Mark& mark);

  // All up to a mark, as bytes; another archive from them; replace this archive by that one, after which every mark
  // of this one that has a track is refused. Each throws std::invalid_argument, and changes nothing.
  void write(const Mark& mark, ByteWriter& out) const;
  static Archive read(ByteReader& in);
  void replace(Archive&& other);
  int strips() const { return strips_; }

 private:
  static constexpr double SQUARE = 0.0625;  // side (m) of the squares in which tracks are looked up

  std::vector<Track> tracks_;
  std::unordered_map<std::uint64_t, std::vector<int>> squares_;  // later track of each pair, by square
  std::unordered_set<std::uint64_t> regions_;
  std::vector<std::int64_t> numbers_;  // numbers of the tracks, in the order in which any were ever added, from 1
  std::int64_t added_ = 0;
  int strips_ = 0;
  double energy_ = 0.0;

  std::int64_t last(std::size_t count) const { return count == 0 ? 0 : numbers_[count - 1]; }
  void require_kept(const Mark& mark) const;
  void enter_squares(int later);
  const Track* before(int later) const;
};

}  // namespace skisnow
