// SPDX-License-Identifier: Apache-2.0

/* Compiled as strict C99, with all warnings: all that a controller in C needs. */
#include <cohort/cohort.h>

void drive_in_a_loop(void);
void drive_in_a_loop(void) {
  const CohortOptions options = {NULL, 1, "0..3", "loop", NULL};
  CohortClient* client = cohort_connect(&options);
  CohortEvent event;
  CohortCommandChannel channel = {0, 0, 0.0, 0.0};
  while (client != NULL && cohort_next(client, &event) != cohort_event_end) {
    if (event.kind == cohort_event_start) channel = cohort_find_command(event.start, "treel/left/velocity");
    if (event.kind == cohort_event_observation) cohort_set(event.command, channel, 0.1);
    cohort_answer(client);
  }
  cohort_close(client);
}

static int start(void* self, const CohortStart* start) {
  (void)self;
  return cohort_has_command(start, "treel/left/velocity") ? 0 : cohort_fail("no %s", "tracks");
}

static int step(void* self, const CohortObservation* observation, CohortCommand* command) {
  (void)self, (void)observation, (void)command;
  return 0;
}

COHORT_C_CONTROLLER(Nothing, NULL, start, step, NULL)
