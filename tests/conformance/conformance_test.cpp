// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <csignal>
#include <memory>
#include <utility>

#include "tests/support/control.hpp"
#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

constexpr const char* avoidance = COHORT_BUILD_DIR "/lib/controllers/obstacle_avoidance.so";
constexpr const char* braitenberg = COHORT_BUILD_DIR "/lib/controllers/braitenberg.so";
constexpr const char* remembering = COHORT_BUILD_DIR "/lib/test_controllers/remembering.so";
constexpr const char* obstacles = COHORT_SOURCE_DIR "/worlds/arenas/obstacles.sdf";

// A server, and its clients on Fast DDS.
class Conformance : public ::testing::Test {
 protected:
  std::unique_ptr<Process> serve(const std::string& experiment, std::vector<std::string> more = {},
                                 Process::Environment environment = {}) {
    std::vector<std::string> command = {cohort_program(), "serve", experiment, "--domain", domain.text()};
    command.insert(command.end(), more.begin(), more.end());
    environment.emplace("COHORT_LOG", "info");
    return std::make_unique<Process>(command, environment);
  }
  std::unique_ptr<Process> start_foreign(const std::string& robots, const std::string& plugin = avoidance,
                                         const std::string& loses_every = "0") {
    // Disables a check of AddressSanitizer that the destructors of Fast DDS itself violate.
    return std::make_unique<Process>(
        std::vector<std::string>{COHORT_BUILD_DIR "/bin/fastdds_client", plugin, domain.text(), robots, loses_every},
        Process::Environment{{"ASAN_OPTIONS", "new_delete_type_mismatch=0"}});
  }
  std::unique_ptr<Process> start_own(const std::string& robots, const std::string& controller = "obstacle_avoidance") {
    return std::make_unique<Process>(
        std::vector<std::string>{cohort_program(), "host", controller, "--robots", robots, "--domain", domain.text()});
  }
  // The robots of the demo, with a controller for which every frame matters.
  std::string experiment_with(const std::string& timing) {
    std::string file = (folder / "experiment.yaml").string();
    write_file(file,
               std::string("world: ") + obstacles +
                   "\nduration: 5\nseed: 1\nteams:\n  - name: explorers\n    robots: explorers/*\n    controller: " +
                   remembering + "\n    parameters: {speed: 0.2}\n" + timing);
    return file;
  }
  static std::string hash_in_process(const std::string& experiment) {
    return run_experiment(experiment, {"--controllers", "inprocess"})["state_hash"];
  }
  static void expect_end(Process& server, const std::string& hash) {
    EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
    EXPECT_NE(server.output().find(hash), std::string::npos) << server.output();
  }
  static void expect_finished(Process& client) { EXPECT_EQ(client.wait_for_exit(), 0) << client.output(); }

  ReservedDomain domain;
  ScratchFolder folder;
};

TEST_F(Conformance, AClientOnAnotherDdsGivesIdenticalResults) {
  const auto server = serve(demo_experiment(), {"--duration", "5"});
  const auto client = start_foreign("all");
  expect_end(*server, reference_hash(5));
  expect_finished(*client);
  EXPECT_NE(client->output().find("report 0 (complete)"), std::string::npos) << client->output();
}

TEST_F(Conformance, ClientsOfTwoDdsShareARunWithIdenticalResults) {
  const auto server = serve(demo_experiment(), {"--duration", "5"});
  const auto foreign = start_foreign("0..3,explorers/sbot_7,12..14");
  const auto own = start_own("4..6,8..11,15");
  expect_end(*server, reference_hash(5));
  expect_finished(*foreign);
  expect_finished(*own);
}

TEST_F(Conformance, AClientCanStartBeforeItsServer) {
  const auto client = start_foreign("all");
  ASSERT_TRUE(client->wait_for_output("looking for a server")) << client->output();
  const auto server = serve(demo_experiment(), {"--duration", "5"});
  expect_end(*server, reference_hash(5));
  expect_finished(*client);
}

