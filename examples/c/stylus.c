/* A C program as a stylus of irdm-server: presses the object from above and prints the force on the stylus.
 *   cc stylus.c -o stylus $(pkg-config --cflags --libs irdm)
 *   stylus HOST:PORT            in real time, 1000 poses a second
 *   stylus HOST:PORT lockstep   step by step, with a server that runs with --lockstep
 */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "irdm.h"

#define POSES 400

/* Down onto the top of a cube of 12 cm whose centre is the origin. */
static irdm_command pose(int k) {
  const double way = 0.0001 * k;
  irdm_command command;
  memset(&command, 0, sizeof command);
  command.present = 1;
  command.tip[1] = 0.075 - (way < 0.02 ? way : 0.02);
  return command;
}

static irdm_status press(irdm_stylus_client* stylus, int lockstep) {
  const struct timespec millisecond = {0, 1000000};
  for (int k = 0; k < POSES; ++k) {
    const irdm_command command = pose(k);
    irdm_feedback feedback;
    irdm_status status;
    if (lockstep) {
      status = irdm_stylus_step(stylus, &command, &feedback);
    } else {
      status = irdm_stylus_set(stylus, &command);
      nanosleep(&millisecond, NULL);
      if (status == IRDM_OK) status = irdm_stylus_get(stylus, &feedback);
    }
    if (status != IRDM_OK) return status;
    if (k % 50 == 49) printf("%d  %8.5f N%s\n", k + 1, feedback.force[1], feedback.ready ? "" : "  not ready");
  }
  return IRDM_OK;
}

int main(int argc, char** argv) {
  char message[256];
  irdm_stylus_client* stylus = NULL;
  irdm_status status;
  const int lockstep = argc == 3 && strcmp(argv[2], "lockstep") == 0;
  if (argc != 2 && !lockstep) return fputs("usage: stylus HOST:PORT [lockstep]\n", stderr), 2;
  status = irdm_stylus_connect(argv[1], lockstep ? "lockstep = true" : "tip = [0, 0.075, 0]", &stylus, message,
                               sizeof message);
  if (status == IRDM_OK) {
    status = press(stylus, lockstep);
    if (status != IRDM_OK) irdm_stylus_state(stylus, message, sizeof message);
  }
  irdm_stylus_close(stylus);
  if (status != IRDM_OK) fprintf(stderr, "stylus: error: %s\n", message);
  return status == IRDM_OK ? 0 : 1;
}
