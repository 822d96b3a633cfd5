#include "carve/point.hpp"

#include <algorithm>
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
constexpr double LEAST_EXCESS = 1e-12;              // k_u - H_V over H_V that elastic snow is differentiated at

// Numbers of a section that the sum is differentiated by.
enum Along { CORNER, ANGLE, HALF, HARDNESS, EXCESS, BEVEL, BEVEL_WIDTH, SIDE, RADIUS, NUMBERS };
// And those that the places across depend on.
enum OfPlaces { LINE, REACH, BEVEL_END, ROUND_END, OF_PLACES };
using Place = Slopes<OF_PLACES>;

// Growth of a force and of its moment with one number of a piece.
struct Pair {
  double force, moment;

  double sum(const Pair& share) const { return share.force * force + share.moment * moment; }
};

// Growth of a piece's force with its own numbers; the depths of base and groove at both ends, the groove less the drop
// to the next place.
struct Piece {
  std::size_t place;
  bool cut;  // ends with the base
  double start, end, drop;
  Pair depth[2], groove[2], from, length, hardness, excess;
};

struct Felt {  // a section in the snow, or that deepens the groove
  bool touches = false;
  bool deepens[MOST_PLACES] = {};
  double other;
  double by_bevel[EdgeShape::HINGES] = {}, by_side = 0.0;  // growth of the rises with the bevel, of the second with γ
  CarveSection section;
  double force = 0.0, moment = 0.0;
  std::size_t begin = 0, end = 0;  // its pieces
};

// Growth of an integral over [start, start + length] with a line's values at both ends, by its moments.
void add_ends(const double (&by)[3], double start, double length, Pair (&ends)[2]) {
  const double far = (by[1] - start * by[0]) / length, far_moment = (by[2] - start * by[1]) / length;
  ends[0] = {by[0] - far, by[1] - far_moment};
  ends[1] = {far, far_moment};
}

}  // namespace

// A pass from tip to tail, the same for all outputs.
struct CarvePoint::Passed {
  const CarvedSki& ski;
  const CarveConditions given;
  const EdgeShape edges;
  const bool ground;
  double bevel_width, round_width, sine, cosine;
  const CarveBoot<double> boot;
  std::vector<Place> origin;                // where each place is on the ski
  std::vector<double> place, groove, base;  // each with the depths of groove and base there
  std::vector<Felt> felt;
  std::vector<Piece> pieces;

  Passed(const CarvedSki& of, const CarveConditions& conditions, const std::vector<double>& own_place,
         const CarveState& at)
      : ski(of),
        given(conditions),
        edges(conditions.edges()),
        ground(edges.acts()),
        bevel_width(conditions.bevel > 0.0 ? conditions.bevel_width : 0.0),
        round_width(edges.width(1)),
        sine(std::sin(conditions.edge_angle)),
        cosine(std::cos(conditions.edge_angle)),
        boot(CarveBoot<double>::at(conditions.edge_angle, at.border, conditions.twists)) {
    if (own_place.empty())
      origin = places_across(Place::along(straight_waterline(ski, given), LINE),
                             Place::along(ski.greatest_width * cosine, REACH),
                             {bevel_width > 0.0 ? Place::along(bevel_width * cosine, BEVEL_END) : Place(0.0),
                              round_width > 0.0 ? Place::along(round_width * cosine, ROUND_END) : Place(0.0)});
    else
      origin.assign(own_place.begin(), own_place.end());
    if (origin.size() > MOST_PLACES) throw std::invalid_argument("too many places for derivatives");
    for (const Place& each : origin) place.push_back(each.value);
    groove.assign(place.size(), FAR_ABOVE);
    felt.resize(ski.stations.size());
    pieces.reserve(4 * felt.size());
    for (std::size_t i = 0; i < felt.size(); i++) feel(ski.stations[i], at, felt[i]);
  }

