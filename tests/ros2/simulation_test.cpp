// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>

#include "tests/ros2/services_helper.hpp"
#include "tests/ros2/simulation_interfaces.hpp"

/// Nodes of ROS control a run by the services of simulation_interfaces.
namespace cohort::test {
namespace {

const std::string bridge_program = COHORT_BUILD_DIR "/bin/cohort-ros2-bridge";
const std::string caller_program = COHORT_BUILD_DIR "/bin/cyclone_caller";
const std::string experiment = COHORT_SOURCE_DIR "/worlds/experiments/turtlebot3.yaml";
const std::string calls = "100";

// A run in a network of its own, with a bridge. It is paused unless the server has options.
class ControlledRun {
 public:
  explicit ControlledRun(const std::vector<std::string>& options = {}, const std::string& program = bridge_program,
                         const std::vector<std::string>& server_options = {"--paused"}) {
    std::vector<std::string> server = {cohort_program(), "serve", experiment};
    server.insert(server.end(), server_options.begin(), server_options.end());
    server_ = network_.start(server);
    std::vector<std::string> command = {program};
    command.insert(command.end(), options.begin(), options.end());
    bridge_ = network_.start(command);
  }

  const OwnNetwork& network() const { return network_; }
  Process& server() { return *server_; }
  Process& bridge() { return *bridge_; }

 private:
  OwnNetwork network_;
  std::unique_ptr<Process> server_;
  std::unique_ptr<Process> bridge_;
};

// The bridge's program in a folder of its own.
class BridgeWithoutHelper {
 public:
  BridgeWithoutHelper() { std::filesystem::copy_file(bridge_program, program()); }
  std::string program() const { return (folder_ / "cohort-ros2-bridge").string(); }
  std::string helper() const { return (folder_ / "cohort-ros2-services").string(); }

