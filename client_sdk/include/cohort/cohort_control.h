// SPDX-License-Identifier: Apache-2.0
#ifndef COHORT_COHORT_CONTROL_H
#define COHORT_COHORT_CONTROL_H

#include <cohort/cohort.h>

/* Functions that control a run of a Cohort server, in C99 (C++ can also include them), for programs that do what
 * `cohort ctl` does. They are the C equivalent of <cohort/control.hpp>.
 *
 *   CohortControl* control = cohort_control_connect(NULL);
 *   CohortEntityState state;
 *   if (control == NULL || cohort_control_pause(control) != 0 || cohort_control_step(control, 100) != 0 ||
 *       cohort_control_entity_state(control, "explorers/sbot_7", &state) != 0)
 *     fprintf(stderr, "%s\n", cohort_last_error());
 *   cohort_control_close(control);
 *
 * Entities are the objects of the world, including robots, and are identified by their scoped names. Poses, twists,
 * forces and torques are in the world frame, in SI units. A boundary is the moment between two ticks. Functions that
 * return int return 0, or -1 if the request failed. cohort_last_error then returns the reason as text, and
 * cohort_control_result as a code. Each function blocks until its reply arrives, at most for the time limit. Returned
 * strings and bytes are valid until the next call with the same handle. Use a handle on one thread at a time, except
 * for cohort_control_cancel. */

