// SPDX-License-Identifier: Apache-2.0
#include "tools/exec/preload/this_program.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include <utility>

namespace cohort::exec {

ClockPage* the_page = nullptr;
Process* this_process = nullptr;
__thread Thread self __attribute__((tls_model("initial-exec")));

namespace {

const char* name_in(const char* path) {
  const char* slash = ::strrchr(path, '/');
  return slash == nullptr ? path : slash + 1;
}

bool begins_with(const char* text, const char* start) { return ::strncmp(text, start, ::strlen(start)) == 0; }

std::uint8_t judge(const void* caller) {
  static const void* const python = ::dlsym(RTLD_DEFAULT, "Py_IsInitialized");
  Dl_info there{};
  if (::dladdr(caller, &there) == 0 || there.dli_fname == nullptr) return 1;
  const char* const name = name_in(there.dli_fname);
  std::uint8_t what = 1;
  for (const char* dds : {"libddsc", "libdds_security", "libfastrtps", "libfastdds", "libfastcdr", "libiceoryx"})
    if (begins_with(name, dds)) what |= 2;
  Dl_info here{};
  static int somewhere;
  if (::dladdr(&somewhere, &here) != 0 && here.dli_fbase == there.dli_fbase) what |= 4;
  const bool has_python = python != nullptr && ::dladdr(python, &here) != 0 && here.dli_fbase == there.dli_fbase;
  if (has_python || begins_with(name, "libpython")) what |= 8;
  return what;
}

std::uint8_t verdict_on(const void* caller) {
  auto& slot = self.verdicts[(reinterpret_cast<std::uintptr_t>(caller) >> 2U) & 255U];
  if (slot.caller != caller || slot.what == 0) slot = {caller, judge(caller)};
  return slot.what;
}

// In the child of a fork only the thread that forked goes on.
void begin_child() {
  if (the_page == nullptr) return;
  forget_waits();
  enter_process();
}

__attribute__((constructor(101))) void begin() {
  const char* const path = ::getenv(page_variable);
  if (path == nullptr) return;
  const int file = ::open(path, O_RDWR | O_CLOEXEC);
  if (file < 0) return;
  void* const memory = ::mmap(nullptr, sizeof(ClockPage), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  ::close(file);
  if (memory == MAP_FAILED) return;
  the_page = static_cast<ClockPage*>(memory);
  if (the_page->version != page_version) {
    the_page = nullptr;
    return;
  }
  enter_process();
  if (the_page == nullptr) return;
  order_of_thread();
  ::pthread_atfork(nullptr, nullptr, &begin_child);
}

std::int64_t offset_of(clockid_t clock) {
  return clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE || clock == CLOCK_TAI ? the_page->date.load() : 0;
}

}  // namespace

void enter_process() {
  const std::int32_t id = ::getpid();
  this_process = nullptr;
  for (Process& process : the_page->processes)  // the parent may have entered it
    if (process.id == id) this_process = &process;
  for (Process& process : the_page->processes) {
    std::int32_t free = 0;
    if (this_process == nullptr && process.id.compare_exchange_strong(free, id)) this_process = &process;
  }
  if (this_process == nullptr) {
    the_page = nullptr;
    return;
  }
  this_process->has_started = 1;
  this_process->real_calls = 0;
  this_process->turn = 0;
  the_page->threads.fetch_add(1);
}

void note_real_sleep() {
  if (the_page == nullptr || std::exchange(self.has_slept_really, true)) return;
  for (std::atomic<std::int32_t>& each : the_page->real_sleepers) {
    std::int32_t free = 0;
    if (each.compare_exchange_strong(free, id_of_thread())) return;
  }
}

ClockPage* page() { return the_page; }

bool is_real(const void* caller) {
  return the_page == nullptr || self.uses_real_time > 0 || (verdict_on(caller) & 6U) != 0;
}
bool is_virtual_for(const void* caller) { return !is_real(caller) && the_page->is_real == 0; }
bool is_dds(const void* caller) { return the_page != nullptr && (verdict_on(caller) & 2U) != 0; }
bool is_interpreter(const void* caller) { return the_page != nullptr && (verdict_on(caller) & 8U) != 0; }

std::int64_t real_time(clockid_t clock) {
  timespec time{};
  call_system(SYS_clock_gettime, clock, reinterpret_cast<long>(&time));
  return nanoseconds(time);
}

bool is_virtual(clockid_t clock) {
  switch (clock) {
    case CLOCK_REALTIME:
    case CLOCK_REALTIME_COARSE:
    case CLOCK_MONOTONIC:
    case CLOCK_MONOTONIC_COARSE:
    case CLOCK_MONOTONIC_RAW:
    case CLOCK_BOOTTIME:
    case CLOCK_TAI: return true;
    default: return false;  // processor time
  }
}

std::int64_t now() {
  const std::int64_t time = the_page->now;
  return the_page->is_real != 0 ? time + real_time(CLOCK_MONOTONIC) - the_page->real_from : time;
}

std::int64_t virtual_time(clockid_t clock) { return now() + offset_of(clock); }
std::int64_t on_page(clockid_t clock, std::int64_t time) { return time - offset_of(clock); }

timespec in_real_time(clockid_t clock, std::int64_t deadline) {
  return to_timespec(real_time(clock) + deadline - now());
}

void note_real_time(std::size_t number) {
  const std::uint64_t bit = std::uint64_t{1} << number;
  if ((this_process->real_calls.fetch_or(bit) & bit) == 0) the_page->real_calls.fetch_add(1);
}

Override::Override(std::int64_t deadline) : before_(self.overridden) { self.overridden = deadline + 1; }
Override::~Override() { self.overridden = before_; }
std::int64_t overridden() { return self.overridden == 0 ? never : self.overridden - 1; }

}  // namespace cohort::exec

using namespace cohort::exec;

// For clients of DDS that know of virtual time: what the network goes by.
COHORT_REPLACES std::int64_t cohort_exec_real_time() { return real_time(CLOCK_MONOTONIC); }
COHORT_REPLACES void cohort_exec_use_real_time(int change) { self.uses_real_time += change; }
