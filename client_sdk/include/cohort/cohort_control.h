#ifndef COHORT_COHORT_CONTROL_H
#define COHORT_COHORT_CONTROL_H

#include <cohort/cohort.h>

/* Controls a run of a Cohort server, in C99 (C++ may include it too): what <cohort/control.hpp> says in C++, and all
 * that `cohort ctl` does.
 *
 *   CohortControl* control = cohort_control_connect(NULL);
 *   CohortEntityState state;
 *   if (control == NULL || cohort_control_pause(control) != 0 || cohort_control_step(control, 100) != 0 ||
 *       cohort_control_entity_state(control, "explorers/sbot_7", &state) != 0)
 *     fprintf(stderr, "%s\n", cohort_last_error());
 *   cohort_control_close(control);
 *
 * Entities are objects of the world under their scoped names, robots or not. Poses, twists, forces and torques are in
 * the world frame, in SI units. Functions that return int return 0, or -1 if the request was not done: then
 * cohort_last_error says why for people, and cohort_control_result for programs. Each blocks until the reply is there,
 * for at most the time limit. Texts and bytes that a function gives are valid until the next call with the same handle.
 * A handle is for one thread at a time, but for cohort_control_cancel. */

#ifdef __cplusplus
extern "C" {
#endif

typedef struct CohortControl CohortControl;

/* Returns at once: the first request waits for a server that is not there yet. `server` (IPv4 address or host name),
 * `domain`, `secure` and `name` of the options are used, as in cohort_connect, also if `options` is NULL. NULL if it
 * fails. */
CohortControl* cohort_control_connect(const CohortOptions* options);
/* Frees it; NULL is allowed. The server forgets the snapshots that it saved, and its recording. */
void cohort_control_close(CohortControl* control);

/* How long each request waits [ms]. Negative, as at first: 30 s, and without end for step, reset, stop, back and
 * load. */
void cohort_control_set_time_limit(CohortControl* control, int64_t milliseconds);
/* Ends the request under way and all later ones with cohort_result_interrupted, within some 10 ms. From any thread, or
 * a signal handler. */
void cohort_control_cancel(CohortControl* control);

/* Why a request was not done. Later versions may add some: treat those as cohort_result_failed. */
typedef enum CohortResult {
  cohort_result_ok = 0,
  cohort_result_failed = 1, /* cohort_last_error says why; the world is as it was */
  cohort_result_feature_unsupported = 2,
  cohort_result_not_found = 3,       /* there is no such object, light, link or data */
  cohort_result_incorrect_state = 4, /* not now */
  cohort_result_name_not_unique = 5,
  cohort_result_name_invalid = 6,
  cohort_result_no_resource = 7,    /* neither a model nor a text was given */
  cohort_result_invalid_pose = 8,   /* of what is spawned */
  cohort_result_malformed = 9,      /* a value is not finite or out of its range */
  cohort_result_not_permitted = 10, /* the identity may not do this */
  cohort_result_forgotten = 11,
  cohort_result_no_answer = 12,   /* within the time limit; what was asked for may still be done */
  cohort_result_server_gone = 13, /* a server was there, and is no longer */
  cohort_result_interrupted = 14, /* cohort_control_cancel was called */
  cohort_result_bad_reply = 15    /* the server sent something else than it was asked for */
} CohortResult;

/* Returns the result of the last request. */
CohortResult cohort_control_result(const CohortControl* control);

/* ---- What the reply to the last request that was done says ---- */

typedef enum CohortSimulationState {
  cohort_simulation_stopped = 0, /* at the beginning, until it plays */
  cohort_simulation_playing = 1,
  cohort_simulation_paused = 2,
  cohort_simulation_quitting = 3
} CohortSimulationState;

CohortSimulationState cohort_control_state(const CohortControl* control);
uint32_t cohort_control_run(const CohortControl* control);        /* higher after each reset or restore */
uint64_t cohort_control_tick(const CohortControl* control);       /* the boundary at which it was done */
int64_t cohort_control_time_ns(const CohortControl* control);     /* simulated, since tick 0 [ns] */
const char* cohort_control_message(const CohortControl* control); /* what was done, for people */

/* ---- Time ---- */

int cohort_control_ask_state(CohortControl* control); /* then cohort_control_state and its like say how the run is */
int cohort_control_play(CohortControl* control);      /* also if it plays already */
int cohort_control_pause(CohortControl* control);     /* at the next boundary; also if it is paused already */
int cohort_control_stop(CohortControl* control);      /* from the beginning, paused */
int cohort_control_quit(CohortControl* control);      /* ends run and server */
int cohort_control_step(CohortControl* control, uint64_t steps); /* makes ticks of a paused run, and waits for them */
int cohort_control_reset(CohortControl* control);                /* from the beginning, with the same seed */
int cohort_control_reset_seed(CohortControl* control, uint64_t seed);
int cohort_control_back(CohortControl* control, int64_t time_ns);   /* to the last kept snapshot at or before it */
int cohort_control_set_speed(CohortControl* control, double speed); /* simulated seconds per second; 0: no limit */

/* Asks how the run is. The functions below say it, until the next call of this. */
int cohort_control_ask_status(CohortControl* control);
const char* cohort_control_experiment(const CohortControl* control);
uint64_t cohort_control_seed(const CohortControl* control);
uint64_t cohort_control_state_hash(const CohortControl* control);
bool cohort_control_started(const CohortControl* control);        /* false while controllers are missing at the start */
int64_t cohort_control_step_ns(const CohortControl* control);     /* simulated time between ticks [ns] */
int64_t cohort_control_duration_ns(const CohortControl* control); /* simulated, of the whole run [ns] */
double cohort_control_speed(const CohortControl* control);
double cohort_control_real_time_factor(const CohortControl* control);
uint32_t cohort_control_robots(const CohortControl* control);
uint32_t cohort_control_awaited(const CohortControl* control); /* robots that the run waits for */
size_t cohort_control_controllers(const CohortControl* control);
const char* cohort_control_controller(const CohortControl* control, size_t index); /* its label; NULL beyond the last */

/* Whether the server can do something: `feature` is a number of simulation_interfaces/msg/SimulatorFeatures. 1 or 0; -1
 * if the request fails. */
int cohort_control_has_feature(CohortControl* control, uint32_t feature);

/* ---- The world ---- */

/* The pose of the origin of an entity's root link in the world frame. */
typedef struct CohortPose {
  double position[3];    /* x y z [m] */
  double orientation[4]; /* quaternion x y z w, of length 1 */
} CohortPose;

typedef struct CohortTwist {
  double linear[3];  /* [m/s] */
  double angular[3]; /* [rad/s] */
} CohortTwist;

typedef struct CohortEntityState {
  CohortPose pose;
  CohortTwist twist;
} CohortEntityState;

/* Asks for the names of all entities, a part of which matches `filter`, a POSIX extended regular expression; all if
 * NULL. Returns how many there are, or -1. */
int64_t cohort_control_ask_entities(CohortControl* control, const char* filter);
const char* cohort_control_entity(const CohortControl* control, size_t index); /* NULL beyond the last */

int cohort_control_entity_state(CohortControl* control, const char* entity, CohortEntityState* state);
/* Puts an entity elsewhere, at rest, and then gives it a velocity. Either may be NULL: it stays as it is. */
int cohort_control_set_entity_state(CohortControl* control, const char* entity, const CohortPose* pose,
                                    const CohortTwist* twist);
/* Adds a model of the world, such as `sbot`, at rest. `team`: that a robot joins; may be NULL where only one is
 * possible. With `allow_renaming` it gets another name if this one is taken. Returns the name that it got, or NULL. */
const char* cohort_control_spawn(CohortControl* control, const char* name, const char* model, const CohortPose* pose,
                                 const char* team, bool allow_renaming);
/* The same of the text of a model in SDF, URDF or YAML. */
const char* cohort_control_spawn_text(CohortControl* control, const char* name, const char* text,
                                      const CohortPose* pose, const char* team, bool allow_renaming);
int cohort_control_remove(CohortControl* control, const char* entity);
/* `light`: `object/light`, an object for all of its lights, or a light of the world. `intensity` (>= 0) and `color`
 * (red, green, blue from 0 to 1) may be NULL: they stay as they are. */
int cohort_control_set_light(CohortControl* control, const char* light, bool on, const double* intensity,
                             const double color[3]);
/* At the centre of mass of `link` (NULL: the root link) for a simulated time, at least one step. `force` [N] and
 * `torque` [N m] are in the world's axes; either may be NULL. */
int cohort_control_apply_force(CohortControl* control, const char* entity, const char* link, const double force[3],
                               const double torque[3], int64_t duration_ns);

/* ---- Snapshots and recordings ---- */

/* Gives the run as it stands at the next boundary: `*bytes`, `*size` of them. */
int cohort_control_save(CohortControl* control, const void** bytes, size_t* size);
int cohort_control_load(CohortControl* control, const void* bytes, size_t size); /* another run, from there */

/* Begins a recording (MCAP). `recorded`: what it holds, in YAML as after an experiment's `record`; NULL: what the
 * experiment says. One at a time; the server keeps at most 80 MiB that was not fetched. */
int cohort_control_start_recording(CohortControl* control, const char* recorded);
int cohort_control_stop_recording(CohortControl* control); /* the rest is still to be fetched */
/* Gives what there is of its file from byte `offset` on, maybe nothing yet; the server forgets what is before. Returns
 * 1, or 0 with the last part, or -1. */
int cohort_control_fetch_recording(CohortControl* control, uint64_t offset, const void** bytes, size_t* size);
/* Writes the whole recording to `file`, until it was stopped or the run has ended. */
int cohort_control_save_recording(CohortControl* control, const char* file);

/* ---- What has happened ---- */

typedef struct CohortRunEvent CohortRunEvent;

uint64_t cohort_run_event_tick(const CohortRunEvent* event);      /* of the first time */
uint64_t cohort_run_event_last_tick(const CohortRunEvent* event); /* of the last time */
uint64_t cohort_run_event_count(const CohortRunEvent* event);
const char* cohort_run_event_kind(const CohortRunEvent* event); /* a word, for programs */
const char* cohort_run_event_text(const CohortRunEvent* event); /* for people */

/* Asks for what has happened since a revision, 0 for all. Gives the revision to ask with next to `*revision`; revisions
 * begin at 0 with each run. Returns how many events there are, or -1. */
int64_t cohort_control_ask_history(CohortControl* control, uint64_t* revision);
const CohortRunEvent* cohort_control_event(const CohortControl* control, size_t index); /* NULL beyond the last */

#ifdef __cplusplus
}
#endif

#endif
