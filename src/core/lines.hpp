// Transverse lines of snow under one runner. A line is laid ahead of the tip and stays where it is in the snow until
// the tail has passed, so the history is never transported or interpolated.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "archive.hpp"
#include "columns.hpp"
#include "delayed.hpp"
#include "groove.hpp"
#include "lanes.hpp"
#include "runner.hpp"
#include "snow.hpp"

namespace skisnow {

// clang-format off: fields that belong together share a row
enum LineField {
  ORIGIN_X, ORIGIN_Y, ORIGIN_Z,  // on the surface (m)
  AHEAD_X, AHEAD_Y, AHEAD_Z,     // unit vectors: along the ski when it was laid,
  NORMAL_X, NORMAL_Y, NORMAL_Z,  // and out of the snow
  HARDNESS, EXCESS, STRENGTH,    // H_V and k_u - H_V (N/m³), S_f (Pa) at the line
  ANCHORED, ANCHOR,              // whether the edge holds (0 or 1), and where across (m)
  ABOVE, EDGE_ABOVE, DEPTH_ABOVE,     // whether the base was just above at the last accepted pose; its edge then
  MARKED, EDGE_MARKED, DEPTH_MARKED,  // whether it was in the snow then; its edge then
  SLIPPED,                            // how far an edge has slipped across here (m)
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
  std::vector<DelayedGround> delayed;  // (capacity,), empty where the snow has none

  Vector3 origin(int slot) const;
  Vector3 lateral(int slot) const;  // unit vector along the line, to the left
  Ground ground(int slot) const;
  void keep(int slot, const Ground& ground);

  // All that is kept of a line, to put it back.
  struct Line {
    int slot;
    double values[LINE_FIELDS];
    Ground ground;
  };
  Line line(int slot) const;
  void put_back(const Line& line);

  // Position along the straight ski under which a line passes (m).
  double station(std::int64_t number, const Pose& pose) const;

  // Lay the lines that the ski will meet.
  void lay_ahead(const Runner& runner, const Pose& pose, const Snow& snow);
  // Drop those that it has left into the archive, or in a trial (`archive` null) for good. `strip`: the track of this
  // runner in the archive.
  void drop_left(const Runner& runner, const Pose& pose, Archive* archive, int strip);

  // Whether they have come to lie unevenly or the ski has turned away from them.
  bool is_uneven(const Pose& pose) const;
  void leave_all(Archive& archive, int strip);

  // Of a ground, for each metre of ski (J/m); empty: that of the core's own law.
  std::function<double(const Ground&)> lost;
  // Energy lost in the grooves under the ski (J), older tracks' share taken off.
  double groove_energy() const;
  double groove_energy(int slot) const;
  std::vector<double> recalled_energy;  // (capacity,) that an older track had taken (J)

 private:
  double spacing_ = LINE_SPACING;
  std::vector<std::uint8_t> filled_;  // knots of each block's tile that are filled

  void fill(int slot, int from, int to);
  void lay(std::int64_t number, const Pose& pose, double station, const Snow& snow);
  void leave(std::int64_t number, Archive* archive, int strip);
};

}  // namespace skisnow
