#include "carve/point.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "carve/places.hpp"
#include "carve/residual.hpp"

namespace skisnow {

namespace {

constexpr int MOST_PLACES = 11;
constexpr int MOST_CORRECTIONS = 6;
constexpr double ALMOST = 1e-10, ROUNDING = 1e-15;  // (m) last corrections
constexpr double FAR_ABOVE = -1e3;                  // depth (m) that marks untouched snow

// Directions in which the forces on a section are differentiated; GROOVE and above: depth of the groove at each place.
enum Along { CORNER, ANGLE, HALF, HARDNESS, EXCESS, BEVEL, BEVEL_WIDTH, LINE, REACH, BEVEL_END, ROUND_END, GROOVE };
constexpr int DIRECTIONS = GROOVE + MOST_PLACES;
using Number = Slopes<DIRECTIONS>;

// Factors by which a section's force, moment and depths count in a sum.
struct Shares {
  double force, moment, edge, other;
};

struct Felt {  // a section in the snow, or that deepens the groove
  bool touches = false;
  bool deepens[MOST_PLACES] = {};
  double sine, cosine, deflection, corner, angle;
  Number force, moment, edge, other;

  double sum(const Shares& share, int along) const {
    return share.force * force.by[along] + share.moment * moment.by[along] + share.edge * edge.by[along] +
           share.other * other.by[along];
  }
};

}  // namespace

// [passed] A pass from tip to tail, the same for all outputs.
struct CarvePoint::Passed {
  const CarvedSki& ski;
  const CarveConditions given;
  double bevel_width, round_width, sine, cosine;
  std::vector<Number> place;
  std::vector<Felt> felt;

  Passed(const CarvedSki& of, const CarveConditions& conditions, const std::vector<double>& own_place,
         const CarveState& at)
      : ski(of),
        given(conditions),
        bevel_width(conditions.bevel > 0.0 ? conditions.bevel_width : 0.0),
        round_width(conditions.edges().width(1)),
        sine(std::sin(conditions.edge_angle)),
        cosine(std::cos(conditions.edge_angle)) {
    if (own_place.empty())
      place = places_across(Number::along(straight_waterline(ski, given), LINE),
                            Number::along(ski.greatest_width * cosine, REACH),
                            {bevel_width > 0.0 ? Number::along(bevel_width * cosine, BEVEL_END) : Number(0.0),
                             round_width > 0.0 ? Number::along(round_width * cosine, ROUND_END) : Number(0.0)});
    else
      place.assign(own_place.begin(), own_place.end());
    if (place.size() > MOST_PLACES) throw std::invalid_argument("too many places for derivatives");
    std::vector<Number> groove;
    for (std::size_t k = 0; k < place.size(); k++) groove.push_back(Number::along(FAR_ABOVE, GROOVE + int(k)));
    felt.resize(ski.stations.size());
    for (std::size_t i = 0; i < felt.size(); i++) feel(ski.stations[i], at, groove, felt[i]);
  }

  SectionIn<Number> section(const CarveStation& s, const Felt& f) const {
    const Number angle = Number::along(f.angle, ANGLE), bevel = Number::along(given.bevel, BEVEL);
    SectionIn<Number> out(Number::along(f.corner, CORNER), angle, Number::along(s.half_width, HALF), bevel,
                          bevel_width > 0.0 ? Number::along(bevel_width, BEVEL_WIDTH) : Number(0.0));
    round_off(out, angle, bevel);
    return out;
  }

  template <class T>
  void round_off(SectionIn<T>& section, const T& angle, const T& bevel) const {
    if (round_width > 0.0) section.round_off(angle - bevel, T(0.5) * (T(given.side) + bevel), given.radius);
  }

