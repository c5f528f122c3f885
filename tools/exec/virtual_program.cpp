// SPDX-License-Identifier: Apache-2.0
#include "tools/exec/virtual_program.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <fstream>
#include <mutex>
#include <set>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tools/exec/clock_page.hpp"
#include "tools/exec/program_file.hpp"
#include "tools/exec/program_start.hpp"
#include "tools/exec/real_time_reports.hpp"
#include "tools/exec/thread_watch.hpp"

namespace cohort::exec {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto longest_nap = 1ms;
constexpr auto given_up_is_asked_every = 100ms;
constexpr auto busy_is_told_after = 5s;
constexpr auto check_interval = 1s;
constexpr auto to_come_to_rest = 200ms;
constexpr auto longest_real_sleep = 2s;  // twice the longest that threads of Fast DDS sleep by default
constexpr int looks_between_lists = 256;

void wait_on(std::atomic<std::uint32_t>& word, std::uint32_t seen, std::chrono::nanoseconds at_most) {
  const timespec time{at_most.count() / 1'000'000'000, at_most.count() % 1'000'000'000};
  ::syscall(SYS_futex, &word, FUTEX_WAIT, seen, &time, nullptr, 0);
}

void wake(std::atomic<std::uint32_t>& word) {
  ::syscall(SYS_futex, &word, FUTEX_WAKE, 0x7fffffff, nullptr, nullptr, 0);
}

VirtualProgram::Options named(VirtualProgram::Options options) {
  if (options.name.empty()) options.name = options.command.front();
  return options;
}

}  // namespace

struct VirtualProgram::State {
  explicit State(Options given) : options(named(std::move(given))), page(file.page()), reports(page, options.name) {
    const std::filesystem::path program = file_of_command(options.command.front());
    if (const std::string why = why_not_virtual(program); !why.empty())
      throw std::runtime_error("'" + options.name + "' cannot run in virtual time: " + why);
    page.now = options.start.count();
    page.date = options.date.count();
    process = start_program(options, program, file.path());
    enter(process);
  }

  void enter(pid_t child) {
    for (Process& each : page.processes)
      if (each.id == child) return;
    for (Process& each : page.processes) {
      std::int32_t free = 0;
      if (each.id.compare_exchange_strong(free, child)) break;
    }
    page.threads.fetch_add(1);
  }

  bool has_ended() {
    if (status) return true;
    int how = 0;
    if (::waitpid(process, &how, WNOHANG) != process) return false;
    tell_all(reports.new_calls(process));
    status = WIFEXITED(how) ? WEXITSTATUS(how) : 128 + WTERMSIG(how);
    return true;
  }

  // Processes that have ended are forgotten, with their waits.
  std::vector<pid_t> living_processes() {
    reports.note_calls();
    std::vector<pid_t> living;
    for (Process& each : page.processes) {
      const std::int32_t id = each.id;
      if (id == 0) continue;
      if (::kill(id, 0) == 0 || errno == EPERM) {
        if (std::ranges::find(living, id) == living.end()) living.push_back(id);
        continue;
      }
      for (Wait& wait : page.waits)
        if (wait.process == id) wait.process = 0;
      each.id = 0;
      each.has_started = 0;
      each.real_calls = 0;
      reports.forget(id);
    }
    return living;
  }

  // Processes that one has started, also without a call that the library replaces.
  void find_children(pid_t parent) {
    enter(parent);
    std::ifstream list("/proc/" + std::to_string(parent) + "/task/" + std::to_string(parent) + "/children");
    for (pid_t child = 0; list >> child;) find_children(child);
  }

  bool is_at_rest() {
    const std::uint32_t threads = page.threads;
    if (threads != listed_threads || watch.has_changed() || ++looks >= looks_between_lists) {
      looks = 0;
      listed_threads = threads;
      may_have_new_images = true;
      watch.look_at(living_processes());
    }
    if (!watch.all_wait()) return false;
    // A process that was started by a call that the library does not replace begins to be watched here.
    for (const pid_t child : watch.children()) enter(child);
    return page.threads == listed_threads && has_started();
  }

