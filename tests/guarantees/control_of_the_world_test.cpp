// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/controlled_run.hpp"

// Objects are added, removed, moved and pushed.
namespace cohort::test {
namespace {

using wire::ResultCode;

wire::EntityState state_of(ControlClient& client, const std::string& name) {
  const auto reply = client.ask(wire::GetEntityState{name}, patience, never);
  const auto* const state = reply ? reply->get<wire::EntityState>() : nullptr;
  EXPECT_NE(state, nullptr) << name;
  return state != nullptr ? *state : wire::EntityState{};
}

constexpr const char* box = R"(<sdf version="1.9"><model name="box"><link name="body">
  <inertial><mass>1</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial>
  <collision name="hull"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>
</link></model></sdf>)";

TEST(ControlAtTickBoundariesOnly, ActionsChangeTheWorldAndAreReproducible) {
  const FieldOfRobots field(2, 1e4);
  const std::string model = (field / "box.sdf").string();
  const std::string file = (field / "snapshot").string();
  write_file(model, box);
  const auto act = [&](const std::string& threads) {
    ControlledRun run(field, {"--paused", "--threads", threads});
    ControlClient client = client_of(run);
    run.done({"step", "10"});
    run.done({"spawn", model, "--name", "crate", "--pose", "-2 0 1 0 0 1.5"});
    EXPECT_EQ(run.done({"entities", "crate"}), "crate\n");
    EXPECT_EQ(state_of(client, "crate").pose.position.x, -2.0);
    EXPECT_NEAR(state_of(client, "crate").pose.orientation.z, std::sin(0.75), 1e-12);
    run.done({"step", "10"});
    EXPECT_LT(state_of(client, "crate").twist.linear.z, -0.9) << "it falls";
    run.done({"set-pose", "crate", "--pose", "2 -2 3"});
    run.done({"set-velocity", "crate", "--linear", "1 0 -0.5", "--angular", "0 0 2"});
    const wire::EntityState thrown = state_of(client, "crate");
    EXPECT_EQ(thrown.pose.position, (wire::Vector3{2, -2, 3}));
    EXPECT_NEAR(thrown.twist.linear.x, 1.0, 1e-12);
    EXPECT_NEAR(thrown.twist.angular.z, 2.0, 1e-12);
    run.done({"apply-force", "crate", "--force", "0 0 30", "--duration", "0.1"});
    run.done({"step", "5"});
    run.done({"save", file});
    run.done({"step", "15"});
    EXPECT_GT(state_of(client, "crate").twist.linear.z, 0.3) << "0.1 s of 30 N against 9.81 N and 0.5 m/s";
    const std::string hash = run.status()["state_hash"];
    run.done({"load", file});
    run.done({"step", "15"});
    EXPECT_EQ(run.status()["state_hash"], hash) << "with what was spawned, and the push that was under way";
    run.done({"remove", "crate"});
    EXPECT_EQ(run.done({"entities", "crate"}), "");
    run.done({"step", "5"});
    run.done({"shutdown"});
    return run.finish();
  };
  const auto first = act("1");
  EXPECT_EQ(act("4")["state_hash"], first["state_hash"]);
  EXPECT_EQ(first["ticks"], 45);
  EXPECT_GE(events_of(first, "control").size(), 4u) << first["events"].dump(1);
}

// For any number of threads, and for a controller that joins before its robot is due or long after.
TEST(ControlAtTickBoundariesOnly, TheRunWaitsForTheControllerOfANewRobot) {
  const FieldOfRobots field(2, 1e4);
  const auto act = [&](const std::string& threads, bool comes_late) {
    const std::string recording = field / (threads + ".mcap");
    const std::string saved = field / "saved";
    const std::string without = field / "without";
    ControlledRun run(field, {"--paused", "--threads", threads, "--record", recording});
    run.done({"step", "10"});
    EXPECT_NE(run.done({"spawn", "sbot", "--name", "swarm/late", "--pose", "0.4 0.1 0"}).find("in team 'swarm'"),
              std::string::npos);
    EXPECT_EQ(run.status()["robots"], 3);
    if (!comes_late) run.attach("swarm/late");
    Process steps(run.ctl({"--timeout", patience_in_seconds, "step", "20"}));
    if (comes_late) {
      EXPECT_TRUE(run.comes_to([](const auto& status) { return status["awaited"] == nlohmann::json{"swarm/late"}; }));
      EXPECT_EQ(run.tick(), 10u);
      run.attach("2");
    }
    EXPECT_EQ(steps.wait_for_exit(), 0) << steps.output();
    run.done({"save", saved});
    run.done({"step", "20"});
    const nlohmann::json after = run.status();
    EXPECT_EQ(after["controllers"].size(), 2u);
    run.done({"remove", "swarm/late"});
    run.done({"save", without});
    run.done({"step", "5"});
    const std::string hash = run.status()["state_hash"];
    run.done({"load", saved});
    run.done({"step", "20"});
    EXPECT_EQ(run.status()["state_hash"], after["state_hash"]) << "a snapshot brings the robot along";
    run.done({"load", without});
    run.done({"step", "5"});
    EXPECT_EQ(run.status()["state_hash"], hash) << "the run does not wait for a removed robot";
    run.done({"shutdown"});
    run.finish();
    const Ended replayed = run_to_end({cohort_program(), "replay", "--verify", recording});
    EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
    EXPECT_NE(replayed.out.find("identical"), std::string::npos) << replayed.out;
    return hash;
  };
  EXPECT_EQ(act("1", false), act("3", true));
}

constexpr const char* lamp = R"(<sdf version="1.9"><model name="lamp"><static>true</static><link name="post">
  <collision name="hull"><geometry><box><size>0.1 0.1 1</size></box></geometry></collision>
  <light name="bulb" type="point"><pose>0 0 0.6 0 0 0</pose><diffuse>1 1 1 1</diffuse><attenuation><range>5</range></attenuation></light>
</link></model></sdf>)";

