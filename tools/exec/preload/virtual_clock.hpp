// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dlfcn.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/time.h>
#include <time.h>

#include <cstddef>
#include <cstdint>

#include "tools/exec/clock_page.hpp"
#include "tools/exec/waiting_calls.hpp"

/// Functions shared by the calls that this library replaces: the time that a caller gets, and waits that end in virtual
/// time. The library runs inside arbitrary programs. Therefore it uses no exceptions, no heap and no C++ library.
namespace cohort::exec {

#define COHORT_REPLACES extern "C" __attribute__((visibility("default")))

inline constexpr std::int64_t second = 1'000'000'000;
inline constexpr timespec past{};  ///< a time limit that has passed: a call with it does not wait

/// Returns the function that a call would reach without this library.
template <class Function>
Function next(const char* name, const char* version = nullptr) {
  void* found = version != nullptr ? ::dlvsym(RTLD_NEXT, name, version) : nullptr;
  if (found == nullptr) found = ::dlsym(RTLD_NEXT, name);
  return reinterpret_cast<Function>(found);
}
/// Like `next`, but also finds a function of a library that was loaded without RTLD_GLOBAL, as Python does. That is the
/// library on which the library of `caller` depends.
template <class Function>
Function next_for(const void* caller, const char* name) {
  if (const auto found = next<Function>(name)) return found;
  Dl_info info{};
  if (::dladdr(caller, &info) == 0) return nullptr;
  void* library = ::dlopen(info.dli_fname, RTLD_LAZY | RTLD_NOLOAD);
  void* found = library != nullptr ? ::dlsym(library, name) : nullptr;
  if (library != nullptr) ::dlclose(library);
  return reinterpret_cast<Function>(found);
}

/// A name as a template parameter.
template <std::size_t size>
struct Name {
  constexpr Name(const char (&its_text)[size]) {  // NOLINT(google-explicit-constructor): for literals
    for (std::size_t i = 0; i < size; ++i) text[i] = its_text[i];
  }
  char text[size]{};
};
// Initialised when this library is loaded, unless a call came earlier. A later search could deadlock: it waits for
// threads that load libraries, and these may wait for something that the searching thread holds.
template <Name name, class Function, Name version>
inline Function found_next = next<Function>(name.text, version.text[0] == '\0' ? nullptr : version.text);
template <Name name, class Function, Name version = "">
Function next_of() {
  Function& found = found_next<name, Function, version>;
  if (found == nullptr) found = next<Function>(name.text, version.text[0] == '\0' ? nullptr : version.text);
  return found;
}
#define COHORT_NEXT(name) const auto real = cohort::exec::next_of<#name, decltype(&::name)>()
#define COHORT_NEXT_VERSION(name, version) const auto real = cohort::exec::next_of<#name, decltype(&::name), version>()

inline std::int64_t nanoseconds(const timespec& time) { return time.tv_sec * second + time.tv_nsec; }
inline std::int64_t nanoseconds(const timeval& time) { return time.tv_sec * second + time.tv_usec * 1000; }
inline timespec to_timespec(std::int64_t time) { return {time / second, time % second}; }
inline bool is_valid(const timespec& time) { return time.tv_sec >= 0 && time.tv_nsec >= 0 && time.tv_nsec < second; }

/// Returns the sum, limited to `never`.
inline std::int64_t later(std::int64_t time, std::int64_t by) { return by >= never - time ? never : time + by; }

/// Returns the page; nullptr in a program that runs in real time.
ClockPage* page();

/// Returns whether a caller gets the machine's time: a DDS library, this library, or any caller if there is no page.
bool is_real(const void* caller);
/// Returns whether a caller gets virtual time, and virtual time has not ended.
bool is_virtual_for(const void* caller);
/// Returns whether a caller is the Python interpreter itself, which passes its lock between threads by real time.
bool is_interpreter(const void* caller);
/// Returns whether a caller is a DDS library.
bool is_dds(const void* caller);

/// Returns the machine's time.
std::int64_t real_time(clockid_t clock);
/// Returns whether this clock is virtual in the program.
bool is_virtual(clockid_t clock);
/// Returns the program's time on a virtual clock.
std::int64_t virtual_time(clockid_t clock);
/// Converts a time of a virtual clock to CLOCK_MONOTONIC of the program.
std::int64_t on_page(clockid_t clock, std::int64_t time);
std::int64_t now();
/// Converts a time of the page to the machine's clock, after the end of virtual time.
timespec in_real_time(clockid_t clock, std::int64_t deadline);

void note_real_time(std::size_t number);
/// Records, for a warning, that this process makes a call that waits in real time.
template <Name name>
void note_real_time() {
  constexpr std::size_t number = number_of_real_call(name.text);
  static_assert(number != no_such_call, "a row of waiting_calls.hpp");
  note_real_time(number);
}

/// Records that the calling thread is about to sleep in real time through this library, as DDS threads do. The host
/// warns about threads that sleep without this record.
void note_real_sleep();

/// Records that the calling thread is about to do something that may wake another thread.
void stir();

/// Counts a read of the clock or an unsuccessful poll. After many of these in a row, the thread waits.
void count_spin();

/// The helper thread's action at the end of a wait.
struct Ending {
  enum class Kind : std::uint8_t { none, write_event, broadcast, wake_futex, call } kind = Kind::none;
  int descriptor = -1;
  void* object = nullptr;         // a condition variable, or a futex
  void (*call)(void*) = nullptr;  // with `object`
};

/// Sleeps until a virtual time. Returns false if a signal handler has run before.
bool sleep_until(std::int64_t deadline);

/// A wait of the calling thread for an event, until `deadline` at the latest. The helper thread ends the wait by
/// `ending`, possibly more than once.
class TimedWait {
 public:
  TimedWait(std::int64_t deadline, const Ending& ending);
  ~TimedWait();
  TimedWait(const TimedWait&) = delete;
  TimedWait& operator=(const TimedWait&) = delete;
  bool is_over() const;

 private:
  std::int64_t deadline_;
  Wait* wait_;
};

/// Polls until a virtual time. A `deadline` of 0 does not wait.
int poll_until(pollfd* polled, nfds_t count, std::int64_t deadline, const sigset_t* mask);

/// Makes a timer, which is a wait that belongs to no thread. Returns nullptr if there are too many.
Wait* make_timer(const Ending& ending);
void set_timer(Wait* timer, std::int64_t deadline);
void remove_timer(Wait* timer);

/// Drains and returns this thread's event descriptor, which ends its polls.
int event_of_thread();

/// Replaces the time limits that libraries pass to this thread's waits by `deadline`. `overridden` returns `never` if
/// there is no override.
struct Override {
  explicit Override(std::int64_t deadline);
  ~Override();
  Override(const Override&) = delete;
  Override& operator=(const Override&) = delete;

 private:
  std::int64_t before_;
};
std::int64_t overridden();

/// Sets whether threads that this thread creates belong to DDS, until the destructor restores the former value.
struct CreatesThreadsOfDds {
  explicit CreatesThreadsOfDds(bool they_do);
  ~CreatesThreadsOfDds();
  CreatesThreadsOfDds(const CreatesThreadsOfDds&) = delete;
  CreatesThreadsOfDds& operator=(const CreatesThreadsOfDds&) = delete;

 private:
  bool before_;
};
/// Returns whether the calling thread belongs to DDS.
bool is_thread_of_dds();

}  // namespace cohort::exec