  // A thread of DDS that sleeps by the machine's clock may hold what others need to receive messages. Fast DDS does so
  // while it looks whether a peer's shared memory is in order. But a thread that sleeps again and again is at rest.
  // `since`: when such sleeps began to be all that happens; set here.
  bool library_sleeps(std::optional<Clock::time_point>& since) {
    bool any = false;
    for (const std::atomic<std::int32_t>& each : page.real_sleepers) {
      const std::int32_t thread = each;
      if (thread == 0) break;
      if (habitual_sleepers.contains(thread) || !watch.sleeps(thread)) continue;
      if (!since) since = Clock::now();
      if (Clock::now() - *since > longest_real_sleep) habitual_sleepers.insert(thread);
      any = true;
    }
    return any;
  }

  // The library announces itself before the program's own code runs.
  bool has_started() {
    return std::ranges::any_of(page.processes,
                               [this](const Process& each) { return each.id == process && each.has_started != 0; });
  }

  bool settle() {
    page.host_looks = 1;
    bool runs = find_rest();
    page.host_looks = 0;
    // A thread may have become ready before that was set.
    while (runs && has_ready()) {
      page.host_looks = 1;
      runs = find_rest();
      page.host_looks = 0;
    }
    return runs;
  }

  bool find_rest() {
    Clock::time_point begin = Clock::now();
    Clock::time_point ask_at = begin + given_up_is_asked_every;
    std::optional<Clock::time_point> only_sleeps_since;
    std::chrono::nanoseconds ran = watch.processor_time();
    for (;;) {
      const std::uint32_t seen = page.changes;
      const bool rests = is_at_rest() && !library_sleeps(only_sleeps_since);
      if (rests) page.no_turns = 0;
      if (rests && !give_turn()) {
        has_settled = true;
        check_now_and_then();
        return !has_ended();
      }
      if (has_ended()) return false;
      const Clock::time_point now = Clock::now();
      if (rests) {
        begin = now;
        only_sleeps_since.reset();
        ran = watch.processor_time();
      }
      nap(seen, now - begin);
      if (now < ask_at) continue;
      ask_at = now + given_up_is_asked_every;
      find_children(process);
      tell_all(reports.new_calls(process));
      if (options.given_up && options.given_up()) return false;
      if (page.no_turns == 0 && watch.processor_time() - ran > busy_is_told_after) release_turns();
      if (now - begin > busy_is_told_after && !std::exchange(has_told_busy, true)) tell_busy();
    }
  }

  void nap(std::uint32_t seen, Clock::duration since_begin) {
    page.host_waits = 1;
    wait_on(page.changes, seen,
            std::min<Clock::duration>(longest_nap, std::max<Clock::duration>(since_begin / 4, 20us)));
    page.host_waits = 0;
  }

  // Lets one of the threads go on that wait for their turn, by the order in which they were created. Each goes on once
  // before another one does so twice.
  bool give_turn() {
    Wait* next = nullptr;
    bool has_any = false;
    for (Wait& wait : used_waits()) {
      if (wait.process == 0 || wait.kind != WaitKind::turn || wait.is_ready == 0 || wait.wake != 0) continue;
      has_any = true;
      if (!had_turns.contains(&wait) && (next == nullptr || wait.order < next->order)) next = &wait;
    }
    if (next == nullptr) had_turns.clear();
    if (!has_any) return false;
    if (next == nullptr) return give_turn();
    had_turns.insert(next);
    end_wait(*next);
    return true;
  }

  bool has_ready() {
    return std::ranges::any_of(used_waits(), [](const Wait& wait) {
      return wait.process != 0 && wait.kind == WaitKind::turn && wait.is_ready != 0 && wait.wake == 0;
    });
  }

