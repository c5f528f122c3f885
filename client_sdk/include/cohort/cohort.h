#ifndef COHORT_COHORT_H
#define COHORT_COHORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What the author of a controller in C writes against (C99; C++ may include it too). It says in C what
 * <cohort/controller.hpp> says in C++, and gives the same bits. There are two ways to use it:
 *
 * - Callbacks: four functions and COHORT_C_CONTROLLER at the end of the source file. It builds as a program and as a
 *   plugin, as controllers in C++ do (`cohort_add_controller` in CMake makes both).
 * - A loop of its own: cohort_connect, cohort_next, cohort_answer, cohort_close, for firmware that owns its `main`.
 *
 * Values are float64 in SI units; what a channel measures or moves, and in which frame, is said where its device is
 * (docs/devices.md). What a function gives belongs to Cohort unless it says otherwise. No function throws or ends the
 * program, and no callback may throw or jump out (longjmp). The SDK calls all callbacks of a process on one thread, one
 * after the other; the functions of a loop are for one thread at a time. */

#ifdef __cplusplus
extern "C" {
#define COHORT_EXTERN extern "C"
#else
#define COHORT_EXTERN extern
#endif

/* ---- Errors ---- */

/* Why the last call that failed on this thread, since its callback began, did; "" if none has. Good until the next one
 * fails. */
const char* cohort_last_error(void);

/* For a callback that fails: `return cohort_fail("no %s", what);`. Takes what printf takes, keeps it as the last error,
 * and returns -1. */
int cohort_fail(const char* format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 1, 2)))
#endif
    ;

/* ---- Start ---- */

/* Why a robot's controller is started. */
typedef enum CohortStartReason {
  cohort_start_first,    /* the run begins */
  cohort_start_takeover, /* another process drove this robot before; the run goes on from `tick` */
  cohort_start_reset,    /* the world was built anew */
  cohort_start_restored, /* the world was restored from a snapshot */
  cohort_start_check     /* `cohort check --load-controllers` and `cohort run` look for mistakes: no step */
} CohortStartReason;

typedef struct CohortStartInfo {
  uint32_t robot;         /* id in this run */
  const char* name;       /* scoped name, such as `explorers/sbot_7` */
  const char* model;      /* such as `sbot` */
  const char* team;       /* the robot's, in the experiment file */
  const char* controller; /* that the experiment file names for the team */
  CohortStartReason reason;
  uint64_t tick;   /* of the first observation to come */
  uint64_t seed;   /* for the controller's own random numbers: fixed by experiment seed and robot name */
  int64_t step_ns; /* simulated time between ticks [ns] */
  uint32_t period; /* ticks from one observation to the next */
} CohortStartInfo;

/* What a controller is told before its first step, and again after each reset, restore and takeover. Valid, with all
 * texts that come from it, until the callback returns or the next cohort_next.
 *
 * The functions below that look for channels or parameters cannot fail unseen: the first mistake of a start ends the
 * run with its message, whatever the callback returns, so what they return need not be checked. */
typedef struct CohortStart CohortStart;

const CohortStartInfo* cohort_start_info(const CohortStart* start);

/* ---- Channels ---- */

/* Handle of an observation channel: `size` values of the robot's, from `offset` on. Good until the robot's next start;
 * of size 0 if the lookup failed. */
typedef struct CohortObservationChannel {
  uint32_t offset;
  uint32_t size;
} CohortObservationChannel;

/* As CohortObservationChannel, of the robot's command. `lower` and `upper` are infinite if there are no bounds. */
typedef struct CohortCommandChannel {
  uint32_t offset;
  uint32_t size;
  double lower;
  double upper;
} CohortCommandChannel;

/* The channel `device/index/quantity`, such as `turret/0/position`. A mistake, which names the nearest ones, if the
 * robot has none of that name. */
CohortObservationChannel cohort_find_observation(const CohortStart* start, const char* name);
CohortCommandChannel cohort_find_command(const CohortStart* start, const char* name);

/* All channels that match, in the order of the robot's layout: writes the first `capacity` of them and returns how many
 * there are. `*` stands for any run of characters but `/`. A mistake if none matches; then 0. */
size_t cohort_find_observations(const CohortStart* start, const char* pattern, CohortObservationChannel* channels,
                                size_t capacity);
size_t cohort_find_commands(const CohortStart* start, const char* pattern, CohortCommandChannel* channels,
                            size_t capacity);