 private:
  ScratchFolder folder_;
};

std::string interfaces(const Ros2Distribution& distribution, SimulationInterfaces version) {
  const ScratchFolder folder;
  const InterfaceTexts texts(folder / "texts", version);
  const std::string name = version == SimulationInterfaces::former ? "simulation-1" : "simulation-2";
  return build_interfaces(distribution, (folder / "texts").string(), name, {InterfaceTexts::package});
}

// One distribution has the versions 1.x, the other one 2.x.
class Ros2Simulation : public ::testing::TestWithParam<std::size_t> {
 protected:
  const Ros2Distribution& distribution() const { return ros2_distributions()[GetParam()]; }
  SimulationInterfaces version() const {
    return GetParam() == 0 ? SimulationInterfaces::former : SimulationInterfaces::current;
  }
  Process::Environment environment() const { return {{"PYTHONPATH", interfaces(distribution(), version())}}; }
};

TEST_P(Ros2Simulation, AnUnmodifiedNodeControlsARunByEachService) {
  if (const std::string missing = missing_for_services(); !missing.empty()) GTEST_SKIP() << missing;
  const auto with_interfaces = environment();
  ControlledRun run(version() == SimulationInterfaces::former ? std::vector<std::string>()
                                                              : std::vector<std::string>{"--ros-distro", "rolling"});
  const auto client = run.network().start_node(distribution(), "simulation_client.py", {"all"}, with_interfaces);
  ASSERT_EQ(client->wait_for_exit(), 0) << client->output();
  EXPECT_EQ(run.server().wait_for_exit(), 0) << run.server().output();
  EXPECT_EQ(run.bridge().wait_for_exit(), 0) << run.bridge().output();
}

TEST_P(Ros2Simulation, ANodeDrivesARobotThatItAdds) {
  if (const std::string missing = missing_for_services(); !missing.empty()) GTEST_SKIP() << missing;
  const auto with_interfaces = environment();
  ControlledRun run({}, bridge_program, {"--duration", "3600"});
  const auto node = run.network().start_node(distribution(), "spawner.py", {"drive"}, with_interfaces);
  EXPECT_EQ(node->wait_for_exit(), 0) << node->output() << run.bridge().output();
  EXPECT_EQ(run.server().wait_for_exit(), 0) << run.server().output();
}

TEST_P(Ros2Simulation, AnswersFitTheirFramesWhileRobotsComeAndGo) {
  if (const std::string missing = missing_for_services(); !missing.empty()) GTEST_SKIP() << missing;
  const auto with_interfaces = environment();
  const ScratchFolder folder;
  ControlledRun run({}, bridge_program, {"--duration", "3600", "--summary", folder / "summary.json"});
  const std::string seed = std::to_string(GetParam());
  const auto node = run.network().start_node(distribution(), "spawner.py", {"random", seed, "50"}, with_interfaces);
  EXPECT_EQ(node->wait_for_exit(), 0) << node->output() << run.bridge().output();
  EXPECT_EQ(run.server().wait_for_exit(), 0) << run.server().output();
  EXPECT_EQ(run.bridge().output().find("rejected"), std::string::npos) << run.bridge().output();
  for (const auto& event : read_json(folder / "summary.json")["events"])
    EXPECT_NE(event["kind"], "rejected") << event.dump();
}

TEST_P(Ros2Simulation, ClientsOnBothImplementationsOfDdsGetOneReplyEach) {
  if (const std::string missing = missing_for_services(); !missing.empty()) GTEST_SKIP() << missing;
  const auto with_interfaces = environment();
  const ControlledRun run;
  const auto cyclone = run.network().start({caller_program, calls, calls});
  ASSERT_TRUE(cyclone->wait_for_output("services are there\n"));
  const auto fast = run.network().start_node(distribution(), "simulation_client.py", {"ask", calls}, with_interfaces);
  EXPECT_EQ(fast->wait_for_exit(), 0) << fast->output();
  EXPECT_EQ(cyclone->wait_for_exit(), 0);
  EXPECT_EQ(cyclone->output(), "services are there\nreplies: 101 own, 0 wrong, 100 of others\n");
}

// A request that only the bridge gets is never answered.
TEST_P(Ros2Simulation, ANodeOnFastDdsSeesNoServiceWithoutTheHelper) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const auto with_interfaces = environment();
  const BridgeWithoutHelper bridge;
  const ControlledRun run({}, bridge.program());
  const auto fast = run.network().start_node(distribution(), "simulation_client.py", {"look"}, with_interfaces);
  EXPECT_EQ(fast->wait_for_exit(), 0) << fast->output();
}

INSTANTIATE_TEST_SUITE_P(OfEachDistribution, Ros2Simulation, ::testing::Values(0, 1),
                         [](const auto& tested) { return ros2_distributions()[tested.param].name; });

TEST(Ros2SimulationControl, ContinuesAfterTheHelperHasEnded) {
  if (const std::string missing = missing_for_services(); !missing.empty()) GTEST_SKIP() << missing;
  ControlledRun run;
  const auto first = run.network().start({caller_program, "1", "0"});
  EXPECT_EQ(first->wait_for_exit(), 0);
  const std::vector<pid_t> helpers = children_of(run.bridge().pid());
  ASSERT_EQ(helpers.size(), 1u);
  ::kill(helpers.front(), SIGKILL);
  const std::string told = "services are not available to clients on Fast DDS: cohort-ros2-services has ended\n";
  EXPECT_TRUE(run.bridge().wait_for_output(told));
  const auto second = run.network().start({caller_program, "10", "0"});
  EXPECT_EQ(second->wait_for_exit(), 0);
  EXPECT_EQ(second->output(), "services are there\nreplies: 11 own, 0 wrong, 0 of others\n");
  run.bridge().signal(SIGINT);
  run.bridge().wait_for_exit();
  EXPECT_EQ(run.bridge().output().find(told), run.bridge().output().rfind(told)) << run.bridge().output();
}

TEST(Ros2SimulationControl, WorksForCycloneDdsWithoutTheHelper) {
  if (const std::string missing = missing_for_ros2(); !missing.empty()) GTEST_SKIP() << missing;
  const BridgeWithoutHelper bridge;
  ControlledRun run({}, bridge.program());
  EXPECT_TRUE(run.bridge().wait_for_output(
      "services are not available to clients on Fast DDS: no such program: " + bridge.helper() + "\n"));
  const auto caller = run.network().start({caller_program, "1", "0"});
  EXPECT_EQ(caller->wait_for_exit(), 0);
  EXPECT_EQ(caller->output(), "services are there\nreplies: 2 own, 0 wrong, 0 of others\n");
}

}  // namespace
}  // namespace cohort::test
