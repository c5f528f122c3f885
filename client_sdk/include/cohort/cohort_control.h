#ifndef COHORT_COHORT_CONTROL_H
#define COHORT_COHORT_CONTROL_H

#include <cohort/cohort.h>

/* Controls a run of a Cohort server, in C99 (C++ may include it too). It is the same in C as <cohort/control.hpp> in
 * C++, and does everything that `cohort ctl` does.
 *
 *   CohortControl* control = cohort_control_connect(NULL);
 *   CohortEntityState state;
 *   if (control == NULL || cohort_control_pause(control) != 0 || cohort_control_step(control, 100) != 0 ||
 *       cohort_control_entity_state(control, "explorers/sbot_7", &state) != 0)
 *     fprintf(stderr, "%s\n", cohort_last_error());
 *   cohort_control_close(control);
 *
 * Entities are the objects of the world, robots included, under their scoped names. Poses, twists, forces and
 * torques are in the world frame, in SI units. A boundary is the moment between two ticks. Functions that return int
 * return 0, or -1 if the request failed: cohort_last_error then gives the reason as text, and cohort_control_result
 * as a code. Each function blocks until its reply arrives, at most for the time limit. Returned texts and bytes are
 * valid until the next call with the same handle. Use a handle on one thread at a time, except for
 * cohort_control_cancel. */

