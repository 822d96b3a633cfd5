// Snow: its surface, its strength over the place, its laws, and the tracks that are left in it.
#pragma once

#include "snow/archive.hpp"
#include "snow/surface.hpp"

namespace skisnow {

// Friction of the base: μ = constant + linear v + square v² + film/(1 + v/film_speed), all of Coulomb's, by speed
// (m/s).
struct FrictionLaw {
  double constant = 0.0, linear = 0.0, square = 0.0, film = 0.0, film_speed = 1.0;
  double stick = 0.02e-3;   // way of the base to full friction (m): until then it sticks, as by a spring
  bool is_vector = true;    // against the sliding velocity; false: along the ski, by the velocity along the ski
  bool acts_across = true;  // its part across the ski; else the shear law has that
};

// Strength of an edge over that of the snow's line, by its angle ϑ and by how far it has slipped there.
struct ShearLaw {
  double decrease = 0.0;        // k of 1 - k ϑ (1/rad)
  bool cuts = false;            // machining: 2 cot φ of the line's strength S, φ = (ϑ - β)/2; thrust cot² φ - 1
  double friction_angle = 0.0;  // its β
  double least_plane = 0.087;   // φ where the edge is flatter (rad)
  double residual_ratio = 1.0;  // strength after slip over that before, reached linearly over a slip (m)
  double weakening = 1e-3;
  bool loaded_only = false;  // inwards an edge holds by the height of the base that bears, not by all of it

  bool by_angle() const { return cuts || decrease != 0.0; }
};

// Answer of the snow that depends on time: a dashpot beside the law, and a Kelvin element in series with it.
struct RateLaw {
  double damping = 0.0;        // c (N s/m³)
  double delayed_share = 0.0;  // H_V/H₂: delayed depth under a load that stays, over that at once
  double retardation = 0.1;    // c₂/H₂ (s)
  double spacing = 1e-3;       // between the places on a line that keep their delayed depth (m)

  bool is_delayed() const { return delayed_share > 0.0; }
  bool acts() const { return damping > 0.0 || is_delayed(); }
};

struct Snow {
  Grid surface;                         // height (m)
  Grid hardness, strength;              // H_V (N/m³), S_f (Pa)
  Grid friction_share = Grid(1.0);      // μ over the place over that of the law
  double strength_share = 1.0;          // of S_f everywhere, which may change during a run
  double unloading_ratio = 1.0;         // k_u/H_V
  double shear_displacement = 0.02e-3;  // displacement of the edge across, to full strength (m)
  bool compaction_resistance = true;
  FrictionLaw friction;
  bool friction_on_base = false;  // of what presses on the base, or of the pressure along the snow's normal
  ShearLaw shear;
  RateLaw rate;
  double knot_area = 1e-4;  // share of depth times width of a contact below which a knot is dropped
  // longest way (m) of tip and tail, along the ski and across it, over which the history is marched at once
  double part_along = 0.006, part_across = 2e-3;
  Archive archive;
};

}  // namespace skisnow
