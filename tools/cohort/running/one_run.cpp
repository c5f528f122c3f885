#include "tools/cohort/running/one_run.hpp"

#include <fmt/format.h>

#include "server/session/run_recorder.hpp"
#include "tools/cohort/cli/output_file.hpp"
#include "tools/cohort/running/summary_file.hpp"
#include "tools/cohort/running/team_controllers.hpp"
#include "tools/drawing/plot.hpp"

namespace cohort::tool {

using session::RunResult;

std::filesystem::path numbered(const std::filesystem::path& file, std::size_t number, std::size_t count) {
  if (file.empty() || count == 1) return file;
  return file.parent_path() / fmt::format("{}-{}{}", file.stem().string(), number, file.extension().string());
}

OneRun::OneRun(const RunCommand& command, std::size_t number, std::size_t count,
               const description::Experiment& experiment, Simulation& simulation, recording::Recorder* recorder,
               Log& log)
    : experiment_(experiment),
      log_(log),
      summary_(numbered(command.summary, number, count)),
      plot_(numbered(command.plot, number, count)),
      csv_(numbered(command.csv, number, count)),
      terminal_(log, {.quiet = command.quiet,
                      .own_controllers = command.controllers != Controllers::external && !has_keyboard(experiment)}) {
  if (recorder != nullptr) recorders_.push_back(recorder);
  if (!plot_.empty()) trace_.emplace(experiment.world, simulation, command.viewpoint);
  if (!experiment.prints.empty()) table_.emplace(experiment, simulation, csv_.empty() && !command.quiet);
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
  if (!summary_.empty()) written &= try_to([&] { write_summary(summary_, experiment_, result, cpu_seconds); });
  if (trace_)
    written &= try_to([&] {
      const PlotCaption caption = {experiment_.name, result.sim_time, result.state_hash};
      write_file("the plot", plot_, draw_plot(trace_->finish(), caption));
    });
  if (!csv_.empty()) written &= try_to([&] { write_file("the table", csv_, table_ ? table_->text() : std::string()); });
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
