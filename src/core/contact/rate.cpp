#include "contact/rate.hpp"

#include <algorithm>
#include <cmath>

#define SKISNOW_LANES alone
#include "contact/force_kernels.hpp"
#include "support/quadrature.hpp"

namespace skisnow {

namespace {

using alone::Acting, alone::Pushed;
using Section = alone::Cut<double>;

constexpr double RATE_STEP = 1e-4;  // of differences by rates (m/s, rad/s)

// A quantity that is straight over x, which counts across along the line from the edge (m).
struct Straight {
  double at_edge, slope;

  double operator()(double x) const { return at_edge + slope * x; }
};

Straight operator+(const Straight& a, const Straight& b) { return {a.at_edge + b.at_edge, a.slope + b.slope}; }
Straight operator*(double a, const Straight& b) { return {a * b.at_edge, a * b.slope}; }

// How the depth grows along the ski.
double growth_ahead(const Section& c) { return (c.climb - dot(c.along, c.left) * c.fall) / dot(c.along, c.ahead); }

// [depth_rate] How fast the base goes into the snow of a line: downwards, and along its edge where it climbs. What goes
// across the edge shears the snow, which resists only with its strength.
Straight depth_rate(const Section& c, const BaseMotion& m) {
  const double g[3] = {c.normal.x + c.climb * c.along.x, c.normal.y + c.climb * c.along.y,
                       c.normal.z + c.climb * c.along.z};
  const double out[3] = {c.left.x - c.fall * c.normal.x, c.left.y - c.fall * c.normal.y,
                         c.left.z - c.fall * c.normal.z};
  const double at[3] = {c.station, c.grip_left, c.grip_up}, *v = m.velocity, *o = m.turning;
  const auto moved = [&](const double* r, const double* with, double x, double y, double z) {
    return with[0] * (x + o[1] * r[2] - o[2] * r[1]) + with[1] * (y + o[2] * r[0] - o[0] * r[2]) +
           with[2] * (z + o[0] * r[1] - o[1] * r[0]);
  };
  const double reach = c.reach * m.twisting, widening = c.widening * m.twisting;
  const double edge[3] = {c.along.x, c.along.y, c.along.z};
  const double y = v[1] - c.sp * reach, z = v[2] + m.deflecting - c.cp * reach;
  const double climbing = c.twist_slope / (1.0 - c.sine * c.sine) * c.size;  // growth of the climb across the base
  return {-moved(at, g, v[0], y, z),
          -moved(out, g, 0.0, -c.sp * widening, -c.cp * widening) - climbing * moved(at, edge, v[0], y, z)};
}

// The snow of one line over a step: what it answers to a depth less the delayed one that is known before the step ends.
struct PointLaw {
  double hardness, unloading, damping;  // H_V, k_u (N/m³), c (N s/m³)
  // stress (Pa) above which all of c acts: the change of stress by one line more or less. Lines that a ski reaches one
  // after the other come in as its base between them would.
  double full;
  KelvinStep step;

  PointLaw(const Snow& snow, const GrooveLines& lines, int slot, const Section& c, double dt)
      : hardness(lines.values[HARDNESS][slot]),
        unloading(hardness + lines.values[EXCESS][slot]),
        damping(snow.rate.damping),
        full(hardness * lines.spacing() * std::fabs(growth_ahead(c))) {
    if (snow.rate.is_delayed()) step = KelvinStep(snow.rate, hardness, dt);
  }

  template <class Depth>
  Depth virgin(const Depth& depth) const {
    return hardness / (1.0 + hardness * step.now) * depth;
  }
  template <class Depth>
  Depth pressed(const Depth& depth, const Depth& deepest) const {
    return 1.0 / (1.0 + unloading * step.now) * ((hardness - unloading) * deepest + unloading * depth);
  }
  // p_e (Pa)
  double stress(double depth, double deepest) const {
    const double virgin = this->virgin(depth);
    return virgin > hardness * deepest ? virgin : std::max(pressed(depth, deepest), 0.0);
  }
  // c ε', as far as it does not pull (Pa). It comes in by a parabola, of mean 1 over the depths between two lines.
  double damped(double stress, double rate) const {
    if (rate < 0.0) return std::max(damping * rate, -stress);
    const double t = stress < full ? stress / full : 1.0;
    return damping * rate * t * (4.0 - 3.0 * t);
  }
};

struct Sums {
  double force = 0.0, moment = 0.0, energy = 0.0, power = 0.0;
};

// A part of a line over which depth, deepest depth and rate are straight: divided where a branch of the law ends.
void add_straight(const PointLaw& law, double from, double to, const Straight& depth, const Straight& deepest,
                  const Straight& rate, Sums& out) {
  double cuts[9] = {from, to};
  int count = 2;
  const auto add_zero = [&](const Straight& f) {
    const double x = -f.at_edge / f.slope;
    if (x > from + THIN && x < to - THIN) cuts[count++] = x;
  };
  const Straight virgin = law.virgin(depth), pressed = law.pressed(depth, deepest);
  add_zero(virgin + (-law.hardness) * deepest);
  add_zero(pressed);
  if (law.damping > 0.0) {
    for (const Straight& stress : {virgin, pressed}) {
      add_zero(stress + law.damping * rate);
      add_zero(stress + Straight{-law.full, 0.0});
    }
    add_zero(rate);
  }
  std::sort(cuts, cuts + count);
  for (int i = 0; i + 1 < count; i++)
    for (int k = 0; k < 3; k++) {
      const double half = 0.5 * (cuts[i + 1] - cuts[i]), x = 0.5 * (cuts[i + 1] + cuts[i]) + Gauss<3>::POINT[k] * half;
      const double weight = half * Gauss<3>::WEIGHT[k];
      const double stress = law.stress(depth(x), deepest(x));
      if (!(stress > 0.0)) continue;
      const double damping = law.damped(stress, rate(x));
      out.force += weight * (stress + damping);
      out.moment += weight * (stress + damping) * x;
      out.energy += weight * 0.5 * stress * stress / law.unloading;
      out.power += weight * damping * rate(x);
    }
}

// One section's base over its line: the ground there, which an edge may have cut within the step, and delayed depth.
struct BaseOnLine {
  const Section& c;
  const DelayedGround& delayed;
  PointLaw law;
  Ground ground;
  double from, to;  // ends of the wet base
  alone::BasePieces<double> pieces;