  void feel(const CarveStation& s, const CarveState& at, Felt& f) {
    CarveSection& section = f.section;
    section = {boot.section(s, at.u.data() + s.first)};
    if (ground) section.grind(edges), grow_with_edge(f);
    f.other = section.other_depth();
    find_depths(section, place, base);
    f.touches =
        section.depth > 0.0 || f.other > 0.0 || std::any_of(base.begin(), base.end(), [](double d) { return d > 0.0; });
    f.begin = pieces.size();
    if (f.touches)
      each_stretch(section, place, base, groove, [&](const SnowStretch<double>& stretch) { add_piece(stretch, f); });
    f.end = pieces.size();
    deepen(base, groove, [&](std::size_t k) { f.deepens[k] = true; });
  }

  // Growth of the rises with the bevel: the angle of strip and snow falls by it, that of the corner, γ, rises by half.
  void grow_with_edge(Felt& f) const {
    const double tangent = given.radius > 0.0 ? given.radius / round_width : 0.0;
    const double on_strip = f.section.angle - edges.bevel(), sine = std::sin(on_strip), cosine = std::cos(on_strip);
    if (f.section.rise[1] > 0.0) f.by_side = -0.5 * (1.0 - cosine) * (1.0 + tangent * tangent);
    if (!(bevel_width > 0.0)) return;
    f.by_bevel[0] = cosine;
    if (f.section.rise[1] > 0.0) f.by_bevel[1] = sine * tangent - cosine + f.by_side;
  }

  // [piece] Force and moment are linear in H and E, and the force in the length.
  void add_piece(const SnowStretch<double>& at, Felt& f) {
    Piece piece{
        .place = at.place, .cut = at.cut, .start = at.start, .end = at.cut ? f.section.reach : place[at.place + 1]};
    piece.drop = groove[at.place + 1] - groove[at.place];
    const double length = at.length, lift[2] = {at.groove[0] - at.depth[0], at.groove[1] - at.depth[1]};
    const double excess = std::max(given.excess, LEAST_EXCESS * given.hardness);
    StripSums sums;
    sums.add_interval(at.start, length, at.depth[0], at.depth[1], at.groove[0], at.groove[1], given.hardness, excess);
    f.force += sums.force, f.moment += sums.moment;
    add_ends(sums.by_depth, piece.start, length, piece.depth);
    add_ends(sums.by_groove, piece.start, length, piece.groove);
    piece.from = {0.0, sums.force};
    piece.length = {sums.force / length, (2.0 * sums.moment - piece.start * sums.force) / length};
    const double slope = (lift[1] - lift[0]) / length, level = lift[0] - slope * piece.start;
    const auto lifted = [&](int n) { return (level * sums.by_groove[n] + slope * sums.by_groove[n + 1]) / excess; };
    piece.excess = {lifted(0), lifted(1)};
    piece.hardness = {(sums.force - excess * piece.excess.force) / given.hardness,
                      (sums.moment - excess * piece.excess.moment) / given.hardness};
    pieces.push_back(piece);
  }

  // Add the growth of `weight` times the depth of the base at ξ; returns that with ξ.
  double add_depth(const Felt& f, double weight, double xi, double (&by)[NUMBERS]) const {
    const CarveSection& section = f.section;
    by[CORNER] += weight;
    by[ANGLE] += weight * section.base_by_angle(xi);
    double by_place = -section.tangent;
    if (!ground) return weight * by_place;
    for (int h = 0; h < EdgeShape::HINGES; h++) {
      const double left = edges.width(h) - xi / section.cosine;
      if (!(left > 0.0)) continue;
      by_place += section.rise[h] / section.cosine;
      by[BEVEL] -= weight * left * f.by_bevel[h];
      if (h == 0) by[BEVEL_WIDTH] -= weight * section.rise[0];
      if (h == 0) continue;
      // the rounding's width, r cot(γ/2), falls with half of γ
      const double narrower =
          0.5 * weight * section.rise[1] * (given.radius + round_width * round_width / given.radius);
      if (bevel_width > 0.0) by[BEVEL] += narrower;
      by[SIDE] += narrower - weight * left * f.by_side;
      by[RADIUS] -= weight * section.rise[1] * round_width / given.radius;
    }
    return weight * by_place;
  }

