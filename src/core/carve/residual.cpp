#include "carve/residual.hpp"

#include <limits>

#include "carve/places.hpp"

namespace skisnow {

namespace {

using Long = long double;
using Growing = Slopes<1>;

Growing growing(double value, double growth) {
  Growing out(value);
  out.by[0] = growth;
  return out;
}

double of(const std::vector<double>& column, std::size_t i) { return column.empty() ? 0.0 : column[i]; }

// The equations' numbers, exact for their derivatives or digits.
template <class T>
struct Conditions {
  T edge_angle, hardness, excess, load, moment, side_force, bevel, bevel_width, pitch_of_force, pitch_of_shear;
  bool shears, twists, by_reaction;
  GroundEdge<T> edges;

  Conditions(const CarveConditions& c, const auto& number)
      : edge_angle(number(c.edge_angle, &CarveDirection::edge_angle)),
        hardness(number(c.hardness, &CarveDirection::hardness)),
        excess(number(c.excess, &CarveDirection::excess)),
        load(number(c.load, &CarveDirection::load)),
        moment(number(c.moment, &CarveDirection::moment)),
        side_force(number(c.side_force, &CarveDirection::side_force)),
        bevel(number(c.bevel, &CarveDirection::bevel)),
        bevel_width(c.bevel > 0.0 ? number(c.bevel_width, &CarveDirection::bevel_width) : T(0.0)),
        pitch_of_force(number(c.pitch_of_force, &CarveDirection::pitch_of_force)),
        pitch_of_shear(number(c.pitch_of_shear, &CarveDirection::pitch_of_shear)),
        shears(c.side_force_bending),
        twists(c.twists),
        by_reaction(c.by_reaction),
        edges(bevel, bevel_width, number(c.side, &CarveDirection::side), number(c.radius, &CarveDirection::radius)) {}
};

// A pass from tip to tail. `residual` begins with the beam's elastic forces.
template <class T>
class Residual {
 public:
  Residual(const Conditions<T>& given, std::vector<T> place, std::vector<T> u, const T (&border)[CARVE_BORDER],
           std::vector<T> elastic)
      : residual(std::move(elastic)),
        given_(given),
        boot_(CarveBoot<T>::at(given.edge_angle, border, given.twists)),
        stress_(border[2]),
        place_(std::move(place)),
        groove_(place_.size(), T(FAR_ABOVE)),
        u_(std::move(u)) {
    subtract_loads(given, stress_, this->border);
  }

  std::vector<T> residual, depth, force;
  T border[CARVE_BORDER] = {};

  // `event`: takes how far a station is from touching the snow, or from deepening the groove
  void add(const StationOf<T>& s, const auto& event) {
    const T zero(0.0);
    SnowSection<T> section = boot_.section(s, u_.data() + s.first);
    if (given_.edges.acts()) section.grind(given_.edges);
    find_depths(section, place_, base_);
    Strip<T, WithoutGrowth> sums;
    each_stretch(section, place_, base_, groove_, [&](const SnowStretch<T>& at) {
      sums.add_interval(at.start, at.length, at.depth[0], at.depth[1], at.groove[0], at.groove[1], given_.hardness,
                        given_.excess);
    });
    for (std::size_t k = 0; k < place_.size(); k++) event(base_[k] - groove_[k]);
    deepen(base_, groove_, [](std::size_t) {});
    const T edge = section.depth, other = section.other_depth(), held = edge > zero ? edge : zero;
    event(edge);
    const auto load = section_load<T>(sums.force, sums.moment, given_.by_reaction, held, other > zero ? other : zero,
                                      given_.shears ? stress_ : zero, {boot_.sine, boot_.cosine},
                                      {s.half_width * section.sine, s.half_width * section.cosine});
    add_load(given_, s, load, sums.force, stress_, border, residual.data() + s.first);
    depth.push_back(edge), force.push_back(sums.force);
  }

