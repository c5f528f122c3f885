#include "tools/cohort/running/one_run.hpp"

#include <fmt/format.h>

#include <utility>

#include "server/session/run_recorder.hpp"
#include "tools/cohort/cli/exit_codes.hpp"
#include "tools/cohort/cli/output_file.hpp"
#include "tools/cohort/running/summary_file.hpp"
#include "tools/cohort/running/team_controllers.hpp"
#include "tools/drawing/plot.hpp"

namespace cohort::tool {

using session::RunResult;

OneRun::OneRun(const RunCommand& command, Outputs outputs, const description::Experiment& experiment,
               Simulation& simulation, recording::Recorder* recorder, Log& log)
    : experiment_(experiment),
      log_(log),
      outputs_(std::move(outputs)),
      terminal_(log, {.quiet = command.quiet,
                      .own_controllers = command.controllers != Controllers::external && !has_keyboard(experiment)}) {
  if (recorder != nullptr) recorders_.push_back(recorder);
  if (!outputs_.plot.empty()) trace_.emplace(experiment.world, simulation, outputs_.viewpoint);
  if (!experiment.prints.empty()) table_.emplace(experiment, simulation, outputs_.csv.empty() && !command.quiet);
}

session::RunListener OneRun::listener() {
  session::RunListener listener = {
      .progress = [&](const session::Progress& progress) { terminal_.progress(progress); },
      .news = [&](const session::RunEvent& event) { terminal_.event(event); },
      .boundary =
          [&] {
            if (trace_) trace_->boundary();
            if (table_) table_->boundary();
          },
  };
  session::add_recorders(listener, recorders_);
  return listener;
}

int OneRun::finish(const RunResult& result, double cpu_seconds) {
  terminal_.summary(result, cpu_seconds);
  const bool written = write_files(result, cpu_seconds);
  switch (result.end) {
    case RunResult::End::finished:
    case RunResult::End::shut_down: return written ? exit_ok : exit_failed;
    case RunResult::End::reset:
    case RunResult::End::restored: return exit_ok;  // another one follows
    case RunResult::End::interrupted: return exit_interrupted;
    case RunResult::End::failed:
      log_.error(fmt::format("the run ended at tick {}: {}", result.ticks, result.error), {{"tick", result.ticks}});
  }
  return exit_failed;
}

bool OneRun::write_files(const RunResult& result, double cpu_seconds) {
  const auto try_to = [&](const auto& write) {
    try {
      write();
      return true;
    } catch (const std::exception& error) {
      log_.error(error.what());
      return false;
    }
  };
  bool written = true;
  if (!outputs_.summary.empty())
    written &= try_to([&] { write_summary(outputs_.summary, experiment_, result, cpu_seconds); });
  if (trace_)
    written &= try_to([&] {
      const PlotCaption caption = {experiment_.name, result.sim_time, result.state_hash};
      write_file("the plot", outputs_.plot, draw_plot(trace_->finish(), caption));
    });
  if (!outputs_.csv.empty())
    written &= try_to([&] { write_file("the table", outputs_.csv, table_ ? table_->text() : std::string()); });
  return written;
}

bool close_recording(recording::Recorder& recorder, const std::filesystem::path& file, const RunResult& result,
                     Log& log) {
  recorder.finish(word_of(result.end), result.end == RunResult::End::finished ? result.stop_reason : result.error);
  if (const std::uint64_t dropped = recorder.dropped(); dropped > 0)
    log.warning(
        fmt::format("{} poses and observations are not in {}: its disk was too slow. Commands and events are all "
                    "there; --record-poses and --record-observations ask for fewer",
                    dropped, file.string()),
        {{"dropped", dropped}});
  const std::optional<std::string> error = recorder.error();
  if (error) log.error("the recording ended before its run: " + *error);
  return !error;
}

}  // namespace cohort::tool
