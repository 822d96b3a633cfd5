// Transverse lines of snow under one runner. A line is laid ahead of the tip and stays where it is in the snow until
// the tail has passed, so the history is never transported or interpolated.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "beam/runner.hpp"
#include "snow/archive.hpp"
#include "snow/delayed.hpp"
#include "snow/groove.hpp"
#include "snow/snow.hpp"
#include "support/columns.hpp"
#include "support/lanes.hpp"

namespace skisnow {

// clang-format off: fields that belong together share a row
enum LineField {
  ORIGIN_X, ORIGIN_Y, ORIGIN_Z,  // on the surface (m)
  AHEAD_X, AHEAD_Y, AHEAD_Z,     // unit vectors: along the ski when it was laid,
  NORMAL_X, NORMAL_Y, NORMAL_Z,  // and out of the snow
  HARDNESS, EXCESS, STRENGTH,    // H_V and k_u - H_V (N/m³), S_f (Pa) at the line,
  FRICTION,                      // and μ there over that of the law
  MARKED,                        // whether the ski was over it at the last accepted pose (0 or 1)
  MARK_STATION, MARK_CLIMB,      // place along the ski then (m), and how fast the depth grew ahead there
  // each edge then: where across it was, how far this moves as the line moves ahead by one, how deep, and where it holds
  // if it was in the snow (m)
  LEFT_MARK, RIGHT_MARK, LEFT_MARK_SKEW, RIGHT_MARK_SKEW, LEFT_MARK_DEPTH, RIGHT_MARK_DEPTH, LEFT_ANCHOR, RIGHT_ANCHOR,
  SLIPPED,                       // how far an edge has slipped across here, the one that slipped farther (m)
  // where the strength varies: that of the edges then (Pa); depth of each and its displacement from the anchor (m)
  STRENGTH_HELD, LEFT_DEPTH_HELD, RIGHT_DEPTH_HELD, LEFT_SHEAR_HELD, RIGHT_SHEAR_HELD,
  // whether the base rubs here; where along the ski and across its friction is 0, of a point how far across the base (m)
  STUCK, STUCK_STATION, STUCK_PLACE, STUCK_ARM,
  KNOWN_FROM, KNOWN_TO,               // where across older tracks were looked for (m)
  LINE_FIELDS
};
// clang-format on

constexpr double LINE_SPACING = 0.02;  // (m) unless said otherwise

class GrooveLines {
 public:
  std::int64_t first = 0, end = 0;  // numbers of the lines that are laid: first <= n < end

  GrooveLines() = default;
  GrooveLines(const Runner& runner, double spacing);

  double spacing() const { return spacing_; }
  int capacity() const { return values.length(); }
  int count() const { return int(end - first); }
  int slot(std::int64_t number) const { return int(number & (capacity() - 1)); }
  int blocks() const { return capacity() / BLOCK; }

  Columns<LineField, LINE_FIELDS> values;

  // Knots lie in tiles: of a block of lines, knot by knot, line by line.
  int tile(int slot, int knot) const { return ((slot / BLOCK) * KNOTS + knot) * BLOCK + slot % BLOCK; }
  Column place, depth, slope;
  std::vector<std::uint8_t> knots;
  std::vector<DelayedGround> delayed;  // (capacity,), empty if the snow has no delayed depth

  Vector3 origin(int slot) const;
  Vector3 lateral(int slot) const;  // unit vector along the line, to the left
  Ground ground(int slot) const;
  void keep(int slot, const Ground& ground);

  // All that is kept of a line, to put it back.
  struct Line {
    int slot;
    double values[LINE_FIELDS];
    Ground ground;
    Line(const GrooveLines& lines, int slot);
  };
  void put_back(const Line& line);
  Track track(std::int64_t number, int strip, double time) const;  // as it would be left at a time

  // Position along the straight ski under which a line passes (m).
  double station(std::int64_t number, const Pose& pose) const;

  // Place across a line (m) under the straight axis of a ski.
  double aside(int slot, const Pose& pose) const;
  // Whether older tracks are known as far as a ski reaches, `room` (m) to both sides of its axis; if not, where across
  // a line they are to be looked for, up to two stretches.
  int unknown(int slot, const Pose& pose, double room, double (&from)[2], double (&to)[2]) const;

  // Lay the lines that the ski will meet. Nothing is known yet of older tracks there.
  void lay_ahead(const Runner& runner, const Pose& pose, const Snow& snow);
  // Drop those that it has left into the archive, or in a trial (`archive` null) for good. `strip`: the track of this
  // runner in the archive.
  void drop_left(const Runner& runner, const Pose& pose, Archive* archive, int strip);

  // Whether the ski has turned away from them, or the surface is another one there.
  bool is_left(const Pose& pose, const Snow& snow) const;
  void leave_all(Archive& archive, int strip);
  // Take hardness and strength of a place (m) across a line; its ground stays as it is.
  void follow_snow(int slot, double place, const Snow& snow);

  // Energy lost in a ground, for each metre of ski (J/m); empty: by the core's law.
  std::function<double(const Ground&)> lost;
  // Energy lost in the grooves under the ski (J): what pressed a line's ground since it was counted last counts for the
  // length of ski of the line.
  double groove_energy() const;
  void count_energy(int slot, double length);
  // The same, where ∫ depth² over the line's ground is known (m³) and the core's own law holds.
  void count_energy(int slot, double length, double squared);
  // Press an older track into a line's ground; its energy was counted there.
  void press_older(int slot, const Ground& older);

  // The lines that are laid, as bytes, and back into lines of an equal runner. Throws std::invalid_argument.
  void write(ByteWriter& out) const;
  void read(ByteReader& in);

 private:
  double spacing_ = LINE_SPACING;
  std::vector<std::uint8_t> filled_;  // knots of each block's tile that are filled
  std::vector<double> energy_;        // (capacity,) of each line (J)
  std::vector<double> counted_;       // (capacity,) of its ground, up to when it was counted last (J/m)

  void fill(int slot, int from, int to);
  double energy_per_metre(int slot, const Ground& ground) const;
  double energy_of(int slot, double squared) const;
  void count(int slot, double length, double energy_per_metre);
  void lay(std::int64_t number, const Pose& pose, double station, const Snow& snow);
  void leave(std::int64_t number, Archive* archive, int strip);
  bool is_off_surface(int slot, const Pose& pose, const Snow& snow) const;
  void take_snow(int slot, const Vector3& at, const Snow& snow);
};

}  // namespace skisnow
