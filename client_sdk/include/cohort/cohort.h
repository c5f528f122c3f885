// SPDX-License-Identifier: Apache-2.0
#ifndef COHORT_COHORT_H
#define COHORT_COHORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The interface for authors of controllers in C (C99; C++ can also include it). It is the C equivalent of
 * <cohort/controller.hpp>, and gives bit-identical results. There are two ways to use it:
 *
 * - Callbacks: define four functions, and use COHORT_C_CONTROLLER at the end of the source file.
 *   `cohort_add_controller` in CMake then builds a program and a plugin.
 * - Your own loop: call cohort_connect, cohort_next, cohort_answer and cohort_close, for firmware with its own
 *   `main`.
 *
 * Values are float64 in SI units. The documentation of each device (docs/reference) defines the quantities and the
 * frames of its channels. Cohort owns the memory of returned pointers unless stated otherwise. No function throws or
 * ends the program, and no callback may throw or call longjmp. The SDK calls all callbacks of a process on one
 * thread, one after the other. Call the functions of a loop from one thread at a time. */

#ifdef __cplusplus
extern "C" {
#define COHORT_EXTERN extern "C"
#else
#define COHORT_EXTERN extern
#endif

/* ---- Errors ---- */

/* Returns the error message of the last failed call on this thread since the current callback started, or "" if no
 * call has failed. Valid until the next call fails. */
const char* cohort_last_error(void);

/* Reports the failure of a callback: `return cohort_fail("no %s", what);`. Takes the arguments of printf, stores the
 * message as the last error, and returns -1. */
int cohort_fail(const char* format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 1, 2)))
#endif
    ;

/* ---- Start ---- */

/* The reason why a robot's controller is started. */
typedef enum CohortStartReason {
  cohort_start_first,    /* the run begins */
  cohort_start_takeover, /* another process drove this robot before; the run continues from `tick` */
  cohort_start_reset,    /* the world was rebuilt */
  cohort_start_restored, /* the world was restored from a snapshot */
  cohort_start_check     /* `cohort check --load-controllers` and `cohort run` test the start; no step follows */
} CohortStartReason;

typedef struct CohortStartInfo {
  uint32_t robot;         /* id in this run */
  const char* name;       /* scoped name, such as `explorers/sbot_7` */
  const char* model;      /* such as `sbot` */
  const char* team;       /* name of the robot's team in the experiment file */
  const char* controller; /* name of the team's controller in the experiment file */
  CohortStartReason reason;
  uint64_t tick;   /* tick of the next observation */
  uint64_t seed;   /* random seed for the controller; derived from the experiment's seed and the robot's name */
  int64_t step_ns; /* simulated time between ticks [ns] */
  uint32_t period; /* number of ticks from one observation to the next */
} CohortStartInfo;

/* The information that a controller receives at its start: before its first step, and after each reset, restore and
 * takeover. The object and its strings are valid until the callback returns or until the next cohort_next.
 *
 * The results of the functions below need not be checked: the first error during a start ends the run with its
 * message, even if the callback returns 0. */
typedef struct CohortStart CohortStart;

const CohortStartInfo* cohort_start_info(const CohortStart* start);

/* ---- Channels ---- */

/* A handle of an observation channel: `size` values in the robot's observation, from index `offset` on. Valid until
 * the robot's next start; `size` is 0 if the lookup failed. */
typedef struct CohortObservationChannel {
  uint32_t offset;
  uint32_t size;
} CohortObservationChannel;

/* A handle of a command channel, like CohortObservationChannel. `lower` and `upper` are infinite if there are no
 * bounds. */
typedef struct CohortCommandChannel {
  uint32_t offset;
  uint32_t size;
  double lower;
  double upper;
} CohortCommandChannel;

/* Returns the channel with the name `device/index/quantity`, such as `turret/0/position`. An unknown name is an
 * error, whose message lists similar names. */
CohortObservationChannel cohort_find_observation(const CohortStart* start, const char* name);
CohortCommandChannel cohort_find_command(const CohortStart* start, const char* name);

/* Finds all channels whose names match `pattern`, in the order of their values. Writes the first `capacity` handles
 * to `channels` and returns the number of matches. `*` matches any characters except `/`. No match is an error; the
 * result is then 0. */
size_t cohort_find_observations(const CohortStart* start, const char* pattern, CohortObservationChannel* channels,
                                size_t capacity);
size_t cohort_find_commands(const CohortStart* start, const char* pattern, CohortCommandChannel* channels,
                            size_t capacity);

/* Returns true if there is a channel with this name; false is not an error. */
bool cohort_has_observation(const CohortStart* start, const char* name);
bool cohort_has_command(const CohortStart* start, const char* name);