  BaseOnLine(const Snow& snow, const GrooveLines& lines, int slot, const Section& base, double dt)
      : c(base),
        delayed(lines.delayed[std::size_t(slot)]),
        law(snow, lines, slot, base, dt),
        ground(lines.ground(slot)),
        from(base.wet_from),
        to(std::max(base.wet_to, base.wet_from)),
        pieces(base) {
    for (int k = 0; k < 2; k++) {
      const alone::CutGround<double> cut(lines, slot, c, k, from, to);
      if (!cut.is_there()) continue;
      const auto left = [&](double x) { return cut.at(x) - delayed.depth_at(c.place + x); };
      ground.press(c.place + cut.from, left(cut.from), c.place + cut.to, left(cut.to));
    }
  }

  // The delayed depth at the step's end, but for what that end's own stress adds.
  double known(double x) const {
    return law.step.keep * delayed.depth_at(c.place + x) + law.step.before * delayed.stress_at(c.place + x);
  }

  // Depth of the ground before its knot of this number.
  Straight deepest(int knot) const {
    if (knot == 0 || knot >= ground.count) return {0.0, 0.0};
    const double a = ground.place[knot - 1] - c.place, width = ground.place[knot] - c.place - a;
    const double slope = (ground.depth[knot] - ground.depth[knot - 1]) / width;
    return {ground.depth[knot - 1] - slope * a, slope};
  }

  int knot_behind(double x) const {
    int knot = 0;
    while (knot < ground.count && ground.place[knot] - c.place <= x + THIN) knot++;
    return knot;
  }

  int piece_behind(double x) const {
    int piece = 0;
    while (piece + 1 < pieces.COUNT && pieces.place[piece + 1] <= x + THIN) piece++;
    return piece;
  }

  double stress(double x) const {
    const double depth = pieces.depth(piece_behind(x), x);
    return x < from || x > to ? 0.0 : law.stress(depth - known(x), deepest(knot_behind(x))(x));
  }

