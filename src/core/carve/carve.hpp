// A ski that carves steadily, or stands: its shape over a groove that its own stations cut from tip to tail.
//
// Equations: docs/methods/carved-turn.md and docs/methods/ski.md.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "beam/edge_shape.hpp"
#include "carve/law.hpp"
#include "support/columns.hpp"

namespace skisnow {

// Unknowns beside those of the beam: depth of the boot b₀ (m), its slope along the ski b₁, what draws the side force,
// τ: for each area of the edge in the snow (Pa), or for each force of the snow on the base.
constexpr int CARVE_BORDER = 3;
constexpr int CARVE_BAND = 11;  // columns of a row: five to each side

constexpr int BENDS[4] = {0, 1, 3, 4}, TURNS[2] = {2, 5};  // an element's unknowns of deflection and of twist

// One place along the ski at which the snow is felt, on any kind of number.
template <class T>
struct StationOf {
  T place, weight, half_width, base_height;  // from the boot; length of ski of the station (m)
  T deflection[4], twist[2];                 // shapes of its element's unknowns
  int first;                                 // unknown of its element
};
using CarveStation = StationOf<double>;

// A ski clamped at the boot, its unknowns from tip to tail. Between those before and behind the clamp lie six that do
// not move, so that every element has six in a row.
struct CarvedSki {
  static constexpr int HELD = 6;

  std::vector<CarveStation> stations;  // tip to tail
  int front = 0, size = 0;             // unknowns before the clamp; in all, those held included
  Column stiffness;                    // banded rows
  double waist = 0.0, running_length = 0.0, greatest_width = 0.0;
  Column bent_by_width, bent_by_height;  // the ski bent onto the snow: tan ϑ times the first less the second

  Column spread(const double* free) const;                // free unknowns, with room for the held ones between
  std::vector<double> gathered(const Column& all) const;  // and back
};

struct CarveConditions {
  double edge_angle, hardness, excess;  // ϑ (rad), H_V, k_u - H_V (N/m³)
  double load, moment, side_force;      // at the boot (N, N m, N)
  bool side_force_bending, twists;
  double bevel, bevel_width, side, radius;  // the ground edge, see `EdgeShape`
  double pitch_of_force, pitch_of_shear;    // shares of snow force and side force in the balance of moments
  bool by_reaction = false;         // the side force goes along the edge as the force on the base, not as its depth
  const CarveLaws* laws = nullptr;  // from outside; hardness and excess are then where the search begins
  double law_share = 1.0;           // share of the pressure from these laws
  double law_memory = 1.0;          // share of the groove's lead over the base that they see

  EdgeShape edges() const { return {bevel, bevel_width, side, radius}; }
};

struct CarveState {
  Column u;
  std::array<double, CARVE_BORDER> border{};

  void add(const CarveState& step, double share) {
    for (std::size_t j = 0; j < u.size(); j++) u[j] += share * step.u[j];
    for (std::size_t a = 0; a < border.size(); a++) border[a] += share * step.border[a];
  }
};

struct CarveSolution {
  bool converged = false;
  int iterations = 0;
  CarveState state;
  std::vector<double> depth, force;  // at the stations: of the edge (m), of the snow along its normal (N/m)
};

// The equilibrium: elastic snow first, then its memory, at need on softer snow that hardens.
//
// Where `offset` is not empty the groove lies along the path, and the edge of each station beside it by that (m,
// towards the inside of the turn). `near` is tried first where it is given. `asked` is called now and then while it
// takes long, and may throw.
CarveSolution find_carve(const CarvedSki& ski, const CarveConditions& conditions, std::vector<double> offset,
                         const CarveState* near, std::function<void()> asked);

}  // namespace skisnow