/* ---- Parameters of the team in the experiment file ----
 *
 * Keys of nested maps are joined by '.'. Read every parameter at the start: a parameter that is not read is reported
 * as an error in the file. In your own loop, this is an error only if the loop has read another parameter of the robot
 * before it answers the start event. A bridge, which reads none, may drive robots whose parameters are for another
 * controller. The functions return `fallback` if the parameter is missing. A parameter of the wrong type is an error;
 * the result is then also `fallback`. */

bool cohort_has_parameter(const CohortStart* start, const char* name); /* also marks it as read */
double cohort_real(const CohortStart* start, const char* name, double fallback);
int64_t cohort_whole(const CohortStart* start, const char* name, int64_t fallback); /* at most 2^53 in magnitude */
bool cohort_flag(const CohortStart* start, const char* name, bool fallback);        /* `true` or `false` */
const char* cohort_text(const CohortStart* start, const char* name, const char* fallback);
/* Reads a list of numbers or a single number. Writes the first `capacity` numbers to `values` and returns the size of
 * the list, 0 if the parameter is missing. */
size_t cohort_reals(const CohortStart* start, const char* name, double* values, size_t capacity);
/* Read a required parameter. It is an error if the parameter is missing; the result is then 0 or "". */
double cohort_needed_real(const CohortStart* start, const char* name);
const char* cohort_needed_text(const CohortStart* start, const char* name);

/* ---- Step ---- */

/* One robot's sensor readings at one tick. Valid until the callback returns, or until the event is answered. Use only
 * channels that were looked up with this robot's CohortStart; handles are not checked, and other handles give arbitrary
 * values. */
typedef struct CohortObservation CohortObservation;

uint64_t cohort_tick(const CohortObservation* observation);
int64_t cohort_time_ns(const CohortObservation* observation); /* simulated time since tick 0 [ns] */
/* Returns the value of a channel, or the first value if it has several. */
double cohort_read(const CohortObservation* observation, CohortObservationChannel channel);
/* Returns all `channel.size` values of a channel. */
const double* cohort_read_all(const CohortObservation* observation, CohortObservationChannel channel);

/* One robot's command. At the start of each step, every channel has its neutral value. Valid as long as the
 * observation. */
typedef struct CohortCommand CohortCommand;

/* Sets the first value of a channel, clamped to the channel's range. The channel must have been looked up with this
 * robot's CohortStart; this is not checked. The server rejects NaN and reports the name of the channel. */
void cohort_set(CohortCommand* command, CohortCommandChannel channel, double value);
/* Sets value `index` of a channel, like cohort_set. `index` must be less than `channel.size`; this is not checked. */
void cohort_set_at(CohortCommand* command, CohortCommandChannel channel, size_t index, double value);

/* ---- Callbacks ---- */

/* A controller as a set of callbacks. `self` is the pointer that `create` returned for the robot. A failed callback
 * ends the run. The run's error message is that of cohort_fail, or else the last error. */
typedef struct CohortController {
  const char* name;      /* for messages */
  void* (*create)(void); /* returns NULL if it fails; if this member is NULL, `self` is NULL */
  /* Looks up channels and reads parameters. Called before the first step and each time the run restarts; also called
   * to find errors early (cohort_start_check). Returns 0, or another value if it fails. */
  int (*start)(void* self, const CohortStart* start);
  /* Computes a command from an observation. For bit-identical runs, the command must depend only on the last start
   * and the observations of all steps since. So do not use a clock, a random device, or state that robots share.
   * Returns 0, or another value if it fails. */
  int (*step)(void* self, const CohortObservation* observation, CohortCommand* command);
  void (*destroy)(void* self); /* destroys what `create` returned; may be NULL */
} CohortController;

/* ---- State of a controller ----
 *
 * When a snapshot of the run is taken, between two steps, `save` writes the state accumulated since the start, at
 * most 1 MiB. When a run continues from a snapshot, `load` of another object reads all of this state in the same
 * order, immediately after `start`. A controller without state writes nothing. Both functions return 0, or another
 * value if they fail. Handles are valid until the callback returns. */
typedef struct CohortStateWriter CohortStateWriter;
typedef struct CohortStateReader CohortStateReader;

void cohort_save_real(CohortStateWriter* state, double value);
void cohort_save_whole(CohortStateWriter* state, int64_t value);
void cohort_save_flag(CohortStateWriter* state, bool value);
void cohort_save_bytes(CohortStateWriter* state, const void* bytes, size_t size);

/* Read the next value. If the state ends too early or contains an invalid value, they return 0, and the run ends even
 * if `load` returns 0. */
double cohort_load_real(CohortStateReader* state);
int64_t cohort_load_whole(CohortStateReader* state);
bool cohort_load_flag(CohortStateReader* state);
void cohort_load_bytes(CohortStateReader* state, void* bytes, size_t size);

