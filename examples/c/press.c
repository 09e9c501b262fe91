/* Presses a soft object from a C program and prints the force on the fingertip, and the contacts.
 *   cc press.c -o press $(pkg-config --cflags --libs irdm)
 *   press SCENE.toml
 */
#include <stdio.h>
#include <string.h>

#include "irdm.h"

#define STEPS 400
#define MOST_CONTACTS 256

static irdm_contact contacts[MOST_CONTACTS];

/* Down onto the top of a cube of 12 cm whose centre is the origin. */
static double height(int step) {
  const double way = 0.0001 * step;
  return 0.075 - (way < 0.02 ? way : 0.02);
}

static int press(irdm_simulation* simulation) {
  const double dt = irdm_simulation_dt(simulation);
  irdm_stylus stylus;
  irdm_object object;
  double impulse = 0.0;
  size_t count = 0;
  for (int k = 0; k < STEPS; ++k) {
    irdm_command command;
    memset(&command, 0, sizeof command);
    command.present = 1;
    command.tip[1] = height(k);
    if (irdm_simulation_step(simulation, &command, 1, &stylus) != IRDM_OK) return 1;
    if (irdm_simulation_contacts(simulation, contacts, MOST_CONTACTS, &count) != IRDM_OK) return 1;
    for (size_t i = 0; i < count; ++i) impulse += contacts[i].force[1] * dt;
    if (k % 50 == 49) printf("%.3f s  %8.5f N  %zu contacts\n", (k + 1) * dt, stylus.force[1], count);
  }
  if (irdm_simulation_objects(simulation, &object, 1) != IRDM_OK) return 1;
  printf("impulse %.9f N s, velocity %.9f m/s\n", impulse, object.velocity[1]);
  return 0;
}

int main(int argc, char** argv) {
  char message[256];
  irdm_simulation* simulation = NULL;
  int status;
  if (argc != 2) return fputs("usage: press SCENE.toml\n", stderr), 2;
  if (irdm_api_version() / 1000 != IRDM_API_MAJOR) return fputs("press: another libirdm\n", stderr), 1;
  if (irdm_simulation_open(argv[1], &simulation, message, sizeof message) != IRDM_OK) {
    fprintf(stderr, "press: error: %s\n", message);
    return 1;
  }
  if (irdm_simulation_stylus_count(simulation) != 1 || irdm_simulation_object_count(simulation) != 1) {
    fputs("press: error: the scene must have one object and one stylus\n", stderr);
    status = 1;
  } else {
    status = press(simulation);
  }
  irdm_simulation_close(simulation);
  return status;
}
