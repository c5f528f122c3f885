// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

/// The C library's waiting calls, and the time by which each waits in a program in virtual time.
namespace cohort::exec {

enum class Waits : std::uint8_t {
  by_virtual_time,  ///< replaced: ends at a time of the program's clock
  by_real_time,     ///< not replaced: its time limit is real time; causes a warning
  for_others,       ///< has no time limit
};

struct WaitingCall {
  std::string_view name;
  Waits waits;
};

inline constexpr WaitingCall waiting_calls[] = {
    {"sleep", Waits::by_virtual_time},
    {"usleep", Waits::by_virtual_time},
    {"nanosleep", Waits::by_virtual_time},
    {"__nanosleep", Waits::by_virtual_time},
    {"clock_nanosleep", Waits::by_virtual_time},
    {"thrd_sleep", Waits::by_virtual_time},
    {"poll", Waits::by_virtual_time},
    {"__poll", Waits::by_virtual_time},
    {"__poll_chk", Waits::by_virtual_time},
    {"ppoll", Waits::by_virtual_time},
    {"__ppoll_chk", Waits::by_virtual_time},
    {"select", Waits::by_virtual_time},
    {"__select", Waits::by_virtual_time},
    {"pselect", Waits::by_virtual_time},
    {"epoll_wait", Waits::by_virtual_time},
    {"epoll_pwait", Waits::by_virtual_time},
    {"epoll_pwait2", Waits::by_virtual_time},
    // Sockets with SO_RCVTIMEO.
    {"read", Waits::by_virtual_time},
    {"__read", Waits::by_virtual_time},
    {"__read_chk", Waits::by_virtual_time},
    {"readv", Waits::by_virtual_time},
    {"recv", Waits::by_virtual_time},
    {"__recv_chk", Waits::by_virtual_time},
    {"recvfrom", Waits::by_virtual_time},
    {"__recvfrom_chk", Waits::by_virtual_time},
    {"recvmsg", Waits::by_virtual_time},
    {"recvmmsg", Waits::by_virtual_time},
    {"accept", Waits::by_virtual_time},
    {"accept4", Waits::by_virtual_time},
    {"pthread_cond_timedwait", Waits::by_virtual_time},
    {"pthread_cond_clockwait", Waits::by_virtual_time},
    {"cnd_timedwait", Waits::by_virtual_time},
    {"sem_timedwait", Waits::by_virtual_time},
    {"sem_clockwait", Waits::by_virtual_time},
    {"pthread_mutex_timedlock", Waits::by_virtual_time},
    {"pthread_mutex_clocklock", Waits::by_virtual_time},
    {"mtx_timedlock", Waits::by_virtual_time},
    {"pthread_rwlock_timedrdlock", Waits::by_virtual_time},
    {"pthread_rwlock_clockrdlock", Waits::by_virtual_time},
    {"pthread_rwlock_timedwrlock", Waits::by_virtual_time},
    {"pthread_rwlock_clockwrlock", Waits::by_virtual_time},
    {"sigtimedwait", Waits::by_virtual_time},
    {"mq_timedreceive", Waits::by_virtual_time},
    {"mq_timedsend", Waits::by_virtual_time},
    {"alarm", Waits::by_virtual_time},
    {"ualarm", Waits::by_virtual_time},
    {"setitimer", Waits::by_virtual_time},
    {"timer_settime", Waits::by_virtual_time},
    {"timerfd_settime", Waits::by_virtual_time},

    {"pthread_timedjoin_np", Waits::by_real_time},
    {"pthread_clockjoin_np", Waits::by_real_time},
    {"semtimedop", Waits::by_real_time},
    {"aio_suspend", Waits::by_real_time},
    {"aio_suspend64", Waits::by_real_time},
    {"gai_suspend", Waits::by_real_time},
    {"setsockopt(SO_SNDTIMEO)", Waits::by_real_time},
    {"syscall", Waits::by_real_time},  // with the number of another call; futexes and sleeps are replaced

    {"pause", Waits::for_others},
    {"sigpause", Waits::for_others},
    {"__sigpause", Waits::for_others},
    {"__xpg_sigpause", Waits::for_others},
    {"sigsuspend", Waits::for_others},
    {"__sigsuspend", Waits::for_others},
    {"sigwait", Waits::for_others},
    {"sigwaitinfo", Waits::for_others},
    {"wait", Waits::for_others},
    {"__wait", Waits::for_others},
    {"wait3", Waits::for_others},
    {"wait4", Waits::for_others},
    {"waitid", Waits::for_others},
    {"waitpid", Waits::for_others},
    {"__waitpid", Waits::for_others},
    {"pthread_join", Waits::for_others},
    {"thrd_join", Waits::for_others},
    {"pthread_tryjoin_np", Waits::for_others},
    {"pthread_cond_wait", Waits::for_others},
    {"cnd_wait", Waits::for_others},
    {"pthread_barrier_wait", Waits::for_others},
    {"sem_wait", Waits::for_others},
};

inline constexpr std::size_t no_such_call = ~std::size_t{0};

/// Returns the number of a call among those that wait by real time.
constexpr std::size_t number_of_real_call(std::string_view name) {
  std::size_t number = 0;
  for (const WaitingCall& call : waiting_calls) {
    if (call.waits != Waits::by_real_time) continue;
    if (call.name == name) return number;
    ++number;
  }
  return no_such_call;
}
/// Returns the name of the call with this number; empty if there is none.
constexpr std::string_view name_of_real_call(std::size_t number) {
  for (const WaitingCall& call : waiting_calls)
    if (call.waits == Waits::by_real_time && number-- == 0) return call.name;
  return {};
}

}  // namespace cohort::exec