  // While no function of this class is being called, something else may wake its threads, such as a message.
  void attend(const std::stop_token& stop) {
    const std::stop_callback end(stop, [this] {
      page.ready.fetch_add(1);
      exec::wake(page.ready);
    });
    while (!stop.stop_requested() && page.is_real == 0) {
      const std::uint32_t seen = page.ready;
      const bool is_ready = has_ready();
      if (is_ready) {
        const std::lock_guard lock(mutex);
        if (is_at_rest()) give_turn();
      }
      wait_on(page.ready, seen, is_ready ? Clock::duration(longest_nap) : Clock::duration(given_up_is_asked_every));
    }
  }

  void check_now_and_then() {
    tell_all(reports.new_calls(process));
    const Clock::time_point now = Clock::now();
    const bool is_time = now >= check_at;
    if (!is_time && !may_have_new_images) return;
    may_have_new_images = false;
    tell_all(reports.new_programs(living_processes()));
    if (!is_time) return;
    check_at = now + check_interval;
    find_children(process);
    tell_all(reports.new_sleepers(watch));
  }

  void tell_all(const std::vector<std::string>& texts) const {
    for (const std::string& text : texts) tell(text);
  }

  void tell(const std::string& text) const {
    if (options.tell) options.tell(text);
  }

  void tell_busy() {
    const std::string busy = watch.busy_threads();
    if (!has_started()) return tell("'" + options.name + "' does not load the library that replaces its clocks");
    tell("'" + options.name + "' has not waited for anything for 5 s, so simulated time does not advance: " +
         (busy.empty() ? "its threads wake each other" : busy));
  }

  // A thread of the Python interpreter may wait for another one without a call that waits. Until all are at rest again,
  // the interpreter switches between them by the real time.
  void release_turns() {
    page.no_turns = 1;
    bool has_any = false;
    for (Wait& wait : used_waits()) {
      if (wait.process == 0 || wait.kind != WaitKind::turn) continue;
      has_any = true;
      wait.wake = 1;
      exec::wake(wait.wake);
    }
    if (has_any && !std::exchange(has_told_turns, true))
      tell("a Python thread of '" + options.name +
           "' has computed for 5 s while others wait for it: until all of them wait, they take turns by real time, so "
           "that results may differ from run to run");
  }

  std::span<Wait> used_waits() {
    return std::span(page.waits).first(std::min<std::size_t>(page.waits_used, most_waits));
  }

  // The wait that ends first, at `limit` at the latest; nullptr if none does.
  Wait* first_wait(std::int64_t limit) {
    Wait* first = nullptr;
    for (Wait& wait : used_waits()) {
      if (wait.process == 0 || wait.kind == WaitKind::none || wait.wake != 0) continue;
      const std::int64_t deadline = wait.deadline;
      if (deadline == never || deadline > limit) continue;
      if (first == nullptr ||
          std::pair(deadline, wait.order.load()) < std::pair(first->deadline.load(), first->order.load()))
        first = &wait;
    }
    return first;
  }

  void end_wait(Wait& wait) {
    const std::int32_t id = wait.process;
    if (wait.thread != 0)
      for (Process& each : page.processes)
        if (each.id == id) each.turn = wait.thread.load();
    wait.wake = 1;
    if (wait.kind != WaitKind::helper) return exec::wake(wait.wake);
    for (Process& each : page.processes) {
      if (each.id != id) continue;
      each.attention.fetch_add(1);
      exec::wake(each.attention);
    }
  }

  bool end_waits(std::int64_t limit) {
    while (Wait* const wait = first_wait(limit)) {
      page.now = std::max(page.now.load(), wait->deadline.load());
      // Others could be woken by what this library does not see, such as the C library's writing to pipes.
      const bool is_alone = wait->kind == WaitKind::sleep && watch.process_count() == 1;
      page.alone_until = limit;
      page.alone_since = page.stirs.load();
      page.alone = is_alone ? wait->thread.load() : 0;
      end_wait(*wait);
      const bool runs = settle();
      page.alone = 0;
      if (!runs) return false;
    }
    return true;
  }