  void feel(const CarveStation& s, const CarveState& at, std::vector<Number>& groove, Felt& f) {
    const double* u = at.u.data() + s.first;
    f.deflection = 0.0, f.angle = given.edge_angle;
    for (int a = 0; a < 4; a++) f.deflection += s.deflection[a] * u[BENDS[a]];
    for (int a = 0; a < 2 && given.twists; a++) f.angle += s.twist[a] * u[TURNS[a]];
    f.sine = std::sin(f.angle), f.cosine = std::cos(f.angle);
    f.corner = at.border[0] + at.border[1] * s.place - cosine * (s.base_height + f.deflection) + s.half_width * f.sine;
    SectionIn<double> flat(f.corner, f.angle, s.half_width, given.bevel, bevel_width);
    round_off(flat, f.angle, given.bevel);
    std::vector<double> depth;
    for (const Number& each : place) depth.push_back(flat.base_depth(each.value));
    const bool deep = *std::max_element(depth.begin(), depth.end()) > 0.0 || flat.other_depth() > 0.0;
    f.touches = deep || flat.edge_depth() > 0.0;
    if (f.touches) {
      const auto in_snow = section(s, f);
      add_strips(in_snow, groove, f);
      f.edge = in_snow.edge_depth(), f.other = in_snow.other_depth();
    }
    for (std::size_t k = 0; k < place.size(); k++) {
      f.deepens[k] = depth[k] >= groove[k].value;
      if (f.deepens[k]) groove[k].value = depth[k];
    }
  }

  // As `strip_across`: each piece is differentiated by its own eight numbers, then these by the section's.
  void add_strips(const SectionIn<Number>& section, const std::vector<Number>& groove, Felt& f) const {
    using Local = Slopes<8>;
    const Number reach = section.reach();
    for (std::size_t k = 0; k + 1 < place.size() && place[k] < reach; k++) {
      const bool cut = !(place[k + 1] < reach);
      const Number &start = place[k], &end = cut ? reach : place[k + 1], length = end - start;
      const Number depth[2] = {section.base_depth(start), section.base_depth(end)};
      if (!(depth[0].value > 0.0) && !(depth[1].value > 0.0)) continue;
      const Number far =
          cut ? groove[k] + length / (place[k + 1] - start) * (groove[k + 1] - groove[k]) : groove[k + 1];
      const Number* own[] = {&start, &length, &depth[0], &depth[1], &groove[k], &far};
      Local local[8];
      for (int m = 0; m < 6; m++) local[m] = Local::along(own[m]->value, m);
      local[6] = Local::along(given.hardness, 6), local[7] = Local::along(given.excess, 7);
      StripIn<Local> sums;
      sums.add(local[0], local[1], {local[2], local[3]}, {local[4] - local[2], local[5] - local[3]}, local[6],
               local[7]);
      const auto chain = [&](const Local& sum, Number& out) {
        out.value += sum.value;
        for (int m = 0; m < 6; m++)
          for (int n = 0; n < DIRECTIONS; n++) out.by[n] += sum.by[m] * own[m]->by[n];
        out.by[HARDNESS] += sum.by[6], out.by[EXCESS] += sum.by[7];
      };
      chain(sums.force, f.force);
      chain(sums.moment, f.moment);
    }
  }

  // Gradient of λ·R + seed; `by_state`: the same by the unknowns.
  CarveGradient backward(const CarveState& at, CarveState adjoint, const CarveSeed& seed, CarveState& by_state) const;

