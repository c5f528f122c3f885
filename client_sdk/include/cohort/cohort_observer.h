#ifndef COHORT_COHORT_OBSERVER_H
#define COHORT_COHORT_OBSERVER_H

#include <cohort/cohort_control.h>

/* Observes the runs of a Cohort server, in C99 (C++ may include it too). It is the same in C as
 * <cohort/observer.hpp> in C++. An observer drives nothing, is never waited for and cannot slow down the server; it
 * may miss ticks.
 *
 *   CohortObserver* observer = cohort_observer_connect(NULL);
 *   while (observer != NULL && cohort_observer_ended(observer) == cohort_observer_goes_on)
 *     if (cohort_observer_next(observer, 100))
 *       printf("%llu\n", (unsigned long long)cohort_observer_tick(observer));
 *   cohort_observer_close(observer);
 *
 * Poses are in the world frame, in SI units. Returned texts and pointers are valid until the next call of
 * cohort_observer_next, cohort_observer_ask_robots or cohort_observer_ask_events with the same handle. Use a handle
 * on one thread at a time. */

#ifdef __cplusplus
extern "C" {
#endif

typedef struct CohortObserver CohortObserver;

/* Returns at once; waits for a server that is not there yet. Uses `server`, `domain`, `secure` and `name` of the
 * options like cohort_connect, also if `options` is NULL. Returns NULL if it fails. */
CohortObserver* cohort_observer_connect(const CohortOptions* options);
void cohort_observer_close(CohortObserver* observer); /* NULL is allowed */

/* Waits for the next world state, at most `milliseconds`, which may be 0. Returns false if none arrives. A tick is
 * repeated when a paused run resumes, and when its world was changed. */
bool cohort_observer_next(CohortObserver* observer, int milliseconds);
/* Returns a file descriptor that poll() reports as readable while cohort_observer_next would return at once. Do not
 * read or close it. */
int cohort_observer_descriptor(const CohortObserver* observer);

/* ---- The world state from the last cohort_observer_next ---- */

uint32_t cohort_observer_run(const CohortObserver* observer); /* increases after each reset or restore */
uint64_t cohort_observer_tick(const CohortObserver* observer);
int64_t cohort_observer_time_ns(const CohortObserver* observer); /* simulated time since tick 0 [ns] */
uint64_t cohort_observer_state_hash(const CohortObserver* observer);
size_t cohort_observer_poses(const CohortObserver* observer); /* number of robots with poses */
/* Returns the pose of one of these robots, in the order of their ids, and NULL beyond the last. Writes its id to
 * `*robot` unless that is NULL. */
const CohortPose* cohort_observer_pose(const CohortObserver* observer, size_t index, uint32_t* robot);

/* ---- The end ---- */

typedef enum CohortObserverEnd {
  cohort_observer_goes_on = 0,    /* running, or no server has been there yet */
  cohort_observer_run_ended = 1,  /* the server has announced that no further run follows */
  cohort_observer_server_gone = 2 /* the server died or left without notice */
} CohortObserverEnd;

/* Returns whether and how the runs have ended; cohort_last_error then gives details. */
CohortObserverEnd cohort_observer_ended(const CohortObserver* observer);

/* ---- Queries ---- */

/* Queries all robots of the run, at most for `milliseconds`. Do not call it at each tick. Returns the number of
 * robots, or -1. */
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