TEST(ControlAtTickBoundariesOnly, LightsAreSetByObjectOrByName) {
  const FieldOfRobots field(2, 1e4);
  const std::string model = (field / "lamp.sdf").string();
  write_file(model, lamp);
  ControlledRun run(field, {"--paused"});
  run.done({"spawn", model, "--name", "lamp", "--pose", "1 1 0.5"});
  const auto hash = [&] { return run.status()["state_hash"].get<std::string>(); };
  const std::string lit = hash();
  run.done({"set-light", "lamp/bulb", "off"});
  const std::string dark = hash();
  EXPECT_NE(dark, lit);
  run.done({"set-light", "lamp", "on"});
  EXPECT_EQ(hash(), lit);
  run.done({"set-light", "lamp/bulb", "on", "--intensity", "3", "--color", "1 0 0"});
  EXPECT_NE(hash(), lit);
  EXPECT_NE(hash(), dark);
  const Ended refused = run_to_end(run.ctl({"set-light", "lamp/bulbb", "on"}));
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("did you mean 'bulb'?"), std::string::npos) << refused.err;
  run.done({"shutdown"});
  run.finish();
}

TEST(ControlAtTickBoundariesOnly, InvalidActionsAreRejectedWithTheReasonAndChangeNothing) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  ControlClient client = client_of(run);
  const std::string hash = run.status()["state_hash"];
  wire::SpawnEntity spawn{.entity = "crate"};
  const auto result_of = [&](const wire::Operation& operation) {
    const auto reply = client.ask(operation, patience, never);
    EXPECT_TRUE(reply && !reply->error_message.empty());
    return reply ? reply->result : ResultCode::ok;
  };
  EXPECT_EQ(result_of(spawn), ResultCode::no_resource);
  spawn.resource_string = "<sdf version='1.9'><model name='box'><link";
  EXPECT_EQ(result_of(spawn), ResultCode::resource_parse_error);
  spawn.resource_string = box;
  spawn.pose.orientation = {0, 0, 0, 0};
  EXPECT_EQ(result_of(spawn), ResultCode::invalid_spawn_pose);
  spawn.pose.orientation = {0, 0, 0, 1};
  spawn.entity = "swarm/sbot_0";
  EXPECT_EQ(result_of(spawn), ResultCode::name_not_unique);
  for (const char* no_name : {"/crate", "crates//crate", "crate/"}) {
    spawn.entity = no_name;
    EXPECT_EQ(result_of(spawn), ResultCode::name_invalid) << no_name;
  }
  spawn.entity = "swarm/sbot_0";
  const std::string nobody = "swarm/nobody";
  EXPECT_EQ(result_of(wire::DeleteEntity{nobody}), ResultCode::not_found);
  EXPECT_EQ(result_of(wire::ApplyForce{.entity = nobody, .force = {1, 0, 0}}), ResultCode::not_found);
  EXPECT_EQ(result_of(wire::SetEntityState{.entity = nobody, .pose = wire::Pose{}}), ResultCode::not_found);
  EXPECT_EQ(result_of(wire::SetEntityState{.entity = "ground", .twist = wire::Twist{{1, 0, 0}, {}}}),
            ResultCode::immovable);
  EXPECT_EQ(result_of(wire::SetLight{.entity = "ground"}), ResultCode::light_not_found);
  EXPECT_EQ(run.status()["state_hash"], hash);

  // Gives it another name if that is allowed, and the reply contains it.
  spawn.allow_renaming = true;
  spawn.pose.position = {2, 2, 1};
  const auto renamed = client.ask(spawn, patience, never);
  ASSERT_TRUE(renamed);
  EXPECT_EQ(renamed->result, ResultCode::ok) << renamed->error_message;
  const auto* const name = renamed->get<wire::EntityName>();
  ASSERT_NE(name, nullptr);
  EXPECT_NE(name->entity, "swarm/sbot_0");
  EXPECT_EQ(state_of(client, name->entity).pose.position.x, 2.0);
  EXPECT_NE(run.status()["state_hash"], hash);
  run.done({"shutdown"});
  run.finish();
}

}  // namespace
}  // namespace cohort::test
