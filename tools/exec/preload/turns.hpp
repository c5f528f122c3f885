// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/exec/preload/virtual_clock.hpp"

/// Threads of a Python interpreter run one after the other, each until it waits. A thread that another one has woken
/// continues at its turn, which comes when all threads are at rest. Without turns, real time would decide which thread
/// takes the interpreter's lock, or a lock of the program, first.
namespace cohort::exec {

/// Returns whether threads wait for their turns.
bool has_turns();

/// Waits until all other threads are at rest and this one has its turn.
void wait_for_turn();

/// The calling thread's place in the queue of threads that wait for their turn.
class PlaceInLine {
 public:
  /// `object` is what the thread waits for. If `is_ready` is false, the thread gets no turn before make_ready or
  /// `deadline`, which is in virtual time.
  PlaceInLine(const void* object, std::int64_t deadline, bool is_ready);
  ~PlaceInLine();
  PlaceInLine(const PlaceInLine&) = delete;
  PlaceInLine& operator=(const PlaceInLine&) = delete;
  /// Sleeps until the turn, the deadline, or the end of turns. Returns false if a signal handler has run before.
  bool sleep();

 private:
  Wait* wait_;
};

/// Allows turns to the threads that wait for an object.
void make_ready(const void* object);
/// Called in the child of a fork.
void forget_turns();

// Hooks for the calls by which the interpreter takes and releases its lock.
void before_lock(const pthread_mutex_t* mutex);
void before_signal(const pthread_cond_t* condition);
void before_unlock(const pthread_mutex_t* mutex);
/// Waits until another thread has released the interpreter's lock. Returns the result of a wait on the lock's condition
/// variable: 0 or ETIMEDOUT. Sets `is_done` to false if the caller must wait in real time instead.
int wait_for_interpreter(pthread_cond_t* condition, pthread_mutex_t* mutex, bool& is_done);

/// Called when the interpreter has read the clock.
void after_read_of_clock();
/// Called when the interpreter has tried to take a lock of its program. The related read of the clock then does not
/// count as spinning, because the number of locks that an import takes depends on other processes.
void after_try_to_take(bool is_taken);

}  // namespace cohort::exec
