/* A ski along a recorded motion, from C: forces out.
 *
 *     cc contact_in_c.c -I HEADERS LIBRARY -Wl,-rpath,FOLDER_OF_LIBRARY -lm -o contact_in_c
 *     ./contact_in_c MOTION FORCES
 *
 * HEADERS and LIBRARY: python -c "from skisnow.contact import c_header, c_library; print(c_header().parent,
 * c_library())"
 *
 * MOTION: doubles as this machine writes them, 19 in a row: place of the boot (3), rotation (9), velocity (6), dt.
 * FORCES: 6 in a row, force (N) and moment about the boot (N m).
 */
#include <stdio.h>
#include <stdlib.h>

#include "skisnow_contact.h"

static int complain(const char* what, const char* why) {
  fprintf(stderr, "%s: %s\n", what, why);
  return EXIT_FAILURE;
}

int main(int count, char** words) {
  if (count != 3) return complain(words[0], "needs a file of motion and one for the forces");
  FILE* motion = fopen(words[1], "rb");
  FILE* forces = fopen(words[2], "wb");
  if (motion == NULL || forces == NULL) return complain(words[motion == NULL ? 1 : 2], "cannot be opened");

  const double place[] = {0.8, 0.0, -0.8}, half_width[] = {0.05, 0.033, 0.045}, base_height[] = {0.01, 0.0, 0.004};
  const skisnow_runner ski = {3, place, half_width, base_height, 0, NULL, 0, 0, 0, 0};
  skisnow_snow snow;
  skisnow_snow_defaults(&snow);
  snow.snow_hardness = 2e8;        /* N/m^3: 0.2 N/mm^3, a hard piste */
  snow.failure_shear_stress = 3e5; /* N/m^2 */
  snow.unloading_ratio = 10.0;
  snow.friction_constant = 0.04;

  char why[200];
  skisnow_contact* contact;
  if (skisnow_contact_new(&snow, &ski, 1, &contact, why, sizeof why) != SKISNOW_OK) return complain("no contact", why);

  double row[19], wrench[6];
  while (fread(row, sizeof(double), 19, motion) == 19) {
    const double *position = row, *rotation = row + 3, *velocity = row + 12, dt = row[18];
    /* a look, as often as one likes; then the step is accepted, and the snow remembers it */
    if (skisnow_contact_force(contact, position, rotation, velocity, dt, NULL, NULL, wrench, NULL) != SKISNOW_OK ||
        skisnow_contact_update(contact, position, rotation, dt, NULL) != SKISNOW_OK)
      return complain("contact", skisnow_contact_message(contact));
    fwrite(wrench, sizeof(double), 6, forces);
  }
  skisnow_contact_free(contact);
  fclose(motion);
  return fclose(forces) == 0 ? EXIT_SUCCESS : complain(words[2], "cannot be written");
}