/* Whether there is a channel of that name. Never a mistake. */
bool cohort_has_observation(const CohortStart* start, const char* name);
bool cohort_has_command(const CohortStart* start, const char* name);

/* ---- Parameters that the experiment file gives the team ----
 *
 * Keys of nested maps are joined by '.'. Every parameter has to be asked for during the start: one that is left over is
 * a mistake of the file. One that is missing gives `fallback`; one that is something else than asked for is a mistake,
 * and gives `fallback` too. */

bool cohort_has_parameter(const CohortStart* start, const char* name); /* counts as asking */
double cohort_real(const CohortStart* start, const char* name, double fallback);
int64_t cohort_whole(const CohortStart* start, const char* name, int64_t fallback); /* of at most 2^53 either way */
bool cohort_flag(const CohortStart* start, const char* name, bool fallback);        /* `true` or `false` */
const char* cohort_text(const CohortStart* start, const char* name, const char* fallback);
/* A list of numbers, or one alone: writes the first `capacity` and returns how many there are, 0 if it is missing. */
size_t cohort_reals(const CohortStart* start, const char* name, double* values, size_t capacity);
/* The same for parameters that have to be there: a mistake, and 0 or "", if they are not. */
double cohort_needed_real(const CohortStart* start, const char* name);
const char* cohort_needed_text(const CohortStart* start, const char* name);

/* ---- Step ---- */

/* One robot's sensor readings at one tick. Valid until the callback returns, or until the event is answered. Channels
 * are those that the start found; others are not noticed and read anything. */
typedef struct CohortObservation CohortObservation;

uint64_t cohort_tick(const CohortObservation* observation);
int64_t cohort_time_ns(const CohortObservation* observation); /* simulated, since tick 0 [ns] */
/* The value of a channel, the first one if it has several. */
double cohort_read(const CohortObservation* observation, CohortObservationChannel channel);
/* All `channel.size` values of a channel. */
const double* cohort_read_all(const CohortObservation* observation, CohortObservationChannel channel);

/* One robot's command. Every channel begins each step at its neutral value. Valid as the observation is. */
typedef struct CohortCommand CohortCommand;

/* Sets a channel's first value, brought into the channel's range. The channel is one that the start found, which is not
 * checked. NaN is passed on as it is, and refused by the server by name. */
void cohort_set(CohortCommand* command, CohortCommandChannel channel, double value);
/* The same for value `index`, which is less than `channel.size`; not checked either. */
void cohort_set_at(CohortCommand* command, CohortCommandChannel channel, size_t index, double value);

/* ---- Callbacks ---- */

/* A controller as callbacks. `self` is what `create` gave: one for each robot. A function that fails ends the run, with
 * what it gave to cohort_fail or else the last error as its message. */
typedef struct CohortController {
  const char* name;      /* for messages */
  void* (*create)(void); /* NULL if it fails. May be NULL itself: then so is `self` */
  /* Looks channels up and asks for parameters. Called before the first step, and again whenever the world begins anew;
   * also of those that only serve to find mistakes (cohort_start_check). 0, or anything else if it fails. */
  int (*start)(void* self, const CohortStart* start);
  /* From one observation to one command. For lockstep with identical bits, a pure function of what the start and the
   * steps since gave: no clock, no random device, no state shared between robots. 0, or anything else if it fails. */
  int (*step)(void* self, const CohortObservation* observation, CohortCommand* command);
  void (*destroy)(void* self); /* of what `create` gave. May be NULL */
} CohortController;

/* ---- What a controller remembers ----
 *
 * When a snapshot of the run is taken, `save` writes what the controller remembers of the steps since its start,
 * between steps and at most 1 MiB; where a run goes on from a snapshot, `load` of another object reads it to the last
 * byte and in the same order, right after `start`. Who remembers nothing writes nothing. Both return 0, or anything
 * else if they fail. Handles are valid until the callback returns. */
typedef struct CohortStateWriter CohortStateWriter;
typedef struct CohortStateReader CohortStateReader;

void cohort_save_real(CohortStateWriter* state, double value);
void cohort_save_whole(CohortStateWriter* state, int64_t value);
void cohort_save_flag(CohortStateWriter* state, bool value);
void cohort_save_bytes(CohortStateWriter* state, const void* bytes, size_t size);

