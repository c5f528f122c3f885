// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cohort/control.hpp>
#include <functional>
#include <thread>

#include "server/messages/experiment_inputs.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/simulation/simulation.hpp"
#include "tests/support/controlled_run.hpp"

// Every method of <cohort/control.hpp>, with a server.
namespace cohort::test {
namespace {

constexpr const char* box = R"(<sdf version="1.9"><model name="box"><link name="body">
  <inertial><mass>1</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial>
  <collision name="hull"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>
</link></model></sdf>)";

constexpr const char* lamp = R"(<sdf version="1.9"><model name="lamp"><static>true</static><link name="post">
  <collision name="hull"><geometry><box><size>0.1 0.1 1</size></box></geometry></collision>
  <light name="bulb" type="point"><pose>0 0 0.6 0 0 0</pose><diffuse>1 1 1 1</diffuse><attenuation><range>5</range></attenuation></light>
</link></model></sdf>)";

// Returns the result of a refused request; fails if the request succeeds, or has no message.
ControlResult refusal(const std::function<void()>& request) {
  try {
    request();
  } catch (const ControlError& error) {
    EXPECT_STRNE(error.what(), "");
    return error.result;
  }
  ADD_FAILURE() << "it was done";
  return ControlResult::bad_reply;
}

TEST(ProgramsControlARun, TheyPauseItStepItAndEndIt) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused", "--keep-snapshots", "0.5"});
  Control control = control_of(run);
  EXPECT_EQ(control.state(), SimulationState::paused);
  EXPECT_EQ(control.step(70).tick, 70u);
  const ControlReply paused = control.pause();
  EXPECT_EQ(paused.tick, 70u);
  EXPECT_TRUE(paused.was_in_state);
  EXPECT_EQ(control.set_speed(0.0).message, "as fast as possible");
  EXPECT_EQ(control.back(std::chrono::milliseconds(600)).tick, 50u);
  const ControlReply reset = control.reset(7);
  EXPECT_EQ(reset.run, 3u);
  EXPECT_EQ(reset.tick, 0u);
  EXPECT_EQ(reset.state, SimulationState::paused);
  const ControlReply played = control.play();
  EXPECT_EQ(played.state, SimulationState::playing);
  EXPECT_FALSE(played.was_in_state);
  EXPECT_TRUE(eventually([&] { return control.status().tick > 5; }));
  EXPECT_EQ(refusal([&] { control.step(); }), ControlResult::not_paused) << "it plays";
  EXPECT_EQ(control.stop().state, SimulationState::stopped);

  EXPECT_TRUE(eventually([&] { return !control.status().controllers.empty(); })) << "it is attached through all of it";
  const SimulationStatus status = control.status();
  EXPECT_EQ(status.experiment, "experiment");
  EXPECT_EQ(status.seed, 7u);
  EXPECT_EQ(status.robots, 2u);
  EXPECT_EQ(status.step, std::chrono::milliseconds(10));
  ASSERT_EQ(status.controllers.size(), 1u);
  EXPECT_EQ(status.controllers[0].robots, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_TRUE(status.controllers[0].alive);
  const SimulatorFeatures features = control.features();
  EXPECT_EQ(features.spawn_formats, (std::vector<std::string>{"sdf", "urdf", "yaml"}));
  EXPECT_FALSE(features.features.empty());

  EXPECT_EQ(refusal([&] { control.reset({}, ResetScope::time); }), ControlResult::feature_unsupported);
  EXPECT_EQ(refusal([&] { control.step(0); }), ControlResult::malformed);
  EXPECT_EQ(refusal([&] { control.set_speed(std::nan("")); }), ControlResult::malformed);
  control.quit();
  run.finish();
}

