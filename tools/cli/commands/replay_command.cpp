// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "server/core/processors.hpp"
#include "server/core/text.hpp"
#include "server/recording/replay.hpp"
#include "server/simulation/build_identity.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/recording_part.hpp"
#include "tools/cli/commands/refuse_experiment.hpp"
#include "tools/cli/commands/ros2_playback.hpp"
#include "tools/cli/common/shown.hpp"
#include "tools/cli/common/terminal/replay_progress.hpp"
#include "tools/cli/common/wording.hpp"

namespace cohort::tool {
namespace {

struct ReplayCommand {
  std::filesystem::path file;
  bool verify = false;  ///< compare the state at every tick boundary
  RecordingPart part{};
  unsigned threads = 0;  ///< 0: one for each core
  bool quiet = false;
  bool is_for_ros2 = false;  ///< publish messages instead of simulating
  Ros2Playback ros2{};
};

using Seconds = std::chrono::duration<double>;

void say(bool quiet, const std::string& line) {
  if (!quiet) show(line + "\n");
}

std::string fact_of(const recording::Recording& recording, const char* name) {
  const auto found = recording.facts().find(name);
  return found == recording.facts().end() ? std::string() : found->second;
}

BuildIdentity build_of(const recording::Recording& recording) {
  return {fact_of(recording, "version"), fact_of(recording, "commit"), fact_of(recording, "arithmetic")};
}

// Warns of differences between the builds that may explain a different replay.
void warn_of_other_build(const recording::Recording& recording, Log& log) {
  if (const std::string why = why_results_differ(build_of(recording)); !why.empty())
    log.warning(fmt::format("{}: {}", recording.file().string(), why));
  if (const std::string functions = fact_of(recording, "functions_not_portable"); !functions.empty())
    log.warning(fmt::format("{} was recorded with {} of the C library: results may differ on another CPU",
                            recording.file().string(), functions));
}

// Reported only to explain a difference: with the same arithmetic, another commit usually has the same results.
void tell_other_commit(const recording::Recording& recording, LogLevel level, Log& log) {
  const BuildIdentity recorded = build_of(recording);
  if (recorded.commit == this_build().commit || !why_results_differ(recorded).empty()) return;
  log.write(level,
            fmt::format("{} was recorded by another commit of Cohort ({}); this is {}", recording.file().string(),
                        recorded.commit.empty() ? "unknown" : recorded.commit, this_build().commit));
}

int report(const recording::Verification& found, const recording::Recording& recording, const ReplayCommand& command,
           Log& log) {
  if (found.difference || !found.problem.empty()) tell_other_commit(recording, LogLevel::warning, log);
  if (found.difference) {
    const auto& difference = *found.difference;
    log.clear_progress();
    say(false,
        fmt::format("differs at tick {} ({:.3f} s): recorded {:016x}, replayed {:016x}; {} before it {} identical",
                    difference.tick, Seconds(difference.log_time).count(), difference.recorded, difference.replayed,
                    counted(found.boundaries, "tick"), found.boundaries == 1 ? "is" : "are"));
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

int verify(const recording::Recording& recording, recording::Replay& replay, const ReplayCommand& command, Log& log,
           const std::atomic<bool>& stop) {
  ReplayProgress progress(log);
  const recording::Verification found = recording::verify(
      replay, start_of_part(command.part), end_of_part(command.part), [&](std::chrono::nanoseconds log_time) {
        if (!command.quiet) progress.at(log_time, "replayed");
        return !stop;
      });
  log.clear_progress();
  if (found.boundaries == 0 && !found.difference && found.problem.empty() && !stop)
    throw std::invalid_argument(nothing_in_part);
  return stop ? exit_interrupted : report(found, recording, command, log);
}

// Replays without comparing states with the recorded ones.
int run_again(recording::Replay& replay, const ReplayCommand& command, Log& log, const std::atomic<bool>& stop) {
  std::uint64_t ticks = 0;
  if (!replay_part(replay, command.part, log, stop, [&] { ++ticks; })) return exit_interrupted;
  say(command.quiet,
      fmt::format("replayed {}, state hash {:016x}", counted(ticks, "tick"), replay.simulation().state_hash()));
  return exit_ok;
}

int publish(ReplayCommand command, Log& log, const std::atomic<bool>& stop) {
  command.ros2.file = command.file;
  command.ros2.part = command.part;
  command.ros2.quiet = command.quiet;
  return play_to_ros2(command.ros2, log, stop);
}

int replay(const ReplayCommand& command, Log& log, const std::atomic<bool>& stop) {
  if (command.is_for_ros2) return publish(command, log, stop);
  refuse_experiment(command.file);
  const recording::Recording recording(command.file);
  if (!recording.damage().empty()) log.warning(recording.damage());
  warn_of_other_build(recording, log);
  tell_other_commit(recording, LogLevel::info, log);
  recording::Replay replay(recording, command.threads == 0 ? available_processors() : command.threads);

  const auto start = std::chrono::steady_clock::now();
  const int code =
      command.verify ? verify(recording, replay, command, log, stop) : run_again(replay, command, log, stop);
  const double wall = Seconds(std::chrono::steady_clock::now() - start).count();
  log.info(fmt::format("replayed in {:.2f} s", wall), {{"wall_s", wall}});
  return stop ? exit_interrupted : code;
}

void add_ros2_options(CommandLine line, ReplayCommand& command, Option ros2) {
  Ros2Playback& playback = command.ros2;
  line.add_option_function<std::string>(
          "--speed",
          [&playback](const std::string& speed) { playback.speed = speed == "max" ? 0.0 : *parse_real(speed); },
          "With --ros2: limit of recorded seconds per second of wall time (default: 1)")
      .check(max_or_number_above_zero(1e9))
      .type_name("max|X")
      .needs(ros2);
  line.add_option("--wait", playback.awaited,
                  "With --ros2: start when nodes have N subscriptions to the published topics")
      .check(whole_number(1, 1'000'000))
      .type_name("N")
      .needs(ros2);
  line.add_flag("--loop", playback.loops, "With --ros2: repeat the recording until Ctrl-C").needs(ros2);
  line.add_option("--ros-domain", playback.domain, "With --ros2: ROS domain (default: $ROS_DOMAIN_ID, or 0)")
      .check(whole_number(0, 232))
      .type_name("N")
      .needs(ros2);
}

}  // namespace

Subcommand add_replay(CommandLine app) {
  const auto command = std::make_shared<ReplayCommand>();
  CommandLine line =
      app.add_subcommand("replay", "Replay a recorded run without controllers, or publish its messages to ROS 2 nodes");
  line.add_option("FILE", command->file, "Recording (MCAP)").required().type_name("");
  const Option verify =
      line.add_flag("--verify", command->verify, "Compare the state hash at every tick with the recorded hash");
  add_part_options(line, command->part);
  const Option threads =
      line.add_option("--threads", command->threads, "Number of threads that step the world (default: one per core)")
          .check(whole_number(1, 1024))
          .type_name("N");
  const Option ros2 = line.add_flag("--ros2", command->is_for_ros2,
                                    "Publish the recorded messages and /clock to ROS 2 nodes, without simulation")
                          .excludes(verify)
                          .excludes(threads);
  add_ros2_options(line, *command, ros2);
  line.add_flag("--quiet", command->quiet, "Print only errors and differences");
  line.footer("Example: cohort replay run.mcap --verify\n         cohort replay run.mcap --ros2 --speed 2");
  return {line, [command](Log& log, const std::atomic<bool>& stop) { return replay(*command, log, stop); }};
}

}  // namespace cohort::tool
