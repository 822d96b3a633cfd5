#include "carve/law.hpp"

#include <algorithm>
#include <cmath>

#include "support/quadrature.hpp"

namespace skisnow {

namespace {

constexpr int POINTS = 5;
using Quadrature = Gauss<POINTS>;
constexpr double STEP = 1e-8;        // (m) of differences of the law
constexpr double ANGLE_STEP = 1e-6;  // (rad)
constexpr int MOST_GUESSES = 30;
constexpr double DRY = 1e-9;     // depth at one end of a part, over that at the other, that is the surface
constexpr double CLOSE = 1e-15;  // (m) to the depth at which a place bears nothing

}  // namespace

double CarvePressure::Part::point(int which) const {
  const double share = 0.5 * (1.0 + Quadrature::POINT[which]), length = to - from;
  return dry > 0 ? to - length * share * share : from + length * (dry < 0 ? share * share : share);
}

double CarvePressure::Part::weight(int which) const {
  return 0.5 * (to - from) * Quadrature::WEIGHT[which] * (dry != 0 ? 1.0 + Quadrature::POINT[which] : 1.0);
}

void CarvePressure::begin(const CarveLaws* laws, double share, double memory, double hardness, double excess) {
  laws_ = laws, memory_ = memory;
  share_ = laws != nullptr && laws->pressure ? share : 0.0;
  hardness_ = (1.0 - share_) * hardness, excess_ = (1.0 - share_) * excess;
  gathering_ = share_ > 0.0;
  parts_.clear(), ends_.clear();
  interval_ = part_ = 0;
}

void CarvePressure::add_by_law(const CarveInterval& at, StripSums& sums) {
  if (gathering_) {
    divide(at);
    ends_.push_back(parts_.size());
    return;
  }
  const std::size_t end = ends_[interval_++];
  for (; part_ < end; part_++) add_part(parts_[part_], POINTS * part_, sums);
  if (share_ < 1.0)
    sums.add_interval(at.start, at.length, at.depth0, at.depth1, at.groove0, at.groove1, hardness_, excess_);
}

// [divide] Of the wet part: where base and groove cross, or either passes a bend of the law.
void CarvePressure::divide(const CarveInterval& at) {
  const double fall = (at.depth1 - at.depth0) / at.length, deepening = (at.groove1 - at.groove0) / at.length;
  cuts_.assign({0.0, at.length});
  add_zero(at.depth0, fall, 0.0, at.length, cuts_);
  add_zero(at.groove0 - at.depth0, deepening - fall, 0.0, at.length, cuts_);
  for (const double bend : laws_->bends) {
    add_zero(at.depth0 - bend, fall, 0.0, at.length, cuts_);
    add_zero(at.groove0 - bend, deepening, 0.0, at.length, cuts_);
  }
  std::sort(cuts_.begin(), cuts_.end());
  const double angle = std::asin(std::min(std::fabs(at.sine), 1.0));
  for (std::size_t i = 0; i + 1 < cuts_.size(); i++) {
    const double from = cuts_[i], to = cuts_[i + 1], middle = 0.5 * (from + to);
    const double depth = at.depth0 + fall * middle, groove = at.groove0 + deepening * middle;
    const double first = at.depth0 + fall * from, last = at.depth0 + fall * to;
    const int dry = first < DRY * last ? -1 : last < DRY * first ? 1 : 0;
    if (to > from && depth > 0.0)
      parts_.push_back({from, to, at.start, at.depth0, fall, at.groove0, deepening, angle, groove > depth, dry});
  }
}

double CarvePressure::Bracket::guess() const { return low + (high - low) * below / (below - above); }

// Regula falsi, with Illinois's halving of the value at an end that stays. Whether the place was the zero.
bool CarvePressure::Bracket::take(double x, double value) {
  if (std::fabs(value) <= CLOSE) return true;
  const int under = value < 0.0 ? 1 : 0;
  if (under == last_under) (under == 1 ? above : below) *= 0.5;
  last_under = under;
  (under == 1 ? low : high) = x;
  (under == 1 ? below : above) = value;
  return false;
}

// How far above the residual depth the base is, at places of parts.
CarveLaws::Values CarvePressure::over_residual(const std::vector<Place>& places) const {
  CarveLaws::Values deepest;
  for (const auto& [part, x] : places) {
    const Part& at = parts_[part];
    deepest.push_back(told(at.depth + at.fall * x, at.groove + at.deepening * x));
  }
  CarveLaws::Values out = laws_->residual(deepest);
  for (std::size_t i = 0; i < places.size(); i++) {
    const Part& part = parts_[places[i].part];
    out[i] = part.depth + part.fall * places[i].x - out[i];
  }
  return out;
}

// [residual] Of the parts that were pressed deeper before, what lies above the residual depth is dropped.
void CarvePressure::keep_what_bears() {
  std::vector<Place> ends;
  for (std::size_t k = 0; k < parts_.size(); k++)
    if (parts_[k].lifted) ends.insert(ends.end(), {{k, parts_[k].from}, {k, parts_[k].to}});
  if (ends.empty()) return;
  const auto over = over_residual(ends);
  std::vector<Bracket> open;
  for (std::size_t i = 0; i < ends.size(); i += 2) {
    Part& part = parts_[ends[i].part];
    const double a = over[i], b = over[i + 1];
    if (a <= 0.0 && b <= 0.0) part.to = part.from;
    if (a < 0.0 && b > 0.0) open.push_back({ends[i].part, true, part.from, part.to, a, b});
    if (a > 0.0 && b < 0.0) open.push_back({ends[i].part, false, part.to, part.from, b, a});
  }
  for (int round = 0; round < MOST_GUESSES && !open.empty(); round++) narrow(open);
}

// Ends of parts move to where the base comes to the residual depth; what has come there leaves the list.
void CarvePressure::narrow(std::vector<Bracket>& open) {
  std::vector<Place> places;
  for (const Bracket& each : open) places.push_back({each.part, each.guess()});
  const auto over = over_residual(places);
  std::size_t left = 0;
  for (std::size_t i = 0; i < open.size(); i++) {
    Part& part = parts_[open[i].part];
    (open[i].rises ? part.from : part.to) = places[i].x;
    if (!open[i].take(places[i].x, over[i])) open[left++] = open[i];
  }
  open.erase(open.begin() + std::ptrdiff_t(left), open.end());
}

// A point of a part at x, with depth, groove or angle changed a little.
void CarvePressure::push(const Part& part, double x, Change change) {
  double depth = part.depth + part.fall * x, groove = part.groove + part.deepening * x;
  if (change == DEEPER) depth += STEP;
  if (change == LESS_DEEP) depth = std::max(depth - STEP, 0.0);
  if (change == DEEPER_GROOVE) groove += STEP;
  if (change == LESS_DEEP_GROOVE) groove -= STEP;
  depth_.push_back(depth);
  deepest_.push_back(part.lifted ? told(depth, std::max(groove, depth)) : depth);
  angle_.push_back(part.angle + (change == STEEPER ? ANGLE_STEP : 0.0));
}

void CarvePressure::ask() {
  gathering_ = false;
  keep_what_bears();
  depth_.clear(), deepest_.clear(), angle_.clear();
  for (int change = NONE; change < CHANGES; change++)
    for (const Part& part : parts_)
      for (int k = 0; k < POINTS; k++) push(part, part.point(k), Change(change));
  found_ = depth_.empty() ? depth_ : laws_->pressure(depth_, deepest_, angle_);
}

// [points] Sums over the points of a part; growth by differences of the law.
void CarvePressure::add_part(const Part& part, std::size_t first, StripSums& sums) const {
  const std::size_t all = POINTS * parts_.size();
  for (int k = 0; k < POINTS; k++) {
    const std::size_t i = first + std::size_t(k);
    const auto growth = [&](const CarveLaws::Values& by, Change up, Change down) {
      const double way = by[up * all + i] - by[down * all + i];
      return way > 0.0 ? (found_[up * all + i] - found_[down * all + i]) / way : 0.0;
    };
    const double x = part.start + part.point(k);
    const double weight = share_ * part.weight(k);
    const double by_depth = weight * growth(depth_, DEEPER, LESS_DEEP);
    const double by_groove = part.lifted ? memory_ * weight * growth(deepest_, DEEPER_GROOVE, LESS_DEEP_GROOVE) : 0.0;
    const double by_angle = weight * growth(angle_, STEEPER, NONE);
    const double power[3] = {1.0, x, x * x};
    sums.force += weight * found_[i];
    sums.moment += weight * found_[i] * x;
    for (int n = 0; n < 3; n++) {
      sums.by_depth[n] += by_depth * power[n];
      sums.by_groove[n] += by_groove * power[n];
    }
    for (int n = 0; n < 2; n++) sums.by_angle[n] += by_angle * power[n];
  }
}

}  // namespace skisnow
