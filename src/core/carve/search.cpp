// Equilibrium of a clamped ski in snow: a first guess, elastic snow, then the snow's memory by continuation.
#include <algorithm>
#include <cmath>
#include <utility>

#include "carve/equations.hpp"
#include "carve/places.hpp"
#include "linear_algebra/banded.hpp"

namespace skisnow {

namespace {

constexpr double SMALLEST_STRIDE = 1e-3;  // share of a path of conditions: a shorter stage is not tried
constexpr double ROUGHNESS = 0.05;        // of the greatest depth: correction at which a stage on the way ends
constexpr double SOFTENINGS[] = {1000.0, 30.0, 3.0};
// A ski bent so that its edge is straight in the snow, as deep as a rigid one of that contact length would be.
CarveState first_guess(const CarvedSki& ski, const CarveConditions& given) {
  const double angle = given.edge_angle, length = CONTACT_SHARE * ski.running_length;
  const double aside = ski.waist / 2.0 * std::sin(angle);
  const double wedge = straight_waterline(ski, given) * std::tan(std::max(angle, SHALLOWEST_WEDGE));
  const double flat = given.load / (given.hardness * length * ski.waist * std::cos(angle)) + aside;
  const double depth = std::min(wedge, flat);
  const double drawn = given.by_reaction ? given.load : depth * length;
  CarveState out{Column(ski.bent_by_width.size(), 0.0), {depth - aside, 0.0, given.side_force / drawn}};
  for (std::size_t j = 0; j < out.u.size(); j++)
    out.u[j] = std::tan(angle) * ski.bent_by_width[j] - ski.bent_by_height[j];
  return out;
}

class Search {
 public:
  Search(const CarvedSki& ski, const CarveConditions& conditions, std::vector<double> offset,
         std::function<void()> asked)
      : newton(ski, std::move(asked)), ski_(ski), conditions_(conditions), groove_(ski.stations.size()) {
    groove_.along_path = !offset.empty();
    groove_.path.offset = std::move(offset);
    groove_.edge.place = places_across(ski, conditions);
    newton.state = first_guess(ski, conditions);
  }

  CarveNewton newton;

  // From another solution; back at the first guess if that fails.
  bool continues(const CarveState& near) {
    newton.state = near;
    const bool found = reaches(conditions_);
    if (!found) newton.state = first_guess(ski_, conditions_);
    return found;
  }

  // Elastic snow, then memory; a law from outside as if all places were virgin, then with their memory.
  bool loaded(const CarveConditions& to) { return has_law(to) ? presses(to) : remembers(to); }

  // The same on softer snow, which is then hardened; the law from outside comes last.
  bool hardened(double softening) {
    const auto softer = [&](double share) {
      const double factor = std::pow(softening, share - 1.0);
      CarveConditions out = conditions_;
      out.law_share = 0.0;
      out.hardness *= factor;
      out.excess *= factor;
      return out;
    };
    newton.state = first_guess(ski_, softer(0.0));
    return remembers(softer(0.0)) && follows(softer) && takes_law(conditions_);
  }

 private:
  const CarvedSki& ski_;
  CarveConditions conditions_;
  CarveGroove groove_;

  // Elastic snow, then memory: the logarithm of the unloading ratio grows from 0.
  bool remembers(const CarveConditions& conditions) {
    CarveConditions elastic = conditions;
    elastic.excess = 0.0;
    if (!reaches(elastic, conditions.excess > 0.0)) return false;
    if (conditions.excess == 0.0) return true;
    const double goal = std::log1p(conditions.excess / conditions.hardness);
    return follows([&](double share) {
      CarveConditions out = conditions;
      out.excess = conditions.hardness * std::expm1(share * goal);
      return out;
    });
  }

  static bool has_law(const CarveConditions& under) { return under.laws != nullptr && under.laws->pressure; }

  // A law from outside: its share of the pressure grows on elastic snow, then its share of the groove.
  bool presses(const CarveConditions& conditions) {
    CarveConditions elastic = conditions, virgin = conditions;
    elastic.excess = elastic.law_share = 0.0;
    virgin.excess = virgin.law_memory = 0.0;
    if (!reaches(elastic)) return false;
    return takes_law(virgin) && takes_memory(conditions);
  }

  // The law from outside sees a growing share of the groove, as fast as the logarithm of the unloading ratio.
  bool takes_memory(const CarveConditions& conditions) {
    const double ratio = conditions.excess / conditions.hardness, goal = std::log1p(ratio);
    return follows([&](double share) {
      CarveConditions out = conditions;
      if (share < 1.0 && ratio > 0.0) out.law_memory = std::expm1(share * goal) / ratio;
      return out;
    });
  }

  // From the core's law to one from outside, where there is one: its share of the pressure grows from 0.
  bool takes_law(const CarveConditions& conditions) {
    return !has_law(conditions) || follows([&](double share) {
      CarveConditions out = conditions;
      out.law_share = share;
      return out;
    });
  }

  // To the equilibrium under these conditions; stays where it was if that fails.
  bool reaches(const CarveConditions& conditions, bool passing = false) {
    const CarveState before = newton.state;
    newton.roughness = passing ? ROUGHNESS : 0.0;
    const bool found = newton.solve(conditions, groove_);
    if (!found) newton.state = before;
    return found;
  }

  // Along a path of conditions from 0 (where it stands) to 1, in one step or as many as it needs.
  template <class Path>
  bool follows(const Path& path) {
    double reached = 0.0, stride = 1.0;
    while (stride > SMALLEST_STRIDE) {
      const double target = std::min(reached + stride, 1.0);
      if (reaches(path(target), target < 1.0)) {
        if (target == 1.0) return true;
        reached = target;
        stride *= 2.0;
      } else {
        stride /= 3.0;
      }
    }
    return false;
  }
};

}  // namespace

Column CarvedSki::spread(const double* free) const {
  Column all(std::size_t(size + BAND_HALF), 0.0);
  std::copy_n(free, front, all.data());
  std::copy_n(free + front, size - HELD - front, all.data() + front + HELD);
  return all;
}

std::vector<double> CarvedSki::gathered(const Column& all) const {
  std::vector<double> free(all.begin(), all.begin() + front);
  free.insert(free.end(), all.begin() + front + HELD, all.begin() + size);
  return free;
}

CarveSolution find_carve(const CarvedSki& ski, const CarveConditions& conditions, std::vector<double> offset,
                         const CarveState* near, std::function<void()> asked) {
  Search search(ski, conditions, std::move(offset), std::move(asked));
  bool found = near != nullptr && search.continues(*near);
  found = found || search.loaded(conditions);
  for (double softening : SOFTENINGS) found = found || search.hardened(softening);
  CarveNewton& newton = search.newton;
  return {found, newton.iterations, std::move(newton.state), std::move(newton.at.depth), std::move(newton.at.force)};
}

}  // namespace skisnow