#ifdef __cplusplus
extern "C" {
#endif

typedef struct CohortControl CohortControl;

/* Returns at once; the first request waits for a server that is not there yet. Uses `server` (IPv4 address or host
 * name), `domain`, `secure` and `name` of the options like cohort_connect, also if `options` is NULL. Returns NULL
 * if it fails. */
CohortControl* cohort_control_connect(const CohortOptions* options);
/* Frees the handle; NULL is allowed. The server discards the snapshots that it saved, and its recording. */
void cohort_control_close(CohortControl* control);

/* Sets the time limit of each request [ms]. If negative, which is the default: 30 s, and no limit for step, reset,
 * stop, back and load. */
void cohort_control_set_time_limit(CohortControl* control, int64_t milliseconds);
/* Ends the current request and all later ones with cohort_result_interrupted, within about 10 ms. May be called from
 * any thread or a signal handler. */
void cohort_control_cancel(CohortControl* control);

/* Result of a request. Later versions may add values: treat those as cohort_result_failed. */
typedef enum CohortResult {
  cohort_result_ok = 0,
  cohort_result_failed = 1, /* cohort_last_error gives the reason; the world is unchanged */
  cohort_result_feature_unsupported = 2,
  cohort_result_not_found = 3,       /* no such object, light, link or data */
  cohort_result_incorrect_state = 4, /* not possible now */
  cohort_result_name_not_unique = 5,
  cohort_result_name_invalid = 6,
  cohort_result_no_resource = 7,    /* neither a model nor a text was given */
  cohort_result_invalid_pose = 8,   /* the pose of a new object is invalid */
  cohort_result_malformed = 9,      /* a value is not finite or out of range */
  cohort_result_not_permitted = 10, /* the identity does not have the right */
  cohort_result_forgotten = 11,
  cohort_result_no_answer = 12,   /* no reply within the time limit; the request may still be done */
  cohort_result_server_gone = 13, /* the server is no longer there */
  cohort_result_interrupted = 14, /* cohort_control_cancel was called */
  cohort_result_bad_reply = 15    /* the server's reply does not match the request */
} CohortResult;

/* Returns the result of the last request. */
CohortResult cohort_control_result(const CohortControl* control);

/* ---- The reply to the last successful request ---- */

typedef enum CohortSimulationState {
  cohort_simulation_stopped = 0, /* at the beginning, before the first tick */
  cohort_simulation_playing = 1,
  cohort_simulation_paused = 2,
  cohort_simulation_quitting = 3
} CohortSimulationState;

CohortSimulationState cohort_control_state(const CohortControl* control);
uint32_t cohort_control_run(const CohortControl* control);        /* increases after each reset or restore */
uint64_t cohort_control_tick(const CohortControl* control);       /* boundary at which the request was done */
int64_t cohort_control_time_ns(const CohortControl* control);     /* simulated time since tick 0 [ns] */
const char* cohort_control_message(const CohortControl* control); /* description of what was done, for people */

/* ---- Time ---- */

int cohort_control_ask_state(CohortControl* control); /* updates cohort_control_state and the other functions above */
int cohort_control_play(CohortControl* control);      /* does nothing if it is playing */
int cohort_control_pause(CohortControl* control);     /* at the next boundary; does nothing if it is paused */
int cohort_control_stop(CohortControl* control);      /* restarts the run from the beginning, paused */
int cohort_control_quit(CohortControl* control);      /* ends the run and the server */
int cohort_control_step(CohortControl* control, uint64_t steps); /* advances a paused run and waits for it */
int cohort_control_reset(CohortControl* control);                /* restarts from the beginning, with the same seed */
int cohort_control_reset_seed(CohortControl* control, uint64_t seed);
int cohort_control_back(CohortControl* control, int64_t time_ns); /* to the last snapshot kept at or before it */
int cohort_control_set_speed(CohortControl* control,
                             double speed); /* limit of simulated seconds per wall-clock second; 0: no limit */

/* Queries the status of the run. The functions below return it, until the next call of this. */
int cohort_control_ask_status(CohortControl* control);
const char* cohort_control_experiment(const CohortControl* control);
uint64_t cohort_control_seed(const CohortControl* control);
uint64_t cohort_control_state_hash(const CohortControl* control);
bool cohort_control_started(const CohortControl* control);        /* false while controllers are missing at the start */
int64_t cohort_control_step_ns(const CohortControl* control);     /* simulated time between ticks [ns] */
int64_t cohort_control_duration_ns(const CohortControl* control); /* simulated duration of the whole run [ns] */
double cohort_control_speed(const CohortControl* control);
double cohort_control_real_time_factor(const CohortControl* control);
uint32_t cohort_control_robots(const CohortControl* control);
uint32_t cohort_control_awaited(const CohortControl* control); /* number of robots that the run waits for */
size_t cohort_control_controllers(const CohortControl* control);
const char* cohort_control_controller(const CohortControl* control, size_t index); /* its label; NULL beyond the last */

/* Queries a capability of the server: `feature` is a number of simulation_interfaces/msg/SimulatorFeatures. Returns
 * 1 or 0; -1 if the request fails. */
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

/* Queries the names of the entities that contain a match of `filter`, a POSIX extended regular expression; all names
 * if NULL. Returns the number of names, or -1. */
int64_t cohort_control_ask_entities(CohortControl* control, const char* filter);
const char* cohort_control_entity(const CohortControl* control, size_t index); /* NULL beyond the last */

int cohort_control_entity_state(CohortControl* control, const char* entity, CohortEntityState* state);
/* Moves an entity to a pose, at rest, and then sets its velocity. Either may be NULL: it is then unchanged. */
int cohort_control_set_entity_state(CohortControl* control, const char* entity, const CohortPose* pose,
                                    const CohortTwist* twist);
/* Adds a model of the world, such as `sbot`, at rest. `team` is the team that a robot joins; it may be NULL if only
 * one is possible. With `allow_renaming`, chooses another name if this one is taken. Returns the name, or NULL. */
const char* cohort_control_spawn(CohortControl* control, const char* name, const char* model, const CohortPose* pose,
                                 const char* team, bool allow_renaming);
/* Adds a model from a text in SDF, URDF or YAML, otherwise like cohort_control_spawn. */
const char* cohort_control_spawn_text(CohortControl* control, const char* name, const char* text,
                                      const CohortPose* pose, const char* team, bool allow_renaming);
int cohort_control_remove(CohortControl* control, const char* entity);
/* Switches a light. `light` is `object/light`, an object for all of its lights, or a light of the world. `intensity`
 * (>= 0) and `color` (red, green, blue from 0 to 1) may be NULL: they are then unchanged. */
int cohort_control_set_light(CohortControl* control, const char* light, bool on, const double* intensity,
                             const double color[3]);
/* Applies a force and a torque at the centre of mass of `link` (NULL: the root link), for a simulated time of at
 * least one step. `force` [N] and `torque` [N m] are in the world frame; either may be NULL. */
int cohort_control_apply_force(CohortControl* control, const char* entity, const char* link, const double force[3],
                               const double torque[3], int64_t duration_ns);

/* ---- Snapshots and recordings ---- */

/* Gets a snapshot of the run at the next boundary: `*size` bytes at `*bytes`. */
int cohort_control_save(CohortControl* control, const void** bytes, size_t* size);
int cohort_control_load(CohortControl* control, const void* bytes,
                        size_t size); /* continues from a snapshot, as another run */

/* Starts a recording (MCAP). `recorded` is its content in YAML, as in an experiment's `record`; NULL: that of the
 * experiment. One at a time; the server keeps at most 80 MiB of unfetched data. */
int cohort_control_start_recording(CohortControl* control, const char* recorded);
int cohort_control_stop_recording(CohortControl* control); /* the rest can still be fetched */
/* Gets the file's bytes from `offset` on, possibly none; the server discards all earlier bytes. Returns 1, or 0 with
 * the last part, or -1. */
int cohort_control_fetch_recording(CohortControl* control, uint64_t offset, const void** bytes, size_t* size);
/* Writes the whole recording to `file`, until it is stopped or the run ends. */
int cohort_control_save_recording(CohortControl* control, const char* file);

/* ---- Events of the run ---- */

typedef struct CohortRunEvent CohortRunEvent;

uint64_t cohort_run_event_tick(const CohortRunEvent* event);      /* of the first occurrence */
uint64_t cohort_run_event_last_tick(const CohortRunEvent* event); /* of the last occurrence */
uint64_t cohort_run_event_count(const CohortRunEvent* event);
const char* cohort_run_event_kind(const CohortRunEvent* event); /* keyword, for programs */
const char* cohort_run_event_text(const CohortRunEvent* event); /* description, for people */

/* Queries the events since a revision, 0 for all. Sets `*revision` to the value for the next query; revisions start
 * at 0 with each run. Returns the number of events, or -1. */
int64_t cohort_control_ask_history(CohortControl* control, uint64_t* revision);
const CohortRunEvent* cohort_control_event(const CohortControl* control, size_t index); /* NULL beyond the last */

#ifdef __cplusplus
}
#endif

#endif
