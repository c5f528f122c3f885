#pragma once

#include "tools/exec/preload/virtual_clock.hpp"

/// Threads of a Python interpreter run one after the other, each until it waits. A thread that another one has woken
/// goes on at its turn, which it has once all threads are at rest. Otherwise which of them takes the interpreter's lock
/// first, or a lock of the program, would depend on the real time.
namespace cohort::exec {

/// Returns whether threads wait for their turns.
bool has_turns();

/// Waits until all other threads are at rest and this one has its turn.
void wait_for_turn();

/// A place in the line of threads that wait for their turn, of the calling thread.
class PlaceInLine {
 public:
  /// `object`: what the thread waits for; it is not `is_ready` before make_ready. `deadline`: in virtual time.
  PlaceInLine(const void* object, std::int64_t deadline, bool is_ready);
  ~PlaceInLine();
  PlaceInLine(const PlaceInLine&) = delete;
  PlaceInLine& operator=(const PlaceInLine&) = delete;
  /// Sleeps until the turn, the deadline, or the end of turns. Returns false if a signal was handled before.
  bool sleep();

 private:
  Wait* wait_;
};

/// Lets the threads that wait for an object have turns.
void make_ready(const void* object);
/// In the child of a fork.
void forget_turns();

// Hooks for the calls by which the interpreter takes and releases its lock.
void before_lock(const pthread_mutex_t* mutex);
void before_signal(const pthread_cond_t* condition);
void before_unlock(const pthread_mutex_t* mutex);
/// Waits until another thread has released the interpreter's lock. The result is that of a wait on its condition
/// variable: 0 or ETIMEDOUT. `is_done` is false if this is to be waited for in real time.
int wait_for_interpreter(pthread_cond_t* condition, pthread_mutex_t* mutex, bool& is_done);

/// The interpreter has read the clock.
void after_read_of_clock();
/// The interpreter has tried to take a lock of its program. The read of the clock that belongs to it does not count as
/// one of a thread that spins. How many locks an import takes depends on what other processes do.
void after_try_to_take(bool is_taken);

}  // namespace cohort::exec
