// The delayed depth of the snow under one line: of its Kelvin element, at places a fixed spacing apart across the line,
// straight between them and zero beyond.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace skisnow {

struct DelayedGround {
  double spacing = 1e-3;  // between the places (m)
  long first = 0;         // number of the first: it lies first · spacing to the left of the line's origin
  std::vector<double> depth{}, stress{};  // ε₂ (m), and the stress p_e (Pa) at the end of the last step

  bool empty() const { return depth.empty(); }
  long end() const { return first + long(depth.size()); }
  double depth_at(double place) const { return between(depth, place / spacing); }
  double stress_at(double place) const { return between(stress, place / spacing); }

  // Let it hold all places from a number up to one.
  void cover(long from, long to) {
    if (to <= from) return;
    if (empty()) first = from;
    const long low = std::min(first, from), high = std::max(end(), to);
    for (std::vector<double>* each : {&depth, &stress}) {
      each->insert(each->begin(), std::size_t(first - low), 0.0);
      each->resize(std::size_t(high - low), 0.0);
    }
    first = low;
  }

  // Take over what another one has at its places, where that is more.
  void take_over(const DelayedGround& other) {
    cover(other.first, other.end());
    for (long n = other.first; n < other.end(); n++) {
      double& here = depth[std::size_t(n - first)];
      here = std::max(here, other.depth[std::size_t(n - other.first)]);
    }
  }

  // Drop places at both ends that have sprung back.
  void trim() {
    const auto none = [&](std::size_t j) { return depth[j] < NONE && stress[j] == 0.0; };
    std::size_t gone = 0, left = depth.size();
    while (gone < left && none(gone)) gone++;
    while (left > gone && none(left - 1)) left--;
    for (std::vector<double>* each : {&depth, &stress}) {
      each->resize(left);
      each->erase(each->begin(), each->begin() + std::ptrdiff_t(gone));
    }
    first += long(gone);
  }

 private:
  static constexpr double NONE = 1e-10;  // (m)

  double of(const std::vector<double>& values, long number) const {
    return number < first || number >= end() ? 0.0 : values[std::size_t(number - first)];
  }
  double between(const std::vector<double>& values, double number) const {
    const double low = std::floor(number), share = number - low;
    return (1.0 - share) * of(values, long(low)) + share * of(values, long(low) + 1);
  }
};

}  // namespace skisnow
