// Forces and tangents of a clamped ski in snow, station by station from tip to tail.
#include <cmath>

#include "carve/equations.hpp"

namespace skisnow {

namespace {

// Forces of the snow on a section, per length of ski, and their growth with the depth of the section, its twist and τ.
struct Load {
  SectionLoad<double> at;
  double normal_by_depth, normal_by_twist, normal_by_stress;
  double moment_by_depth, moment_by_twist, moment_by_stress;
  double force_by_depth, force_by_twist;  // along the snow normal
  double bite_by_depth, bite_by_twist;
  // parts of a force that a deeper groove adds: to the force normal to the base, the moment besides that of its place,
  // and the balance of moments
  double pulled_normal, pulled_moment, pulled_pitch;
};

// Strength of the edge by a law from outside, over the one that all have in common, and how it grows.
struct Strength {
  double share = 1.0, by_depth = 0.0, by_angle = 0.0;
};

class Pass {
 public:
  Pass(const CarvedSki& ski, const CarveConditions& conditions, CarveGroove& groove, const CarveState& at,
       CarveEquations& out)
      : ski_(ski),
        conditions_(conditions),
        links_(groove.links),
        pressure_(groove.pressure),
        at_(at),
        out_(out),
        sine_(std::sin(conditions.edge_angle)),
        cosine_(std::cos(conditions.edge_angle)),
        boot_(CarveBoot<double>::at(conditions.edge_angle, at.border, conditions.twists)),
        edges_(conditions.edges()) {}

  template <class Groove>
  void from_tip_to_tail(Groove& groove, bool linearises);

 private:
  const CarvedSki& ski_;
  const CarveConditions& conditions_;
  CarveLinks& links_;
  CarvePressure& pressure_;
  const CarveState& at_;
  CarveEquations& out_;
  double sine_, cosine_;  // edge angle of the boot
  const CarveBoot<double> boot_;
  const EdgeShape edges_;
  std::vector<Strength> strength_;  // one for each station, if a law gives it

