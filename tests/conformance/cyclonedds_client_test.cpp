// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "tests/support/control.hpp"
#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

// This DDS implementation tells how its types are composed. If the server told it too, they would differ, since each
// has names of its own for the same parts.
TEST(ClientOnCycloneDdsForPython, GivesIdenticalResults) {
  if (std::string_view(COHORT_CYCLONEDDS_PYTHON).empty())
    GTEST_SKIP() << "no Cyclone DDS 11 here: tools/dev/python-environment --cyclonedds";
  const ReservedDomain domain;
  const ScratchFolder folder;
  const std::string experiment = (folder / "experiment.yaml").string();
  write_file(experiment, "world: " COHORT_SOURCE_DIR
                         "/worlds/arenas/obstacles.sdf\nduration: 5\nseed: 1\nteams:\n  - name: explorers\n"
                         "    robots: explorers/*\n    controller: constant\n"
                         "    parameters: {treel/left/velocity: 0.1, treel/right/velocity: 0.12}\n");
  const std::string expected = run_experiment(experiment, {"--controllers", "inprocess"})["state_hash"];
  Process server({cohort_program(), "serve", experiment, "--domain", domain.text()});
  Process client({COHORT_CYCLONEDDS_PYTHON, COHORT_SOURCE_DIR "/tests/conformance/cyclonedds_client.py", domain.text(),
                  "0..7", "explorers/sbot_8", "9..15"});
  EXPECT_EQ(client.wait_for_exit(), 0) << client.output() << server.output();
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_NE(server.output().find(expected), std::string::npos) << server.output();
}

}  // namespace
}  // namespace cohort::test