/* State that ends too early, or has what cannot be, gives 0, and ends the run whatever `load` returns. */
double cohort_load_real(CohortStateReader* state);
int64_t cohort_load_whole(CohortStateReader* state);
bool cohort_load_flag(CohortStateReader* state);
void cohort_load_bytes(CohortStateReader* state, void* bytes, size_t size);

/* Of a controller that has them. */
typedef struct CohortMemory {
  int (*save)(const void* self, CohortStateWriter* state);
  int (*load)(void* self, CohortStateReader* state); /* NULL if there is nothing to read */
} CohortMemory;

/* What a plugin exports as `cohort_plugin`: the same as plugins in C++ do. COHORT_C_CONTROLLER fills it in. */
#define COHORT_PLUGIN_ABI 3u
typedef struct CohortPlugin {
  uint32_t abi;
  const char* name;
  void* (*create)(void);
  void (*destroy)(void*);
} CohortPlugin;

/* For COHORT_C_CONTROLLER and its like. */
void* cohort_make_controller(const CohortController* controller);
void* cohort_make_controller_with_memory(const CohortController* controller, const CohortMemory* memory);
void cohort_destroy_controller(void* made);
/* The `main` of a controller that runs as a process of its own: `--robots`, `--server`, `--domain`, `--secure`,
 * `--help`. Returns the exit code: 0 when the run finished, 1 when it or a controller failed, 2 for a mistake in the
 * options or a refused claim, 130 when interrupted. */
int cohort_run_controller(const CohortPlugin* plugin, int argc, char** argv);

#ifdef COHORT_BUILDS_PLUGIN
#define COHORT_C_CONTROLLER_MAIN
#else
#define COHORT_C_CONTROLLER_MAIN \
  int main(int argc, char** argv) { return cohort_run_controller(&cohort_plugin, argc, argv); }
#endif

/* Once in a controller, at the end of a source file, without a semicolon. `Name` is for messages; the others are the
 * functions of CohortController, `create` and `destroy` may be NULL. Whoever goes on from a snapshot starts such a
 * controller anew, and is told so. */
