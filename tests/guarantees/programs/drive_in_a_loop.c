// SPDX-License-Identifier: Apache-2.0

/* The example in C from a loop of its own instead of from callbacks: drive_in_a_loop DOMAIN ROBOTS, or
 * without them all robots of the server that the environment names. */

#include <stdio.h>

#define COHORT_BUILDS_PLUGIN /* for no main but ours */
#include "client_sdk/examples/obstacle_avoidance.c"

enum { most_robots = 64 };

int main(int argc, char** argv) {
  static ObstacleAvoidance robots[most_robots];
  CohortOptions options = {NULL, 0, NULL, "drive_in_a_loop", NULL};
  if (argc == 3) {
    options.domain = (uint32_t)strtoul(argv[1], NULL, 10);
    options.robots = argv[2];
  }
  CohortClient* client = cohort_connect(argc == 3 ? &options : NULL);
  if (client == NULL) return 2;
  CohortEvent event;
  while (cohort_next(client, &event) != cohort_event_end) {
    if (event.robot >= most_robots) return 2;
    if (event.kind == cohort_event_start) {
      start(&robots[event.robot], event.start);
    } else {
      step(&robots[event.robot], event.observation, event.command);
      cohort_answer(client);
    }
  }
  if (event.end != cohort_end_finished) fprintf(stderr, "%s\n", cohort_last_error());
  cohort_close(client);
  return event.end == cohort_end_finished ? 0 : 1;
}