#ifdef __cplusplus
extern "C" {
#endif

typedef struct CohortControl CohortControl;

/* Connects to a server. Does not block; the first request waits until there is a server. Uses `server` (IPv4 address
 * or host name), `domain`, `secure` and `name` of the options like cohort_connect, even if `options` is NULL. Returns
 * NULL if it fails. */
CohortControl* cohort_control_connect(const CohortOptions* options);
/* Disconnects and frees the handle, which may be NULL. The server discards this program's saved snapshots and
 * recording. */
void cohort_control_close(CohortControl* control);

/* Sets the time limit of each request [ms]. A negative value, the default, means 30 s, and no limit for step, reset,
 * stop, back and load. */
void cohort_control_set_time_limit(CohortControl* control, int64_t milliseconds);
/* Interrupts the current request and all later ones, which end with cohort_result_interrupted within about 10 ms. May
 * be called from any thread or from a signal handler. */
void cohort_control_cancel(CohortControl* control);

/* The result of a request. Servers of 0.2 and before send cohort_result_failed instead of the values from 16 on. Later
 * versions may add values: treat unknown values as cohort_result_failed. */
typedef enum CohortResult {
  cohort_result_ok = 0,
  cohort_result_failed = 1, /* none of the other reasons; cohort_last_error gives it. The world is unchanged */
  cohort_result_feature_unsupported = 2,
  cohort_result_not_found = 3,       /* no such object or data */
  cohort_result_incorrect_state = 4, /* not possible now */
  cohort_result_name_not_unique = 5,
  cohort_result_name_invalid = 6,
  cohort_result_no_resource = 7,    /* neither the name nor the text of a model was given */
  cohort_result_invalid_pose = 8,   /* the pose of a new object is invalid */
  cohort_result_malformed = 9,      /* a value is not finite or out of range */
  cohort_result_not_permitted = 10, /* the client's identity does not have this right */
  cohort_result_forgotten = 11,
  cohort_result_no_answer = 12,         /* no reply within the time limit; the request may still be executed */
  cohort_result_server_gone = 13,       /* the server has crashed or exited */
  cohort_result_interrupted = 14,       /* cohort_control_cancel was called */
  cohort_result_bad_reply = 15,         /* the server's reply does not match the request */
  cohort_result_too_many_requests = 16, /* too many requests of this client or its identity wait */
  cohort_result_cancelled = 17,         /* a change of state or the end of the run cancelled the remaining steps */
  cohort_result_not_paused = 18,        /* a run that plays cannot be stepped */
  cohort_result_time_not_held = 19,     /* this client does not hold the run's time */
  cohort_result_link_not_found = 20,    /* the object has no such link */
  cohort_result_light_not_found = 21,   /* no such light, or its object is not in the world */
  cohort_result_immovable = 22,         /* the object is static, or fixed to the world */
  cohort_result_quarantined = 23,       /* the object has left the world, or its state is no longer finite */
  cohort_result_unknown_model = 24,     /* the world has no model of this name */
  cohort_result_invalid_model = 25,     /* the text of the model cannot be read */
  cohort_result_missing_file = 26, /* the text of the model refers to a file that the server's world does not have */
  cohort_result_unsupported_model = 27, /* the physics of this run cannot simulate the model, or not at this pose */
  cohort_result_invalid_team = 28, /* no such team, or the robot needs the name of one, or the model is not a robot */
  cohort_result_too_many_objects = 29,    /* no more objects can be added in this run */
  cohort_result_too_large = 30,           /* the data exceed what can be sent */
  cohort_result_invalid_snapshot = 31,    /* the snapshot is damaged, or of another experiment or version */
  cohort_result_not_saved = 32,           /* the state of the run or of a controller cannot be saved */
  cohort_result_already_recording = 33,   /* this client has a recording */
  cohort_result_too_many_recordings = 34, /* the run has as many live recordings as it can have */
  cohort_result_invalid_selection = 35    /* the selection of the recording's contents cannot be read */
} CohortResult;

/* Returns the result of the last request. */
CohortResult cohort_control_result(const CohortControl* control);

/* ---- The reply to the last successful request ---- */

typedef enum CohortSimulationState {
  cohort_simulation_stopped = 0, /* at the start of the run, before the first tick */
  cohort_simulation_playing = 1,
  cohort_simulation_paused = 2,
  cohort_simulation_quitting = 3
} CohortSimulationState;

CohortSimulationState cohort_control_state(const CohortControl* control); /* state of the run after the request */
uint32_t cohort_control_run(const CohortControl* control);  /* number of the run; increases after a reset or restore */
uint64_t cohort_control_tick(const CohortControl* control); /* tick boundary at which the request was executed */
int64_t cohort_control_time_ns(const CohortControl* control);     /* simulated time since tick 0 [ns] */
const char* cohort_control_message(const CohortControl* control); /* human-readable description of the result */

/* ---- Time ---- */

int cohort_control_ask_state(CohortControl* control); /* updates the results of the functions above */
int cohort_control_play(CohortControl* control);      /* resumes the run; does nothing if it is playing */
int cohort_control_pause(CohortControl* control);     /* pauses the run at the next boundary; does nothing if paused */
int cohort_control_stop(CohortControl* control);      /* restarts the run from the beginning, paused */
int cohort_control_quit(CohortControl* control);      /* ends the run and the server */
int cohort_control_step(CohortControl* control, uint64_t steps); /* advances a paused run; returns when done */
int cohort_control_reset(CohortControl* control); /* restarts the run from the beginning, with the same seed */
int cohort_control_reset_seed(CohortControl* control, uint64_t seed);
/* Returns the run to the last kept snapshot at or before a simulated time. */
int cohort_control_back(CohortControl* control, int64_t time_ns);
int cohort_control_set_speed(CohortControl* control, double speed); /* limits the real-time factor; 0: no limit */

/* Queries the status of the run. The functions below return parts of the last status that was queried. */
int cohort_control_ask_status(CohortControl* control);
const char* cohort_control_experiment(const CohortControl* control);
uint64_t cohort_control_seed(const CohortControl* control);
uint64_t cohort_control_state_hash(const CohortControl* control);
bool cohort_control_started(const CohortControl* control);        /* false while controllers are missing at the start */
int64_t cohort_control_step_ns(const CohortControl* control);     /* simulated time between ticks [ns] */
int64_t cohort_control_duration_ns(const CohortControl* control); /* total simulated duration of the run [ns] */
double cohort_control_speed(const CohortControl* control);
double cohort_control_real_time_factor(const CohortControl* control);
uint32_t cohort_control_robots(const CohortControl* control);
uint32_t cohort_control_awaited(const CohortControl* control); /* number of robots that the run waits for */
size_t cohort_control_controllers(const CohortControl* control);
const char* cohort_control_controller(const CohortControl* control, size_t index); /* label; NULL beyond the last */

/* Queries whether the server supports a feature, a number of simulation_interfaces/msg/SimulatorFeatures. Returns 1
 * if it does, 0 if not, and -1 if the request fails. */
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

/* Queries the names of the entities whose name contains a match of `filter`, a POSIX extended regular expression;
 * NULL selects all entities. Returns the number of names, or -1. */
int64_t cohort_control_ask_entities(CohortControl* control, const char* filter);
const char* cohort_control_entity(const CohortControl* control, size_t index); /* one of them; NULL beyond the last */

int cohort_control_entity_state(CohortControl* control, const char* entity, CohortEntityState* state);
/* Moves an entity to `pose` and stops it, then sets its velocity to `twist`. Either may be NULL and is then
 * unchanged. */
int cohort_control_set_entity_state(CohortControl* control, const char* entity, const CohortPose* pose,
                                    const CohortTwist* twist);
/* Adds an entity at rest. `model` is the name of a model in the world, such as `sbot`. `team` is the team that a
 * robot joins; it may be NULL if only one is possible. With `allow_renaming`, the server chooses another name if
 * `name` is taken. Returns the name of the entity, or NULL if the request fails. */
const char* cohort_control_spawn(CohortControl* control, const char* name, const char* model, const CohortPose* pose,
                                 const char* team, bool allow_renaming);
/* Adds an entity like cohort_control_spawn, with a model from `text` in SDF, URDF or YAML. */
const char* cohort_control_spawn_text(CohortControl* control, const char* name, const char* text,
                                      const CohortPose* pose, const char* team, bool allow_renaming);
int cohort_control_remove(CohortControl* control, const char* entity);
/* Switches lights on or off and sets their properties. `light` is `object/light`, the name of an object (all of its
 * lights), or a light of the world. `intensity` (>= 0) and `color` (red, green, blue from 0 to 1) may be NULL and are
 * then unchanged. */
int cohort_control_set_light(CohortControl* control, const char* light, bool on, const double* intensity,
                             const double color[3]);
/* Applies a force and a torque at the centre of mass of `link` (NULL: the root link), for a simulated time of at
 * least one step. `force` [N] and `torque` [N m] are expressed in the world frame; either may be NULL. */
int cohort_control_apply_force(CohortControl* control, const char* entity, const char* link, const double force[3],
                               const double torque[3], int64_t duration_ns);

/* ---- Snapshots and recordings ---- */

/* Gets a snapshot of the run at the next boundary. Sets `*bytes` and `*size`. */
int cohort_control_save(CohortControl* control, const void** bytes, size_t* size);
/* Continues from a snapshot, as a new run. */
int cohort_control_load(CohortControl* control, const void* bytes, size_t size);

/* Starts a recording (MCAP). `recorded` defines its contents in YAML, like an experiment's key `record`; if it is
 * NULL, the experiment's key applies. A client can have one recording at a time. The server keeps at most 80 MiB of
 * unfetched data. */
int cohort_control_start_recording(CohortControl* control, const char* recorded);
int cohort_control_stop_recording(CohortControl* control); /* the remaining data can still be fetched */
/* Gets bytes of the recording file from `offset` on, possibly none; the server discards all earlier bytes. Returns 0
 * for the last part, otherwise 1, and -1 if it fails. */
int cohort_control_fetch_recording(CohortControl* control, uint64_t offset, const void** bytes, size_t* size);
/* Writes the whole recording to `file`. Blocks until the recording is stopped or the run ends. */
int cohort_control_save_recording(CohortControl* control, const char* file);

/* ---- Events of the run ---- */

typedef struct CohortRunEvent CohortRunEvent;

uint64_t cohort_run_event_tick(const CohortRunEvent* event);      /* tick of the first occurrence */
uint64_t cohort_run_event_last_tick(const CohortRunEvent* event); /* tick of the last occurrence */
uint64_t cohort_run_event_count(const CohortRunEvent* event);
const char* cohort_run_event_kind(const CohortRunEvent* event); /* keyword, for programs */
const char* cohort_run_event_text(const CohortRunEvent* event); /* human-readable description */

/* Queries the events since `*revision`, 0 for all events. Sets `*revision` to the value for the next query; revisions
 * start at 0 with each run. Returns the number of events, or -1. */
int64_t cohort_control_ask_history(CohortControl* control, uint64_t* revision);
/* Returns one of these events, or NULL beyond the last. */
const CohortRunEvent* cohort_control_event(const CohortControl* control, size_t index);

#ifdef __cplusplus
}
#endif

#endif