#define COHORT_C_CONTROLLER(Name, create, start, step, destroy)                             \
  static const CohortController cohort_controller_ = {#Name, create, start, step, destroy}; \
  static void* cohort_create_(void) { return cohort_make_controller(&cohort_controller_); } \
  COHORT_C_PLUGIN_(Name)

/* The same of one that has the functions of CohortMemory. */
#define COHORT_C_CONTROLLER_WITH_MEMORY(Name, create, start, step, destroy, save, load)     \
  static const CohortController cohort_controller_ = {#Name, create, start, step, destroy}; \
  static const CohortMemory cohort_memory_ = {save, load};                                  \
  static void* cohort_create_(void) {                                                       \
    return cohort_make_controller_with_memory(&cohort_controller_, &cohort_memory_);        \
  }                                                                                         \
  COHORT_C_PLUGIN_(Name)

#define COHORT_C_PLUGIN_(Name)                                                                              \
  COHORT_EXTERN const CohortPlugin cohort_plugin __attribute__((visibility("default")));                    \
  const CohortPlugin cohort_plugin = {COHORT_PLUGIN_ABI, #Name, cohort_create_, cohort_destroy_controller}; \
  COHORT_C_CONTROLLER_MAIN

/* ---- A loop of its own ----
 *
 *   CohortClient* client = cohort_connect(NULL);
 *   CohortEvent event;
 *   while (client != NULL && cohort_next(client, &event) != cohort_event_end) {
 *     if (event.kind == cohort_event_start) ... cohort_find_command(event.start, ...) ...
 *     if (event.kind == cohort_event_observation) ... cohort_set(event.command, ...) ... cohort_answer(client);
 *   }
 *   cohort_close(client);
 *
 * The protocol runs on a thread of Cohort's; it waits while the loop is at an event, and so does the run, as long as
 * the team's `on_late` has patience. */

typedef struct CohortClient CohortClient;

typedef struct CohortOptions {
  const char* server; /* IPv4 address or host name; $COHORT_SERVER or 127.0.0.1 if NULL */
  uint32_t domain;    /* the server's DDS domain */
  const char* robots; /* selectors with commas between, such as `0..3,explorers/sbot_7`; all if NULL */
  const char* name;   /* shown by the server; "controller" if NULL */
  const char* secure; /* folder of an identity that `cohort security` has made; $COHORT_SECURE or none if NULL */
} CohortOptions;

typedef enum CohortEventKind {
  cohort_event_start,       /* of a robot's run: look its channels up, now and again after each reset */
  cohort_event_observation, /* of a robot: set its command */
  cohort_event_end,         /* nothing will come any more: `end` and cohort_last_error say why */
  cohort_event_none,        /* of cohort_next_within: nothing came in time */
  cohort_event_save,        /* after cohort_remember: write a robot's state to cohort_state_to_save */
  cohort_event_load         /* after cohort_remember: read a robot's state from cohort_state_to_load */
} CohortEventKind;

typedef enum CohortEnd {
  cohort_end_finished,    /* the server ended the run */
  cohort_end_refused,     /* the claim was refused */
  cohort_end_superseded,  /* another process took these robots over */
  cohort_end_failed,      /* a lookup failed, the server's address is no good, or the server gave the run up */
  cohort_end_server_lost, /* the server died or left */
  cohort_end_interrupted  /* the client was closed */
} CohortEnd;

typedef struct CohortEvent {
  CohortEventKind kind;
  uint32_t robot;                       /* id of the robot that the event is of */
  const CohortStart* start;             /* of a start, else NULL */
  const CohortObservation* observation; /* of an observation, else NULL */
  CohortCommand* command;               /* of an observation, else NULL */
  CohortEnd end;                        /* of an end */
} CohortEvent;

/* Begins to attach to a server, and returns at once: a server that is not there yet is waited for in cohort_next. All
 * defaults if `options` is NULL, and the domain of $COHORT_DOMAIN; their texts are copied. NULL if it fails. What
 * people should know goes to standard error, after the name. */
CohortClient* cohort_connect(const CohortOptions* options);

/* Blocks until something is there, fills `event` in and returns its kind. If the event before it was not answered, that
 * is done first. With several robots, each tick gives an observation for each, in the order of their ids. Stays at
 * cohort_event_end once it is there. */
CohortEventKind cohort_next(CohortClient* client, CohortEvent* event);

/* The same, but fills in cohort_event_none if nothing comes within `milliseconds`, which may be 0. */
CohortEventKind cohort_next_within(CohortClient* client, CohortEvent* event, int milliseconds);

/* A file descriptor that poll() reports as readable when a tick's events are there. Each tick has an event for each
 * robot, so then call cohort_next_within(..., 0) until it gives cohort_event_none. Not to be read or closed. */
int cohort_descriptor(const CohortClient* client);

/* Whether nobody wants the answer to the event under way any more: the server has ended the run or the lease, or has
 * been away for too long. For loops that wait for hardware before they answer. */
bool cohort_is_over(const CohortClient* client);

/* When a robot's team is asked, and when its commands act: at each tick with `tick % period == phase`, and `delay`
 * ticks later. If it does not wait (`mode: free`), the run keeps its pace whether answers come or not. */
typedef struct CohortPolicy {
  bool waits;
  uint32_t period; /* [ticks] */
  uint32_t phase;  /* [ticks] */
  uint32_t delay;  /* [ticks] */
} CohortPolicy;

/* The policy of a robot that the client drives. False, with a last error, if it drives no robot of this id. */
bool cohort_policy(const CohortClient* client, uint32_t robot, CohortPolicy* policy);

/* From now on the loop also gets cohort_event_save and cohort_event_load, so that a run can go on from a snapshot: see
 * "What a controller remembers". Without it such a run starts this client without its state, and says so. */
void cohort_remember(CohortClient* client);
CohortStateWriter* cohort_state_to_save(CohortClient* client); /* of the event under way; NULL if it is another */
CohortStateReader* cohort_state_to_load(CohortClient* client); /* the same */

/* Ends the client because it cannot go on, such as where a robot lacks a channel. The server is told `why`, and
 * cohort_next gives cohort_event_end. Does nothing if no event is under way. */
void cohort_give_up(CohortClient* client, const char* why);

/* Hands the command of the event under way back, whose pointers are no longer valid, so that the simulation goes on
 * while the loop does something else. With several robots the answers leave when the last one is there. Does nothing
 * if there is no event under way. */
void cohort_answer(CohortClient* client);

/* Leaves the run, without an answer if one is due, and frees the client. The robots are then without a controller, as
 * if the process had died. NULL is allowed. */
void cohort_close(CohortClient* client);

#ifdef __cplusplus
}
#endif

#endif