/* The functions that save and load the state of a controller. */
typedef struct CohortMemory {
  int (*save)(const void* self, CohortStateWriter* state);
  int (*load)(void* self, CohortStateReader* state); /* NULL if there is nothing to read */
} CohortMemory;

/* The type of the symbol `cohort_plugin` that a plugin exports, with the same layout as in C++. COHORT_C_CONTROLLER
 * defines the symbol. */
#define COHORT_PLUGIN_ABI 4u
typedef struct CohortPlugin {
  uint32_t abi;
  const char* name;
  void* (*create)(void);
  void (*destroy)(void*);
} CohortPlugin;

/* Create and destroy controllers for COHORT_C_CONTROLLER and COHORT_C_CONTROLLER_WITH_MEMORY. */
void* cohort_make_controller(const CohortController* controller);
void* cohort_make_controller_with_memory(const CohortController* controller, const CohortMemory* memory);
void cohort_destroy_controller(void* made);
/* Runs a controller as a program with the options `--robots`, `--server`, `--domain`, `--secure` and `--help`; its
 * `main` calls this. Returns the exit code: 0 if the run finished, 1 if the run or a controller failed, 2 for invalid
 * options or a refused claim, 130 if interrupted. */
int cohort_run_controller(const CohortPlugin* plugin, int argc, char** argv);

#ifdef COHORT_BUILDS_PLUGIN
#define COHORT_C_CONTROLLER_MAIN
#else
#define COHORT_C_CONTROLLER_MAIN \
  int main(int argc, char** argv) { return cohort_run_controller(&cohort_plugin, argc, argv); }
#endif

/* Defines the plugin symbol and the `main` function of a controller. Use this macro once, at the end of a source
 * file, without a semicolon. `Name` appears in messages; the other arguments are the functions of CohortController.
 * `create` and `destroy` may be NULL. The controller's state is not saved: when the run continues from a snapshot,
 * the controller restarts with a warning. */
