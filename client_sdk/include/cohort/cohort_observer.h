#ifndef COHORT_COHORT_OBSERVER_H
#define COHORT_COHORT_OBSERVER_H

#include <cohort/cohort_control.h>

/* Looks on at the runs of a Cohort server, in C99 (C++ may include it too): what <cohort/observer.hpp> says in C++. An
 * observer drives nothing, is never waited for and cannot slow the server; what it misses is gone.
 *
 *   CohortObserver* observer = cohort_observer_connect(NULL);
 *   while (observer != NULL && cohort_observer_ended(observer) == cohort_observer_goes_on)
 *     if (cohort_observer_next(observer, 100))
 *       printf("%llu\n", (unsigned long long)cohort_observer_tick(observer));
 *   cohort_observer_close(observer);
 *
 * Poses are in the world frame, in SI units. Texts and pointers that a function gives are valid until the next call of
 * cohort_observer_next, cohort_observer_ask_robots or cohort_observer_ask_events with the same handle. A handle is for
 * one thread at a time. */

#ifdef __cplusplus
extern "C" {
#endif

typedef struct CohortObserver CohortObserver;

/* Returns at once; a server that is not there yet is waited for. `server`, `domain`, `secure` and `name` of the options
 * are used, as in cohort_connect, also if `options` is NULL. NULL if it fails. */
CohortObserver* cohort_observer_connect(const CohortOptions* options);
void cohort_observer_close(CohortObserver* observer); /* NULL is allowed */

/* Waits for the next world state for at most so long, which may be 0. False if none comes. A tick comes again when a
 * paused run goes on, and when its world was changed. */
bool cohort_observer_next(CohortObserver* observer, int milliseconds);
/* A file descriptor that poll() reports as readable while cohort_observer_next would return at once. Not to be read or
 * closed. */
int cohort_observer_descriptor(const CohortObserver* observer);

/* ---- The world state that cohort_observer_next brought last ---- */

uint32_t cohort_observer_run(const CohortObserver* observer); /* higher after each reset or restore */
uint64_t cohort_observer_tick(const CohortObserver* observer);
int64_t cohort_observer_time_ns(const CohortObserver* observer); /* simulated, since tick 0 [ns] */
uint64_t cohort_observer_state_hash(const CohortObserver* observer);
size_t cohort_observer_poses(const CohortObserver* observer); /* of how many robots it has poses */
/* Returns the pose of one of these robots, in the order of their ids, and NULL beyond the last. Writes its id to
 * `*robot` unless that is NULL. */
const CohortPose* cohort_observer_pose(const CohortObserver* observer, size_t index, uint32_t* robot);

/* ---- The end ---- */

typedef enum CohortObserverEnd {
  cohort_observer_goes_on = 0,    /* or no server has been there yet */
  cohort_observer_run_ended = 1,  /* the server has said that there will be no further run */
  cohort_observer_server_gone = 2 /* the server died, or left without a word */
} CohortObserverEnd;

/* Then cohort_last_error says how and why. */
CohortObserverEnd cohort_observer_ended(const CohortObserver* observer);

/* ---- Queries ---- */

/* Asks for all robots of the run, for at most so long. Not for each tick. Returns how many there are, or -1. */
int64_t cohort_observer_ask_robots(CohortObserver* observer, int milliseconds);
/* Returns the scoped name of one of these robots, in the order of their ids, and NULL beyond the last. Writes its id to
 * `*robot` unless that is NULL. The two functions below return its model and its team. */
const char* cohort_observer_robot(const CohortObserver* observer, size_t index, uint32_t* robot);
const char* cohort_observer_model(const CohortObserver* observer, size_t index);
const char* cohort_observer_team(const CohortObserver* observer, size_t index);

/* Asks for what has happened since the last call, at first for all. Returns how many events there are, or -1. */
int64_t cohort_observer_ask_events(CohortObserver* observer, int milliseconds);
const CohortRunEvent* cohort_observer_event(const CohortObserver* observer, size_t index); /* NULL beyond the last */

#ifdef __cplusplus
}
#endif

#endif
