// SPDX-License-Identifier: Apache-2.0

/* Controls and observes a run through the installed headers in C, each request once, and prints what it saw:
 * experimenter RECORDING. The server's domain is $COHORT_DOMAIN; it stands paused. Exit code 1 names what failed. */

#include <cohort/cohort_control.h>
#include <cohort/cohort_observer.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char* const box =
    "<sdf version='1.9'><model name='box'><static>true</static><link name='body'><collision name='hull'><geometry><box>"
    "<size>0.2 0.2 0.2</size></box></geometry></collision><light name='bulb' type='point'><diffuse>1 1 1 1</diffuse>"
    "<attenuation><range>5</range></attenuation></light></link></model></sdf>";

static void require(bool is_so, const char* what) {
  if (is_so) return;
  fprintf(stderr, "%s: %s\n", what, cohort_last_error());
  exit(1);
}

#define DO(call) require((call) == 0, #call)

static void act(CohortControl* control, const char* recording) {
  const CohortPose place = {{2.0, 2.0, 0.5}, {0.0, 0.0, 0.0, 1.0}};
  const CohortPose elsewhere = {{2.5, 2.0, 0.5}, {0.0, 0.0, 0.0, 1.0}};
  const CohortTwist still = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  const double force[3] = {1.0, 0.0, 0.0}, color[3] = {1.0, 0.0, 0.0}, intensity = 2.0;
  const void* bytes = NULL;
  void* snapshot = NULL;
  size_t size = 0, kept = 0;
  int64_t events = 0;
  uint64_t revision = 0;
  CohortEntityState state;
  int64_t count = 0;
  char* robot = NULL;

  DO(cohort_control_pause(control));
  DO(cohort_control_ask_state(control));
  require(cohort_control_state(control) == cohort_simulation_paused, "it is paused");
  require(cohort_control_has_feature(control, 0) == 1, "it spawns");
  DO(cohort_control_start_recording(control, "{poses: 100}"));
  DO(cohort_control_step(control, 10));
  require(cohort_control_tick(control) == 10 && cohort_control_run(control) == 1, "ten steps");
  require(strcmp(cohort_control_spawn_text(control, "crate", box, &place, NULL, false), "crate") == 0, "a crate");
  require(cohort_control_spawn_text(control, "crate", box, &place, NULL, false) == NULL &&
              cohort_control_result(control) == cohort_result_name_not_unique && cohort_last_error()[0] != '\0',
          "a second crate");
  require(cohort_control_spawn(control, "other", "no model", &place, NULL, true) == NULL, "there is no such model");
  DO(cohort_control_set_light(control, "crate/bulb", true, &intensity, color));
  DO(cohort_control_set_entity_state(control, "crate", &elsewhere, NULL));
  DO(cohort_control_entity_state(control, "crate", &state));
  printf("crate at %g %g %g\n", state.pose.position[0], state.pose.position[1], state.pose.position[2]);
  DO(cohort_control_remove(control, "crate"));
  count = cohort_control_ask_entities(control, NULL);
  require(count > 0 && cohort_control_entity(control, (size_t)count) == NULL, "entities");
  count = cohort_control_ask_entities(control, "sbot");
  require(count == 1, "one robot");
  robot = malloc(strlen(cohort_control_entity(control, 0)) + 1);
  require(robot != NULL, "memory");
  strcpy(robot, cohort_control_entity(control, 0));
  DO(cohort_control_apply_force(control, robot, NULL, force, NULL, 100000000));
  DO(cohort_control_set_entity_state(control, robot, NULL, &still));
  DO(cohort_control_save(control, &bytes, &kept));
  snapshot = malloc(kept);
  require(snapshot != NULL, "memory");
  memcpy(snapshot, bytes, kept);
  DO(cohort_control_step(control, 5));
  DO(cohort_control_stop_recording(control));
  require(cohort_control_fetch_recording(control, 0, &bytes, &size) >= 0 && size > 8, "a part of the recording");
  DO(cohort_control_save_recording(control, recording));
  DO(cohort_control_load(control, snapshot, kept));
  require(cohort_control_tick(control) == 10 && cohort_control_run(control) == 2, "back at the snapshot");
  require(cohort_control_ask_history(control, &revision) >= 0 && cohort_control_event(control, 9999) == NULL,
          "history");
  DO(cohort_control_reset_seed(control, 5));
  revision = 0; /* of another run */
  DO(cohort_control_set_speed(control, 0.0));
  events = cohort_control_ask_history(control, &revision);
  require(events >= 1, "the speed is an event");
  for (int64_t i = 0; i < events; ++i)
    printf("event %s\n", cohort_run_event_kind(cohort_control_event(control, (size_t)i)));
  DO(cohort_control_back(control, 0));
  DO(cohort_control_reset(control));
  DO(cohort_control_ask_status(control));
  printf("%s with seed %d: %u robot at tick %d, step %d ms\n", cohort_control_experiment(control),
         (int)cohort_control_seed(control), cohort_control_robots(control), (int)cohort_control_tick(control),
         (int)(cohort_control_step_ns(control) / 1000000));
  free(robot);
  free(snapshot);
}

static void look_on(CohortControl* control, CohortObserver* observer) {
  uint32_t id = 99;
  require(cohort_observer_ask_robots(observer, 60000) == 1, "robots");
  printf("robot %s of %s\n", cohort_observer_robot(observer, 0, &id), cohort_observer_model(observer, 0));
  require(id == 0 && cohort_observer_robot(observer, 1, NULL) == NULL, "one robot");
  do {
    DO(cohort_control_step(control, 1));
  } while (!cohort_observer_next(observer, 100));
  require(cohort_observer_poses(observer) == 1 && cohort_observer_pose(observer, 0, &id) != NULL && id == 0, "a pose");
  require(cohort_observer_pose(observer, 1, NULL) == NULL, "one pose");
  require(cohort_observer_ask_events(observer, 60000) >= 0, "events");
  require(cohort_observer_ended(observer) == cohort_observer_goes_on, "no end");
  require(cohort_observer_descriptor(observer) >= 0, "a descriptor");
}

int main(int argc, char** argv) {
  CohortControl* const control = cohort_control_connect(NULL);
  CohortObserver* const observer = cohort_observer_connect(NULL);
  require(argc == 2, "expected a file for the recording");
  require(control != NULL && observer != NULL, "connect");
  act(control, argv[1]);
  look_on(control, observer);
  DO(cohort_control_play(control));
  DO(cohort_control_stop(control));
  DO(cohort_control_quit(control));
  while (cohort_observer_ended(observer) == cohort_observer_goes_on) cohort_observer_next(observer, 1000);
  printf("the end: %s\n", cohort_observer_ended(observer) == cohort_observer_run_ended ? "told" : "gone");
  cohort_control_cancel(control);
  require(cohort_control_pause(control) == -1 && cohort_control_result(control) == cohort_result_interrupted,
          "cancelled");
  cohort_observer_close(observer);
  cohort_control_close(control);
  return 0;
}