TEST_F(Conformance, AClientCannotClaimARobotOfAnother) {
  const auto server = serve(demo_experiment(), {"--duration", "5", "--paused"});
  const auto first = start_foreign("all");
  control(domain, {"step", "100"});
  const auto second = start_foreign("explorers/sbot_1*");
  // The answers of the first one show that it is running.
  EXPECT_TRUE(eventually(
      [&] {
        control(domain, {"step", "1"});
        return !second->running();
      },
      patience, 100ms));
  EXPECT_EQ(second->wait_for_exit(), 1) << second->output();
  EXPECT_NE(second->output().find("refused: "), std::string::npos) << second->output();
  control(domain, {"resume"});
  expect_end(*server, reference_hash(5));
  expect_finished(*first);
}

TEST_F(Conformance, ParametersAndSeedsGiveIdenticalResults) {
  const std::string weighted = COHORT_SOURCE_DIR "/worlds/experiments/braitenberg.yaml";
  for (const auto& [experiment, plugin] : {std::pair(weighted, braitenberg), {experiment_with(""), remembering}}) {
    const auto server = serve(experiment);
    const auto client = start_foreign("all", plugin);
    expect_end(*server, hash_in_process(experiment));
    expect_finished(*client);
  }
}

TEST_F(Conformance, PeriodAndDelayGiveIdenticalResults) {
  const std::string experiment = experiment_with("    period: 2\n    delay: 1\n");
  const auto server = serve(experiment);
  const auto client = start_foreign("all", remembering);
  expect_end(*server, hash_in_process(experiment));
  expect_finished(*client);
  EXPECT_NE(client->output().find("answered in all 250"), std::string::npos) << client->output();
}

// Drops every seventh frame, and as many answers. With a delay, others arrive in between and must wait.
TEST_F(Conformance, LostFramesAndAnswersGiveIdenticalResults) {
  for (const char* timing : {"", "    delay: 3\n", "    period: 2\n    phase: 1\n    delay: 5\n"}) {
    const std::string experiment = experiment_with(timing);
    const auto server = serve(experiment);
    const auto client = start_foreign("all", remembering, "7");
    expect_end(*server, hash_in_process(experiment));
    expect_finished(*client);
    EXPECT_EQ(client->output().find(", again 0"), std::string::npos) << client->output();
  }
}

TEST_F(Conformance, ARestartedClientGivesIdenticalResults) {
  const auto server = serve(demo_experiment(), {"--duration", "5", "--paused"});
  const auto own = start_own("8..15");
  const auto killed = start_foreign("0..7");
  control(domain, {"step", "200"});
  killed->signal(SIGKILL);
  control(domain, {"resume"});
  ASSERT_TRUE(server->wait_for_output("waiting for explorers/sbot_0 and 7 more")) << server->output();
  const auto again = start_foreign("0..7");
  expect_end(*server, reference_hash(5));
  expect_finished(*again);
  expect_finished(*own);
  EXPECT_NE(again->output().find(", reason 1"), std::string::npos) << again->output();
}

TEST_F(Conformance, AClientLeavesWhenItsServerDies) {
  const auto server = serve(demo_experiment());
  const auto client = start_foreign("all");
  ASSERT_TRUE(client->wait_for_output("admitted")) << client->output();
  server->signal(SIGKILL);
  EXPECT_EQ(client->wait_for_exit(), 4) << client->output();
  EXPECT_NE(client->output().find("the server is gone"), std::string::npos) << client->output();
}

// The second server starts before the client considers the first one lost, and is known only by the protocol.
TEST_F(Conformance, AClientContinuesWithAReplacementServer) {
  const auto first = serve(demo_experiment());
  const auto client = start_foreign("all");
  ASSERT_TRUE(client->wait_for_output("answered 100 frames")) << client->output();
  first->signal(SIGKILL);
  first->wait_for_exit();
  const auto second = serve(demo_experiment(), {"--duration", "5"});
  expect_end(*second, reference_hash(5));
  expect_finished(*client);
}

