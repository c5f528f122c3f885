// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <iostream>

#include "tests/support/controlled_run.hpp"

// A server to which robots are added and from which they are removed all the time stays as small as it was.
namespace cohort::test {
namespace {

double megabytes_of(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) / 1024.0;
  return 0.0;
}

TEST(SpawnsLeaveNothing, InAServer) {
  constexpr int first = 300, all = 3'000;
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  run.done({"step", "1"});
  Control control = control_of(run);
  double before = 0.0;
  for (int cycle = 0; cycle < all; ++cycle) {
    Spawn spawn;
    spawn.name = "swarm/new_" + std::to_string(cycle);
    spawn.model = "sbot";
    spawn.pose.position.x = 1.0;
    EXPECT_EQ(control.spawn(spawn), spawn.name);
    control.remove(spawn.name);
    if (cycle == first) before = megabytes_of(run.server().pid());
  }
  const double kilobytes_each = 1024.0 * (megabytes_of(run.server().pid()) - before) / (all - first);
  std::cout << kilobytes_each << " kB of each robot are kept\n";
  EXPECT_LT(kilobytes_each, 2.0) << "a robot with its devices takes 15 kB";
  run.done({"step", "10"});
  EXPECT_EQ(run.status()["robots"], 2 + all);
  run.done({"shutdown"});
  run.finish();
}

}  // namespace
}  // namespace cohort::test
