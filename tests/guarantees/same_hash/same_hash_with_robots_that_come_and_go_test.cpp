// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <iomanip>
#include <memory>
#include <sstream>

#include "client_sdk/hosting/plugin_loader.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/run/in_process.hpp"
#include "tests/support/controlled_run.hpp"

// Robots are spawned and deleted during a run: two are added, and one of them and an initial one are removed. They are
// added by requests, or by events of the experiment.
namespace cohort::test {
namespace {

constexpr std::uint64_t first_comes = 10, second_comes = 20, saved_at = 25, two_leave = 30, last_tick = 60;
constexpr std::uint32_t robots_at_first = 3;

std::string hex(std::uint64_t hash) {
  std::ostringstream text;
  text << std::hex << std::setw(16) << std::setfill('0') << hash;
  return text.str();
}

Pose at_place(double x, double y) { return {{x, y, 0.0}, Eigen::Quaterniond::Identity()}; }

// A field of robots to which others are added: by requests, or by events of its experiment.
enum class Come { on_request, by_events };

class Field : public FieldOfRobots {
 public:
  explicit Field(Come come) : FieldOfRobots(robots_at_first, 1e4), has_events_(come == Come::by_events) {
    if (!has_events_) return;
    std::ofstream(file(), std::ios::app)
        << "events:\n"
           "  - {at: 0.1, spawn: {model: model://sbot, name: swarm/late, pose: [0.6, 0.1, 0, 0, 0, 0]}}\n"
           "  - {at: 0.2, spawn: {model: model://sbot, name: swarm/late, pose: [0.4, -0.3, 0, 0, 0, 0]}}\n";
  }
  bool has_events() const { return has_events_; }