  // Growth of a piece's share of the sum, with the section, the groove at each place, and the places.
  void add_growth(const Felt& f, const Piece& piece, const Pair& share, double (&by)[NUMBERS],
                  double (&back)[MOST_PLACES], double (&by_place)[MOST_PLACES]) const {
    const std::size_t k = piece.place;
    const double groove = piece.groove[1].sum(share);
    double by_length = piece.length.sum(share), share_of_next = 1.0;
    if (piece.cut) {
      const double spacing = place[k + 1] - piece.start;
      share_of_next = (piece.end - piece.start) / spacing;
      by_length += groove * piece.drop / spacing;
      by_place[k + 1] -= groove * piece.drop * share_of_next / spacing;
      by_place[k] += groove * piece.drop * share_of_next / spacing;
    }
    back[k] += piece.groove[0].sum(share) + groove * (1.0 - share_of_next);
    back[k + 1] += groove * share_of_next;
    by[HARDNESS] += piece.hardness.sum(share), by[EXCESS] += piece.excess.sum(share);
    by_place[k] += piece.from.sum(share) - by_length + add_depth(f, piece.depth[0].sum(share), piece.start, by);
    const double by_end = by_length + add_depth(f, piece.depth[1].sum(share), piece.end, by);
    if (piece.cut) {
      by[HALF] += 2.0 * by_end * f.section.cosine;
      by[ANGLE] -= 2.0 * by_end * f.section.half * f.section.sine;
    } else {
      by_place[k + 1] += by_end;
    }
  }

  // Gradient of λ·R + seed; `by_state`: the same by the unknowns.
  CarveGradient backward(const CarveState& at, CarveState adjoint, const CarveSeed& seed, CarveState& by_state) const;

 private:
  void through_places(CarveGradient& out, const double (&by)[OF_PLACES]) const;
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
  double back[MOST_PLACES] = {}, by_place[MOST_PLACES] = {};
  for (std::size_t i = n; i-- > 0;) {
    const CarveStation& s = ski.stations[i];
    const Felt& f = felt[i];
    const CarveSection& section = f.section;
    double by[NUMBERS] = {};  // growth of the sum with the section's own numbers
    for (std::size_t k = 0; k < places; k++) {
      if (!f.deepens[k]) continue;
      if (back[k] != 0.0) by_place[k] += add_depth(f, back[k], place[k], by);
      back[k] = 0.0;
    }
    if (f.touches) {
      const double* l = adjoint.u.data() + s.first;
      double bends = 0.0, turns = 0.0;
      for (int a = 0; a < 4; a++) bends += s.deflection[a] * l[BENDS[a]];
      for (int a = 0; a < 2 && given.twists; a++) turns += s.twist[a] * l[TURNS[a]];
      const double w = s.weight, half = s.half_width, force = f.force;
      const double bite = reacts ? force : std::max(section.depth, 0.0);
      const double turned = reacts ? bite : bite - 2.0 * std::max(f.other, 0.0);
      const double normal = cosine * force + shears * sine * stress * bite;
      const double moment = f.moment - half * section.cosine * force - shears * half * section.sine * stress * turned;
      const double pitch = by_force * force + by_shear * stress * bite;
      const double held = reacts ? 0.0 : stress * bite;  // by reaction the load alone draws the side force
      const double by_bite = w * stress * (mu[1] * s.place * by_shear - bends * shears * sine + (reacts ? 0.0 : mu[2]));
      const double by_turned = w * stress * turns * shears * half * section.sine;
      const double by_load = w * (mu[0] + mu[1] * s.place * by_force - bends * cosine + turns * half * section.cosine);
      const Pair share{by_load + seed.force[i] + (reacts ? by_bite + by_turned : 0.0), -w * turns};
      for (std::size_t m = share.force != 0.0 || share.moment != 0.0 ? f.begin : f.end; m < f.end; m++)
        add_growth(f, pieces[m], share, by, back, by_place);
      add_depth(f, seed.depth[i] + (!reacts && section.depth > 0.0 ? by_bite + by_turned : 0.0), 0.0, by);
      if (!reacts && f.other > 0.0) {
        by[CORNER] -= 2.0 * by_turned;
        by[HALF] += 4.0 * by_turned * section.sine;
        by[ANGLE] += 4.0 * by_turned * half * section.cosine;
      }
      by[ANGLE] -= w * turns * half * (section.sine * force - shears * section.cosine * stress * turned);
      by[HALF] += w * turns * (section.cosine * force + shears * section.sine * stress * turned);
      out.weight[i] = mu[0] * force + mu[1] * s.place * pitch + mu[2] * held - bends * normal - turns * moment;
      out.place[i] = w * mu[1] * pitch;
      out.normal[i] = w * normal;
      out.edge_angle += w * bends * (sine * force - shears * cosine * stress * bite);
      out.pitch_of_force += w * mu[1] * s.place * force;
      out.pitch_of_shear += w * mu[1] * s.place * stress * bite;
      by_state.border[2] += w * ((mu[1] * s.place * by_shear - bends * shears * sine) * bite +
                                 turns * shears * half * section.sine * turned + (reacts ? 0.0 : mu[2] * bite));
    } else if (seed.depth[i] != 0.0) {  // a prescribed depth above the snow
      add_depth(f, seed.depth[i], 0.0, by);
    }
    const double corner = by[CORNER], angle = by[ANGLE] + corner * s.half_width * section.cosine;
    out.width[i] = 0.5 * (by[HALF] + corner * section.sine);
    out.base_height[i] = -cosine * corner;
    out.deflection[i] = -cosine * corner;
    out.place[i] += corner * at.border[1];
    out.edge_angle += angle + corner * sine * section.height;
    out.hardness += by[HARDNESS], out.excess += by[EXCESS];
    out.bevel += by[BEVEL], out.bevel_width += by[BEVEL_WIDTH], out.side += by[SIDE], out.radius += by[RADIUS];
    by_state.border[0] += corner, by_state.border[1] += corner * s.place;
    for (int a = 0; a < 4; a++) by_state.u[std::size_t(s.first + BENDS[a])] -= cosine * s.deflection[a] * corner;
    for (int a = 0; a < 2 && given.twists; a++) by_state.u[std::size_t(s.first + TURNS[a])] += s.twist[a] * angle;
  }
  out.load -= mu[0], out.moment -= mu[1], out.side_force -= mu[2];
  if (reacts) out.load += mu[2] * stress, by_state.border[2] += mu[2] * given.load;
  double by_origins[OF_PLACES] = {};
  for (std::size_t k = 0; k < places; k++)
    for (int m = 0; m < OF_PLACES; m++) by_origins[m] += by_place[k] * origin[k].by[m];
  through_places(out, by_origins);
  out.adjoint = std::move(adjoint);
  return out;
}

