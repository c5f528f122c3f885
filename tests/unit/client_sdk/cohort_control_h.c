// SPDX-License-Identifier: Apache-2.0

/* Compiled as strict C99, with all warnings: the headers of programs that control a run or look on, and that of kinematic trees. */
#include <cohort/cohort_observer.h>
#include <cohort/cohort_tree.h>

int64_t control_and_look_on(void);
int64_t control_and_look_on(void) {
  const CohortOptions options = {NULL, 1, NULL, "loop", NULL};
  CohortControl* control = cohort_control_connect(&options);
  CohortObserver* observer = cohort_observer_connect(&options);
  int64_t seen = 0;
  if (control != NULL && observer != NULL && cohort_control_step(control, 10) == 0)
    while (cohort_observer_next(observer, 100)) seen += (int64_t)cohort_observer_tick(observer);
  cohort_observer_close(observer);
  cohort_control_close(control);
  return seen;
}
