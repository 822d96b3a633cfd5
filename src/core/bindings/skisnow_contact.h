/* Runners in snow that remembers, for programs in C and all that can call C.
 *
 * Arrays are row by row, in SI, in the slope's axes: x and y along it, z out of the snow. With k runners:
 *   position  (k, 3)     of the boots (m)
 *   rotation  (k, 3, 3)  columns point ahead, left across the base, and off the base
 *   velocity  (k, 6)     of the boots (m/s), and angular (rad/s)
 *   beams     runner after runner (nodes, 3): deflection off the base (m), its slope towards the tail, twist; or their
 *             rates; NULL for rigid runners. A rigid runner among beams has two nodes, its ends.
 *   dt                   time since the last accepted pose (s)
 *
 * Every function gives SKISNOW_OK or says what is wrong: by its code, and in words by skisnow_contact_message. Nothing
 * is thrown, nothing is written on failure. One contact may be used by one thread at a time, contacts of one snow too.
 * Equations: docs/methods/contact.md of skisnow.
 */
#ifndef SKISNOW_CONTACT_H
#define SKISNOW_CONTACT_H

#include <stddef.h>

#if defined(_WIN32)
#define SKISNOW_API __declspec(dllexport)
#else
#define SKISNOW_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

enum skisnow_result {
  SKISNOW_OK = 0,
  SKISNOW_BAD_ARGUMENT = 1, /* a number or a pointer that cannot be */
  SKISNOW_NO_MEMORY = 2,
  SKISNOW_FAILED = 3 /* anything else */
};

typedef struct skisnow_contact skisnow_contact; /* runners in a snow */
typedef struct skisnow_state skisnow_state;     /* all that a contact remembers, to go back to */

/* What the snow is. skisnow_snow_defaults fills in all but the first three, which have none. */
typedef struct skisnow_snow {
  double snow_hardness;        /* H_V (N/m^3), > 0 */
  double failure_shear_stress; /* S_f (N/m^2), >= 0 */
  double unloading_ratio;      /* k_u/H_V, >= 1 */
  /* friction acts against the sliding velocity in the surface; 1: only by its part along the ski, and along the ski */
  int friction_along_ski;
  /* mu = constant + linear v + square v^2 + film/(1 + v/film_speed); stick_displacement (m): way of the base to full
   * friction, until which it sticks */
  double friction_constant, friction_linear, friction_square, friction_film, friction_film_speed, stick_displacement;
  double shear_displacement;      /* of an edge across to its full strength (m), > 0 */
  int compaction_resistance;      /* whether snow that is pressed down resists along the edge */
  double knot_area;               /* share of depth times width below which a knot of the ground is dropped */
  double part_along, part_across; /* longest way (m) over which the history advances at once, > 0 */
  double spacing;                 /* of the lines of snow along a runner (m), > 0 */
  /* heights (m) over a grid, (nx, ny), from (x0, y0) in steps of dx and dy; NULL: the plane z = 0 */
  const double* surface;
  int surface_nx, surface_ny;
  double surface_x0, surface_dx, surface_y0, surface_dy;
} skisnow_snow;

/* The shape of a base that slides on snow. */
typedef struct skisnow_runner {
  int positions;             /* >= 2 */
  const double* position;    /* along it from its boot, positive ahead (m), falling from tip to tail */
  const double* half_width;  /* (m), > 0 */
  const double* base_height; /* of the unloaded base off the snow, 0 at the boot (m) */
  int nodes;                 /* of a beam; 0: rigid */
  const double* node;        /* their positions (m), falling, the first at the tip, the last at the tail */
  /* how the edges are ground: angle (rad) and width (m) of a strip of the base, angle between base and side (rad; 0: a
   * right angle), radius of the corner (m); all 0: sharp and flat */
  double base_bevel, edge_width, side_edge, edge_radius;
} skisnow_runner;

/* Fingerprint of the sources that the library was built from. */
SKISNOW_API const char* skisnow_contact_sources(void);

SKISNOW_API void skisnow_snow_defaults(skisnow_snow* snow);

/* Runners in a snow of their own. Where it fails *contact is NULL, and `message` (of `size` bytes, or NULL) says why.
 */
SKISNOW_API int skisnow_contact_new(const skisnow_snow* snow, const skisnow_runner* runner, int runners,
                                    skisnow_contact** contact, char* message, size_t size);
/* Others in the snow of a contact that is there: each meets the tracks that the others have left. */
SKISNOW_API int skisnow_contact_join(const skisnow_contact* other, const skisnow_runner* runner, int runners,
                                     skisnow_contact** contact, char* message, size_t size);
SKISNOW_API void skisnow_contact_free(skisnow_contact* contact);
/* In words, what was wrong with the last call that failed; empty: nothing yet. */
SKISNOW_API const char* skisnow_contact_message(const skisnow_contact* contact);

/* Forces at a pose, of which nothing is remembered: wrench (k, 6), force (N) and moment (N m) about each boot; loads on
 * the beams as their unknowns (force, and moments on slope and twist), or NULL. */
SKISNOW_API int skisnow_contact_force(skisnow_contact* contact, const double* position, const double* rotation,
                                      const double* velocity, double dt, const double* beams, const double* rates,
                                      double* wrench, double* beam_loads);
/* Minus the derivatives of each wrench by its own runner's pose and by its velocity, (k, 6, 6) each. */
SKISNOW_API int skisnow_contact_tangent(skisnow_contact* contact, const double* position, const double* rotation,
                                        const double* velocity, double dt, const double* beams, const double* rates,
                                        double* stiffness, double* damping);
/* The step to a pose is accepted: the snow remembers all that the runners met on the way. */
SKISNOW_API int skisnow_contact_update(skisnow_contact* contact, const double* position, const double* rotation,
                                       double dt, const double* beams);

/* What a contact remembers, and back to it: what follows has the same bits. A state serves the contact that it is of;
 * tracks in its snow that came later are forgotten with it. Refused where tracks of the state itself were forgotten
 * since, because an earlier one was loaded. */
SKISNOW_API int skisnow_contact_save(skisnow_contact* contact, skisnow_state** state);
SKISNOW_API int skisnow_contact_load(skisnow_contact* contact, const skisnow_state* state);
SKISNOW_API void skisnow_state_free(skisnow_state* state);

/* All that a contact remembers now, with the tracks in its snow, as bytes: for a file, or for another process on any
 * machine. `write` needs room for as many as `size` names. `read` is for a contact of equal runners and spacing in
 * equal snow: what follows has the same bits. All other tracks in its snow are forgotten, and with them the states that
 * were saved before. Bytes that are damaged, not complete, of other runners or of another snow are refused, and nothing
 * changes. Of contacts in one snow write all at one moment, and read all, into contacts made in the same order. */
SKISNOW_API int skisnow_contact_state_size(skisnow_contact* contact, size_t* size);
SKISNOW_API int skisnow_contact_state_write(skisnow_contact* contact, unsigned char* bytes, size_t size);
SKISNOW_API int skisnow_contact_state_read(skisnow_contact* contact, const unsigned char* bytes, size_t size);

#ifdef __cplusplus
}
#endif

#endif