 private:
  void through_places(CarveGradient& out, const double (&by)[GROOVE]) const;
};

// [backward] From tail to tip. `back`: how the sum grows with the groove's depth at each place, behind the station.
CarveGradient CarvePoint::Passed::backward(const CarveState& at, CarveState adjoint, const CarveSeed& seed,
                                           CarveState& by_state) const {
  const std::size_t n = felt.size(), places = place.size();
  CarveGradient out;
  for (auto* each : {&out.place, &out.weight, &out.width, &out.base_height, &out.deflection, &out.normal})
    each->assign(n, 0.0);
  by_state.u.assign(at.u.size(), 0.0), by_state.border = {};
  const double *mu = adjoint.border.data(), stress = at.border[2], shears = given.side_force_bending ? 1.0 : 0.0;
  const double by_force = given.pitch_of_force, by_shear = given.pitch_of_shear;
  const bool reacts = given.by_reaction;
  double back[MOST_PLACES] = {}, by_places[GROOVE] = {};
  for (std::size_t i = n; i-- > 0;) {
    const CarveStation& s = ski.stations[i];
    const Felt& f = felt[i];
    double by[GROOVE] = {};  // growth of the sum with the section's own numbers
    for (std::size_t k = 0; k < places; k++) {
      if (!f.deepens[k]) continue;
      if (back[k] != 0.0) {
        const Number depth = section(s, f).base_depth(place[k]);
        for (int along = 0; along < GROOVE; along++) by[along] += back[k] * depth.by[along];
      }
      back[k] = 0.0;
    }
    if (f.touches) {
      const double* l = adjoint.u.data() + s.first;
      double bends = 0.0, turns = 0.0;
      for (int a = 0; a < 4; a++) bends += s.deflection[a] * l[BENDS[a]];
      for (int a = 0; a < 2 && given.twists; a++) turns += s.twist[a] * l[TURNS[a]];
      const double w = s.weight, half = s.half_width, force = f.force.value;
      const double bite = reacts ? force : std::max(f.edge.value, 0.0);
      const double turned = reacts ? bite : bite - 2.0 * std::max(f.other.value, 0.0);
      const double normal = cosine * force + shears * sine * stress * bite;
      const double moment = f.moment.value - half * f.cosine * force - shears * half * f.sine * stress * turned;
      const double pitch = by_force * force + by_shear * stress * bite;
      const double held = reacts ? 0.0 : stress * bite;  // by reaction the load alone draws the side force
      const double by_bite = w * stress * (mu[1] * s.place * by_shear - bends * shears * sine + (reacts ? 0.0 : mu[2]));
      const double by_turned = w * stress * turns * shears * half * f.sine;
      const double by_load = w * (mu[0] + mu[1] * s.place * by_force - bends * cosine + turns * half * f.cosine);
      const Shares share{by_load + seed.force[i] + (reacts ? by_bite + by_turned : 0.0), -w * turns,
                         seed.depth[i] + (!reacts && f.edge.value > 0.0 ? by_bite + by_turned : 0.0),
                         !reacts && f.other.value > 0.0 ? -2.0 * by_turned : 0.0};
      for (int along = 0; along < GROOVE; along++) by[along] += f.sum(share, along);
      for (std::size_t k = 0; k < places; k++) back[k] += f.sum(share, GROOVE + int(k));
      by[ANGLE] -= w * turns * half * (f.sine * force - shears * f.cosine * stress * turned);
      by[HALF] += w * turns * (f.cosine * force + shears * f.sine * stress * turned);
      out.weight[i] = mu[0] * force + mu[1] * s.place * pitch + mu[2] * held - bends * normal - turns * moment;
      out.place[i] = w * mu[1] * pitch;
      out.normal[i] = w * normal;
      out.edge_angle += w * bends * (sine * force - shears * cosine * stress * bite);
      out.pitch_of_force += w * mu[1] * s.place * force;
      out.pitch_of_shear += w * mu[1] * s.place * stress * bite;
      by_state.border[2] += w * ((mu[1] * s.place * by_shear - bends * shears * sine) * bite +
                                 turns * shears * half * f.sine * turned + (reacts ? 0.0 : mu[2] * bite));
    } else if (seed.depth[i] != 0.0) {  // a prescribed depth above the snow
      const Number edge = section(s, f).edge_depth();
      for (int along = 0; along < GROOVE; along++) by[along] += seed.depth[i] * edge.by[along];
    }
    const double corner = by[CORNER], angle = by[ANGLE] + corner * s.half_width * f.cosine;
    out.width[i] = 0.5 * (by[HALF] + corner * f.sine);
    out.base_height[i] = -cosine * corner;
    out.deflection[i] = -cosine * corner;
    out.place[i] += corner * at.border[1];
    out.edge_angle += angle + corner * sine * (s.base_height + f.deflection);
    out.hardness += by[HARDNESS], out.excess += by[EXCESS];
    out.bevel += by[BEVEL], out.bevel_width += by[BEVEL_WIDTH];
    for (int along = LINE; along < GROOVE; along++) by_places[along] += by[along];
    by_state.border[0] += corner, by_state.border[1] += corner * s.place;
    for (int a = 0; a < 4; a++) by_state.u[std::size_t(s.first + BENDS[a])] -= cosine * s.deflection[a] * corner;
    for (int a = 0; a < 2 && given.twists; a++) by_state.u[std::size_t(s.first + TURNS[a])] += s.twist[a] * angle;
  }
  out.load -= mu[0], out.moment -= mu[1], out.side_force -= mu[2];
  if (reacts) out.load += mu[2] * stress, by_state.border[2] += mu[2] * given.load;
  through_places(out, by_places);
  out.adjoint = std::move(adjoint);
  return out;
}

// The places across depend on the question: the chain rule through `straight_waterline` and the widths.
void CarvePoint::Passed::through_places(CarveGradient& out, const double (&by)[GROOVE]) const {
  const double line = straight_waterline(ski, given), tangent = std::tan(given.edge_angle), by_line = by[LINE];
  out.load += 0.5 * by_line * line / given.load;
  out.hardness -= 0.5 * by_line * line / given.hardness;
  out.running_length -= 0.5 * by_line * line / ski.running_length;
  if (given.edge_angle > SHALLOWEST_WEDGE) out.edge_angle -= 0.5 * by_line * line * (1.0 + tangent * tangent) / tangent;
  out.greatest_width += by[REACH] * cosine;
  out.bevel_width += by[BEVEL_END] * cosine;
  if (round_width > 0.0) {  // r cot(γ/2) falls with half the bevel
    const double cotangent = round_width / given.radius;
    out.bevel -= by[ROUND_END] * cosine * 0.5 * given.radius * (1.0 + cotangent * cotangent);
  }
  out.edge_angle -= (by[REACH] * ski.greatest_width + by[BEVEL_END] * bevel_width + by[ROUND_END] * round_width) * sine;
}

CarvePoint::CarvePoint(const CarvedSki& ski, const CarveConditions& conditions, std::vector<double> place,
                       CarveState near)
    : ski_(ski), conditions_(conditions), place_(std::move(place)), state_(std::move(near)), at_(ski) {
  refine();
}

CarvePoint::~CarvePoint() = default;

void CarvePoint::factor() {
  CarveGroove groove(ski_.stations.size());
  groove.edge.place = place_.empty() ? places_across(ski_, conditions_) : place_;
  assemble(ski_, conditions_, groove, state_, at_);
  factors_.factor(ski_, at_);
}

// [refine] Newton's corrections for the residual in more digits, as long as they fall.
void CarvePoint::refine() {
  CarveState step = state_;
  double before = std::numeric_limits<double>::infinity();
  const std::vector<double> place = place_.empty() ? places_across(ski_, conditions_) : place_;
  for (int k = 0; k < MOST_CORRECTIONS; k++) {
    if (before > ALMOST) factor();  // the matrix hardly changes any more
    refine_residual(ski_, conditions_, place, state_, at_);
    if (!factors_.correct(ski_, at_, step)) break;
    last_correction_ = depth_change(ski_, conditions_, step);
    if (!(last_correction_ < 0.5 * before)) break;
    before = last_correction_;
    for (std::size_t j = 0; j < state_.u.size(); j++) state_.u[j] += step.u[j];
    for (std::size_t a = 0; a < CARVE_BORDER; a++) state_.border[a] += step.border[a];
    if (last_correction_ < ROUNDING) break;
  }
  factor();
}

CarveGradient CarvePoint::gradient(const CarveSeed& seed) {
  if (!passed_) passed_ = std::make_unique<Passed>(ski_, conditions_, place_, state_);
  CarveState adjoint{Column(state_.u.size(), 0.0), {}}, right;
  passed_->backward(state_, adjoint, seed, right);
  for (std::size_t j = 0; j < adjoint.u.size(); j++) adjoint.u[j] = -right.u[j] - seed.u[j];
  for (std::size_t a = 0; a < CARVE_BORDER; a++) adjoint.border[a] = -right.border[a];
  factors_.solve_transposed(ski_, adjoint);
  return passed_->backward(state_, std::move(adjoint), seed, right);
}

CarveGrowth CarvePoint::growth(CarveDirection& along) {
  CarveGrowth explicit_part = growth_along(ski_, conditions_, place_, state_, along);
  at_.residual = std::move(explicit_part.residual);
  std::copy_n(explicit_part.border, CARVE_BORDER, at_.border_residual);
  along.state = state_;
  if (!factors_.correct(ski_, at_, along.state)) throw std::invalid_argument("the equations are singular");
  return growth_along(ski_, conditions_, place_, state_, along);
}

}  // namespace skisnow
