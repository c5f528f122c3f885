// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/running/one_run.hpp"

#include <fmt/format.h>

#include <utility>

#include "server/run/run_recorder.hpp"
#include "tools/cli/common/exit_codes.hpp"
#include "tools/cli/common/output_file.hpp"
#include "tools/cli/common/picture_file.hpp"
#include "tools/cli/running/profile.hpp"
#include "tools/cli/running/run_recording.hpp"
#include "tools/cli/running/summary_file.hpp"
#include "tools/cli/running/team_controllers.hpp"
#include "tools/common/drawing/plot.hpp"

namespace cohort::tool {

using session::RunResult;

OneRun::OneRun(const RunCommand& command, Outputs outputs, Log& log, const std::atomic<bool>& stop)
    : command_(command), outputs_(std::move(outputs)), log_(log), stop_(stop) {}

void OneRun::begin(const description::Experiment& experiment, const Simulation& simulation,
                   recording::Beginning beginning) {
  experiment_ = &experiment;
  simulation_ = &simulation;
  stage_times_ = {};
  const bool own_controllers = command_.controllers != Controllers::external && !has_keyboard(experiment);
  if (!terminal_)  // it remembers what it has told
    terminal_.emplace(log_, Terminal::Options{.quiet = command_.quiet || is_of_several_,
                                              .shows_progress = !command_.is_part,
                                              .own_controllers = own_controllers});
  if (!outputs_.plot.empty()) trace_.emplace(experiment.world, simulation, outputs_.viewpoint);
  if (!experiment.prints.empty())
    table_.emplace(experiment, simulation, outputs_.csv.empty() && !command_.quiet && !is_of_several_);
  if (outputs_.recording.empty()) return;
  if (!recorder_) recorders_ = {&recorder_.emplace(outputs_.recording, experiment)};
  recorder_->begin(experiment, simulation, beginning);
}

session::RunListener OneRun::listener() {
  watchdog_.emplace(stop_, log_);
  if (command_.profile) watchdog_->measure(stage_times_);
  session::RunListener listener = {
      .progress = [&](const session::Progress& progress) { terminal_->progress(progress); },
      .news = [&](const session::RunEvent& event) { terminal_->event(event); },
      .boundary =
          [&] {
            if (watchdog_) watchdog_->reached(simulation_->tick());
            if (trace_) trace_->boundary();
            if (table_) table_->boundary();
          },
      .unrecorded = [&] { return recorder_ ? recorder_->error() : std::nullopt; },
      .stopped =
          [&] {
            watchdog_.reset();
            if (recorder_) recorder_->flush();
          },
  };
  session::add_recorders(listener, recorders_);
  return listener;
}

int OneRun::finish(RunResult result, double cpu_seconds) {
  using enum RunResult::End;
  const bool was_recorded = !recorder_ || close_recording(result);
  std::FILE* const stream = table_ && table_->is_on_stdout() ? stderr : stdout;
  terminal_->summary(*experiment_, result, cpu_seconds, stream);
  if (command_.profile) std::fputs(profile_text(result, stage_times_).c_str(), stream);
  const bool is_complete = write_files(result, cpu_seconds);
  const bool ended_for_that = result.end == failed && recorder_ && result.error == recorder_->error();
  if (!was_recorded && (ended_for_that || (command_.record_or_stop && result.end == finished))) return exit_unrecorded;
  if (result.end == failed)
    log_.error(fmt::format("the run ended at tick {}: {}", result.ticks, result.error), {{"tick", result.ticks}});
  if (result.end == interrupted) return exit_interrupted;
  return is_complete && was_recorded && (result.end == finished || result.end == shut_down) ? exit_ok : exit_failed;
}

bool OneRun::write_files(const RunResult& result, double cpu_seconds) {
  const auto try_to = [&](const auto& write) {
    try {
      write();
      return true;
    } catch (const std::exception& error) {
      log_.error(text_of(error));
      return false;
    }
  };
  bool written = true;
  if (!outputs_.summary.empty())
    written &= try_to([&] { write_summary(outputs_.summary, *experiment_, result, cpu_seconds, stage_times_); });
  if (trace_)
    written &= try_to([&] {
      const PlotCaption caption = {experiment_->name, result.sim_time, result.state_hash};
      write_picture(outputs_.plot, draw_plot(trace_->finish(), caption));
    });
  if (command_.record.makes_rosbag2 && recorder_ && !recorder_->error())
    written &= try_to([&] { write_rosbag2_metadata(outputs_.recording); });
  if (!outputs_.csv.empty() && (table_ || !is_of_several_))
    written &= try_to([&] { write_file("the table", outputs_.csv, table_ ? table_->text() : std::string()); });
  return written;
}

// Returns true if the recording is complete. Adds an event for an error that appeared when the file was closed.
bool OneRun::close_recording(RunResult& result) {
  recorder_->finish(word_of(result.end), result.end == RunResult::End::finished ? result.stop_reason : result.error);
  if (const std::uint64_t dropped = recorder_->dropped(); dropped > 0)
    log_.warning(
        fmt::format("{} poses and observations are missing from {}, because its disk was too slow. All commands and "
                    "events are recorded; '--record-poses' and '--record-observations' reduce the rate",
                    dropped, outputs_.recording.string()),
        {{"dropped", dropped}});
  const std::optional<std::string> error = recorder_->error();
  if (!error) return true;
  if (result.unrecorded.empty()) {
    result.unrecorded = *error;
    result.events.push_back({.tick = result.ticks, .kind = "unrecorded", .text = *error, .last_tick = result.ticks});
    terminal_->event(result.events.back());
  }
  return false;
}

}  // namespace cohort::tool
