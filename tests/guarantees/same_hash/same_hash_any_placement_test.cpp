// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

TEST(SameHashAnyPlacement, InProcessOneProcessAndAProcessForEachRobotGiveTheSameBits) {
  const std::string expected = reference_hash(10);
  for (const char* placement : {"process", "per-robot"}) {
    const auto summary = run_demo({"--controllers", placement, "--duration", "10"});
    EXPECT_EQ(summary["state_hash"], expected) << placement;
    EXPECT_EQ(summary["late"], 0);
  }
}

TEST(SameHashAnyPlacement, ControllersThatAttachFromOutsideGiveTheSameBits) {
  const ReservedDomain domain;
  Process server({cohort_program(), "serve", demo_experiment(), "--duration", "5", "--domain", domain.text()});
  Process first({cohort_program(), "host", "obstacle_avoidance", "--robots", "0..4,9", "--domain", domain.text()});
  ASSERT_TRUE(server.wait_for_output("waiting for explorers/sbot_5")) << server.output();
  Process second({cohort_program(), "host", "obstacle_avoidance", "--robots", "5..8", "--domain", domain.text()});
  Process third({COHORT_BUILD_DIR "/bin/obstacle_avoidance", "--robots", "10..15", "--domain", domain.text()});
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_EQ(first.wait_for_exit(), 0) << first.output();
  EXPECT_EQ(second.wait_for_exit(), 0) << second.output();
  EXPECT_EQ(third.wait_for_exit(), 0) << third.output();
  EXPECT_NE(server.output().find(reference_hash(5)), std::string::npos) << server.output();
}

// The server on one of two hosts, controllers on both: network namespaces, with a pair of virtual interfaces as the
// cable.
TEST(SameHashAnyPlacement, ControllersOnTheServersHostAndOnAnotherGiveTheSameBits) {
  const ScratchFolder folder;
  write_file(folder / "two_hosts.sh", R"(set -e
mount -t tmpfs none /run
ip netns add here
ip netns add there
ip link add cable netns here type veth peer name cable netns there
for side in here:10.98.0.1/24 there:10.98.0.2/24; do
  ip -n ${side%%:*} link set lo up
  ip -n ${side%%:*} addr add ${side#*:} dev cable
  ip -n ${side%%:*} link set cable up
done
export COHORT_SERVER=10.98.0.1
COHORT_NETWORK=10.98.0.1 ip netns exec here "$COHORT" serve "$EXPERIMENT" --duration 10 --summary summary.json > server.out 2>&1 &
server=$!
ip netns exec here "$COHORT" host obstacle_avoidance --robots 0..4 > here.out 2>&1 &
ip netns exec there "$COHORT" host obstacle_avoidance --robots 5..9 > there.out 2>&1 &
ip netns exec there "$PROGRAM" --robots 10..15 > program.out 2>&1 &
wait $server
wait
)");
  const Ended hosts = run_to_end({"/usr/bin/unshare", "--map-root-user", "--net", "--mount", "/bin/bash", "-c",
                                  "cd " + folder.path().string() + " && . ./two_hosts.sh"},
                                 {{"COHORT", cohort_program()},
                                  {"EXPERIMENT", demo_experiment()},
                                  {"PROGRAM", COHORT_BUILD_DIR "/bin/obstacle_avoidance"}});
  if (hosts.err.find("ermitted") != std::string::npos || hosts.err.find("Unknown device type") != std::string::npos)
    GTEST_SKIP() << "no two hosts here: " << hosts.err;
  ASSERT_EQ(hosts.exit_code, 0) << hosts.err << read_file(folder / "server.out") << read_file(folder / "there.out");
  const auto summary = read_json(folder / "summary.json");
  EXPECT_EQ(summary["state_hash"], reference_hash(10));
  int joined = 0;
  for (const auto& event : summary["events"]) joined += event["kind"] == "joined" ? 1 : 0;
  EXPECT_EQ(joined, 3);
}

// As a plugin, as a program, and from a loop of its own.
TEST(SameHashAnyPlacement, AControllerInCGivesTheBitsOfItsTwinInCpp) {
  const std::string expected = reference_hash(5);
  const ScratchFolder folder;
  const std::string experiment = (folder / "experiment.yaml").string();
  write_file(experiment, "world: " COHORT_SOURCE_DIR
                         "/worlds/arenas/obstacles.sdf\nduration: 5\nseed: 1\nteams:\n  - name: explorers\n"
                         "    robots: explorers/*\n    controller: obstacle_avoidance_c\n");
  for (const char* placement : {"inprocess", "process"})
    EXPECT_EQ(run_experiment(experiment, {"--controllers", placement})["state_hash"], expected) << placement;

  const ReservedDomain domain;
  Process server({cohort_program(), "serve", experiment, "--domain", domain.text()});
  Process program({COHORT_BUILD_DIR "/bin/obstacle_avoidance_c", "--robots", "0..7", "--domain", domain.text()});
  Process loop({COHORT_BUILD_DIR "/bin/drive_in_a_loop", domain.text(), "8..15"});
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_EQ(program.wait_for_exit(), 0) << program.output();
  EXPECT_EQ(loop.wait_for_exit(), 0) << loop.output();
  EXPECT_NE(server.output().find(expected), std::string::npos) << server.output();
}

TEST(SameHashAnyPlacement, ALoopInCWithoutOptionsUsesTheServerOfTheEnvironment) {
  const ReservedDomain domain;
  Process server({cohort_program(), "serve", demo_experiment(), "--duration", "1", "--domain", domain.text()});
  Process loop({COHORT_BUILD_DIR "/bin/drive_in_a_loop"},
               {{"COHORT_DOMAIN", domain.text()}, {"COHORT_SERVER", "127.0.0.1"}});
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_EQ(loop.wait_for_exit(), 0) << loop.output();
  EXPECT_NE(server.output().find(reference_hash(1)), std::string::npos) << server.output();
}

// A wall is removed, a robot is added, another one is removed, and one is absent for a second.
TEST(SameHashAnyPlacement, EventsAreTheSameForAnyPlacementAndThreadCount) {
  const std::string experiment = COHORT_SOURCE_DIR "/worlds/experiments/changes.yaml";
  const auto expected = run_experiment(experiment, {"--controllers", "inprocess", "--threads", "1"});
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--controllers", "inprocess", "--threads", "4"},
        {"--controllers", "process"},
        {"--controllers", "per-robot", "--threads", "2"}}) {
    const auto summary = run_experiment(experiment, arguments);
    EXPECT_EQ(summary["state_hash"], expected["state_hash"]) << arguments[1];
    EXPECT_EQ(summary["late"], 0);
    EXPECT_EQ(summary["touches"]["robot_ticks"], expected["touches"]["robot_ticks"]);
  }
  int events = 0;
  for (const auto& event : expected["events"]) events += event["kind"] == "event" ? 1 : 0;
  EXPECT_EQ(events, 6);
}

TEST(SameHashAnyPlacement, RepeatedRunsGiveTheSameBits) {
  const auto once = run_demo({"--duration", "10"});
  const auto again = run_demo({"--duration", "10"});
  EXPECT_EQ(once["state_hash"], again["state_hash"]);
}

}  // namespace
}  // namespace cohort::test
