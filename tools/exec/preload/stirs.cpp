// SPDX-License-Identifier: Apache-2.0

// Calls by which a thread may wake another one: they go on as they are, and are noted.

#include <pthread.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include "tools/exec/preload/retries.hpp"
#include "tools/exec/preload/turns.hpp"

using namespace cohort::exec;

#define COHORT_CALLER __builtin_return_address(0)

COHORT_REPLACES int pthread_cond_signal(pthread_cond_t* condition) noexcept {
  COHORT_NEXT_VERSION(pthread_cond_signal, "GLIBC_2.3.2");
  stir();
  if (is_interpreter(COHORT_CALLER)) before_signal(condition);
  return real(condition);
}

COHORT_REPLACES int pthread_cond_broadcast(pthread_cond_t* condition) noexcept {
  COHORT_NEXT_VERSION(pthread_cond_broadcast, "GLIBC_2.3.2");
  stir();
  return real(condition);
}

COHORT_REPLACES int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  COHORT_NEXT(pthread_mutex_lock);
  if (is_interpreter(COHORT_CALLER)) before_lock(mutex);
  return real(mutex);
}

// A mutex with waiting threads has the value 2.
COHORT_REPLACES int pthread_mutex_unlock(pthread_mutex_t* mutex) noexcept {
  COHORT_NEXT(pthread_mutex_unlock);
  if (mutex->__data.__lock > 1) stir();
  if (is_interpreter(COHORT_CALLER)) before_unlock(mutex);
  const int result = real(mutex);
  note_release();
  return result;
}

COHORT_REPLACES int pthread_rwlock_unlock(pthread_rwlock_t* lock) noexcept {
  COHORT_NEXT(pthread_rwlock_unlock);
  stir();
  const int result = real(lock);
  note_release();
  return result;
}

COHORT_REPLACES int pthread_barrier_wait(pthread_barrier_t* barrier) noexcept {
  COHORT_NEXT(pthread_barrier_wait);
  stir();
  return real(barrier);
}

COHORT_REPLACES int pthread_kill(pthread_t thread, int signal) noexcept {
  COHORT_NEXT(pthread_kill);
  stir();
  return real(thread, signal);
}

COHORT_REPLACES int kill(pid_t process, int signal) noexcept {
  COHORT_NEXT(kill);
  stir();
  return real(process, signal);
}

COHORT_REPLACES ssize_t write(int descriptor, const void* bytes, std::size_t size) {
  COHORT_NEXT(write);
  stir();
  return real(descriptor, bytes, size);
}

COHORT_REPLACES ssize_t writev(int descriptor, const iovec* parts, int count) {
  COHORT_NEXT(writev);
  stir();
  return real(descriptor, parts, count);
}

COHORT_REPLACES int eventfd_write(int descriptor, eventfd_t value) {
  COHORT_NEXT(eventfd_write);
  stir();
  return real(descriptor, value);
}

COHORT_REPLACES ssize_t send(int descriptor, const void* bytes, std::size_t size, int flags) {
  COHORT_NEXT(send);
  stir();
  return real(descriptor, bytes, size, flags);
}

COHORT_REPLACES ssize_t sendto(int descriptor, const void* bytes, std::size_t size, int flags, const sockaddr* to,
                               socklen_t length) {
  COHORT_NEXT(sendto);
  stir();
  return real(descriptor, bytes, size, flags, to, length);
}

COHORT_REPLACES ssize_t sendmsg(int descriptor, const msghdr* message, int flags) {
  COHORT_NEXT(sendmsg);
  stir();
  return real(descriptor, message, flags);
}

COHORT_REPLACES int sendmmsg(int descriptor, mmsghdr* messages, unsigned count, int flags) {
  COHORT_NEXT(sendmmsg);
  stir();
  return real(descriptor, messages, count, flags);
}
