// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <regex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/process.hpp"

namespace cohort::test {

/// A server and a bridge, for the firmware of a test to connect to.
class BridgedRun {
 public:
  struct Options {
    std::string experiment;  ///< the name of one that ships, or a file
    std::string bridge;      ///< the program
    std::string robots = "0";
    std::string seconds = "5";
    std::string threads = "1";
    std::vector<std::string> more{};  ///< options of the bridge
    std::string who = "firmware";     ///< the bridge's name for the robot's driver
  };
  explicit BridgedRun(const Options& options)
      : server_({cohort_program(), "serve",
                 options.experiment.find('/') != std::string::npos
                     ? options.experiment
                     : COHORT_SOURCE_DIR "/worlds/experiments/" + options.experiment + ".yaml",
                 "--duration", options.seconds, "--threads", options.threads, "--domain", domain_.text(), "--summary",
                 (folder_ / "summary.json").string()}),
        who_(options.who) {
    std::vector<std::string> command = {COHORT_BUILD_DIR "/bin/" + options.bridge,
                                        "--robots",
                                        options.robots,
                                        "--domain",
                                        domain_.text(),
                                        "--port",
                                        "0"};
    command.insert(command.end(), options.more.begin(), options.more.end());
    bridge_ = std::make_unique<Process>(command);
  }

  Process& server() { return server_; }
  Process& bridge() { return *bridge_; }
  bool says(const std::string& text) { return bridge_->wait_for_output(text); }

  std::uint16_t port(const std::string& robot = "0") {
    const std::string prefix = "robot " + robot + ": waiting for the " + who_ + " at ";
    if (!bridge_->wait_for_output(prefix)) throw std::runtime_error("no port: " + bridge_->output());
    std::smatch match;
    const std::string output = bridge_->output();
    if (!std::regex_search(output, match, std::regex(prefix + R"([\d.]+:(\d+)\n)"))) return 0;
    return static_cast<std::uint16_t>(std::stoul(match[1]));
  }

  nlohmann::json summary() {
    EXPECT_EQ(server_.wait_for_exit(), 0) << server_.output();
    EXPECT_EQ(bridge_->wait_for_exit(), 0) << bridge_->output();
    return read_json(folder_ / "summary.json");
  }

 private:
  ReservedDomain domain_;
  ScratchFolder folder_;
  Process server_;
  std::string who_;
  std::unique_ptr<Process> bridge_;
};

/// Options of a bridge, and what is said of them.
using Refusals = std::vector<std::pair<std::vector<std::string>, std::string>>;
inline void expect_refusals(const std::string& bridge, const Refusals& refusals) {
  for (const auto& [arguments, text] : refusals) {
    std::vector<std::string> command{COHORT_BUILD_DIR "/bin/" + bridge};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const Ended ended = run_to_end(command);
    EXPECT_EQ(ended.exit_code, 2) << ended.err;
    EXPECT_NE(ended.err.find(text), std::string::npos) << ended.err;
  }
}

}  // namespace cohort::test
