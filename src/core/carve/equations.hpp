// The equations of a carving ski, linearised: a band for the beam, bordered by the unknowns of boot and links.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <vector>

#include "carve/groove.hpp"
#include "linear_algebra/banded.hpp"

namespace skisnow {

// The residual on any kind of number: solver, adjoint, derivatives along a direction and refinement share this text.

// The beam's elastic forces at its unknowns.
template <class T>
void find_elastic_forces(const CarvedSki& ski, const auto& u, T* out) {
  for (int i = 0; i < ski.size; i++) {
    const double* row = ski.stiffness.data() + CARVE_BAND * i;
    T total(0.0);
    for (int k = std::max(0, BAND_HALF - i); k < CARVE_BAND; k++)
      total += T(row[k]) * u[std::size_t(i + k - BAND_HALF)];
    out[i] = total;
  }
}

// The boot: its edge angle with sine and cosine, b₀, b₁, and whether the ski twists.
template <class T>
struct CarveBoot {
  T angle, sine, cosine, depth, slope;
  bool twists;

  static CarveBoot at(const T& angle, const auto& border, bool twists) {
    using std::cos;
    using std::sin;
    return {angle, sin(angle), cos(angle), border[0], border[1], twists};
  }
  // [section] Where the section of a station lies; `u`: unknowns of its element.
  SnowSection<T> section(const StationOf<T>& s, const T* u) const {
    using std::cos;
    using std::sin;
    T height = s.base_height, turned = angle;
    for (int a = 0; a < 4; a++) height += s.deflection[a] * u[BENDS[a]];
    for (int a = 0; a < 2 && twists; a++) turned += s.twist[a] * u[TURNS[a]];
    const T s1 = sin(turned), c1 = cos(turned), corner = depth + slope * s.place - cosine * height + s.half_width * s1;
    return {s.half_width, s1, c1, s1 / c1, corner, corner, T(2.0) * s.half_width * c1, height, turned};
  }
};

// Load on a section, per length of ski, on any kind of number. The side force is τ times `bite`: depth of the edge
// where it is below the surface, or the snow's force.
template <class T>
struct SectionLoad {
  T bite, turned, normal, moment;  // `normal` to the base; `moment`: growth of the edge angle
};

// [load] The snow's force along its normal turns the section about its middle, with the lever W/2 cos at the edge and
// less inwards. The shear τ e turns it by W/2 sin. Of a base that is in the snow with both edges the other edge holds
// its own depth e' of it, on the other side: the moment is that of e - 2 e'. `held`, `other`: depths of both edges,
// with their strength; `stress`: τ, as far as it bends; `boot`: sine and cosine; `lever`: W/2 sin, W/2 cos.
template <class T>
SectionLoad<T> section_load(const T& force, const T& about_edge, bool reacts, const T& held, const T& other,
                            const T& stress, const T (&boot)[2], const T (&lever)[2]) {
  const T bite = reacts ? force : held, turned = reacts ? bite : bite - T(2.0) * other;
  return {bite, turned, boot[1] * force + boot[0] * stress * bite,
          about_edge - lever[1] * force - lever[0] * stress * turned};
}

// [balance] Add a section's load to force, moment about the boot's cross axis, side force, and to its element's
// equations `beam`; `given`: conditions.
template <class T>
void add_load(const auto& given, const StationOf<T>& s, const SectionLoad<T>& load, const T& force, const T& stress,
              T* border, T* beam) {
  border[0] += s.weight * force;
  border[1] += s.weight * (given.pitch_of_force * force + given.pitch_of_shear * stress * load.bite) * s.place;
  if (!given.by_reaction) border[2] += s.weight * stress * load.bite;
  for (int a = 0; a < 4; a++) beam[BENDS[a]] -= s.weight * s.deflection[a] * load.normal;
  for (int a = 0; a < 2 && given.twists; a++) beam[TURNS[a]] -= s.weight * s.twist[a] * load.moment;
}

// What these sums must come to. By reaction the load alone draws the side force.
template <class T>
void subtract_loads(const auto& given, const T& stress, T* border) {
  border[0] -= given.load, border[1] -= given.moment, border[2] -= given.side_force;
  if (given.by_reaction) border[2] += stress * given.load;
}

// Row that links depth and twist of one station to beam and boot.
struct CarveLinkRow {
  int first;                          // unknown of its element
  double place;                       // along the ski (m)
  double deflection[4], by_twist[2];  // of its depth
  double twist[2];                    // of its twist
};

struct CarveEquations {
  explicit CarveEquations(const CarvedSki& ski);

