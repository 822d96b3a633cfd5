// A rigid body on flexible skis: masses, stiffness, equations of motion.
//
// Velocities are those of the body's frame (Hamel's equations): with the momentum p and the angular momentum L about
// the moving origin, p' = f - ω × p and L' = τ - ω × L - v × p. Of the kinetic energy's dependence on the bend its
// largest part is kept, the momentum of a bent ski that turns.
#pragma once

#include <vector>

#include "beam/runner.hpp"
#include "linear_algebra/bordered.hpp"

namespace skisnow {

// A beam clamped to the body at its boot. Three unknowns to a free node: deflection (m), slope towards the tail, twist.
struct FlexibleSki {
  Vector3 boot{};                       // in the body's frame
  Vector3 axes[3] = {};                 // ahead, left across the base, off the base, in the body's frame
  Vector3 velocity{}, turning{};        // motion of a boot that moves, against the body, in the body's frame
  std::vector<int> unknown;             // (nodes,) the first of each node, -1 where it is held
  std::vector<double> mass, stiffness;  // (n, 6): [i, j] is A[i, i - j]
  std::vector<double> coupling;         // (n, 6) of the mass matrix, with the body
  double damping = 0.0;                 // times the stiffness (s)
  BeamColumns mass_columns, stiffness_columns, coupling_columns;  // the same, for products
  // The same as rows of a `BorderedSystem`; coupling with the clamp's freedoms in the ski's axes, the same wherever the
  // boot goes.
  Column mass_rows, stiffness_rows, clamp_coupling;
  struct FreeNodes {
    int unknown, node, count;  // their first unknown, the first of them, how many follow each other
  };
  std::vector<FreeNodes> free;
  std::vector<int> held_places;  // in rows of all nodes' unknowns: columns of nodes that are held or do not exist

  void prepare();
  Vector3 in_body(const Vector3& v) const;                        // a vector of the ski's axes
  void fill_freedoms(double (&by_body)[BODY][BORDER_ROW]) const;  // of its clamp, in its axes, by the body's
  void add_wrench(const double* force, const double* moment, Numbers& out) const;  // on its clamp, in its axes
  int size() const { return int(mass.size()) / (HALF_BAND + 1); }

 private:
  void find_free_nodes();
};

struct Body {
  double inertia[BODY][BODY] = {};  // of body and undeformed skis
  double mass = 0.0;                // of both (kg)
  Vector3 first_moment{};           // (kg m)
  std::vector<FlexibleSki> skis;
  const BandKernels* kernels = nullptr;
  Vector3 gravity{};                     // in space (m/s²)
  double drag = 0.0, drag_height = 0.0;  // ½ ρ C_d A (kg/m); of the centre of pressure (m)
  Vector3 push{}, push_at{};             // a force besides, in space (N); where it acts, in the body's frame (m)
  Layout layout() const;
};

// Place and rotation of the body's origin in space, and the beams' unknowns; rates in the body's frame.
struct BodyState {
  Vector3 position{};
  double rotation[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Numbers bend, rate;  // the body's part of `bend` is zero

  explicit BodyState(const Layout& layout = Layout());
  Vector3 in_body(const Vector3& in_space) const;
  Vector3 in_space(const Vector3& in_body) const;
};

// The pose after an increment of place and rotation vector, in the frame of `from`, and of the bend.
void move(const BodyState& from, const Numbers& increment, BodyState& out);

// A vector after a rotation by a small rotation vector, to its second order.
Vector3 rotated(const double* rotation, const double* vector, double share);

// out += scale M x; out += scale K (x + damping y).
void add_mass(const Body& body, const Layout& layout, const Numbers& x, double scale, Numbers& out);
void add_stiffness(const Body& body, const Layout& layout, const Numbers& x, const Numbers& y, double scale,
                   Numbers& out);

// All that accelerates the body and the skis but the snow, stiffness and damping.
void add_forces(const Body& body, const Layout& layout, const BodyState& state, Numbers& out);

// Pose and motion of one ski.
void fill_pose(const FlexibleSki& ski, const BodyState& state, int first, Pose& out);
void fill_motion(const FlexibleSki& ski, const BodyState& state, int first, Motion& out);

struct Energies {
  double kinetic, potential, elastic;  // (J)

  double sum() const { return kinetic + potential + elastic; }
};
Energies energies(const Body& body, const Layout& layout, const BodyState& state);
double drag_power(const Body& body, const BodyState& state);                           // (W), taken by the air
double push_power(const Body& body, const BodyState& state);                           // (W), given by the push
double damping_power(const Body& body, const Layout& layout, const BodyState& state);  // (W) that the skis dissipate

}  // namespace skisnow