  Options options;
  PageFile file;
  ClockPage& page;
  RealTimeReports reports;
  pid_t process = -1;
  std::optional<int> status{};
  ThreadWatch watch;
  std::uint32_t listed_threads = ~std::uint32_t{0};
  int looks = 0;
  bool has_told_busy = false;
  bool has_told_turns = false;
  std::set<const Wait*> had_turns{};  // since the last one had its turn
  std::set<pid_t> habitual_sleepers{};
  bool has_settled = false;  // once
  Clock::time_point check_at = Clock::now() + check_interval;
  bool may_have_new_images = false;
  std::mutex mutex;        // but for the page
  std::jthread attendant;  // the last, so that it ends first
};

VirtualProgram::VirtualProgram(Options options) : state_(std::make_unique<State>(std::move(options))) {
  state_->attendant = std::jthread([this](const std::stop_token& stop) { state_->attend(stop); });
}
VirtualProgram::~VirtualProgram() {
  if (!exit_code()) end();
}

VirtualProgram::Time VirtualProgram::time() const { return Time(state_->page.now); }

std::uint32_t VirtualProgram::ros_nodes() const { return state_->page.ros_nodes; }

bool VirtualProgram::settle() {
  const std::lock_guard lock(state_->mutex);
  return state_->settle();
}

bool VirtualProgram::run_before(Time time) {
  const std::lock_guard lock(state_->mutex);
  if (!state_->has_settled && !state_->settle()) return false;
  if (!state_->end_waits(time.count() - 1)) return false;
  state_->page.now = std::max<std::int64_t>(state_->page.now, time.count());
  return true;
}

bool VirtualProgram::run_now() {
  const std::lock_guard lock(state_->mutex);
  return state_->settle() && state_->end_waits(state_->page.now);
}

std::optional<VirtualProgram::Time> VirtualProgram::next_end() const {
  const Wait* const wait = state_->first_wait(never);
  return wait == nullptr ? std::nullopt : std::optional(Time(wait->deadline));
}

bool VirtualProgram::end_next_wait() {
  const std::lock_guard lock(state_->mutex);
  if (Wait* const wait = state_->first_wait(never)) state_->end_wait(*wait);
  return state_->settle();
}

std::optional<int> VirtualProgram::exit_code() {
  const std::lock_guard lock(state_->mutex);
  return state_->has_ended() ? state_->status : std::nullopt;
}

void VirtualProgram::go_on_in_real_time() {
  ClockPage& page = state_->page;
  if (page.is_real != 0) return;
  page.real_from = Clock::now().time_since_epoch().count();
  page.is_real = 1;
  for (Wait& wait : page.waits)
    if (wait.process != 0 && wait.kind != WaitKind::none) state_->end_wait(wait);
}

int VirtualProgram::end(std::chrono::milliseconds at_most) {
  go_on_in_real_time();
  const std::lock_guard lock(state_->mutex);
  if (state_->has_ended()) return *state_->status;
  state_->find_children(state_->process);
  // Threads that now begin to sleep in real time are to be in it when the signal comes.
  for (const auto until = Clock::now() + to_come_to_rest; Clock::now() < until && !state_->is_at_rest();)
    std::this_thread::sleep_for(100us);
  ::kill(state_->process, SIGTERM);
  for (const auto until = Clock::now() + at_most; !state_->has_ended();) {
    if (Clock::now() >= until) ::kill(state_->process, SIGKILL);
    ::usleep(1000);
  }
  for (const pid_t each : state_->living_processes()) ::kill(each, SIGKILL);
  return *state_->status;
}

std::string text_of_end(int exit_code) {
  constexpr int signals = 128;
  if (exit_code <= signals) return "has ended with the exit code " + std::to_string(exit_code);
  const char* const name = ::sigdescr_np(exit_code - signals);
  return "was terminated by the signal " + (name != nullptr ? name : std::to_string(exit_code - signals));
}

}  // namespace cohort::exec