 private:
  bool has_events_;
};

// Returns the hash at the end, with controllers in this process, from a snapshot on if there is one.
std::string hash_here(const Field& field, unsigned threads, const std::string& snapshot = "") {
  const auto experiment =
      parsing::read_experiment(field.file(), {}, std::chrono::milliseconds(600), {COHORT_SOURCE_DIR "/worlds/robots"});
  Simulation simulation(experiment, threads);
  session::RunOptions options;
  if (!snapshot.empty()) {
    options.from = std::make_shared<session::SessionSnapshot>(session::read_snapshot(snapshot));
    session::restore(*options.from, simulation);
  }
  session::RunListener listener;
  const bool spawns = !field.has_events();
  listener.stepped = [&] {
    if (spawns && simulation.tick() == first_comes)
      simulation.act(SpawnObject{"swarm/late_1", "sbot", at_place(0.6, 0.1)});
    if (spawns && simulation.tick() == second_comes)
      simulation.act(SpawnObject{"swarm/late_2", "sbot", at_place(0.4, -0.3)});
    if (simulation.tick() != two_leave) return;
    simulation.act(RemoveObject{"swarm/late_1"});
    simulation.act(RemoveObject{"swarm/sbot_1"});
  };
  const LoadedPlugin plugin("obstacle_avoidance", default_plugin_directories());
  const auto result =
      session::run_in_process(experiment, simulation, {kind_of(plugin.plugin())}, options, listener, never);
  EXPECT_EQ(result.end, session::RunResult::End::finished) << result.error;
  EXPECT_EQ(simulation.tick(), last_tick);
  EXPECT_EQ(simulation.robot_count(), robots_at_first + 2);
  return hex(result.state_hash);
}

void step_to(const ControlledRun& run, std::uint64_t tick) { run.done({"step", std::to_string(tick - run.tick())}); }

// Does everything after the snapshot. Returns the hash at the end.
std::string go_on(const ControlledRun& run) {
  step_to(run, two_leave);
  run.done({"remove", "swarm/late_1"});
  run.done({"remove", "swarm/sbot_1"});
  step_to(run, last_tick);
  return run.status()["state_hash"];
}

// Returns the hash of a served run, which writes a snapshot. `hosts`: the processes of the initial robots.
std::string hash_served(const Field& field, const std::vector<std::string>& hosts, const std::string& threads,
                        const std::string& snapshot) {
  const std::string recording = snapshot + ".mcap";
  const bool spawns = !field.has_events();
  ControlledRun run(field, {"--paused", "--threads", threads, "--record", recording}, false);
  for (const std::string& robots : hosts) run.attach(robots);
  step_to(run, first_comes);
  if (spawns) run.done({"spawn", "sbot", "--name", "swarm/late_1", "--pose", "0.6 0.1 0"});
  run.attach("swarm/late_1");
  step_to(run, second_comes);
  if (spawns) run.done({"spawn", "sbot", "--name", "swarm/late_2", "--pose", "0.4 -0.3 0"});
  run.attach("swarm/late_2");
  step_to(run, saved_at);
  run.done({"save", snapshot});
  const std::string hash = go_on(run);
  run.done({"load", snapshot});
  EXPECT_EQ(go_on(run), hash) << "after a load in the same server";
  run.done({"shutdown"});
  run.finish();
  const Ended replayed = run_to_end({cohort_program(), "replay", "--verify", recording});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_NE(replayed.out.find("identical"), std::string::npos) << replayed.out;
  return hash;
}

void expect_same_hash_everywhere(const Field& field) {
  const std::string expected = hash_here(field, 1);
  for (const unsigned threads : {2u, 4u}) EXPECT_EQ(hash_here(field, threads), expected) << threads << " threads";
  EXPECT_EQ(hash_served(field, {"all"}, "2", field / "one_process"), expected);
  EXPECT_EQ(hash_served(field, {"0", "1", "2"}, "4", field / "per_robot"), expected);
  EXPECT_EQ(hash_here(field, 2, field / "per_robot"), expected) << "from a snapshot, with controllers in the process";
}

TEST(SameHashWithRobotsThatComeAndGo, ForAnyPlacementAndThreadCount) {
  expect_same_hash_everywhere(Field(Come::on_request));
}

TEST(SameHashWithRobotsThatComeAndGo, WithEventsThatAddThem) { expect_same_hash_everywhere(Field(Come::by_events)); }

TEST(SameHashWithRobotsThatComeAndGo, WithControllersThatTheRunStartsForThem) {
  const Field field(Come::by_events);
  const auto hash = [&](const std::string& controllers, const std::string& threads) {
    const std::string recording = field / (controllers + ".mcap");
    const nlohmann::json summary = run_experiment(
        field.file(), {"--controllers", controllers, "--threads", threads, "--duration", "0.6", "--record", recording});
    EXPECT_EQ(summary["robots"], robots_at_first + 2);
    EXPECT_EQ(run_to_end({cohort_program(), "replay", "--verify", recording}).exit_code, 0);
    return summary["state_hash"].get<std::string>();
  };
  const std::string expected = hash("inprocess", "1");
  EXPECT_EQ(hash("process", "2"), expected);
  EXPECT_EQ(hash("per-robot", "4"), expected);
}

TEST(SameHashWithRobotsThatComeAndGo, AfterAResetAndALoadWithControllersThatTheRunStarts) {
  const Field field(Come::by_events);
  const ReservedDomain domain;
  const std::string summary = field / "own.json";
  Process run({cohort_program(), "run", field.file(), "--duration", "0.6", "--paused", "--domain", domain.text(),
               "--summary", summary});
  control(domain, {"step", std::to_string(saved_at)});
  control(domain, {"save", field / "own"});
  control(domain, {"reset"});
  control(domain, {"step", "5"});
  control(domain, {"load", field / "own"});
  control(domain, {"resume"});
  EXPECT_EQ(run.wait_for_exit(), 0) << run.output();
  const std::string expected =
      run_experiment(field.file(), {"--controllers", "inprocess", "--duration", "0.6"})["state_hash"];
  EXPECT_EQ(read_json(summary)["state_hash"], expected);
}

TEST(SameHashWithRobotsThatComeAndGo, InANewServerThatLoadsASnapshot) {
  const Field field(Come::on_request);
  const std::string expected = hash_served(field, {"all"}, "1", field / "snapshot");
  ControlledRun another(field, {"--paused"}, false);
  another.done({"load", field / "snapshot"});
  another.attach("swarm/sbot_*");
  another.attach("swarm/late_*");
  EXPECT_EQ(go_on(another), expected);
  another.done({"shutdown"});
  another.finish();
}

}  // namespace
}  // namespace cohort::test