// The places across depend on the question: the chain rule through `straight_waterline` and the widths.
void CarvePoint::Passed::through_places(CarveGradient& out, const double (&by)[OF_PLACES]) const {
  const double line = straight_waterline(ski, given), tangent = std::tan(given.edge_angle), by_line = by[LINE];
  out.load += 0.5 * by_line * line / given.load;
  out.hardness -= 0.5 * by_line * line / given.hardness;
  out.running_length -= 0.5 * by_line * line / ski.running_length;
  if (given.edge_angle > SHALLOWEST_WEDGE) out.edge_angle -= 0.5 * by_line * line * (1.0 + tangent * tangent) / tangent;
  out.greatest_width += by[REACH] * cosine;
  out.bevel_width += by[BEVEL_END] * cosine;
  if (round_width > 0.0) {  // r cot(γ/2) falls with half of γ
    const double cotangent = round_width / given.radius, end = by[ROUND_END] * cosine;
    const double narrower = 0.5 * end * given.radius * (1.0 + cotangent * cotangent);
    if (bevel_width > 0.0) out.bevel -= narrower;
    out.side -= narrower;
    out.radius += end * cotangent;
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
    state_.add(step, 1.0);
    if (last_correction_ < ROUNDING) break;
  }
  factor();  // a last correction of 1e-12 m can move a station into the groove
}

CarveGradient CarvePoint::gradient(const CarveSeed& seed) {
  if (!passed_) passed_ = std::make_unique<Passed>(ski_, conditions_, place_, state_);
  CarveState adjoint{Column(state_.u.size(), 0.0), {}}, right = adjoint;
  const auto acts = [](const auto& by) { return std::count(by.begin(), by.end(), 0.0) < std::ptrdiff_t(by.size()); };
  if (acts(seed.depth) || acts(seed.force)) passed_->backward(state_, adjoint, seed, right);
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
