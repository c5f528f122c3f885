#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "server/serving/server.hpp"
#include "tools/cohort/cli/log.hpp"
#include "tools/cohort/running/run_options.hpp"
#include "tools/cohort/running/team_controllers.hpp"
#include "tools/processes/children.hpp"

namespace cohort::tool {

/// Serves experiments over DDS, one after the other, and answers for the controllers' processes that it starts itself.
class Serving {
 public:
  /// Opens the domains. `experiment` is the first. Throws wire::WireError.
  Serving(const RunCommand& command, const description::Experiment& experiment, Log& log);
  ~Serving();

  /// Starts the processes of the experiment's teams, unless they are started by somebody else; `run` starts those of
  /// the robots that events bring. `experiment` must outlive this call only, `controllers` must outlive this.
  void start_controllers(const description::Experiment& experiment, const std::vector<TeamController>& controllers);

  /// Starts a process that shows the runs in a browser (`cohort view`); that it cannot is a warning. `recording` is
  /// what the last one writes; empty: nothing.
  void start_view(const description::Experiment& experiment, const std::filesystem::path& recording);
  /// Waits while somebody looks at what has ended, unless asked to `stop`.
  void let_look(const std::atomic<bool>& stop);

  /// `is_last`: controllers may leave afterwards.
  session::RunResult run(const description::Experiment& experiment, Simulation& simulation,
                         const session::RunOptions& options, const session::RunListener& listener,
                         const std::atomic<bool>& stop, bool is_last);

 private:
  void drive(const description::Experiment& experiment, const std::vector<std::uint32_t>& robots);

  const RunCommand& command_;
  Log& log_;
  std::vector<std::uint32_t> domains_;
  std::vector<wire::Participant> participants_;
  std::optional<session::Server> server_;
  const std::vector<TeamController>* controllers_ = nullptr;  // null: somebody else starts them
  std::unique_ptr<Children> children_;
  std::vector<std::unique_ptr<Children>> newcomers_;  // of one run
  std::atomic<bool> has_view_{false};
  std::unique_ptr<Children> view_;
};

}  // namespace cohort::tool
