#include "tools/exec/virtual_program.hpp"

#include <fcntl.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <fstream>
#include <new>
#include <set>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

#include "tools/exec/clock_page.hpp"
#include "tools/exec/preload_library.hpp"
#include "tools/exec/program_file.hpp"
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
constexpr int looks_between_lists = 256;

void wait_on(std::atomic<std::uint32_t>& word, std::uint32_t seen, std::chrono::nanoseconds at_most) {
  const timespec time{at_most.count() / 1'000'000'000, at_most.count() % 1'000'000'000};
  ::syscall(SYS_futex, &word, FUTEX_WAIT, seen, &time, nullptr, 0);
}

void wake(std::atomic<std::uint32_t>& word) {
  ::syscall(SYS_futex, &word, FUTEX_WAKE, 0x7fffffff, nullptr, nullptr, 0);
}

std::string system_text(const std::string& what) { return what + ": " + std::generic_category().message(errno); }

// A file in memory that this process and the program map.
class PageFile {
 public:
  PageFile() {
    std::string name = "/dev/shm/cohort-exec-XXXXXX";
    const int file = ::mkostemp(name.data(), O_CLOEXEC);
    if (file < 0) throw std::runtime_error(system_text("cannot create a file in /dev/shm"));
    path_ = name;
    if (::ftruncate(file, sizeof(ClockPage)) == 0)
      memory_ = ::mmap(nullptr, sizeof(ClockPage), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    ::close(file);
    if (memory_ == nullptr || memory_ == MAP_FAILED) {
      ::unlink(path_.c_str());
      throw std::runtime_error(system_text("cannot map a file in /dev/shm"));
    }
    ::new (memory_) ClockPage;
  }
  PageFile(const PageFile&) = delete;
  PageFile& operator=(const PageFile&) = delete;
  ~PageFile() {
    ::munmap(memory_, sizeof(ClockPage));
    ::unlink(path_.c_str());
  }
  const std::string& path() const { return path_; }
  ClockPage& page() { return *static_cast<ClockPage*>(memory_); }

 private:
  std::string path_;
  void* memory_ = nullptr;
};

}  // namespace

struct VirtualProgram::State {
  explicit State(Options given) : options(std::move(given)), page(file.page()) {
    if (options.name.empty()) options.name = options.command.front();
    const std::filesystem::path program = file_of_command(options.command.front());
    if (const std::string why = why_not_virtual(program); !why.empty())
      throw std::runtime_error("'" + options.name + "' cannot run in virtual time: " + why);
    page.now = options.start.count();
    page.date = options.date.count();
    start(program);
  }

  void start(const std::filesystem::path& program) {
    const std::filesystem::path library = preload_library();
    std::vector<std::string> environment;
    std::string preload = library.string();
    for (char** each = environ; *each != nullptr; ++each) {
      const std::string variable = *each;
      if (variable.starts_with("LD_PRELOAD="))
        preload += ":" + variable.substr(variable.find('=') + 1);
      else
        environment.push_back(variable);
    }
    environment.insert(environment.end(), options.environment.begin(), options.environment.end());
    environment.push_back("LD_PRELOAD=" + preload);
    environment.push_back(std::string(page_variable) + "=" + file.path());
    const auto pointers = [](std::vector<std::string>& texts) {
      std::vector<char*> all;
      for (std::string& text : texts) all.push_back(text.data());
      all.push_back(nullptr);
      return all;
    };
    const std::vector<char*> arguments = pointers(options.command);
    const std::vector<char*> variables = pointers(environment);
    int problem[2];
    if (::pipe2(problem, O_CLOEXEC) != 0) throw std::runtime_error(system_text("cannot create a pipe"));
    const pid_t parent = ::getpid();
    process = ::fork();
    if (process == 0) {
      const char* what = "cannot start it";
      const auto fail = [&] {
        const int error = errno;
        (void)(::write(problem[1], &error, sizeof error) + ::write(problem[1], what, std::strlen(what)));
        ::_exit(127);
      };
      if (options.prepare && !options.prepare()) {
        what = "cannot prepare its process";
        fail();
      }
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (::getppid() != parent) ::_exit(127);
      if (!options.folder.empty() && ::chdir(options.folder.c_str()) != 0) {
        what = "cannot change to its folder";
        fail();
      }
      ::execve(program.c_str(), arguments.data(), variables.data());
      fail();
    }
    ::close(problem[1]);
    int error = 0;
    if (process > 0 && ::read(problem[0], &error, sizeof error) == static_cast<ssize_t>(sizeof error)) {
      std::string what(100, '\0');
      what.resize(static_cast<std::size_t>(std::max<ssize_t>(::read(problem[0], what.data(), what.size()), 0)));
      ::close(problem[0]);
      ::waitpid(process, nullptr, 0);
      throw std::runtime_error("'" + options.name + "': " + what + ": " + std::generic_category().message(error));
    }
    ::close(problem[0]);
    if (process < 0) throw std::runtime_error(system_text("cannot start a process"));
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
    status = WIFEXITED(how) ? WEXITSTATUS(how) : 128 + WTERMSIG(how);
    return true;
  }

