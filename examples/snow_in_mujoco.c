/* skisnow's snow as MuJoCo's passive force, in C: mjcb_passive = snow_passive.
 *
 *     cc -shared -fPIC snow_in_mujoco.c -I MUJOCO/include -I HEADERS LIBRARY MUJOCO/libmujoco.so… -lm -o
 * snow_in_mujoco.so
 *
 * MUJOCO: the folder of MuJoCo. HEADERS and LIBRARY: python -c "from skisnow.contact import c_header, c_library;
 * print(c_header().parent, c_library())". From Python, after snow_open: mujoco.set_mjcb_passive(library.snow_passive),
 * `library` by ctypes: MuJoCo then calls it without Python in between.
 */
#include <math.h>
#include <mujoco/mujoco.h>

#include "skisnow_contact.h"

#define MOST 8

static skisnow_contact* contact = NULL;
static int sites[MOST], runners = 0;
static double accepted = NAN; /* time of the last accepted pose */

/* The same runner at each of these sites, in snow of H_V (N/m^3), S_f (N/m^2), k_u/H_V and friction; 0: done. */
int snow_open(const double* snow_numbers, const double* position, const double* half_width, const double* base_height,
              int positions, const int* at, int count) {
  skisnow_runner shapes[MOST];
  skisnow_snow snow;
  if (count > MOST) return SKISNOW_BAD_ARGUMENT;
  skisnow_snow_defaults(&snow);
  snow.snow_hardness = snow_numbers[0];
  snow.failure_shear_stress = snow_numbers[1];
  snow.unloading_ratio = snow_numbers[2];
  snow.friction_constant = snow_numbers[3];
  for (int k = 0; k < count; k++) {
    const skisnow_runner shape = {positions, position, half_width, base_height, 0, NULL, 0, 0, 0, 0};
    shapes[k] = shape;
    sites[k] = at[k];
  }
  skisnow_contact_free(contact);
  runners = count;
  accepted = NAN;
  return skisnow_contact_new(&snow, shapes, count, &contact, NULL, 0);
}

void snow_close(void) {
  skisnow_contact_free(contact);
  contact = NULL;
}

/* The force at a step's beginning; the pose there enters the snow's history once. */
void snow_passive(const mjModel* model, mjData* data) {
  double position[3 * MOST], rotation[9 * MOST], velocity[6 * MOST], wrench[6 * MOST];
  const double since = isnan(accepted) ? 0.0 : data->time - accepted;
  if (contact == NULL) return;
  for (int k = 0; k < runners; k++) {
    mjtNum found[6]; /* angular velocity first */
    mj_objectVelocity(model, data, mjOBJ_SITE, sites[k], found, 0);
    for (int i = 0; i < 3; i++) {
      position[3 * k + i] = data->site_xpos[3 * sites[k] + i];
      velocity[6 * k + i] = found[3 + i];
      velocity[6 * k + 3 + i] = found[i];
    }
    for (int i = 0; i < 9; i++) rotation[9 * k + i] = data->site_xmat[9 * sites[k] + i];
  }
  if (skisnow_contact_force(contact, position, rotation, velocity, since, NULL, NULL, wrench, NULL) != SKISNOW_OK)
    mju_error("%s", skisnow_contact_message(contact));
  if (isnan(accepted) || since > 0.0) {
    if (skisnow_contact_update(contact, position, rotation, since, NULL) != SKISNOW_OK)
      mju_error("%s", skisnow_contact_message(contact));
    accepted = data->time;
  }
  for (int k = 0; k < runners; k++)
    mj_applyFT(model, data, wrench + 6 * k, wrench + 6 * k + 3, position + 3 * k, model->site_bodyid[sites[k]],
               data->qfrc_passive);
}
