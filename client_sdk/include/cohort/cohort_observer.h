// SPDX-License-Identifier: Apache-2.0
#ifndef COHORT_COHORT_OBSERVER_H
#define COHORT_COHORT_OBSERVER_H

#include <cohort/cohort_control.h>

/* A client that observes the runs of a Cohort server, in C99 (C++ can also include it). It is the C equivalent of
 * <cohort/observer.hpp>. An observer drives no robots. The server never waits for it, so it cannot slow down the run,
 * but it may miss ticks.
 *
 *   CohortObserver* observer = cohort_observer_connect(NULL);
 *   while (observer != NULL && cohort_observer_ended(observer) == cohort_observer_goes_on)
 *     if (cohort_observer_next(observer, 100))
 *       printf("%llu\n", (unsigned long long)cohort_observer_tick(observer));
 *   cohort_observer_close(observer);
 *
 * Poses are in the world frame, in SI units. Returned strings and pointers are valid until the next call of
 * cohort_observer_next, cohort_observer_ask_robots or cohort_observer_ask_events with the same handle. Use a handle
 * on one thread at a time. */

#ifdef __cplusplus
extern "C" {
#endif

typedef struct CohortObserver CohortObserver;

/* Connects to a server. Does not block. If there is no server yet, connects when one appears. Uses `server`,
 * `domain`, `secure` and `name` of the options like cohort_connect, even if `options` is NULL. Returns NULL if it
 * fails. */
CohortObserver* cohort_observer_connect(const CohortOptions* options);
void cohort_observer_close(CohortObserver* observer); /* disconnects and frees the handle, which may be NULL */

/* Waits for the next world state for at most `milliseconds`, which may be 0. Returns false if none arrives. A tick is
 * repeated when a paused run resumes or its world is changed. */
bool cohort_observer_next(CohortObserver* observer, int milliseconds);
/* Returns a file descriptor that poll() reports as readable while cohort_observer_next would not block. Do not read
 * or close it. */
int cohort_observer_descriptor(const CohortObserver* observer);

/* ---- The world state of the last cohort_observer_next ---- */

uint32_t cohort_observer_run(const CohortObserver* observer); /* increases after each reset or restore */
uint64_t cohort_observer_tick(const CohortObserver* observer);
int64_t cohort_observer_time_ns(const CohortObserver* observer); /* simulated time since tick 0 [ns] */
uint64_t cohort_observer_state_hash(const CohortObserver* observer);
size_t cohort_observer_poses(const CohortObserver* observer); /* number of robots with poses */
/* Returns the pose of a robot, in the order of ids, or NULL beyond the last. Writes the id to `*robot` unless `robot`
 * is NULL. */
const CohortPose* cohort_observer_pose(const CohortObserver* observer, size_t index, uint32_t* robot);

/* ---- The end ---- */

typedef enum CohortObserverEnd {
  cohort_observer_goes_on = 0,    /* there is a server, or none has appeared yet */
  cohort_observer_run_ended = 1,  /* the server has announced that no further run follows */
  cohort_observer_server_gone = 2 /* the server crashed or exited without notice */
} CohortObserverEnd;

/* Returns the reason for the end of the runs, or cohort_observer_goes_on. After the end, cohort_last_error returns
 * details. */
CohortObserverEnd cohort_observer_ended(const CohortObserver* observer);

/* ---- Queries ---- */

/* Queries all robots of the run; waits for at most `milliseconds`. Do not call this at each tick. Returns the number
 * of robots, or -1. */
int64_t cohort_observer_ask_robots(CohortObserver* observer, int milliseconds);
/* Returns the scoped name of the robot at `index`, in ascending order of ids, or NULL if there is none. Writes the id
 * to `*robot` unless `robot` is NULL. The two functions below return the model and the team of the same robot. */
const char* cohort_observer_robot(const CohortObserver* observer, size_t index, uint32_t* robot);
const char* cohort_observer_model(const CohortObserver* observer, size_t index);
const char* cohort_observer_team(const CohortObserver* observer, size_t index);

/* Queries the events since the last call; the first call queries all events. Waits for at most `milliseconds`.
 * Returns the number of events, or -1. */
int64_t cohort_observer_ask_events(CohortObserver* observer, int milliseconds);
const CohortRunEvent* cohort_observer_event(const CohortObserver* observer,
                                            size_t index); /* the event at `index`; NULL beyond the last */

#ifdef __cplusplus
}
#endif

#endif
