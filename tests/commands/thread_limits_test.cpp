// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/commands/small_experiment.hpp"

// Runs under a limit of processes and threads, which containers and users have.
namespace cohort::test {
namespace {

namespace fs = std::filesystem;

class ThreadLimits : public ::testing::Test {
 protected:
  void SetUp() override {
    if (geteuid() != 0 || !is_installed("setpriv") || !is_installed("prlimit"))
      GTEST_SKIP() << "needs root, setpriv and prlimit, to run as a user that has no other processes";
    fs::permissions(experiment / "", fs::perms::all);
  }

  // Runs the experiment as a user of its own, who may have `most` processes and threads.
  Ended run_with_limit(int most, const std::vector<std::string>& arguments) {
    fs::remove(summary);
    std::vector<std::string> command = experiment.run(arguments);
    command.insert(command.end(), {"--summary", summary.string()});
    command.insert(command.begin(), {"/usr/bin/env", "setpriv", "--reuid", std::to_string(100'000 + getpid()),
                                     "--clear-groups", "prlimit", "--nproc=" + std::to_string(most)});
    return run_to_end(command);
  }

  // Returns how many runs have failed, all of them in order.
  int count_failures(const std::vector<int>& limits, const std::vector<std::string>& arguments) {
    int failures = 0;
    for (const int most : limits) {
      const Ended run = run_with_limit(most, arguments);
      EXPECT_TRUE(fs::exists(summary)) << most << ": " << run.err;
      if (run.exit_code == 0) continue;
      ++failures;
      EXPECT_EQ(run.exit_code, 1) << most << ": " << run.err;
      EXPECT_NE(run.err.find(": the limit is reached; it is " + std::to_string(most) +
                             " processes and threads of this user ('ulimit -u')"),
                std::string::npos)
          << most << ": " << run.err;
      EXPECT_EQ(run.err.find("pthread_create"), std::string::npos) << run.err;
    }
    return failures;
  }

  const SmallExperiment experiment{test_controller("misbehaving"), "", 0.1};
  const fs::path summary = experiment / "summary.json";
};

TEST_F(ThreadLimits, OfThreadsThatStepTheWorldAreNamed) {
  const std::vector<std::string> arguments = {"--controllers", "inprocess", "--threads", "8"};
  EXPECT_EQ(count_failures({1, 2, 3, 5, 7, 8}, arguments), 6);
  EXPECT_EQ(count_failures({9, 64}, arguments), 0);
}

TEST_F(ThreadLimits, OfProcessesOfControllersAreNamed) {
  EXPECT_EQ(count_failures({1, 2, 4, 8, 12, 15}, {"--threads", "2"}), 6);
  count_failures({16, 17, 18, 19}, {"--threads", "2"});
  EXPECT_EQ(count_failures({64}, {"--threads", "2"}), 0);
}

TEST_F(ThreadLimits, OfARecordingAreNamed) {
  const std::vector<std::string> arguments = {
      "--controllers", "inprocess", "--threads", "1", "--record", (experiment / "run.mcap").string()};
  EXPECT_EQ(count_failures({1, 2, 3}, arguments), 3);
  EXPECT_EQ(count_failures({4, 64}, arguments), 0);
}

}  // namespace
}  // namespace cohort::test