// As on another machine, the original files are gone when they are read again.
TEST(ProgramsControlARun, TheyBuildItsExperimentWithoutItsFiles) {
  const FieldOfRobots field(3, 1e4);
  ControlledRun run(field, {"--paused"});
  Control control = control_of(run);
  const SimulationStatus status = control.status();
  std::filesystem::remove(field.file());
  std::filesystem::remove(field / "world.yaml");
  const auto rebuilt = [&] {
    const ExperimentFiles files = control.experiment_files();
    return parsing::read_experiment(std::make_shared<const description::KeptFiles>(messages::kept_files(files)),
                                    files.seed, files.duration);
  };
  const description::Experiment experiment = rebuilt();
  EXPECT_EQ(experiment.seed, status.seed);
  EXPECT_EQ(experiment.name, "experiment");
  ASSERT_EQ(experiment.world.robots.size(), 3u);
  EXPECT_EQ(experiment.world.robot(2).name, "swarm/sbot_2");
  EXPECT_EQ(Simulation(experiment, 1).state_hash(), status.state_hash);

  control.reset(7);
  EXPECT_EQ(Simulation(rebuilt(), 1).state_hash(), control.status().state_hash) << "of another seed";
  control.quit();
  run.finish();
}

TEST(ProgramsControlARun, TheyChangeItsWorldAndReadIt) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  Control control = control_of(run);
  EXPECT_EQ(control.entities("sbot_1$"), (std::vector<std::string>{"swarm/sbot_1"}));
  EXPECT_EQ(control.entities().size(), 3u) << "with the ground";
  Spawn crate{.name = "crate", .text = box, .pose = {{-2, 0, 1}, {0, 0, std::sin(0.75), std::cos(0.75)}}};
  EXPECT_EQ(control.spawn(crate), "crate");
  EXPECT_EQ(refusal([&] { control.spawn(crate); }), ControlResult::name_not_unique);
  crate.allow_renaming = true;
  crate.pose.position.y = 2;
  const std::string other = control.spawn(crate);
  EXPECT_NE(other, "crate");
  EXPECT_EQ(control.entity_state(other).pose.position, (Vector3{-2, 2, 1}));
  EXPECT_NEAR(control.entity_state("crate").pose.orientation.z, std::sin(0.75), 1e-12);
  control.remove(other);
  EXPECT_EQ(refusal([&] { control.entity_state(other); }), ControlResult::not_found);

  control.step(10);
  EXPECT_LT(control.entity_state("crate").twist.linear.z, -0.9) << "it falls";
  control.set_pose("crate", {{2, -2, 3}, {}});
  EXPECT_EQ(control.entity_state("crate").twist.linear, Vector3{});
  control.set_twist("crate", {{1, 0, -0.5}, {0, 0, 2}});
  EXPECT_NEAR(control.entity_state("crate").twist.angular.z, 2.0, 1e-12);
  control.set_entity_state({"crate", {{2, -2, 4}, {}}, {{0, 0, 1}, {}}});
  EXPECT_EQ(control.entity_state("crate").pose.position.z, 4.0);
  EXPECT_NEAR(control.entity_state("crate").twist.linear.z, 1.0, 1e-12);
  control.apply_force("crate", {.force = {0, 0, 30}, .duration = std::chrono::milliseconds(100)});
  control.step(10);
  EXPECT_GT(control.entity_state("crate").twist.linear.z, 2.5) << "0.1 s of 30 N against 9.81 N, from 1 m/s";

  control.spawn({.name = "lamp", .text = lamp, .pose = {{1, 1, 0.5}, {}}});
  const std::uint64_t lit = control.status().state_hash;
  control.set_light("lamp/bulb", {.on = false});
  const std::uint64_t dark = control.status().state_hash;
  EXPECT_NE(dark, lit);
  control.set_light("lamp", {.on = true, .intensity = 3.0, .color = Color{1, 0, 0}});
  EXPECT_NE(control.status().state_hash, dark);
  EXPECT_NE(control.status().state_hash, lit);

  EXPECT_EQ(refusal([&] { control.spawn({.name = "nothing"}); }), ControlResult::no_resource);
  EXPECT_EQ(refusal([&] {
              control.spawn({.name = "new", .text = box, .pose = {{}, {0, 0, 0, 0}}});
            }),
            ControlResult::invalid_pose);
  EXPECT_EQ(refusal([&] { control.spawn({.name = "new", .model = "sbit"}); }), ControlResult::unknown_model);
  EXPECT_EQ(refusal([&] { control.spawn({.name = "new", .text = "<sdf"}); }), ControlResult::invalid_model);
  EXPECT_EQ(refusal([&] { control.set_light("crate/bulb", {}); }), ControlResult::light_not_found);
  EXPECT_EQ(refusal([&] { control.set_pose("nobody", {}); }), ControlResult::not_found);
  EXPECT_EQ(refusal([&] { control.apply_force("crate", {.force = {NAN, 0, 0}}); }), ControlResult::malformed);
  EXPECT_EQ(refusal([&] { control.entities("("); }), ControlResult::malformed);

  EXPECT_EQ(control.spawn({.name = "swarm/late", .model = "sbot", .pose = {{0.4, 0.1, 0}, {}}, .team = "swarm"}),
            "swarm/late");
  EXPECT_EQ(control.status().robots, 3u);
  control.set_time_limit(std::chrono::milliseconds(300));
  EXPECT_EQ(refusal([&] { control.step(); }), ControlResult::no_answer) << "it has no controller";
  control.set_time_limit(patience);
  control.quit();
  run.finish();
}

