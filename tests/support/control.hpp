// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/free_domain.hpp"
#include "tests/support/patience.hpp"
#include "tests/support/process.hpp"

namespace cohort::test {

inline std::vector<std::string> ctl_command(const ReservedDomain& domain, const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {cohort_program(), "ctl", "--domain", domain.text()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return command;
}

/// Runs `cohort ctl`, checks that it succeeds, and returns its output. A server that was started with `--paused` and is
/// stepped stands still between two steps. A test can therefore act at an exact tick, however busy the machine is.
inline std::string control(const ReservedDomain& domain, std::vector<std::string> arguments) {
  const std::string command = arguments.front();
  arguments.insert(arguments.begin(), {"--timeout", patience_in_seconds});
  const Ended ended = run_to_end(ctl_command(domain, arguments));
  EXPECT_EQ(ended.exit_code, 0) << command << ": " << ended.err << ended.out;
  return ended.out;
}

/// Waits until a live controller drives the robot of this id.
inline bool comes_to_drive(const ReservedDomain& domain, std::uint32_t robot) {
  return eventually([&] {
    const auto status = nlohmann::json::parse(control(domain, {"status", "--json"}));
    return std::ranges::any_of(status["controllers"], [&](const nlohmann::json& each) {
      return each["alive"].get<bool>() && std::ranges::count(each["robots"], nlohmann::json(robot)) > 0;
    });
  });
}

}  // namespace cohort::test
