// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "client_sdk/src/control/control_client.hpp"
#include "tests/support/control.hpp"
#include "tests/support/worlds/field_of_robots.hpp"

namespace cohort::test {

/// A served field of robots with its controllers, for tests that control it.
class ControlledRun {
 public:
  explicit ControlledRun(const FieldOfRobots& field, const std::vector<std::string>& more = {}, bool with_host = true)
      : field_(field), server_(field.serve(domain_, more), {{"COHORT_LOG", "info"}}) {
    if (with_host) attach();
  }
  void attach(const std::string& robots = "all") {
    hosts_.push_back(std::make_unique<Process>(FieldOfRobots::host(domain_, robots)));
  }
  Process& host(std::size_t index = 0) { return *hosts_.at(index); }
  Process& server() { return server_; }
  const ReservedDomain& domain() const { return domain_; }

  std::vector<std::string> ctl(const std::vector<std::string>& arguments) const {
    return ctl_command(domain_, arguments);
  }
  /// Runs `cohort ctl`, checks that it succeeds, and returns its output.
  std::string done(const std::vector<std::string>& arguments) const { return control(domain_, arguments); }
  nlohmann::json status() const { return nlohmann::json::parse(done({"status", "--json"})); }
  std::uint64_t tick() const { return status()["tick"]; }
  /// Polls until the status satisfies `condition`. Returns false if it does not in time.
  template <class Condition>
  bool comes_to(Condition condition) const {
    return eventually([&] { return condition(status()); });
  }
  /// Waits for the server's end, and returns the run's summary.
  nlohmann::json finish() {
    EXPECT_EQ(server_.wait_for_exit(), 0) << server_.output();
    return field_.summary();
  }

 private:
  const FieldOfRobots& field_;
  ReservedDomain domain_;
  Process server_;
  std::vector<std::unique_ptr<Process>> hosts_;
};

inline const std::atomic<bool> never = false;

/// Returns the control interface that programs use.
inline Control control_of(const ControlledRun& run) {
  return Control({.domain = run.domain().number(), .time_limit = patience});
}
/// Returns the client under Control, which sends any request, well-formed or not.
inline ControlClient client_of(const ControlledRun& run) { return ControlClient({.domain = run.domain().number()}); }

/// Returns the state hash of the field's run with controllers in the server's process.
inline std::string reference(const FieldOfRobots& field, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"--controllers", "inprocess"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_experiment(field.file(), arguments)["state_hash"];
}

}  // namespace cohort::test