TEST(ProgramsControlARun, TheySaveItLoadItAndRecordIt) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  Control control = control_of(run);
  const std::filesystem::path file = field / "run.mcap";
  EXPECT_EQ(control.start_recording("{poses: 100}").message, "recorded from tick 0 on");
  EXPECT_EQ(refusal([&] { control.start_recording(); }), ControlResult::already_recording);
  control.step(10);
  const std::vector<std::byte> snapshot = control.save_snapshot();
  EXPECT_EQ(control.last_reply().message, "saved at tick 10");
  control.step(10);
  const std::uint64_t hash = control.status().state_hash;
  control.stop_recording();
  EXPECT_EQ(control.save_recording(file), "");
  const Ended replayed = run_to_end({cohort_program(), "replay", "--verify", file.string()});
  EXPECT_NE(replayed.out.find("identical, 20 ticks"), std::string::npos) << replayed.out << replayed.err;
  EXPECT_THROW(control.save_recording("/nowhere/run.mcap"), std::runtime_error);

  EXPECT_EQ(control.load_snapshot(snapshot).tick, 10u);
  control.step(10);
  EXPECT_EQ(control.status().state_hash, hash);
  EXPECT_EQ(refusal([&] { control.load_snapshot(std::as_bytes(std::span("nonsense"))); }),
            ControlResult::invalid_snapshot);

  const RunHistory history = control.history();
  EXPECT_EQ(history.run, 2u);
  EXPECT_EQ(history.begin_tick, 10u);
  ASSERT_FALSE(history.events.empty());
  EXPECT_TRUE(control.history(history.revision).events.empty()) << "nothing has happened since";
  control.set_speed(3.0);
  const RunHistory later = control.history(history.revision);
  ASSERT_EQ(later.events.size(), 1u);
  EXPECT_EQ(later.events[0].kind, "control");
  control.quit();
  run.finish();
}

TEST(ProgramsControlARun, AWaitEndsByItsLimitByAFlagAndWithTheServer) {
  Control alone({.domain = find_empty_domain(), .time_limit = std::chrono::milliseconds(100)});
  EXPECT_EQ(refusal([&] { alone.pause(); }), ControlResult::no_answer) << "there is no server";
  EXPECT_FALSE(alone.wait_for_server(std::chrono::milliseconds(1)));
  EXPECT_EQ(refusal([] { Control({.server = "no host of this name"}); }), ControlResult::no_attachment);
  EXPECT_EQ(refusal([] { Control({.secure = "/nowhere"}); }), ControlResult::no_attachment);

  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"}, false);
  Control control = control_of(run);
  control.set_time_limit(std::nullopt);
  std::atomic<bool> stop = false;
  control.stop_on(&stop);
  std::thread other([&] { stop = true; });
  EXPECT_EQ(refusal([&] { control.step(); }), ControlResult::interrupted) << "no controller is there";
  other.join();
  control.stop_on(nullptr);
  EXPECT_EQ(control.state(), SimulationState::paused);
  run.server().signal(SIGKILL);
  EXPECT_EQ(refusal([&] { control.step(); }), ControlResult::server_gone);
  EXPECT_TRUE(control.server_is_gone());
}

}  // namespace
}  // namespace cohort::test
