// SPDX-License-Identifier: Apache-2.0

// Waits that end in virtual time: in the page, and what ends them in this process.

#include <errno.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "tools/exec/preload/this_program.hpp"
#include "tools/exec/preload/turns.hpp"

namespace cohort::exec {
namespace {

Ending endings[most_waits];  // endings of this process's waits, by their index in the page
std::atomic<bool> has_helper{false};

// The page's wait that is free is taken for this process.
Wait* take_wait() {
  const std::int32_t process = ::getpid();
  for (std::size_t i = 0; i < most_waits; ++i) {
    std::int32_t free = 0;
    Wait& wait = the_page->waits[i];
    if (wait.process.load(std::memory_order_relaxed) != 0 || !wait.process.compare_exchange_strong(free, process))
      continue;
    wait.deadline = never;
    wait.kind = WaitKind::none;
    wait.wake = 0;
    std::uint32_t used = the_page->waits_used;
    while (used < i + 1 && !the_page->waits_used.compare_exchange_weak(used, static_cast<std::uint32_t>(i + 1)))
      ;
    return &wait;
  }
  constexpr char text[] = "cohort exec: too many threads and timers for virtual time\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, sizeof text - 1);
  return nullptr;
}

void release(Wait* wait) {
  wait->deadline = never;
  wait->kind = WaitKind::none;
  wait->thread = 0;
  wait->process = 0;
}

Ending& ending_of(const Wait* wait) { return endings[wait - the_page->waits.data()]; }

void end_wait(const Ending& ending) {
  switch (ending.kind) {
    case Ending::Kind::none: return;
    case Ending::Kind::write_event: {
      const std::uint64_t one = 1;
      [[maybe_unused]] const ssize_t written = ::write(ending.descriptor, &one, sizeof one);
      return;
    }
    case Ending::Kind::broadcast: ::pthread_cond_broadcast(static_cast<pthread_cond_t*>(ending.object)); return;
    case Ending::Kind::wake_futex:  // private or shared
      for (const int operation : {FUTEX_WAKE, FUTEX_WAKE_PRIVATE})
        call_system(SYS_futex, reinterpret_cast<long>(ending.object), operation, 0x7fffffff);
      return;
    case Ending::Kind::call: ending.call(ending.object); return;
  }
}

void* help(void*) {
  self.is_helper = true;
  for (;;) {
    const std::uint32_t seen = this_process->attention;
    const std::int32_t process = this_process->id;
    for (std::uint32_t i = 0; i < the_page->waits_used; ++i) {
      Wait& wait = the_page->waits[i];
      if (wait.process != process || wait.kind != WaitKind::helper || wait.wake == 0) continue;
      const Ending ending = endings[i];
      if (wait.thread == 0) wait.wake = 0;  // a timer, which may be set again
      end_wait(ending);
    }
    futex<std::uint32_t>(this_process->attention, FUTEX_WAIT, seen);
  }
  return nullptr;
}

void need_helper() {
  if (has_helper.exchange(true)) return;
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  const auto create = next_of<"pthread_create", Create>();
  sigset_t all;
  sigset_t before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  pthread_t thread{};
  if (create(&thread, nullptr, &help, nullptr) == 0) ::pthread_detach(thread);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  the_page->threads.fetch_add(1);
}
}  // namespace

void note_change() {
  the_page->changes.fetch_add(1);
  if (the_page->host_waits.load() != 0) futex<std::uint32_t>(the_page->changes, FUTEX_WAKE, 1);
}

Wait* wait_of_thread() {
  if (self.wait == nullptr) {
    self.wait = take_wait();
    if (self.wait == nullptr) return nullptr;
    self.wait->order = order_of_thread();
    self.wait->thread = id_of_thread();
  }
  return self.wait;
}

std::uint64_t order_of_thread() {
  if (!self.has_order) {
    self.order = the_page->next_order.fetch_add(1);
    self.has_order = true;
  }
  return self.order;
}

void leave_thread() {
  if (self.wait != nullptr) release(self.wait);
  self.wait = nullptr;
  if (self.event != 0) ::close(self.event - 1);
  self.event = 0;
}

void forget_waits() {
  self.wait = nullptr;
  self.has_order = false;
  self.event = 0;
  self.id = 0;
  self.has_slept_really = false;
  has_helper = false;
  forget_turns();
  for (Ending& ending : endings) ending = {};
}

void count_spin() {
  if (self.is_helper || ++self.reads < reads_before_it_spins) return;
  sleep_until(later(now(), spin_quantum));
}

namespace {
// After the end of virtual time everybody sleeps by the machine's clock.
bool sleep_really(std::int64_t deadline) {
  const std::int64_t left = deadline - now();
  if (left <= 0) return true;
  const timespec time = to_timespec(left);
  return call_system(SYS_clock_nanosleep, CLOCK_MONOTONIC, 0, reinterpret_cast<long>(&time), 0) == 0;
}

// Returns whether no other wait ends before this one and no other thread can be awake.
bool is_alone(const Wait& wait, std::int64_t deadline) {
  if (the_page->alone != wait.thread || deadline > the_page->alone_until || the_page->stirs != the_page->alone_since)
    return false;
  for (std::uint32_t i = 0; i < the_page->waits_used; ++i) {
    const Wait& other = the_page->waits[i];
    if (&other == &wait || other.process == 0 || other.kind == WaitKind::none) continue;
    if (other.deadline < deadline || (other.deadline == deadline && other.order < wait.order)) return false;
  }
  return true;
}
}  // namespace

void stir() {
  if (the_page != nullptr) the_page->stirs.fetch_add(1, std::memory_order_relaxed);
}

bool sleep_until(std::int64_t deadline) {
  self.reads = 0;
  if (the_page->is_real != 0) return sleep_really(deadline);
  if (deadline <= now()) return true;
  Wait* const wait = wait_of_thread();
  if (wait == nullptr) return sleep_really(later(now(), 1'000'000));
  if (is_alone(*wait, deadline)) {
    the_page->now = deadline;
    return true;
  }
  wait->wake = 0;
  wait->deadline = deadline;
  wait->kind = WaitKind::sleep;
  note_change();
  bool is_whole = true;
  // A wait with a limit is one that each handled signal ends, as it ends each sleep.
  const timespec long_time = to_timespec(never);
  while (wait->wake == 0 && the_page->is_real == 0) {
    const long result =
        call_system(SYS_futex, reinterpret_cast<long>(&wait->wake), FUTEX_WAIT, 0, reinterpret_cast<long>(&long_time));
    if (result == 0 || errno != EINTR) continue;
    is_whole = false;
    break;
  }
  wait->kind = WaitKind::none;
  wait->deadline = never;
  return is_whole && (the_page->is_real == 0 || sleep_really(deadline));
}

TimedWait::TimedWait(std::int64_t deadline, const Ending& ending) : deadline_(deadline), wait_(wait_of_thread()) {
  self.reads = 0;
  if (wait_ == nullptr) return;
  need_helper();
  ending_of(wait_) = ending;
  wait_->wake = 0;
  wait_->deadline = deadline;
  wait_->kind = WaitKind::helper;
  note_change();
}

TimedWait::~TimedWait() {
  if (wait_ == nullptr) return;
  wait_->kind = WaitKind::none;
  wait_->deadline = never;
}

bool TimedWait::is_over() const { return wait_ == nullptr || wait_->wake != 0 || now() >= deadline_; }

Wait* make_timer(const Ending& ending) {
  need_helper();
  Wait* const timer = take_wait();
  if (timer == nullptr) return nullptr;
  timer->order = the_page->next_order.fetch_add(1);
  ending_of(timer) = ending;
  timer->kind = WaitKind::helper;
  return timer;
}

void set_timer(Wait* timer, std::int64_t deadline) {
  timer->wake = 0;
  timer->deadline = deadline;
  note_change();
}

void remove_timer(Wait* timer) { release(timer); }

int event_of_thread() {
  if (self.event == 0) self.event = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK) + 1;
  std::uint64_t count = 0;
  while (::read(self.event - 1, &count, sizeof count) > 0)
    ;
  return self.event - 1;
}

}  // namespace cohort::exec