  Sums bear(const Straight& rate) const {
    Sums out;
    for (double x = from; x < to - THIN;) {
      const int knot = knot_behind(x), piece = piece_behind(x);
      double next = std::min(to, pieces.place[piece + 1]);
      if (knot < ground.count) next = std::min(next, ground.place[knot] - c.place);
      Straight depth{pieces.at_grip[piece], pieces.fall[piece]};
      if (!delayed.empty()) {
        const double number = std::floor((c.place + x) / delayed.spacing + 1e-6) + 1.0;
        if (number <= double(delayed.end()))  // beyond its places it is zero, however far a base reaches
          next = std::min(next, std::max(number, double(delayed.first) - 1.0) * delayed.spacing - c.place);
        const double here = known(x), slope = (known(next) - here) / (next - x);
        depth = depth + Straight{slope * x - here, -slope};
      }
      add_straight(law, x, next, depth, deepest(knot), rate, out);
      x = next;
    }
    return out;
  }
};

// Answers of the laws at a section, with other forces and another place of its edge.
Acting<double> acting(const Snow& snow, const GrooveLines& lines, const Sections& s, int i, const Section& c,
                      const Sums& sums) {
  const double share = s[SHARE][i];
  Acting<double> out{share,
                     share * sums.force,
                     share * sums.moment,
                     s[MU][i] * s[RUB][i],
                     s[MU][i] * s[RUB_ASIDE][i],
                     s[EDGE_STRENGTH][i],
                     s[EDGE_THRUST][i],
                     {}};
  out.find_used(snow, lines, lines.slot(s.line(i)), c);
  return out;
}

void keep_differences(const Pushed<double>& pushed, const Sections& s, int i, int change, double way,
                      SectionDifferences& out) {
  for (int k = 0; k < Pushed<double>::PARTS; k++)
    out.column(change, k)[i] = (s[ForceField(FORCE_0 + k)][i] - pushed.parts[k]) / way;
}

}  // namespace

KelvinStep::KelvinStep(const RateLaw& law, double hardness, double dt) {
  const double steps = dt / law.retardation, give = law.delayed_share / hardness;
  keep = std::exp(-steps);
  const double mean = steps > 0.0 ? -std::expm1(-steps) / steps : 1.0;
  before = (mean - keep) * give;
  now = (1.0 - mean) * give;
}

void RatedBase::press(const Snow& snow, const GrooveLines& lines, const Pose& pose, const Motion& motion, double dt,
                      Sections& s) {
  const alone::BootMotion boot(motion, pose);
  BaseMotion moving;
  std::copy_n(boot.v, 3, moving.velocity);
  std::copy_n(boot.o, 3, moving.turning);
  dt_ = dt;
  moving_.assign(std::size_t(s.count()), moving);
  for (int i = 0; i < s.count(); i++) {
    s.pressure[RATE_POWER][i] = 0.0;
    if (!s.touches(i)) continue;
    BaseMotion& here = moving_[std::size_t(i)];
    alone::find_beam_rates(motion, s.base, i, here.deflecting, here.twisting);
    const Section c = Section::stored(s.base, i);
    const Sums sums =
        BaseOnLine(snow, lines, lines.slot(s.line(i)), c, dt).bear(depth_rate(c, moving_[std::size_t(i)]));
    const double share = s[SHARE][i];
    s.pressure[FORCE][i] = share * sums.force, s.pressure[MOMENT][i] = share * sums.moment;
    s.pressure[SNOW_ENERGY][i] = share * sums.energy, s.pressure[RATE_POWER][i] = share * sums.power;
  }
}

void RatedBase::differ(const Snow& snow, const GrooveLines& lines, const Sections& s, double step, double sense,
                       SectionDifferences& out) const {
  std::fill(out.values.begin(), out.values.end(), 0.0);
  for (int i = 0; i < s.count(); i++)
    for (int change = 0; change < SectionDifferences::CHANGES && s.touches(i); change++) {
      const double way = change == SectionDifferences::OFF ? step : sense * step;
      Section c = alone::displaced(Section(s.base, i), change, way);
      c.cut();
      const Sums sums =
          BaseOnLine(snow, lines, lines.slot(s.line(i)), c, dt_).bear(depth_rate(c, moving_[std::size_t(i)]));
      keep_differences({c, acting(snow, lines, s, i, c, sums), snow}, s, i, change, way, out);
    }
}

void RatedBase::differ_rates(const Snow& snow, const GrooveLines& lines, const Sections& s, double sense,
                             SectionDifferences& out) const {
  std::fill(out.values.begin(), out.values.end(), 0.0);
  for (int i = 0; i < s.count(); i++) {
    if (!s.touches(i)) continue;
    const Section c = Section::stored(s.base, i);
    const BaseOnLine base(snow, lines, lines.slot(s.line(i)), c, dt_);
    for (int change = 0; change < SectionDifferences::CHANGES; change++) {
      const double way = change == SectionDifferences::OFF ? RATE_STEP : sense * RATE_STEP;
      BaseMotion moved = moving_[std::size_t(i)];
      if (change == SectionDifferences::LEFT) moved.velocity[1] += way;
      if (change == SectionDifferences::OFF) moved.velocity[2] += way;
      if (change == SectionDifferences::TWIST) moved.twisting += way;
      const Sums sums = base.bear(depth_rate(c, moved));
      keep_differences({c, acting(snow, lines, s, i, c, sums), snow}, s, i, change, way, out);
    }
  }
}

double advance_delayed(const Snow& snow, const Sections& s, double dt, GrooveLines& lines) {
  double taken = 0.0;
  for (std::int64_t n = lines.first; n < lines.end; n++) {
    const int i = s.index(n), slot = lines.slot(n);
    DelayedGround& delayed = lines.delayed[std::size_t(slot)];
    const Section c = Section::stored(s.base, i);
    const bool touches = s.touches(i);
    if (touches)
      delayed.cover(long(std::ceil((c.place + c.wet_from) / delayed.spacing)),
                    long(std::floor((c.place + c.wet_to) / delayed.spacing)) + 1);
    if (delayed.empty()) continue;
    const BaseOnLine base(snow, lines, slot, c, dt);
    std::vector<double> depth = delayed.depth, stress = delayed.stress;
    double work = 0.0;
    for (std::size_t j = 0; j < depth.size(); j++) {
      const double x = double(delayed.first + long(j)) * delayed.spacing - c.place;
      stress[j] = touches ? base.stress(x) : 0.0;
      depth[j] = base.known(x) + base.law.step.now * stress[j];
      work += 0.5 * (stress[j] + delayed.stress[j]) * (depth[j] - delayed.depth[j]);
    }
    taken += work * delayed.spacing * s[SHARE][i];
    delayed.depth = std::move(depth), delayed.stress = std::move(stress);
    delayed.trim();
  }
  return taken;
}

}  // namespace skisnow
