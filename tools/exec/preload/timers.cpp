// SPDX-License-Identifier: Apache-2.0

// Timers: of descriptors (timerfd), of signals and threads (timer_create), of the process (setitimer, alarm).

#include <errno.h>
#include <signal.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include "tools/exec/preload/virtual_clock.hpp"

using namespace cohort::exec;

#define COHORT_CALLER __builtin_return_address(0)

namespace {

struct Timer {
  std::atomic<std::uint32_t> is_used{0};
  clockid_t clock = CLOCK_MONOTONIC;
  std::int64_t deadline = never;
  std::int64_t interval = 0;
  Wait* wait = nullptr;
  int descriptor = -1;    // for a timerfd
  sigevent event{};       // for timer_create
  bool is_alarm = false;  // for setitimer
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
};
constexpr int most_timers = 256;
Timer timers[most_timers];

void* call_function(void* given) {
  const auto* const timer = static_cast<const Timer*>(given);
  timer->event.sigev_notify_function(timer->event.sigev_value);
  return nullptr;
}

void notify(Timer& timer, std::uint64_t times) {
  if (timer.descriptor >= 0) {
    (void)!::write(timer.descriptor, &times, sizeof times);
  } else if (timer.is_alarm) {
    ::kill(::getpid(), SIGALRM);
  } else if (timer.event.sigev_notify == SIGEV_THREAD) {
    pthread_t thread{};
    if (::pthread_create(&thread, static_cast<pthread_attr_t*>(timer.event.sigev_notify_attributes), &call_function,
                         &timer) == 0)
      ::pthread_detach(thread);
  } else if (timer.event.sigev_notify != SIGEV_NONE) {
    ::sigqueue(::getpid(), timer.event.sigev_signo, timer.event.sigev_value);
  }
}

void expire(void* given) {
  Timer& timer = *static_cast<Timer*>(given);
  ::pthread_mutex_lock(&timer.mutex);
  std::uint64_t times = 0;
  if (timer.wait != nullptr && timer.deadline <= now()) {
    times = 1;
    if (timer.interval > 0) {
      times += static_cast<std::uint64_t>((now() - timer.deadline) / timer.interval);
      timer.deadline += static_cast<std::int64_t>(times) * timer.interval;
    } else {
      timer.deadline = never;
    }
    set_timer(timer.wait, timer.deadline);
  }
  ::pthread_mutex_unlock(&timer.mutex);
  if (times > 0) notify(timer, times);
}

Timer* take_timer() {
  for (Timer& timer : timers) {
    std::uint32_t free = 0;
    if (!timer.is_used.compare_exchange_strong(free, 1)) continue;
    timer.clock = CLOCK_MONOTONIC;
    timer.deadline = never;
    timer.interval = 0;
    timer.descriptor = -1;
    timer.event = {};
    timer.is_alarm = false;
    timer.wait = make_timer({.kind = Ending::Kind::call, .object = &timer, .call = &expire});
    if (timer.wait != nullptr) return &timer;
    timer.is_used = 0;
    break;
  }
  errno = EAGAIN;
  return nullptr;
}

void give_back(Timer& timer) {
  ::pthread_mutex_lock(&timer.mutex);
  remove_timer(timer.wait);
  timer.wait = nullptr;
  ::pthread_mutex_unlock(&timer.mutex);
  timer.is_used = 0;
}

Timer* timer_of(int descriptor) {
  for (Timer& timer : timers)
    if (timer.is_used != 0 && timer.descriptor == descriptor) return &timer;
  return nullptr;
}

struct Setting {
  std::int64_t left = 0;  // 0: off
  std::int64_t interval = 0;
};

Setting setting_of(Timer& timer) {
  ::pthread_mutex_lock(&timer.mutex);
  const Setting setting{timer.deadline == never  ? 0
                        : timer.deadline > now() ? timer.deadline - now()
                                                 : 1,
                        timer.interval};
  ::pthread_mutex_unlock(&timer.mutex);
  return setting;
}

void set(Timer& timer, std::int64_t value, bool is_absolute, std::int64_t interval) {
  ::pthread_mutex_lock(&timer.mutex);
  timer.interval = interval;
  timer.deadline = value == 0 ? never : is_absolute ? on_page(timer.clock, value) : later(now(), value);
  set_timer(timer.wait, timer.deadline);
  ::pthread_mutex_unlock(&timer.mutex);
}

itimerspec to_spec(const Setting& setting) { return {to_timespec(setting.interval), to_timespec(setting.left)}; }

}  // namespace

// An event descriptor stands for one: it counts and is polled in the same way.
COHORT_REPLACES int timerfd_create(int clock, int flags) noexcept {
  COHORT_NEXT(timerfd_create);
  if (is_real(COHORT_CALLER) || page()->is_real != 0) return real(clock, flags);
  const int descriptor = ::eventfd(0, flags);
  if (descriptor < 0) return -1;
  Timer* const timer = take_timer();
  if (timer == nullptr) {
    ::close(descriptor);
    errno = EMFILE;
    return -1;
  }
  if (Timer* const old = timer_of(descriptor)) give_back(*old);  // which was closed
  timer->clock = clock;
  timer->descriptor = descriptor;
  return descriptor;
}

