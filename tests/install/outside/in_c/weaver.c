// SPDX-License-Identifier: Apache-2.0

/* weaver.cpp in C. */

#include <cohort/cohort.h>
#include <math.h>
#include <stdlib.h>

enum { most_sensors = 32 };

typedef struct Weaver {
  CohortObservationChannel proximity[most_sensors];
  size_t sensors;
  CohortCommandChannel left;
  CohortCommandChannel right;
  double phase;
} Weaver;

static void* create(void) { return calloc(1, sizeof(Weaver)); }

static int start(void* self, const CohortStart* start) {
  Weaver* weaver = self;
  weaver->sensors = cohort_find_observations(start, "proximity/*/reading", weaver->proximity, most_sensors);
  if (weaver->sensors > most_sensors) return cohort_fail("%zu sensors are too many", weaver->sensors);
  weaver->left = cohort_find_command(start, "treel/left/velocity");
  weaver->right = cohort_find_command(start, "treel/right/velocity");
  weaver->phase = 0.7 * (double)cohort_start_info(start)->robot;
  return 0;
}

static int step(void* self, const CohortObservation* observation, CohortCommand* command) {
  const Weaver* weaver = self;
  const double t = (double)cohort_time_ns(observation) / 1e9;
  double left = 0.0;
  double right = 0.0;
  for (size_t i = 0; i < weaver->sensors; ++i) {
    const double bearing = 2.1 * (double)i + weaver->phase;
    left += cohort_read(observation, weaver->proximity[i]) * sin(bearing);
    right += cohort_read(observation, weaver->proximity[i]) * cos(bearing);
  }
  const double heading = atan2(left, 1.0 + right * right);
  const double wave = 0.05 * sin(3.7 * t + weaver->phase) + 0.01 * log(1.0 + t) + 0.02 * heading;
  cohort_set(command, weaver->left, 0.1 * exp(-0.3 * t) + wave);
  cohort_set(command, weaver->right, 0.1 * cos(0.9 * t) - wave);
  return 0;
}

COHORT_C_CONTROLLER(Weaver, create, start, step, free)
