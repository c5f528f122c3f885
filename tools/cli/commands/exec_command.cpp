// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cohort/control.hpp>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/shared_options.hpp"
#include "tools/cli/common/shown.hpp"
#include "tools/exec/virtual_program.hpp"

namespace cohort::tool {
namespace {

using std::chrono::milliseconds;
using RunTime = std::chrono::nanoseconds;
using SteadyClock = std::chrono::steady_clock;

constexpr milliseconds until_a_notice{2'000};
constexpr milliseconds looks_around_every{50};
constexpr milliseconds for_a_first_answer{2'000};
constexpr milliseconds worth_a_warning{5'000};
constexpr milliseconds to_end_by_itself{1'000};

struct ExecCommand {
  std::vector<std::string> program;
  Connection connection{};
  double date = 0.0;
  std::uint64_t period = 1;  // [ticks]
  std::filesystem::path ready{};
};

/// Requests for the time of a later tick, made on a separate thread.
class TimeRequests {
 public:
  /// `ends`: the flag of the control's `stop_on`, which the destructor sets.
  TimeRequests(Control& control, std::uint64_t steps, std::atomic<bool>& ends)
      : control_(control), steps_(steps), control_ends_(ends), thread_([this] { run(); }) {}
  TimeRequests(const TimeRequests&) = delete;
  TimeRequests& operator=(const TimeRequests&) = delete;
  ~TimeRequests() {
    control_ends_ = true;
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }

  void ask() {
    {
      const std::lock_guard lock(mutex_);
      asked_ = true;
      reply_.reset();
      error_.reset();
    }
    wake_.notify_all();
  }

  /// Returns the reply, or nothing if there is none within `at_most`. Throws ControlError.
  std::optional<ControlReply> wait(milliseconds at_most) {
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, at_most, [&] { return reply_ || error_; });
    if (error_) throw ControlError(*error_);
    return reply_;
  }

 private:
  void run() {
    std::unique_lock lock(mutex_);
    for (;;) {
      wake_.wait(lock, [&] { return asked_ || ends_; });
      if (ends_) return;
      asked_ = false;
      lock.unlock();
      std::optional<ControlReply> reply;
      std::optional<ControlError> error;
      try {
        reply = control_.advance_time(steps_);
      } catch (const ControlError& failure) {
        error = failure;
      }
      lock.lock();
      reply_ = std::move(reply);
      error_ = std::move(error);
      wake_.notify_all();
    }
  }

  Control& control_;
  std::uint64_t steps_;
  std::atomic<bool>& control_ends_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool asked_ = false;
  bool ends_ = false;
  std::optional<ControlReply> reply_;
  std::optional<ControlError> error_;
  std::thread thread_;
};

// One execution of the command.
class TimedRun {
 public:
  TimedRun(const ExecCommand& command, Log& log, const std::atomic<bool>& stop)
      : command_(command), log_(log), stop_(stop), control_(options()) {
    control_.stop_on(&ends_);
  }

  int run() {
    if (!control_.wait_for_server(until_a_notice) && !stop_)
      log_.notice(fmt::format("waiting for a server at {}, domain {}", command_.connection.server,
                              command_.connection.domain()));
    while (!control_.wait_for_server(looks_around_every))
      if (stop_) return exit_interrupted;
    control_.hold_time();  // before the program can drive a robot, which starts the run
    const SimulationStatus status = control_.status();
    step_ = status.step * command_.period;
    run_ = status.run;
    start(status.time);
    if (status.tick > 0)
      log_.warning(
          fmt::format("the run was already at {:.6g} s when '{}' began. Start 'cohort exec' before the programs "
                      "that drive robots; '--ready FILE' says when it holds the run",
                      seconds(status.time), command_.program.front()));
    tell_ready(status);
    TimeRequests requests(control_, command_.period, ends_);
    try {
      return drive(requests);
    } catch (const ControlError& error) {
      return end_with_run(error);
    }
  }

 private:
  void start(RunTime time) {
    exec::VirtualProgram::Options options;
    options.command = command_.program;
    options.environment = {"COHORT_SERVER=" + command_.connection.server,
                           "COHORT_DOMAIN=" + std::to_string(command_.connection.domain())};
    if (!command_.connection.secure.empty())
      options.environment.push_back("COHORT_SECURE=" + command_.connection.secure.string());
    options.start = time;
    options.date = std::chrono::round<RunTime>(std::chrono::duration<double>(command_.date));
    options.given_up = [this] { return stop_.load(); };
    options.tell = [this](const std::string& text) { log_.warning(text); };
    program_.emplace(std::move(options));
  }

  // A script that waits for the file may then start what begins the run.
  void tell_ready(const SimulationStatus& status) const {
    if (command_.ready.empty()) return;
    std::ofstream file(command_.ready);
    file << "holds the run at tick " << status.tick << std::endl;
    if (!file) log_.warning(fmt::format("cannot write {}, which '--ready' names", command_.ready.string()));
  }

  // Drives the program's clock until the program ends.
  int drive(TimeRequests& requests) {
    for (;;) {
      requests.ask();
      const std::optional<ControlReply> granted = await(requests);
      if (!granted) return ended();
      // The program's clock never goes back: in another run, it continues from its present time.
      if (granted->run != run_) ahead_ = program_->time() - granted->time;
      const bool is_first = !std::exchange(has_started_, true) || granted->run != run_;
      run_ = granted->run;
      const RunTime time = granted->time + ahead_;
      if (!program_->run_before(time) || (is_first && !let_it_answer()) || !program_->run_now() ||
          !program_->run_before(time + step_))
        return ended();
    }
  }

  // Waits for the reply. Returns nothing if the program has ended.
  std::optional<ControlReply> await(TimeRequests& requests) {
    for (const auto begin = SteadyClock::now();;) {
      if (auto reply = requests.wait(looks_around_every)) return reply;
      if (stop_ || program_->exit_code()) return std::nullopt;
      if (!has_started_ && !let_sleepers_go_on()) return std::nullopt;
      if (has_started_ && SteadyClock::now() - begin > worth_a_warning && !std::exchange(has_warned_, true)) warn();
    }
  }

  // A program that drives robots in lockstep finds them over the network, which takes real time but no simulated time.
  // This waits for its first answer, unless the program first waits for its own time to pass.
  bool let_it_answer() {
    const auto begin = SteadyClock::now();
    do {
      if (!program_->settle()) return false;
      if (control_.status().awaited_count == 0) return true;
      std::this_thread::sleep_for(milliseconds(1));
    } while (SteadyClock::now() - begin < for_a_first_answer);
    return true;
  }

  // Before the run starts, its time is 0. A program may sleep before it does what the run waits for: its waits then
  // last as long as in real time.
  bool let_sleepers_go_on() {
    if (!program_->settle()) return false;
    const auto end = program_->next_end();
    const auto now = SteadyClock::now();
    if (end != waits_until_) {
      waits_until_ = end;
      waits_since_ = now;
    }
    if (!end || now - waits_since_ < *end - program_->time()) return true;
    waits_until_.reset();
    return program_->end_next_wait();
  }

  // Warns if the run waits for a robot while the program waits for a time that only the next tick brings.
  void warn() {
    const auto end = program_->next_end();
    const SimulationStatus status = Control(options()).status();
    if (!end || status.state != SimulationState::playing || status.awaited_count == 0) return;
    log_.warning(
        fmt::format("the run waits at {:.6g} s for {}, while '{}' waits until {:.6g} s. A controller in lockstep must "
                    "answer before the next tick; 'period' of its team sets how often it is called",
                    seconds(status.time), status.awaited.front(), command_.program.front(), seconds(*end - ahead_)));
  }
  static double seconds(RunTime time) { return std::chrono::duration<double>(time).count(); }

  ControlOptions options() const {
    return {.server = command_.connection.server,
            .domain = command_.connection.domain(),
            .secure = command_.connection.secure.string(),
            .label = "cohort exec " + command_.program.front(),
            .time_limit = std::nullopt};
  }

  int ended() {
    if (const auto code = program_->exit_code()) return *code;
    program_->end();
    return exit_interrupted;
  }

  int end_with_run(const ControlError& error) {
    const bool is_over = error.result == ControlResult::incorrect_state || error.result == ControlResult::server_gone;
    if (!is_over && !stop_) log_.error(text_of(error));
    if (is_over && !stop_ && ends_by_itself()) return *program_->exit_code();
    const int code = program_->end();
    if (stop_) return exit_interrupted;
    if (is_over)
      log_.notice(
          fmt::format("the run has ended; '{}' was terminated with exit code {}", command_.program.front(), code));
    return is_over ? exit_ok : exit_failed;
  }

  // A client of the server is notified that the run is over, and may end by itself.
  bool ends_by_itself() {
    program_->go_on_in_real_time();
    for (const auto begin = SteadyClock::now(); SteadyClock::now() - begin < to_end_by_itself && !stop_;) {
      if (program_->exit_code()) return true;
      std::this_thread::sleep_for(milliseconds(5));
    }
    return false;
  }

  const ExecCommand& command_;
  Log& log_;
  const std::atomic<bool>& stop_;
  std::atomic<bool> ends_{false};
  Control control_;
  std::optional<exec::VirtualProgram> program_;
  RunTime step_{0};
  RunTime ahead_{0};  // by how much the program's clock is ahead of the run's time
  std::uint32_t run_ = 0;
  bool has_started_ = false;
  bool has_warned_ = false;
  std::optional<RunTime> waits_until_;
  SteadyClock::time_point waits_since_{};
};

}  // namespace

Subcommand add_exec(CommandLine app) {
  const auto command = std::make_shared<ExecCommand>();
  CommandLine line = app.add_subcommand("exec", "Run an unmodified program with simulated time as its clock");
  line.add_option("PROGRAM", command->program, "Program and its arguments, after --").required();
  line.add_option("--date", command->date,
                  "Date that the program's clock shows at simulated time 0, in seconds since 1970")
      .type_name("SECONDS")
      .capture_default_str();
  line.add_option("--period", command->period, "Number of ticks by which the program's clock advances at once")
      .check(whole_number(1, 1'000'000))
      .type_name("TICKS")
      .capture_default_str();
  line.add_option("--ready", command->ready,
                  "File or named pipe to write once the run is held at its current tick, for scripts that wait for it")
      .type_name("FILE");
  add_server_option(line, command->connection.server);
  add_domain_option(line, command->connection.domains, domain_of_server);
  add_secure_option(line, command->connection.secure,
                    "Folder of an identity that may control the run (default: $COHORT_SECURE)");
  line.footer(
      "Example: cohort serve braitenberg & cohort exec -- python3 controller.py\nThe exit code is that of the "
      "program.");
  return {line, [command](Log& log, const std::atomic<bool>& stop) { return TimedRun(*command, log, stop).run(); }};
}

}  // namespace cohort::tool