COHORT_REPLACES int timerfd_settime(int descriptor, int flags, const itimerspec* value, itimerspec* before) noexcept {
  COHORT_NEXT(timerfd_settime);
  Timer* const timer = is_real(COHORT_CALLER) ? nullptr : timer_of(descriptor);
  if (timer == nullptr) return real(descriptor, flags, value, before);
  if (!is_valid(value->it_value) || !is_valid(value->it_interval)) {
    errno = EINVAL;
    return -1;
  }
  if (before != nullptr) *before = to_spec(setting_of(*timer));
  set(*timer, nanoseconds(value->it_value), (flags & TFD_TIMER_ABSTIME) != 0, nanoseconds(value->it_interval));
  return 0;
}

COHORT_REPLACES int timerfd_gettime(int descriptor, itimerspec* value) noexcept {
  COHORT_NEXT(timerfd_gettime);
  Timer* const timer = is_real(COHORT_CALLER) ? nullptr : timer_of(descriptor);
  if (timer == nullptr) return real(descriptor, value);
  *value = to_spec(setting_of(*timer));
  return 0;
}

namespace {
bool is_ours(timer_t timer) {
  const auto* const one = static_cast<const Timer*>(timer);
  return one >= timers && one < timers + most_timers;
}
}  // namespace

COHORT_REPLACES int timer_create(clockid_t clock, sigevent* event, timer_t* id) noexcept {
  COHORT_NEXT_VERSION(timer_create, "GLIBC_2.3.3");
  if (is_real(COHORT_CALLER) || page()->is_real != 0 || !is_virtual(clock)) return real(clock, event, id);
  Timer* const timer = take_timer();
  if (timer == nullptr) return -1;
  timer->clock = clock;
  if (event != nullptr) {
    timer->event = *event;
  } else {
    timer->event.sigev_notify = SIGEV_SIGNAL;
    timer->event.sigev_signo = SIGALRM;
  }
  *id = timer;
  return 0;
}

COHORT_REPLACES int timer_settime(timer_t id, int flags, const itimerspec* value, itimerspec* before) noexcept {
  COHORT_NEXT_VERSION(timer_settime, "GLIBC_2.3.3");
  if (!is_ours(id)) return real(id, flags, value, before);
  auto& timer = *static_cast<Timer*>(id);
  if (before != nullptr) *before = to_spec(setting_of(timer));
  set(timer, nanoseconds(value->it_value), (flags & TIMER_ABSTIME) != 0, nanoseconds(value->it_interval));
  return 0;
}

COHORT_REPLACES int timer_gettime(timer_t id, itimerspec* value) noexcept {
  COHORT_NEXT_VERSION(timer_gettime, "GLIBC_2.3.3");
  if (!is_ours(id)) return real(id, value);
  *value = to_spec(setting_of(*static_cast<Timer*>(id)));
  return 0;
}

COHORT_REPLACES int timer_delete(timer_t id) noexcept {
  COHORT_NEXT_VERSION(timer_delete, "GLIBC_2.3.3");
  if (!is_ours(id)) return real(id);
  give_back(*static_cast<Timer*>(id));
  return 0;
}

namespace {
Timer* alarm_timer() {
  static Timer* timer = nullptr;
  if (timer == nullptr) timer = take_timer();
  if (timer != nullptr) timer->is_alarm = true;
  return timer;
}
}  // namespace

COHORT_REPLACES int setitimer(__itimer_which_t which, const itimerval* value, itimerval* before) noexcept {
  COHORT_NEXT(setitimer);
  if (which != ITIMER_REAL || is_real(COHORT_CALLER) || page()->is_real != 0) return real(which, value, before);
  Timer* const timer = alarm_timer();
  if (timer == nullptr) return -1;
  const Setting setting = setting_of(*timer);
  if (before != nullptr)
    *before = {{setting.interval / second, setting.interval % second / 1000},
               {setting.left / second, setting.left % second / 1000}};
  set(*timer, nanoseconds(value->it_value), false, nanoseconds(value->it_interval));
  return 0;
}

COHORT_REPLACES unsigned alarm(unsigned time) noexcept {
  COHORT_NEXT(alarm);
  if (is_real(COHORT_CALLER) || page()->is_real != 0) return real(time);
  Timer* const timer = alarm_timer();
  if (timer == nullptr) return 0;
  const Setting setting = setting_of(*timer);
  set(*timer, time * second, false, 0);
  return static_cast<unsigned>((setting.left + second - 1) / second);
}

COHORT_REPLACES useconds_t ualarm(useconds_t time, useconds_t interval) noexcept {
  COHORT_NEXT(ualarm);
  if (is_real(COHORT_CALLER) || page()->is_real != 0) return real(time, interval);
  Timer* const timer = alarm_timer();
  if (timer == nullptr) return 0;
  const Setting setting = setting_of(*timer);
  set(*timer, time * 1000LL, false, interval * 1000LL);
  return static_cast<useconds_t>((setting.left + 999) / 1000);
}