  void begin();
  CarveSection section(const CarveStation& station) const;
  template <class Groove>
  void ask_pressure(Groove& groove);
  void ask_strength();
  Load load(const CarveSection& section, const StripSums& sums, const Strength& strength) const;
  void add_to_border(const CarveStation& station, const Load& load);
  void add_to_beam(const CarveStation& station, const Load& load);
  void add_to_matrix(const CarveStation& station, const Load& load);
  void add_pulls(const CarveStation& station, const Load& load, double lever);
  void bind_links();
};

// The beam alone: its matrix and its elastic forces.
void Pass::begin() {
  out_.matrix = ski_.stiffness;
  find_elastic_forces(ski_, at_.u, out_.residual.data());
  out_.rows.assign(BAND_TILE * out_.residual.size(), 0.0);
  out_.columns.assign(out_.tile(tiles_for(CARVE_BORDER)), 0.0);
  for (auto& row : out_.corner) std::fill(std::begin(row), std::end(row), 0.0);
  std::fill(std::begin(out_.border_residual), std::end(out_.border_residual), 0.0);
  out_.link_corner.clear();
  out_.link_from.clear();
}

CarveSection Pass::section(const CarveStation& s) const {
  CarveSection out{boot_.section(s, at_.u.data() + s.first)};
  if (edges_.acts()) out.grind(edges_);
  return out;
}

// The load of `section_load`, and its growth.
Load Pass::load(const CarveSection& section, const StripSums& sums, const Strength& strength) const {
  const double stress = at_.border[2], lever = section.half * section.cosine;
  const double square = 1.0 + section.tangent * section.tangent;
  const double by_depth = sums.by_depth[0];
  const double by_twist = lever * sums.by_depth[0] - square * sums.by_depth[1] + sums.by_angle[0];
  const double moment_by_depth = sums.by_depth[1] - lever * by_depth;
  const double moment_by_twist = lever * sums.by_depth[1] - square * sums.by_depth[2] + sums.by_angle[1] -
                                 lever * by_twist + section.half * section.sine * sums.force;
  const bool reacts = conditions_.by_reaction;
  const double held = section.depth > 0.0 ? section.depth : 0.0;
  const double growth = section.depth > 0.0 ? strength.share + strength.by_depth * held : 0.0;
  const double bite_by_depth = reacts ? by_depth : growth;
  const double bite_by_twist = reacts ? by_twist : growth * section.edge_by_angle() + strength.by_angle * held;
  const double shears = conditions_.side_force_bending ? 1.0 : 0.0;
  const double other = reacts ? 0.0 : std::max(section.other_depth(), 0.0);
  const double other_by_depth = other > 0.0 ? strength.share + strength.by_depth * other : 0.0;
  const double other_by_twist = other > 0.0 ? strength.by_depth * other * section.edge_by_angle() +
                                                  strength.by_angle * other - strength.share * lever
                                            : 0.0;
  const double turned_by_depth = bite_by_depth - 2.0 * other_by_depth;
  const double turned_by_twist = bite_by_twist - 2.0 * other_by_twist;
  const double up = shears * sine_, turn = -shears * section.half * section.sine, turn_by_twist = -shears * lever;
  const auto at = section_load(sums.force, sums.moment, reacts, strength.share * held, strength.share * other,
                               shears * stress, {sine_, cosine_}, {section.half * section.sine, lever});
  return {.at = at,
          .normal_by_depth = cosine_ * by_depth + up * stress * bite_by_depth,
          .normal_by_twist = cosine_ * by_twist + up * stress * bite_by_twist,
          .normal_by_stress = up * at.bite,
          .moment_by_depth = moment_by_depth + turn * stress * turned_by_depth,
          .moment_by_twist = moment_by_twist + (turn * turned_by_twist + turn_by_twist * at.turned) * stress,
          .moment_by_stress = turn * at.turned,
          .force_by_depth = by_depth,
          .force_by_twist = by_twist,
          .bite_by_depth = bite_by_depth,
          .bite_by_twist = bite_by_twist,
          .pulled_normal = reacts ? cosine_ + up * stress : cosine_,
          .pulled_moment = reacts ? turn * stress : 0.0,
          .pulled_pitch = conditions_.pitch_of_force + (reacts ? conditions_.pitch_of_shear * stress : 0.0)};
}

// How force, moment and side force grow with the border.
void Pass::add_to_border(const CarveStation& s, const Load& load) {
  const double stress = at_.border[2], held = stress * load.bite_by_depth;
  const double force = conditions_.pitch_of_force, shear = conditions_.pitch_of_shear;
  const double slope = force * load.force_by_depth + shear * held;
  auto& corner = out_.corner;
  corner[0][0] += s.weight * load.force_by_depth;
  corner[0][1] += s.weight * load.force_by_depth * s.place;
  corner[1][0] += s.weight * slope * s.place;
  corner[1][1] += s.weight * slope * s.place * s.place;
  corner[1][2] += s.weight * shear * load.at.bite * s.place;
  if (conditions_.by_reaction) return;  // the load bears it all: see the end of the pass
  corner[2][0] += s.weight * held;
  corner[2][1] += s.weight * held * s.place;
  corner[2][2] += s.weight * load.at.bite;
}

// What beam and border do to the load on the beam's equations.
void Pass::add_to_beam(const CarveStation& s, const Load& load) {
  const double stress = at_.border[2];
  const double force = conditions_.pitch_of_force, shear = conditions_.pitch_of_shear;
  const auto add = [&](int unknown, double weighted, double by_unknown, double by_depth, double by_stress) {
    const auto j = std::size_t(s.first + unknown);
    double *column = out_.columns.data() + BAND_TILE * j, *row = out_.rows.data() + BAND_TILE * j;
    column[0] -= weighted * by_depth;
    column[1] -= weighted * by_depth * s.place;
    column[2] -= weighted * by_stress;
    // by_unknown: how the depth of the edge grows with it, or the twist
    const bool bends = unknown % 3 != 2;
    const double slope = s.weight * (bends ? load.force_by_depth : load.force_by_twist) * by_unknown;
    const double deeper = s.weight * stress * (bends ? load.bite_by_depth : load.bite_by_twist) * by_unknown;
    row[0] += slope;
    row[1] += (force * slope + shear * deeper) * s.place;
    if (!conditions_.by_reaction) row[2] += deeper;
  };
  for (int a = 0; a < 4; a++)
    add(BENDS[a], s.weight * s.deflection[a], -cosine_ * s.deflection[a], load.normal_by_depth, load.normal_by_stress);
  if (!conditions_.twists) return;
  for (int a = 0; a < 2; a++)
    add(TURNS[a], s.weight * s.twist[a], s.twist[a], load.moment_by_depth, load.moment_by_stress);
}

// How the load on the beam's equations grows with the beam's unknowns.
void Pass::add_to_matrix(const CarveStation& s, const Load& load) {
  double bends[4], turns[2], sinks[4];
  for (int a = 0; a < 4; a++) bends[a] = s.weight * s.deflection[a], sinks[a] = cosine_ * s.deflection[a];
  for (int a = 0; a < 2; a++) turns[a] = conditions_.twists ? s.twist[a] : 0.0;
  const auto add_row = [&](int a, double by_depth, double by_twist) {
    double* at = out_.matrix.data() + CARVE_BAND * (s.first + a) + BAND_HALF - a;
    for (int b = 0; b < 4; b++) at[BENDS[b]] += by_depth * sinks[b];
    for (int b = 0; b < 2; b++) at[TURNS[b]] -= by_twist * turns[b];
  };
  for (int a = 0; a < 4; a++) add_row(BENDS[a], bends[a] * load.normal_by_depth, bends[a] * load.normal_by_twist);
  for (int a = 0; a < 2; a++) {
    const double turn = s.weight * turns[a];
    add_row(TURNS[a], turn * load.moment_by_depth, turn * load.moment_by_twist);
  }
}

// [links] What a deeper groove, cut by the linked stations, does to this station's load.
void Pass::add_pulls(const CarveStation& s, const Load& load, double lever) {
  out_.link_corner.resize(4 * links_.pulls.size(), 0.0);
  out_.link_from.resize(links_.pulls.size(), s.first);
  out_.columns.resize(out_.tile(tiles_for(CARVE_BORDER + 2 * int(links_.pulls.size()))), 0.0);
  for (std::size_t k = 0; k < links_.pulls.size(); k++) {
    const CarvePull& pull = links_.pulls[k];
    const double force[2] = {pull.force_by_depth, pull.force_by_twist};
    const double arm = lever - load.pulled_moment;
    const double moment[2] = {pull.moment_by_depth - arm * force[0], pull.moment_by_twist - arm * force[1]};
    for (std::size_t of = 0; of < 2; of++) {
      if (force[of] == 0.0 && moment[of] == 0.0) continue;
      out_.link_corner[4 * k + 2 * of] += s.weight * force[of];
      out_.link_corner[4 * k + 2 * of + 1] += s.weight * load.pulled_pitch * force[of] * s.place;
      double* column = out_.column(CARVE_BORDER + int(2 * k + of)) + BAND_TILE * s.first;
      for (int a = 0; a < 4; a++)
        column[BAND_TILE * BENDS[a]] -= s.weight * load.pulled_normal * s.deflection[a] * force[of];
      if (!conditions_.twists) continue;
      for (int a = 0; a < 2; a++) column[BAND_TILE * TURNS[a]] -= s.weight * s.twist[a] * moment[of];
    }
  }
}

// [links] The unknowns of the linked stations are what beam and boot give them.
void Pass::bind_links() {
  out_.links.clear();
  for (int number : links_.station) {
    const CarveStation& s = ski_.stations[std::size_t(number)];
    const double lever = s.half_width * section(s).cosine;
    CarveLinkRow row{.first = s.first, .place = s.place, .deflection = {}, .by_twist = {}, .twist = {}};
    for (int a = 0; a < 4; a++) row.deflection[a] = cosine_ * s.deflection[a];
    for (int a = 0; a < 2 && conditions_.twists; a++) {
      row.by_twist[a] = -lever * s.twist[a];
      row.twist[a] = -s.twist[a];
    }
    out_.links.push_back(row);
  }
}

// The stretches of all sections, for a law that is asked once for all of them.
template <class Groove>
void Pass::ask_pressure(Groove& groove) {
  groove.clear();
  for (std::size_t i = 0; i < ski_.stations.size(); i++) {
    const CarveSection found = section(ski_.stations[i]);
    StripSums nothing;
    groove.across(found, int(i), pressure_, nothing, links_);
    groove.pass(found, int(i));
  }
  pressure_.ask();
}

// [strength] At all stations, with depth and angle as they are and each a little more.
void Pass::ask_strength() {
  if (conditions_.laws == nullptr || !conditions_.laws->strength || conditions_.by_reaction) return;
  constexpr double STEP = 1e-8, ANGLE_STEP = 1e-6;  // (m), (rad)
  const std::size_t n = ski_.stations.size();
  CarveLaws::Values depth, angle;
  for (int change = 0; change < 3; change++)
    for (const CarveStation& station : ski_.stations) {
      const CarveSection found = section(station);
      depth.push_back(std::max(found.depth, 0.0) + (change == 1 ? STEP : 0.0));
      const double face = std::asin(std::min(std::fabs(found.sine), 1.0)) - edges_.bevel();
      angle.push_back(std::max(face, 0.0) + (change == 2 ? ANGLE_STEP : 0.0));
    }
  const auto found = conditions_.laws->strength(depth, angle);
  for (std::size_t i = 0; i < n; i++)
    strength_.push_back({found[i], (found[n + i] - found[i]) / STEP, (found[2 * n + i] - found[i]) / ANGLE_STEP});
}

template <class Groove>
void Pass::from_tip_to_tail(Groove& groove, bool linearises) {
  if (linearises) begin();
  links_.clear();
  pressure_.begin(conditions_.laws, conditions_.law_share, conditions_.law_memory, conditions_.hardness,
                  conditions_.excess);
  if (pressure_.gathers()) ask_pressure(groove);
  ask_strength();
  groove.clear();
  for (std::size_t i = 0; i < ski_.stations.size(); i++) {
    const CarveStation& station = ski_.stations[i];
    const CarveSection found = section(station);
    StripSums sums;
    links_.next_section();
    groove.across(found, int(i), pressure_, sums, links_);
    groove.pass(found, int(i));
    out_.depth[i] = found.depth;
    out_.force[i] = sums.force;
    if (!linearises || (sums.by_depth[0] == 0.0 && !(found.depth > 0.0))) continue;
    const Load felt = load(found, sums, strength_.empty() ? Strength{} : strength_[i]);
    const double lever = found.half * found.cosine;
    add_load(conditions_, station, felt.at, sums.force, at_.border[2], out_.border_residual,
             out_.residual.data() + station.first);
    add_to_border(station, felt);
    add_to_beam(station, felt);
    add_to_matrix(station, felt);
    add_pulls(station, felt, lever);
  }
  if (!linearises) return;
  subtract_loads(conditions_, at_.border[2], out_.border_residual);
  if (conditions_.by_reaction) out_.corner[2][2] += conditions_.load;
  bind_links();
}

}  // namespace

CarveEquations::CarveEquations(const CarvedSki& ski)
    : matrix(ski.stiffness),
      residual(std::size_t(ski.size + BAND_HALF), 0.0),
      depth(ski.stations.size(), 0.0),
      force(ski.stations.size(), 0.0) {}

void assemble(const CarvedSki& ski, const CarveConditions& conditions, CarveGroove& groove, const CarveState& at,
              CarveEquations& out, bool linearises) {
  Pass pass(ski, conditions, groove, at, out);
  if (!groove.along_path) return pass.from_tip_to_tail(groove.edge, linearises);
  groove.path.tangent = std::tan(conditions.edge_angle);
  pass.from_tip_to_tail(groove.path, linearises);
}

}  // namespace skisnow
