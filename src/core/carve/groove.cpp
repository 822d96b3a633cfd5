#include "carve/groove.hpp"

namespace skisnow {

namespace {

// Growth of the pressure on an interval of a ground edge with the edge angle, beyond that of a straight base. `growth`:
// moments of ∂p/∂ε over the interval; the bend of the base's own growth is straight between its ends.
void add_ground_growth(const CarveSection& section, double start, double length, const double (&growth)[3],
                       StripSums& sums) {
  const double square = 1.0 + section.tangent * section.tangent, end = start + length;
  const double at_start = section.base_by_angle(start) + start * square;
  const double at_end = section.base_by_angle(end) + end * square;
  for (int n = 0; n < 2; n++) {
    const double far = (growth[n + 1] - start * growth[n]) / length;
    sums.by_angle[n] += at_start * (growth[n] - far) + at_end * far;
  }
}

}  // namespace

void CarveLinks::clear() {
  for (int each : station) number_[std::size_t(each)] = -1;
  station.clear();
  pulls.clear();
}

void CarveLinks::pull(int source, double by_angle, double force, double moment) {
  int& number = number_[std::size_t(source)];
  if (number < 0) {
    number = int(station.size());
    station.push_back(source);
    pulls.emplace_back();
  }
  CarvePull& to = pulls[std::size_t(number)];
  to.force_by_depth += force;
  to.moment_by_depth += moment;
  to.force_by_twist += by_angle * force;
  to.moment_by_twist += by_angle * moment;
}

void GrooveAlongEdge::clear() {
  depth_.assign(place.size(), FAR_ABOVE);
  by_angle_.assign(place.size(), 0.0);
  source_.assign(place.size(), 0);
}

void GrooveAlongEdge::across(const CarveSection& section, int, CarvePressure& pressure, StripSums& sums,
                             CarveLinks& links) {
  find_depths(section, place, base_);
  each_stretch(section, place, base_, depth_, [&](const SnowStretch<double>& at) {
    std::fill_n(sums.by_groove, 3, 0.0);
    double growth[3];
    std::copy_n(sums.by_depth, 3, growth);
    pressure.add({at.start, at.length, at.depth[0], at.depth[1], at.groove[0], at.groove[1], section.sine}, sums);
    for (int n = 0; n < 3; n++) growth[n] = sums.by_depth[n] - growth[n];
    if (section.edge != nullptr) add_ground_growth(section, at.start, at.length, growth, sums);
    if (at.cut && at.depth[1] > 0.0) {  // the base ends in the snow, at W cos α
      const double end = 2.0 * section.half * section.sine * pressure.at(at.depth[1], at.groove[1]);
      sums.by_angle[0] -= end;
      sums.by_angle[1] -= end * section.reach;
    }
    const double* by = sums.by_groove;
    if (by[0] == 0.0) return;
    // the groove is a straight line between two places: each has its share
    const double far = (by[1] - at.start * by[0]) / at.spacing, far_moment = (by[2] - at.start * by[1]) / at.spacing;
    links.pull(source_[at.place], by_angle_[at.place], by[0] - far, by[1] - far_moment);
    links.pull(source_[at.place + 1], by_angle_[at.place + 1], far, far_moment);
  });
}

void GrooveAlongEdge::pass(const CarveSection& section, int station) {
  deepen(base_, depth_, [&](std::size_t k) {
    by_angle_[k] = section.base_by_angle(place[k]);
    source_[k] = station;
  });
}

void GrooveAlongPath::across(const CarveSection& section, int station, CarvePressure& pressure, StripSums& sums,
                             CarveLinks& links) const {
  const double aside = offset[std::size_t(station)], level = section.corner - aside * tangent;
  double hinge[EdgeShape::HINGES] = {};
  for (int h = 0; section.edge != nullptr && h < EdgeShape::HINGES; h++)
    hinge[h] = section.edge->width(h) * section.cosine;
  double low = 0.0;
  for (std::size_t k = 0; k <= steps_.size(); k++) {
    double high = section.reach;
    if (k < steps_.size()) high = std::min(high, std::max(low, steps_[k].left + aside));
    const double deeper = k > 0 ? steps_[k - 1].depth - level : FAR_ABOVE;
    std::fill_n(sums.by_groove, 3, 0.0);
    const auto add = [&](double start, double end) {
      if (!(end > start)) return;
      const double depth0 = section.base_depth(start), depth1 = section.base_depth(end);
      pressure.add({start, end - start, depth0, depth1, depth0 + deeper, depth1 + deeper, section.sine}, sums);
    };
    double from = low;
    for (int h = EdgeShape::HINGES - 1; h >= 0; h--)
      add(from, std::min(high, hinge[h])), from = std::max(from, hinge[h]);
    add(from, high);
    if (sums.by_groove[0] != 0.0) links.pull(steps_[k - 1].source, 0.0, sums.by_groove[0], sums.by_groove[1]);
    low = std::max(low, high);
  }
}

// Put this station's base into the outline: it covers the steps to its right that are less deep.
void GrooveAlongPath::pass(const CarveSection& section, int station) {
  const double left = -offset[std::size_t(station)], level = section.corner + left * tangent;
  bool covered = false;
  const auto covers = [&](const Step& step) {
    const bool deeper = step.depth > level;
    covered = covered || (deeper && step.left <= left);
    return !deeper && step.left >= left;
  };
  std::erase_if(steps_, covers);
  if (covered) return;
  const auto behind = [](double value, const Step& step) { return value < step.left; };
  steps_.insert(std::upper_bound(steps_.begin(), steps_.end(), left, behind), {left, level, station});
}

}  // namespace skisnow
