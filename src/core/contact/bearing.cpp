#include "contact/bearing.hpp"

#include <algorithm>
#include <cmath>

#define SKISNOW_LANES alone
#include "contact/force_kernels.hpp"
#include "support/quadrature.hpp"

namespace skisnow {

namespace {

constexpr int POINTS = 3;
using Quadrature = Gauss<POINTS>;

double point_of(double from, double to, int which) {
  return 0.5 * (from + to) + 0.5 * (to - from) * Quadrature::POINT[which];
}

}  // namespace

// A part on which the base and the ground are straight, divided where one of them meets the other or a bend of the law.
void Bearing::add_straight(const BearingPart& part) {
  cuts_.assign({part.from, part.to});
  add_zero(part.deepest - part.depth, part.deepening - part.fall, part.from + THIN, part.to - THIN, cuts_);
  for (const double bend : law_.bends) {
    add_zero(part.depth - bend, part.fall, part.from + THIN, part.to - THIN, cuts_);
    add_zero(part.deepest - bend, part.deepening, part.from + THIN, part.to - THIN, cuts_);
  }
  std::sort(cuts_.begin(), cuts_.end());
  for (std::size_t i = 0; i + 1 < cuts_.size(); i++) {
    BearingPart each = part;
    each.from = cuts_[i], each.to = cuts_[i + 1];
    const double middle = 0.5 * (each.from + each.to);
    each.lifted = part.deepest - part.depth + (part.deepening - part.fall) * middle > 0.0;
    if (!each.lifted) each.deepest = each.depth, each.deepening = each.fall;
    if (each.to - each.from > THIN) parts_.push_back(each);
  }
}

// [add_base] The wet base of one section over its ground, which an edge may have cut within the step.
template <class Cut>
void Bearing::add_base(const GrooveLines& lines, int slot, const Cut& base) {
  const int owner = int(sums_.size());
  sums_.push_back({std::asin(std::min(std::fabs(base.sine), 1.0)), 0.0, 0.0, 0.0});
  const double from = base.wet_from, to = std::max(base.wet_to, base.wet_from);
  Ground ground = lines.ground(slot);
  for (int k = 0; k < 2; k++) {
    const alone::CutGround<double> cut(lines, slot, base, k, from, to);
    if (cut.is_there()) ground.press(base.place + cut.from, cut.at(cut.from), base.place + cut.to, cut.at(cut.to));
  }
  const alone::BasePieces<double> pieces(base);
  double reached = from;
  const auto add = [&](double a, double b, double deepest, double deepening) {
    const double low = std::max(a, reached), high = std::min(b, to);
    if (!(high > low)) return;
    for (int k = 0; k < pieces.COUNT; k++) {
      const double first = std::max(low, pieces.place[k]), last = std::min(high, pieces.place[k + 1]);
      if (last > first)
        add_straight({owner, first, last, pieces.at_grip[k], pieces.fall[k], deepest, deepening, false});
    }
    reached = high;
  };
  const auto add_virgin = [&](double until) { add(reached, until, -1.0, 0.0); };  // never pressed
  for (int j = 0; j + 1 < ground.count; j++) {
    const double a = ground.place[j] - base.place, b = ground.place[j + 1] - base.place;
    if (j == 0) add_virgin(a);
    if (!(b - a > THIN)) continue;
    const double deepening = (ground.depth[j + 1] - ground.depth[j]) / (b - a);
    add(a, b, ground.depth[j] - deepening * a, deepening);
  }
  add_virgin(to);
}

// [bears] Of the parts that were pressed deeper before, what lies above the residual depth is dropped.
void Bearing::keep_what_bears() {
  deepest_.clear();
  for (const BearingPart& part : parts_)
    if (part.lifted)
      for (const double x : {part.from, part.to}) deepest_.push_back(part.deepest + part.deepening * x);
  if (deepest_.empty()) return;
  const Values residual = law_.residual(deepest_);
  std::size_t next = 0;
  for (BearingPart& part : parts_) {
    if (!part.lifted) continue;
    const double over_from = part.depth + part.fall * part.from - residual[next];
    const double over_to = part.depth + part.fall * part.to - residual[next + 1];
    next += 2;
    const double zero = part.from + (part.to - part.from) * over_from / (over_from - over_to);
    if (over_from <= 0.0) part.from = over_to <= 0.0 ? part.to : zero;
    if (over_from > 0.0 && over_to < 0.0) part.to = zero;
  }
}

// [gauss] Sums over three points of each part.
void Bearing::add_up() {
  keep_what_bears();
  depth_.clear(), deepest_.clear(), angle_.clear();
  for (const BearingPart& part : parts_)
    for (int k = 0; k < POINTS; k++) {
      const double x = point_of(part.from, part.to, k);
      depth_.push_back(part.depth + part.fall * x);
      deepest_.push_back(part.deepest + part.deepening * x);
      angle_.push_back(sums_[std::size_t(part.owner)].edge_angle);
    }
  if (depth_.empty()) return;
  const Values answer = law_.bear(depth_, deepest_, angle_);
  const double *pressure = answer.data(), *energy = pressure + depth_.size();
  for (const BearingPart& part : parts_) {
    Sums& sums = sums_[std::size_t(part.owner)];
    for (int k = 0; k < POINTS; k++, pressure++, energy++) {
      const double weight = 0.5 * (part.to - part.from) * Quadrature::WEIGHT[k];
      sums.force += weight * *pressure;
      sums.moment += weight * *pressure * point_of(part.from, part.to, k);
      sums.energy += weight * *energy;
    }
  }
}

void Bearing::press(const GrooveLines& lines, Sections& s) {
  parts_.clear(), sums_.clear();
  for (int i = 0; i < s.count(); i++)
    if (s.touches(i)) add_base(lines, lines.slot(s.line(i)), alone::Cut<double>::stored(s.base, i));
  add_up();
  auto sums = sums_.begin();
  for (int i = 0; i < s.count(); i++) {
    if (!s.touches(i)) continue;
    s.pressure[FORCE][i] = s[SHARE][i] * sums->force;
    s.pressure[MOMENT][i] = s[SHARE][i] * sums->moment;
    s.pressure[SNOW_ENERGY][i] = s[SHARE][i] * sums->energy;
    if (law_.along_base_normal)
      s.edge[EDGE_STRENGTH][i] = s[FORCE][i] * std::fabs(s[DEPTH_FALL][i]) / (s[DEEPEST][i] * s[SHARE][i]);
    ++sums;
  }
}

void Bearing::differ(const Snow& snow, const GrooveLines& lines, const Sections& s, double step, double sense,
                     SectionDifferences& out) {
  using alone::Cut, alone::Acting, alone::Pushed;
  constexpr int CHANGES = SectionDifferences::CHANGES;
  const auto way = [&](int change) { return change == SectionDifferences::OFF ? step : sense * step; };
  parts_.clear(), sums_.clear();
  std::vector<Cut<double>> moved;
  for (int i = 0; i < s.count(); i++)
    for (int change = 0; change < CHANGES && s.touches(i); change++) {
      moved.push_back(alone::displaced(Cut<double>(s.base, i), change, way(change)));
      moved.back().cut();
      add_base(lines, lines.slot(s.line(i)), moved.back());
    }
  add_up();
  std::fill(out.values.begin(), out.values.end(), 0.0);
  std::size_t next = 0;
  for (int i = 0; i < s.count(); i++)
    for (int change = 0; change < CHANGES && s.touches(i); change++, next++) {
      const double share = s[SHARE][i];
      Acting<double> by{share,
                        share * sums_[next].force,
                        share * sums_[next].moment,
                        s[MU][i] * s[RUB][i],
                        s[MU][i] * s[RUB_ASIDE][i],
                        s[EDGE_STRENGTH][i],
                        s[EDGE_THRUST][i],
                        {}};
      by.find_used(snow, lines, lines.slot(s.line(i)), moved[next]);
      const Pushed<double> pushed(moved[next], by, snow);
      for (int k = 0; k < Pushed<double>::PARTS; k++)
        out.column(change, k)[i] = (s[ForceField(FORCE_0 + k)][i] - pushed.parts[k]) / way(change);
    }
}

double Bearing::lost(const Ground& ground) const {
  Values places, weights, deepest;
  for (int j = 0; j + 1 < ground.count; j++) {
    const double a = ground.place[j], b = ground.place[j + 1];
    if (!(b - a > THIN)) continue;
    const double deepening = (ground.depth[j + 1] - ground.depth[j]) / (b - a),
                 at_zero = ground.depth[j] - deepening * a;
    places.assign({a, b});
    for (const double bend : law_.bends) add_zero(at_zero - bend, deepening, a + THIN, b - THIN, places);
    std::sort(places.begin(), places.end());
    for (std::size_t i = 0; i + 1 < places.size(); i++)
      for (int k = 0; k < POINTS; k++) {
        deepest.push_back(at_zero + deepening * point_of(places[i], places[i + 1], k));
        weights.push_back(0.5 * (places[i + 1] - places[i]) * Quadrature::WEIGHT[k]);
      }
  }
  if (deepest.empty()) return 0.0;
  const Values energy = law_.lost(deepest);
  double total = 0.0;
  for (std::size_t i = 0; i < weights.size(); i++) total += weights[i] * energy[i];
  return total;
}

}  // namespace skisnow
