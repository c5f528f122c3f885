#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include "server/recording/replay.hpp"
#include "tools/cohort/commands.hpp"
#include "tools/cohort/wording.hpp"

namespace cohort::tool {
namespace {

using Seconds = std::chrono::duration<double>;

std::chrono::nanoseconds nanoseconds(double seconds) {
  return std::chrono::round<std::chrono::nanoseconds>(Seconds(seconds));
}

// Where the replay is, a few times a second.
class ReplayProgress {
 public:
  ReplayProgress(Log& log, bool quiet) : log_(log), quiet_(quiet) {}

  void at(std::chrono::nanoseconds log_time) {
    using namespace std::chrono_literals;
    const auto now = std::chrono::steady_clock::now();
    if (quiet_ || !log_.rewrites_progress() || now - last_ < 200ms) return;
    last_ = now;
    log_.progress(fmt::format("{:8.2f} s replayed", Seconds(log_time).count()));
  }

 private:
  Log& log_;
  bool quiet_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void say(bool quiet, const std::string& line) {
  if (!quiet) std::fputs((line + "\n").c_str(), stdout);
}

// What may explain that a replay differs.
void warn_of_other_build(const recording::Recording& recording, Log& log) {
  const auto& facts = recording.facts();
  const auto fact = [&](const char* name) {
    const auto found = facts.find(name);
    return found == facts.end() ? std::string() : found->second;
  };
  if (fact("version") != COHORT_VERSION)
    log.warning(fmt::format("{} was recorded by version {} of Cohort, and this is " COHORT_VERSION
                            ": its runs may have other bits",
                            recording.file().string(), fact("version")));
  if (!fact("functions_not_portable").empty())
    log.warning(fmt::format("{} was recorded with the C library's {}: on another CPU its run may have other bits",
                            recording.file().string(), fact("functions_not_portable")));
}

int report(const recording::Verification& found, const ReplayCommand& command, Log& log) {
  if (found.difference) {
    const auto& difference = *found.difference;
    log.clear_progress();
    say(false, fmt::format("differs at tick {} ({:.3f} s): recorded {:016x}, replayed {:016x}; {} before it {} identical",
                           difference.tick, Seconds(difference.log_time).count(), difference.recorded,
                           difference.replayed, counted(found.boundaries, "tick"), found.boundaries == 1 ? "is" : "are"));
    return exit_failed;
  }
  if (!found.problem.empty()) {
    log.error(fmt::format("the first {} {} identical, then: {}", counted(found.boundaries, "tick"),
                          found.boundaries == 1 ? "is" : "are", found.problem));
    return exit_failed;
  }
  say(command.quiet, fmt::format("identical, {}", counted(found.boundaries, "tick")));
  return exit_ok;
}

}  // namespace

int replay(const ReplayCommand& command, Log& log, const std::atomic<bool>& stop) {
  try {
    const recording::Recording recording(command.file);
    if (!recording.damage().empty()) log.warning(recording.damage());
    warn_of_other_build(recording, log);
    const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
    recording::Replay replay(recording, command.threads == 0 ? cores : command.threads);

    ReplayProgress progress(log, command.quiet);
    const auto start = std::chrono::steady_clock::now();
    const std::chrono::nanoseconds to = command.to ? nanoseconds(*command.to) : std::chrono::nanoseconds::max();
    const recording::Verification found =
        recording::verify(replay, nanoseconds(command.from), to, [&](std::chrono::nanoseconds log_time) {
          progress.at(log_time);
          return !stop;
        });
    log.clear_progress();
    const double wall = Seconds(std::chrono::steady_clock::now() - start).count();
    log.info(fmt::format("replayed {} in {:.2f} s", counted(found.boundaries, "tick"), wall), {{"wall_s", wall}});
    if (stop) return exit_interrupted;
    return report(found, command, log);
  } catch (const std::exception& error) {
    log.error(error.what());
  }
  return exit_usage;
}

}  // namespace cohort::tool