 private:
  const Conditions<T>& given_;
  const CarveBoot<T> boot_;
  const T stress_;
  std::vector<T> place_, groove_, u_, base_;
};

template <class T>
std::vector<T> elastic_forces(const CarvedSki& ski, const std::vector<T>& u) {
  std::vector<T> out(std::size_t(ski.size), T(0.0));
  find_elastic_forces(ski, u, out.data());
  return out;
}

// Places across with their growth.
std::vector<Growing> growing_places(const CarvedSki& ski, const CarveConditions& at, const CarveDirection& along) {
  const double line = straight_waterline(ski, at), tangent = std::tan(at.edge_angle);
  const double steeper =
      at.edge_angle > SHALLOWEST_WEDGE ? along.edge_angle * (1.0 + tangent * tangent) / tangent : 0.0;
  const double growth =
      0.5 * line *
      (along.load / at.load - along.hardness / at.hardness - along.running_length / ski.running_length - steeper);
  const double cosine = std::cos(at.edge_angle), turn = -std::sin(at.edge_angle) * along.edge_angle;
  const double width = at.bevel > 0.0 ? at.bevel_width : 0.0, round = at.edges().width(1);
  // r cot(γ/2) falls with half of γ, the angle between base and side
  const double sharper = along.side + (width > 0.0 ? along.bevel : 0.0);
  const double round_growth =
      round > 0.0 ? (along.radius * round - 0.5 * sharper * (at.radius * at.radius + round * round)) / at.radius : 0.0;
  const Growing hinges[] = {
      growing(width * cosine, width > 0.0 ? along.bevel_width * cosine + width * turn : 0.0),
      growing(round * cosine, round_growth * cosine + round * turn),
  };
  return places_across(growing(line, growth),
                       growing(ski.greatest_width * cosine, along.greatest_width * cosine + ski.greatest_width * turn),
                       hinges);
}

}  // namespace

void refine_residual(const CarvedSki& ski, const CarveConditions& conditions, const std::vector<double>& place,
                     const CarveState& at, CarveEquations& system) {
  const Conditions<Long> given(conditions, [](double value, auto) { return Long(value); });
  const std::vector<Long> u(at.u.begin(), at.u.end());
  const Long border[] = {at.border[0], at.border[1], at.border[2]};
  Residual<Long> sum(given, {place.begin(), place.end()}, u, border, elastic_forces(ski, u));
  for (const CarveStation& s : ski.stations) {
    StationOf<Long> station{s.place, s.weight, s.half_width, s.base_height, {}, {s.twist[0], s.twist[1]}, s.first};
    std::copy_n(s.deflection, 4, station.deflection);
    sum.add(station, [](Long) {});
  }
  for (std::size_t j = 0; j < sum.residual.size(); j++) system.residual[j] = double(sum.residual[j]);
  for (int a = 0; a < CARVE_BORDER; a++) system.border_residual[a] = double(sum.border[a]);
  for (std::size_t i = 0; i < sum.depth.size(); i++)
    system.depth[i] = double(sum.depth[i]), system.force[i] = double(sum.force[i]);
}

CarveGrowth growth_along(const CarvedSki& ski, const CarveConditions& conditions, const std::vector<double>& own_place,
                         const CarveState& at, const CarveDirection& along) {
  const Conditions<Growing> given(
      conditions, [&](double value, double CarveDirection::* growth) { return growing(value, along.*growth); });
  std::vector<Growing> place(own_place.begin(), own_place.end()), u;
  if (own_place.empty()) place = growing_places(ski, conditions, along);
  for (std::size_t j = 0; j < at.u.size(); j++)
    u.push_back(growing(at.u[j], along.state.u.empty() ? 0.0 : along.state.u[j]));
  Growing border[CARVE_BORDER];
  for (std::size_t a = 0; a < CARVE_BORDER; a++) border[a] = growing(at.border[a], along.state.border[a]);
  std::vector<Growing> elastic = elastic_forces(ski, u);
  for (std::size_t j = 0; j < elastic.size() && !along.bent.empty(); j++) elastic[j].by[0] += along.bent[j];
  Residual<Growing> sum(given, std::move(place), std::move(u), border, std::move(elastic));
  CarveGrowth out;
  out.kink = std::numeric_limits<double>::infinity();
  const auto event = [&](const Growing& phi) {
    if (phi.value < -0.5 * FAR_ABOVE && phi.by[0] != 0.0)
      out.kink = std::min(out.kink, std::fabs(phi.value / phi.by[0]));
  };
  for (std::size_t i = 0; i < ski.stations.size(); i++) {
    const CarveStation& s = ski.stations[i];
    StationOf<Growing> station{growing(s.place, of(along.place, i)),
                               growing(s.weight, of(along.weight, i)),
                               growing(s.half_width, 0.5 * of(along.width, i)),
                               growing(s.base_height, of(along.base_height, i)),
                               {},
                               {s.twist[0], s.twist[1]},
                               s.first};
    for (int a = 0; a < 4; a++)  // the shapes of slopes are as long as the element
      station.deflection[a] = growing(s.deflection[a], a % 2 == 1 ? s.deflection[a] * of(along.stretch, i) : 0.0);
    sum.add(station, event);
  }
  out.residual.assign(std::size_t(ski.size + BAND_HALF), 0.0);
  for (std::size_t j = 0; j < sum.residual.size(); j++) out.residual[j] = sum.residual[j].by[0];
  for (int a = 0; a < CARVE_BORDER; a++) out.border[a] = sum.border[a].by[0];
  for (std::size_t i = 0; i < sum.depth.size(); i++) {
    out.depth.push_back(sum.depth[i].by[0]);
    out.force.push_back(sum.force[i].by[0]);
  }
  return out;
}

}  // namespace skisnow
