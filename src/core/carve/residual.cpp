#include "carve/residual.hpp"

namespace skisnow {

namespace {

using Long = long double;

constexpr Long FAR_ABOVE = -1e3L;  // depth (m) that marks untouched snow

class Refined {
 public:
  Refined(const CarvedSki& ski, const CarveConditions& given, const std::vector<double>& place, const CarveState& at)
      : ski_(ski),
        given_(given),
        at_(at),
        place_(place.begin(), place.end()),
        groove_(place.size(), FAR_ABOVE),
        residual_(std::size_t(ski.size), 0.0L),
        border_{-Long(given.load), -Long(given.moment), -Long(given.side_force)} {
    for (int i = 0; i < ski.size; i++)
      for (int k = std::max(0, BAND_HALF - i); k < CARVE_BAND; k++)
        residual_[std::size_t(i)] +=
            Long(ski.stiffness[std::size_t(CARVE_BAND * i + k)]) * at.u[std::size_t(i + k - BAND_HALF)];
    if (given.by_reaction) border_[2] += Long(at.border[2]) * given.load;
    for (const CarveStation& station : ski.stations) add(station);
  }

  void write(CarveEquations& system) const {
    for (std::size_t j = 0; j < residual_.size(); j++) system.residual[j] = double(residual_[j]);
    for (int a = 0; a < CARVE_BORDER; a++) system.border_residual[a] = double(border_[a]);
  }

 private:
  const CarvedSki& ski_;
  const CarveConditions& given_;
  const CarveState& at_;
  std::vector<Long> place_, groove_, residual_;
  Long border_[CARVE_BORDER];

  void add(const CarveStation& s) {
    const double* u = at_.u.data() + s.first;
    Long deflection = 0.0L, twist = 0.0L;
    for (int a = 0; a < 4; a++) deflection += Long(s.deflection[a]) * u[BENDS[a]];
    for (int a = 0; a < 2 && given_.twists; a++) twist += Long(s.twist[a]) * u[TURNS[a]];
    const Long angle = given_.edge_angle + twist, half = s.half_width, place = s.place;
    const Long sine = std::sin(Long(given_.edge_angle)), cosine = std::cos(Long(given_.edge_angle));
    const Long corner =
        at_.border[0] + at_.border[1] * place - cosine * (s.base_height + deflection) + half * std::sin(angle);
    SectionIn<Long> section(corner, angle, half, given_.bevel, given_.bevel > 0.0 ? given_.bevel_width : 0.0);
    if (given_.radius > 0.0) {
      const Long bevel = given_.bevel_width > 0.0 ? given_.bevel : 0.0;
      section.round_off(angle - bevel, 0.5L * (given_.side + bevel), given_.radius);
    }
    const auto sums = strip_across<Long>(section, place_, groove_, given_.hardness, given_.excess);
    for (std::size_t k = 0; k < place_.size(); k++) groove_[k] = std::max(groove_[k], section.base_depth(place_[k]));
    const bool reacts = given_.by_reaction;
    const Long stress = at_.border[2], shears = given_.side_force_bending ? 1.0L : 0.0L;
    const Long bite = reacts ? sums.force : std::max(section.edge_depth(), 0.0L);
    const Long turned = reacts ? bite : bite - 2.0L * std::max(section.other_depth(), 0.0L);
    const Long normal = cosine * sums.force + shears * sine * stress * bite;
    const Long moment =
        sums.moment - half * section.cosine * sums.force - shears * half * section.sine * stress * turned;
    const Long weight = s.weight;
    border_[0] += weight * sums.force;
    border_[1] += weight * (given_.pitch_of_force * sums.force + given_.pitch_of_shear * stress * bite) * place;
    if (!reacts) border_[2] += weight * stress * bite;
    for (int a = 0; a < 4; a++) residual_[std::size_t(s.first + BENDS[a])] -= weight * s.deflection[a] * normal;
    for (int a = 0; a < 2 && given_.twists; a++)
      residual_[std::size_t(s.first + TURNS[a])] -= weight * s.twist[a] * moment;
  }
};

}  // namespace

void refine_residual(const CarvedSki& ski, const CarveConditions& conditions, const std::vector<double>& place,
                     const CarveState& at, CarveEquations& system) {
  Refined(ski, conditions, place, at).write(system);
}

}  // namespace skisnow