// Its epochs are lower than those of the leases of the first one.
TEST_F(Conformance, AClientContinuesWithAServerWhoseClockIsAMinuteBehind) {
  for (const bool is_own : {false, true}) {
    const auto first = serve(demo_experiment(), {"--paused"});
    const auto client = is_own ? start_own("all") : start_foreign("all");
    control(domain, {"step", "100"});
    first->signal(SIGKILL);
    first->wait_for_exit();
    const auto second =
        serve(demo_experiment(), {"--duration", "5"}, {{"LD_PRELOAD", COHORT_BUILD_DIR "/lib/libclock_behind.so"}});
    expect_end(*second, reference_hash(5));
    expect_finished(*client);
  }
}

// The state of controllers goes from either client into a snapshot, and from a snapshot to either client.
TEST_F(Conformance, ControllerStateInSnapshotsGivesIdenticalResults) {
  const std::string experiment = experiment_with("    delay: 1\n");
  const std::string expected = hash_in_process(experiment);
  const std::string file = folder / "saved.snap";
  {
    const auto server = serve(experiment, {"--paused"});
    const auto foreign = start_foreign("0..7", remembering);
    const auto own = start_own("8..15", remembering);
    control(domain, {"step", "150"});
    EXPECT_EQ(control(domain, {"save", file}).find("without state"), std::string::npos);
    control(domain, {"step", "100"});
    control(domain, {"load", file});
    control(domain, {"resume"});
    expect_end(*server, expected);
    expect_finished(*foreign);
    expect_finished(*own);
    EXPECT_NE(foreign->output().find("gave state of tick 150"), std::string::npos) << foreign->output();
    EXPECT_NE(foreign->output().find("reason 4"), std::string::npos) << foreign->output();
  }
  const auto server = serve(experiment, {"--from", file});
  const auto own = start_own("0..7", remembering);
  const auto foreign = start_foreign("8..15", remembering);
  expect_end(*server, expected);
  expect_finished(*own);
  expect_finished(*foreign);
  EXPECT_NE(foreign->output().find("loaded "), std::string::npos) << foreign->output();
}

TEST_F(Conformance, AClientThatTakesOverAtTheRestoredTickGetsTheState) {
  const std::string experiment = experiment_with("");
  const std::string file = folder / "saved.snap";
  {
    const auto server = serve(experiment, {"--paused"});
    const auto client = start_foreign("all", remembering);
    control(domain, {"step", "150"});
    control(domain, {"save", file});
    control(domain, {"shutdown"});
    server->wait_for_exit();
  }
  const auto server = serve(experiment, {"--from", file, "--paused"});
  const auto killed = start_foreign("all", remembering);
  ASSERT_TRUE(killed->wait_for_output("loaded ")) << killed->output();
  killed->signal(SIGKILL);
  const auto again = start_foreign("all", remembering);
  ASSERT_TRUE(again->wait_for_output("loaded ")) << again->output();
  control(domain, {"resume"});
  expect_end(*server, hash_in_process(experiment));
  expect_finished(*again);
  EXPECT_NE(again->output().find("from tick 150, reason 4"), std::string::npos) << again->output();
}

// Messages are larger than a datagram and are fragmented in both directions.
TEST_F(Conformance, AThousandRobotsGiveIdenticalResults) {
  write_file(folder / "world.yaml",
             "world:\n  name: swarm\n"
             "  model: {name: ground, static: true, link: {collision: {geometry: {plane: {}}}}}\n"
             "  cohort:population:\n    name: swarm\n    uri: model://sbot\n    count: 1000\n"
             "    placement: {grid: {spacing: 0.2}}\n");
  write_file(folder / "experiment.yaml",
             "world: world.yaml\nduration: 0.3\nseed: 1\nteams:\n  - name: swarm\n    robots: all\n"
             "    controller: obstacle_avoidance\n");
  const std::string experiment = (folder / "experiment.yaml").string();
  const auto server = serve(experiment);
  const auto client = start_foreign("all");
  expect_end(*server, hash_in_process(experiment));
  expect_finished(*client);
}

}  // namespace
}  // namespace cohort::test