  Column matrix, residual;  // banded rows of the beam
  Column rows;              // border rows, `BAND_TILE` to each unknown of the beam, the last one zero
  Column columns;           // of border and links, in tiles: `BAND_TILE` of them to each unknown of the beam
  double corner[CARVE_BORDER][CARVE_BORDER], border_residual[CARVE_BORDER];
  std::vector<double> link_corner;   // rows 0 and 1 of each link column
  std::vector<CarveLinkRow> links;   // each with two columns
  std::vector<int> link_from;        // first unknown of the beam that a link acts on
  std::vector<double> depth, force;  // at the stations

  int used() const { return CARVE_BORDER + 2 * int(links.size()); }
  // Where a tile begins, and where in it a column: its numbers lie `BAND_TILE` apart.
  std::size_t tile(int number) const { return std::size_t(number) * BAND_TILE * residual.size(); }
  double deepest() const { return *std::max_element(depth.begin(), depth.end()); }
  double* column(int k) { return columns.data() + tile(k / BAND_TILE) + k % BAND_TILE; }
};

constexpr int tiles_for(int columns) { return (columns + BAND_TILE - 1) / BAND_TILE; }

// The groove, and scratch space of the assembly.
struct CarveGroove {
  explicit CarveGroove(std::size_t stations) : links(stations) {}

  bool along_path = false;
  GrooveAlongEdge edge;
  GrooveAlongPath path;
  CarveLinks links;
  CarvePressure pressure;
};

// Put together at a state; without `linearises` only depth and force at the stations.
void assemble(const CarvedSki& ski, const CarveConditions& conditions, CarveGroove& groove, const CarveState& at,
              CarveEquations& out, bool linearises = true);

// The linearised equations, factored: the beam first, then what is left of border and links.
class CarveFactors {
 public:
  // Takes matrix, rows and columns out of the system.
  void factor(const CarvedSki& ski, CarveEquations& system);
  // Newton's correction for the residuals of `system`; false where it is not finite.
  bool correct(const CarvedSki& ski, const CarveEquations& system, CarveState& step);
  // Replace a right side by the solution with the transposed matrix. The held unknowns must be zero.
  void solve_transposed(const CarvedSki& ski, CarveState& right);

 private:
  int used_ = 0, tiles_ = 0;  // unknowns of border and links; their tiles
  std::size_t room_ = 0;      // rows of a tile
  Column band_, rows_;
  Column influence_;              // tiles: the beam's answer to each of them
  std::vector<BandBlock> block_;  // one for each tile
  std::vector<CarveLinkRow> links_;
  std::vector<double> schur_, border_;
  std::vector<int> order_;

  double* influence(int tile, int row) {
    return influence_.data() + BAND_TILE * (std::size_t(tile) * room_ + std::size_t(row));
  }
  void solve_tiles(const CarvedSki& ski, const CarveEquations& system);
  void add_border(const CarveEquations& system);
  void add_links();
  void solve_border(const CarveEquations& system, const double* u);
};

// Root mean square change of the edge depth along the ski (m) that a step makes.
double depth_change(const CarvedSki& ski, const CarveConditions& conditions, const CarveState& step);

// Newton's method from `state`, which it moves to the equilibrium; `at` then holds the equations there.
class CarveNewton {
 public:
  CarveNewton(const CarvedSki& ski, std::function<void()> asked);

  CarveState state;
  CarveEquations at;
  int iterations = 0;
  double roughness = 0.0;  // correction at which the iteration may end, of the greatest depth

  // False where it finds none: the state is then somewhere on the way.
  bool solve(const CarveConditions& conditions, CarveGroove& groove);

 private:
  const CarvedSki& ski_;
  std::function<void()> asked_;
  CarveEquations spare_;
  CarveState step_, trial_, trial_step_;
  CarveFactors factors_;

  // Move by `step_`, shorter where the correction that follows would not fall; its length, or none.
  std::optional<double> damped_step(const CarveConditions& conditions, CarveGroove& groove, double length,
                                    double& damping);
  double length_of(const CarveConditions& conditions, const CarveState& step) const;
};

}  // namespace skisnow