  // Processes that have ended are forgotten, with their waits.
  std::vector<pid_t> living_processes() {
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
      watch.look_at(living_processes());
    }
    if (!watch.all_wait()) return false;
    // A process that was started by a call that the library does not replace begins to be watched here.
    for (const pid_t child : watch.children()) enter(child);
    return page.threads == listed_threads && has_started();
  }

  // The library announces itself before the program's own code runs.
  bool has_started() {
    return std::ranges::any_of(page.processes,
                               [this](const Process& each) { return each.id == process && each.has_started != 0; });
  }

  bool settle() {
    const Clock::time_point begin = Clock::now();
    Clock::time_point ask_at = begin + given_up_is_asked_every;
    for (;;) {
      const std::uint32_t seen = page.changes;
      if (is_at_rest()) {
        has_settled = true;
        check_now_and_then();
        return !has_ended();
      }
      if (has_ended()) return false;
      page.host_waits = 1;
      const Clock::time_point now = Clock::now();
      wait_on(page.changes, seen,
              std::min<Clock::duration>(longest_nap, std::max<Clock::duration>((now - begin) / 4, 20us)));
      page.host_waits = 0;
      if (now < ask_at) continue;
      ask_at = now + given_up_is_asked_every;
      find_children(process);
      if (options.given_up && options.given_up()) return false;
      if (now - begin > busy_is_told_after && !std::exchange(has_told_busy, true)) tell_busy();
    }
  }

  // Reports threads and processes whose clock is not the library's, once each.
  void check_now_and_then() {
    const Clock::time_point now = Clock::now();
    if (now < check_at) return;
    check_at = now + check_interval;
    find_children(process);
    for (const Process& each : page.processes)
      if (each.id != 0 && each.has_started == 0 && told.insert(each.id).second && ::kill(each.id, 0) == 0)
        tell("process " + std::to_string(each.id) + ", which '" + options.name +
             "' has started, runs in real time: it does not load the library that replaces its clocks");
    for (const ThreadWatch::SystemCall& call : watch.system_calls())
      if ((call.number == SYS_nanosleep || call.number == SYS_clock_nanosleep) && told.insert(call.thread).second)
        tell("thread " + std::to_string(call.thread) + " of '" + options.name +
             "' sleeps in real time: it makes system calls without the C library, or is a thread of DDS");
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

  // The wait that ends first, at `limit` at the latest; nullptr if none does.
  Wait* first_wait(std::int64_t limit) {
    Wait* first = nullptr;
    const std::uint32_t used = std::min<std::uint32_t>(page.waits_used, most_waits);
    for (std::uint32_t i = 0; i < used; ++i) {
      Wait& wait = page.waits[i];
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
    wait.wake = 1;
    if (wait.kind == WaitKind::sleep) return exec::wake(wait.wake);
    const std::int32_t id = wait.process;
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
  pid_t process = -1;
  std::optional<int> status{};
  ThreadWatch watch;
  std::uint32_t listed_threads = ~std::uint32_t{0};
  int looks = 0;
  bool has_told_busy = false;
  bool has_settled = false;  // once
  Clock::time_point check_at = Clock::now() + check_interval;
  std::set<pid_t> told{};  // processes and threads
};

VirtualProgram::VirtualProgram(Options options) : state_(std::make_unique<State>(std::move(options))) {}
VirtualProgram::~VirtualProgram() {
  if (!state_->has_ended()) end();
}

VirtualProgram::Time VirtualProgram::time() const { return Time(state_->page.now); }

std::uint32_t VirtualProgram::ros_nodes() const { return state_->page.ros_nodes; }

bool VirtualProgram::settle() { return state_->settle(); }

bool VirtualProgram::run_before(Time time) {
  if (!state_->has_settled && !state_->settle()) return false;
  if (!state_->end_waits(time.count() - 1)) return false;
  state_->page.now = std::max<std::int64_t>(state_->page.now, time.count());
  return true;
}

bool VirtualProgram::run_now() { return state_->settle() && state_->end_waits(state_->page.now); }

std::optional<VirtualProgram::Time> VirtualProgram::next_end() const {
  const Wait* const wait = state_->first_wait(never);
  return wait == nullptr ? std::nullopt : std::optional(Time(wait->deadline));
}

bool VirtualProgram::end_next_wait() {
  if (Wait* const wait = state_->first_wait(never)) state_->end_wait(*wait);
  return state_->settle();
}

std::optional<int> VirtualProgram::exit_code() { return state_->has_ended() ? state_->status : std::nullopt; }

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
  return exit_code > signals ? "was terminated by the signal " + std::string(::strsignal(exit_code - signals))
                             : "has ended with the exit code " + std::to_string(exit_code);
}

}  // namespace cohort::exec