#define COHORT_C_CONTROLLER(Name, create, start, step, destroy)                             \
  static const CohortController cohort_controller_ = {#Name, create, start, step, destroy}; \
  static void* cohort_create_(void) { return cohort_make_controller(&cohort_controller_); } \
  COHORT_C_PLUGIN_(Name)

/* Defines a controller whose state the functions of CohortMemory save and load. */
#define COHORT_C_CONTROLLER_WITH_MEMORY(Name, create, start, step, destroy, save, load)     \
  static const CohortController cohort_controller_ = {#Name, create, start, step, destroy}; \
  static const CohortMemory cohort_memory_ = {save, load};                                  \
  static void* cohort_create_(void) {                                                       \
    return cohort_make_controller_with_memory(&cohort_controller_, &cohort_memory_);        \
  }                                                                                         \
  COHORT_C_PLUGIN_(Name)

/* Defines a controller without state between steps, so that a snapshot need not save any. */
#define COHORT_C_STATELESS_CONTROLLER(Name, create, start, step, destroy)       \
  static int cohort_save_nothing_(const void* self, CohortStateWriter* state) { \
    (void)self;                                                                 \
    (void)state;                                                                \
    return 0;                                                                   \
  }                                                                             \
  COHORT_C_CONTROLLER_WITH_MEMORY(Name, create, start, step, destroy, cohort_save_nothing_, NULL)

#define COHORT_C_PLUGIN_(Name)                                                                              \
  COHORT_EXTERN const CohortPlugin cohort_plugin __attribute__((visibility("default")));                    \
  const CohortPlugin cohort_plugin = {COHORT_PLUGIN_ABI, #Name, cohort_create_, cohort_destroy_controller}; \
  COHORT_C_CONTROLLER_MAIN

/* ---- Your own loop ----
 *
 *   CohortClient* client = cohort_connect(NULL);
 *   CohortEvent event;
 *   while (client != NULL && cohort_next(client, &event) != cohort_event_end) {
 *     if (event.kind == cohort_event_start) ... cohort_find_command(event.start, ...) ...
 *     if (event.kind == cohort_event_observation) ... cohort_set(event.command, ...) ... cohort_answer(client);
 *   }
 *   cohort_close(client);
 *
 * The protocol runs on one of Cohort's threads. While your loop handles an event, that thread and the run wait, as
 * long as the team's `on_late` allows. */

typedef struct CohortClient CohortClient;

typedef struct CohortOptions {
  const char* server; /* IPv4 address or host name; $COHORT_SERVER or 127.0.0.1 if NULL */
  uint32_t domain;    /* the server's DDS domain */
  const char* robots; /* comma-separated selectors, such as `0..3,explorers/sbot_7`; all robots if NULL */
  const char* name;   /* name shown by the server; "controller" if NULL */
  const char* secure; /* folder of an identity created by `cohort security`; $COHORT_SECURE or none if NULL */
} CohortOptions;

typedef enum CohortEventKind {
  cohort_event_start,       /* start of a robot: look up its channels, now and after each reset */
  cohort_event_observation, /* observation of a robot: set its command */
  cohort_event_end,         /* last event: `end` and cohort_last_error give the reason */
  cohort_event_none,        /* from cohort_next_within only: nothing arrived in time */
  cohort_event_save,        /* after cohort_remember: write a robot's state to cohort_state_to_save */
  cohort_event_load         /* after cohort_remember: read a robot's state from cohort_state_to_load */
} CohortEventKind;

typedef enum CohortEnd {
  cohort_end_finished,   /* the server has ended the run */
  cohort_end_refused,    /* the claim was refused */
  cohort_end_superseded, /* another process has taken over these robots */
  cohort_end_failed, /* a lookup failed, the server's address is invalid, or the server ended the run with an error */
  cohort_end_server_lost, /* the server crashed or exited */
  cohort_end_interrupted  /* the client was closed */
} CohortEnd;

typedef struct CohortEvent {
  CohortEventKind kind;
  uint32_t robot;                       /* id of the event's robot */
  const CohortStart* start;             /* set by a start event, otherwise NULL */
  const CohortObservation* observation; /* set by an observation event, otherwise NULL */
  CohortCommand* command;               /* set by an observation event, otherwise NULL */
  CohortEnd end;                        /* set by an end event */
} CohortEvent;

/* Starts to attach to a server; does not block. cohort_next waits until there is a server. If `options` is NULL, all
 * options have their defaults, and the domain is $COHORT_DOMAIN. Copies the strings of the options. Returns NULL if
 * it fails. Log messages are written to standard error, each after the client's name. */
CohortClient* cohort_connect(const CohortOptions* options);

/* Answers the previous event if it has not been answered, waits for the next event, fills in `event` and returns its
 * kind. With several robots, each tick has one observation event per robot, in the order of their ids. Returns
 * cohort_event_end on every call after the end. */
CohortEventKind cohort_next(CohortClient* client, CohortEvent* event);

/* Acts like cohort_next, but returns cohort_event_none if nothing arrives within `milliseconds`, which may be 0. */
CohortEventKind cohort_next_within(CohortClient* client, CohortEvent* event, int milliseconds);

/* Returns a file descriptor that poll() reports as readable when the events of a tick are available. Each tick has
 * one event per robot: call cohort_next_within(..., 0) until it returns cohort_event_none. Do not read or close the
 * descriptor. */
int cohort_descriptor(const CohortClient* client);

/* Returns true if the answer to the current event is no longer needed: the server has ended the run or the lease, or
 * has been unreachable for too long. Poll this while your loop waits for hardware before it answers. */
bool cohort_is_over(const CohortClient* client);

/* The schedule of a team's commands. A robot is due at each tick with `tick % period == phase`, and its command takes
 * effect `delay` ticks later. If `waits` is false (`mode: free`), the run never waits for answers. */
typedef struct CohortPolicy {
  bool waits;
  uint32_t period; /* [ticks] */
  uint32_t phase;  /* [ticks] */
  uint32_t delay;  /* [ticks] */
} CohortPolicy;

/* Gets the policy of a robot that the client drives. Returns false and sets the last error if the client does not
 * drive a robot with this id. */
bool cohort_policy(const CohortClient* client, uint32_t robot, CohortPolicy* policy);

/* Enables cohort_event_save and cohort_event_load, so that snapshots contain this client's state: see "State of a
 * controller". Without this call, a run that continues from a snapshot starts this client without its state, with a
 * warning. */
void cohort_remember(CohortClient* client);
CohortStateWriter* cohort_state_to_save(CohortClient* client); /* for the current event; NULL if it has another kind */
CohortStateReader* cohort_state_to_load(CohortClient* client); /* likewise */

/* Ends the client with the error `why`. Call this if the client cannot continue, for example because a robot lacks a
 * channel. Sends `why` to the server; cohort_next then returns cohort_event_end. Does nothing if there is no current
 * event. */
void cohort_give_up(CohortClient* client, const char* why);

/* Answers the current event, so that the simulation continues while the loop does something else. The pointers of the
 * event are then invalid. With several robots, the answers of a tick are sent together, after the last one. Does
 * nothing if there is no current event. */
void cohort_answer(CohortClient* client);

/* Detaches without answering the current event, and frees the client. The robots are then without a controller, as if
 * the process had crashed. `client` may be NULL. */
void cohort_close(CohortClient* client);

#ifdef __cplusplus
}
#endif

#endif
