// The end of a step that is taken: what it presses is counted, and lines follow the ski.
#include <algorithm>
#include <cmath>
#include <utility>

#include "contact/contact.hpp"

namespace skisnow {

namespace {

// Of pairs with rising first numbers; beyond the ends the last one.
double interpolated(const std::vector<std::pair<double, double>>& table, double at) {
  const auto after = std::lower_bound(table.begin(), table.end(), std::pair(at, -1e300));
  if (after == table.begin()) return after->second;
  const auto before = after - 1;
  if (after == table.end() || !(after->first > before->first)) return before->second;
  return before->second + (at - before->first) / (after->first - before->first) * (after->second - before->second);
}

constexpr double MOST_UNEVEN = 0.25;  // share of the spacing, between neighbours

// Whether lines have come to lie unevenly under the straight axis of a ski.
bool is_uneven(const Base& s, const GrooveLines& lines) {
  const auto station = [&](std::int64_t n) {
    const int i = s.index(n);
    return s[FROM_BOOT_0][i] - s[FROM_BOOT_1][i] * s[LINE_LEFT_0][i] / s[LINE_LEFT_1][i];
  };
  double before = station(lines.first), worst = 0.0;
  for (std::int64_t n = lines.first + 1; n < lines.end; n++) {
    const double here = station(n);
    worst = std::max(worst, std::fabs(here - before - lines.spacing()));
    before = here;
  }
  return worst > MOST_UNEVEN * lines.spacing();
}

}  // namespace

// The end of a step, for which the sections stand, enters the history; lines that the ski has left are dropped.
void SnowContact::settle_history(int k, const Situation& at) {
  GrooveLines& lines = state_.lines[std::size_t(k)];
  const Pose& pose = at.poses[std::size_t(k)];
  if (is_clear(k, at)) return leave_lines(k);
  if (snow_->rate.is_delayed()) state_.delayed_energy += advance_delayed(*snow_, sections(k), dt_, lines);
  remember(k, lines, strength_varies());
  if (strength_varies()) hold_strength(k, lines);
  count_energy(k, lines);
  if (lines.count() > 0 && (is_uneven(sections(k).base, lines) || lines.is_left(pose, *snow_))) lay_anew(k, pose);
  follow_snow(k, lines);
  lines.drop_left(runner(k), pose, &snow_->archive, state_.strips[std::size_t(k)]);
}

// Strength, depths and displacements of the edges that hold, against which the next step's are set: see [ease].
void SnowContact::hold_strength(int k, GrooveLines& lines) const {
  const Sections& s = sections(k);
  for (std::int64_t n = lines.first; n < lines.end; n++) {
    const int i = s.index(n), slot = lines.slot(n);
    lines.values[STRENGTH_HELD][slot] = s.touches(i) ? s[EDGE_STRENGTH][i] : 0.0;
    for (int k = 0; k < 2; k++) {
      const auto of_line = [&](LineField left) -> double& { return lines.values[of_edge(left, k)][slot]; };
      of_line(LEFT_DEPTH_HELD) = s[of_edge(LEFT_DEPTH, k)][i];
      of_line(LEFT_SHEAR_HELD) = of_line(LEFT_ANCHOR) - of_line(LEFT_MARK);
    }
  }
}

// A line that tip or tail passes counts for the whole spacing: what the ski presses there first is pressed for good.
void SnowContact::count_energy(int k, GrooveLines& lines) {
  const Sections& s = sections(k);
  const double half = 0.5 * lines.spacing(), tail = runner(k).tail + half, tip = runner(k).tip - half;
  if (!lines.lost) kernels_->square_depths(lines, scratch_.data());
  for (std::int64_t n = lines.first; n < lines.end; n++) {
    const int i = s.index(n), slot = lines.slot(n);
    if (!s.touches(i)) continue;
    const bool is_whole = s[STATION][i] > tail && s[STATION][i] < tip;
    const double length = is_whole ? s[SHARE][i] : lines.spacing();
    if (lines.lost)
      lines.count_energy(slot, length);
    else
      lines.count_energy(slot, length, scratch_[std::size_t(slot)]);
  }
}

// Where hardness, strength or friction vary in place, each line has those of where its edge is now.
void SnowContact::follow_snow(int k, GrooveLines& lines) const {
  if (snow_->hardness.is_constant() && snow_->strength.is_constant() && snow_->friction_share.is_constant()) return;
  const Sections& s = sections(k);
  for (std::int64_t n = lines.first; n < lines.end; n++) {
    const int i = s.index(n), slot = lines.slot(n);
    if (!s.touches(i)) continue;
    const double before = lines.values[STRENGTH][slot];
    lines.follow_snow(slot, s[GRIP_PLACE][i], *snow_);
    // an edge that slips meets the full strength of its new place
    if (std::max(std::fabs(s[LEFT_USED][i]), std::fabs(s[RIGHT_USED][i])) > 1.0)
      lines.values[STRENGTH_HELD][slot] *= lines.values[STRENGTH][slot] / before;
  }
}

// Leave all lines to the archive; those laid next belong to another strip.
void SnowContact::leave_lines(int k) {
  GrooveLines& lines = state_.lines[std::size_t(k)];
  if (lines.count() == 0) return;
  lines.leave_all(snow_->archive, state_.strips[std::size_t(k)]);
  state_.strips[std::size_t(k)] = snow_->archive.new_strip();
}

// Leave all lines to the archive and lay others, on which the edges are displaced and have slipped as they had at the
// same station.
void SnowContact::lay_anew(int k, const Pose& pose) {
  GrooveLines& lines = state_.lines[std::size_t(k)];
  Sections& s = sections_[std::size_t(k)];
  std::vector<std::pair<double, double>> displaced[2], slipped;  // by station, rising
  const auto anchor = [&](int slot, int side) -> double& { return lines.values[of_edge(LEFT_ANCHOR, side)][slot]; };
  const auto place = [&](int slot, int side) { return lines.values[of_edge(LEFT_MARK, side)][slot]; };
  const auto is_in_snow = [&](int i, int side) { return s.touches(i) && s[of_edge(LEFT_DEPTH, side)][i] > 0.0; };
  for (std::int64_t n = lines.first; n < lines.end; n++) {
    const int i = s.index(n), slot = lines.slot(n);
    if (s.touches(i)) slipped.emplace_back(s[STATION][i], lines.values[SLIPPED][slot]);
    for (int side = 0; side < 2; side++)
      if (is_in_snow(i, side)) displaced[side].emplace_back(s[STATION][i], anchor(slot, side) - place(slot, side));
  }
  for (auto* each : {&slipped, &displaced[0], &displaced[1]}) std::sort(each->begin(), each->end());
  leave_lines(k);
  prepare(k, lines, pose);
  kernels_->find_sections(runner(k), pose, lines, nullptr, s.base);
  remember(k, lines, false);
  for (std::int64_t n = lines.first; n < lines.end; n++) {
    const int i = s.index(n), slot = lines.slot(n);
    if (s.touches(i) && !slipped.empty()) lines.values[SLIPPED][slot] = interpolated(slipped, s[STATION][i]);
    for (int side = 0; side < 2; side++)
      if (is_in_snow(i, side) && !displaced[side].empty())
        anchor(slot, side) = place(slot, side) + interpolated(displaced[side], s[STATION][i]);
  }
}

}  // namespace skisnow
