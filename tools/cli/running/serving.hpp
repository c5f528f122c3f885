// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/serving/server.hpp"
#include "tools/cli/common/log.hpp"
#include "tools/cli/running/run_options.hpp"
#include "tools/cli/running/team_controllers.hpp"
#include "tools/common/processes/children.hpp"

namespace cohort::tool {

/// Serves experiments over DDS, one after the other, and manages the controller processes that it starts.
class Serving {
 public:
  /// Opens the domains. `experiment` is the first one. Throws wire::WireError.
  Serving(const RunCommand& command, const description::Experiment& experiment, Log& log);
  ~Serving();

  /// Starts the processes of the experiment's teams, unless controllers are started elsewhere; `run` starts those of
  /// robots that events add. `experiment` must outlive this call only, `controllers` must outlive this.
  void start_controllers(const description::Experiment& experiment, const std::vector<TeamController>& controllers);

  /// Starts a process that shows the runs in a browser (`cohort view`), and returns when its page can be opened.
  /// `recording` is the file that the last run writes; empty: none. Throws std::runtime_error if the process ends.
  void start_view(const description::Experiment& experiment, const std::filesystem::path& recording,
                  const std::atomic<bool>& stop);
  /// Waits while viewers of a finished run are connected, until `stop` is set.
  void let_look(const std::atomic<bool>& stop);
  /// Returns the command line that repeats the run and shows it at the same address, if the view's page has asked for
  /// it; nothing otherwise. Call after `let_look`.
  std::vector<std::string> command_line_to_run_again() const;

  /// `is_last`: controllers may leave after this run.
  session::RunResult run(const description::Experiment& experiment, Simulation& simulation,
                         const session::RunOptions& options, const session::RunListener& listener,
                         const std::atomic<bool>& stop, bool is_last);

 private:
  void note_page(const std::string& line);
  void tell_of_keyboard(const description::Experiment& experiment);
  description::Experiment without_ros2(const description::Experiment& experiment) const;
  void drive(const description::Experiment& experiment, const std::vector<std::uint32_t>& robots);

  const RunCommand& command_;
  Log& log_;
  std::vector<std::uint32_t> domains_;
  std::vector<wire::Participant> participants_;
  std::optional<session::Server> server_;
  const std::vector<TeamController>* controllers_ = nullptr;  // null: started elsewhere
  std::unique_ptr<Children> children_;
  std::vector<std::unique_ptr<Children>> newcomers_;  // processes for added robots of the present run
  std::atomic<bool> has_view_{false};
  std::atomic<bool> is_asked_again_{false};
  std::atomic<int> page_port_{0};  // 0: the page cannot be opened yet
  std::string view_failure_;       // why the page cannot be opened; set before has_failed_view_
  std::atomic<bool> has_failed_view_{false};
  std::unique_ptr<Children> view_;
};

}  // namespace cohort::tool
