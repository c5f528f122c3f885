// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "tests/ros2/nodes.hpp"

namespace cohort::test {

/// A server and cohort-ros2-bridge in a network of their own, for nodes of ROS 2 to drive robots.
class BridgedNodes {
 public:
  struct Options {
    std::string experiment;  ///< the name of one that ships
    std::string ros2{};      ///< the key `ros2` in place of the experiment's, as YAML in one line
    std::string seconds{};   ///< simulated time
    std::string threads{"1"};
    std::vector<std::string> server{};   ///< further options
    std::vector<std::string> bridge{};   ///< options
    Process::Environment environment{};  ///< environment of the bridge
  };
  explicit BridgedNodes(Options options) : options_(std::move(options)) {
    std::string experiment = read_file(worlds / "experiments" / (options_.experiment + ".yaml"));
    const std::string arenas = "../arenas/";
    experiment.replace(experiment.find(arenas), arenas.size(), (worlds / "arenas/").string());
    if (!options_.ros2.empty())
      experiment = experiment.substr(0, experiment.find("\nros2:")) + "\nros2: " + options_.ros2 + "\n";
    std::ofstream(folder_ / "experiment.yaml") << experiment;
  }

  const OwnNetwork& network() const { return network_; }

  void start_server() {
    std::vector<std::string> command = {cohort_program(),
                                        "serve",
                                        (folder_ / "experiment.yaml").string(),
                                        "--duration",
                                        options_.seconds,
                                        "--threads",
                                        options_.threads,
                                        "--domain",
                                        "1",
                                        "--summary",
                                        (folder_ / "summary.json").string(),
                                        "--quiet"};
    command.insert(command.end(), options_.server.begin(), options_.server.end());
    server_ = network_.start(command);
  }
  void start_bridge() {
    std::vector<std::string> command = {COHORT_BUILD_DIR "/bin/cohort-ros2-bridge", "--domain", "1"};
    command.insert(command.end(), options_.bridge.begin(), options_.bridge.end());
    bridge_ = network_.start(command, options_.environment);
  }
  /// Starts both.
  BridgedNodes& start() {
    start_server();
    start_bridge();
    return *this;
  }

  std::unique_ptr<Process> start_node(const Ros2Distribution& distribution, const std::string& script,
                                      const std::vector<std::string>& arguments = {}) const {
    return network_.start_node(distribution, script, arguments);
  }

  Process& server() { return *server_; }
  Process& bridge() { return *bridge_; }
  /// Waits until the bridge has said a text.
  testing::AssertionResult says(const std::string& text) {
    if (bridge_->wait_for_output(text)) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "the bridge does not say '" << text << "' but:\n" << bridge_->output();
  }

  /// Waits for the end of the run. Returns its summary.
  nlohmann::json summary() {
    EXPECT_EQ(server_->wait_for_exit(), 0) << server_->output() << bridge_->output();
    EXPECT_EQ(bridge_->wait_for_exit(), 0) << bridge_->output();
    return read_json(folder_ / "summary.json");
  }
  /// Waits for the end of the run. Returns the hash of its state.
  std::string hash() { return summary()["state_hash"]; }

  std::filesystem::path file(const std::string& name) const { return folder_ / name; }

 private:
  static inline const std::filesystem::path worlds{COHORT_SOURCE_DIR "/worlds"};

  Options options_;
  ScratchFolder folder_;
  OwnNetwork network_;
  std::unique_ptr<Process> server_;
  std::unique_ptr<Process> bridge_;
};

inline const Ros2Distribution& jazzy() { return ros2_distributions()[0]; }
inline const Ros2Distribution& kilted() { return ros2_distributions()[1]; }

}  // namespace cohort::test
