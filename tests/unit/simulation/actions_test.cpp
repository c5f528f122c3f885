// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <tuple>

#include "server/core/infinity.hpp"
#include "server/simulation/simulation.hpp"
#include "tests/support/worlds/model_text.hpp"
#include "tests/support/worlds/small_world.hpp"

/// Actions on a running simulation from outside.
namespace cohort {
namespace {

using namespace std::chrono_literals;
using namespace test;

const std::string crate_sdf = R"(<sdf version="1.9" xmlns:cohort="https://cohort-sim.org/sdf/1"><model name="crate">
<link name="body">
<inertial><mass>1</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial>
<collision name="hull"><geometry><box><size>0.2 0.2 0.2</size></box></geometry>
<cohort:material>felt</cohort:material></collision>
</link></model></sdf>)";
const std::string crate_yaml = R"(model:
  name: yaml_crate
  link:
    name: body
    inertial: {mass: 1, inertia: {ixx: 0.01, iyy: 0.01, izz: 0.01}}
    collision: {name: hull, geometry: {box: {size: 0.2 0.2 0.2}}}
)";
const std::string crate_urdf = R"(<robot name="urdf_crate"><link name="body">
<inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link></robot>)";

// With everything that a sensor can remember.
description::Model remembering_robot() {
  description::Model model = tracked_robot();
  description::Noise noise;
  noise.deviation = 0.01;
  noise.drift_deviation = 0.1;
  noise.drift_time = 1.0;
  auto& ring = std::get<description::ProximityRing>(model.devices.back());
  ring.readout.noises = {noise};
  description::ProximityRing late = ring;
  late.name = "late";
  late.readout.latency = 30ms;
  description::ProximityRing slow = ring;
  slow.name = "slow";
  slow.readout.period = 20ms;
  slow.readout.drop_out = 0.3;
  model.devices.push_back(late);
  model.devices.push_back(slow);
  model.devices.push_back(description::RangeAndBearing{"rab", 1, {{0, 0, 0.03}}, 2.0, 2, 4, {}});
  model.devices.push_back(description::Battery{"battery", 100.0});
  return model;
}

description::Model lamp_on_a_post() {
  description::Model model = static_shape("post", description::Box{{0.1, 0.1, 0.4}});
  model.emitters.push_back({"top", 0, {{0, 0, 0.3}}, true, description::Light{}});
  model.emitters.push_back({"foot", 0, {{0, 0, 0.1}}, true, description::Light{}});
  model.emitters.push_back({"hum", 0, {}, true, description::Sound{440.0}});
  return model;
}

class Actions : public ::testing::TestWithParam<description::Fidelity> {
 protected:
  Actions() {
    description::World& world = experiment_.world;
    world = world_with_floor();
    world.physics.fidelity = GetParam();
    place(world, remembering_robot(), "team/a", at(0, 0, 0));
    place(world, remembering_robot(), "team/b", at(0, 0.3, 0));
    box_ = place(
        world,
        loose("box", description::Box{Eigen::Vector3d::Constant(0.2)}, solid_box(2.0, Eigen::Vector3d::Constant(0.2))),
        "things/box", at(-1, 0, 0.1));
    post_ = place(world, lamp_on_a_post(), "post", at(2, 2, 0.2));
    late_ = place(world, static_shape("wall", description::Box{{0.1, 1.0, 0.4}}), "late", at(3, 0, 0.2));
    world.instances[late_].is_present = false;
    experiment_.seed = 5;
    experiment_.read_model = model_of_text;
    experiment_.duration = 10s;
    description::Team team{"team", {0, 1}, "none", {}};
    team.policy.period = 2;
    experiment_.teams.push_back(team);
  }
  static void run(Simulation& simulation, std::uint64_t until) {
    while (simulation.tick() < until) {
      for (std::uint32_t robot = 0; robot < simulation.robot_count(); ++robot) {
        std::vector<double> command(simulation.kinds()[simulation.kind_of(robot)].command_size, 0.0);
        command[0] = command[1] = 0.05;
        command[3] = 1.0;  // it is sending
        command[4] = static_cast<double>(simulation.tick());
        simulation.set_command(robot, command);
      }
      simulation.step();
    }
  }
  static std::string why_not(Simulation& simulation, const Action& action) {
    try {
      simulation.act(action);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "it was done";
  }
  static std::uint32_t object(const Simulation& simulation, const std::string& name) {
    return *simulation.objects().find(name);
  }

  description::Experiment experiment_;
  std::uint32_t box_ = 0, post_ = 0, late_ = 0;
};

INSTANTIATE_TEST_SUITE_P(Fidelities, Actions,
                         ::testing::Values(description::Fidelity::treel, description::Fidelity::planar),
                         [](const auto& tested) {
                           return tested.param == description::Fidelity::planar ? "planar" : "treel";
                         });

// The hash is cached until a change, so each change must invalidate it.
TEST_P(Actions, ChangeACachedStateHash) {
  const std::vector<std::function<void(Simulation&)>> changes = {
      [](Simulation& simulation) {
        std::vector<double> command(simulation.kinds()[0].command_size, 0.0);
        command[0] = 0.07;
        simulation.set_command(0, command);
      },
      [](Simulation& simulation) { simulation.set_neutral_command(0); },
      [](Simulation& simulation) { simulation.step(); },
      [](Simulation& simulation) {
        simulation.act(SetPose{"things/box", at(0.2, 0, 0.1)});
      },
      [](Simulation& simulation) {
        simulation.act(SetLight{"post/top", false});
      },
      [](Simulation& simulation) { simulation.act(RemoveObject{"things/box"}); },
      [](Simulation& simulation) {
        simulation.act(SetLight{"post/foot", false});
      },
      [](Simulation& simulation) {
        simulation.act(SpawnObject{"more", model_of_text(crate_sdf), at(4, 4, 0.2)});
      },
      [](Simulation& simulation) {
        simulation.act(SpawnObject{"second_box", "box", at(5, 5, 0.1)});
      },
      [](Simulation& simulation) {
        simulation.act(SpawnObject{"team/late", "tracked_robot", at(1, 0.3, 0)});
      },
  };
  Simulation asked(experiment_, 1);
  run(asked, 10);
  std::uint64_t before = asked.state_hash();
  for (std::size_t i = 0; i < changes.size(); ++i) {
    changes[i](asked);
    EXPECT_NE(asked.state_hash(), before) << "change " << i;
    before = asked.state_hash();
    Simulation twin(experiment_, 1);
    run(twin, 10);
    for (std::size_t j = 0; j <= i; ++j) changes[j](twin);
    EXPECT_EQ(before, twin.state_hash()) << "change " << i;
  }
  Simulation restored(experiment_, 1);
  EXPECT_NE(restored.state_hash(), before);
  restored.restore(asked.save());
  EXPECT_EQ(restored.state_hash(), before);
}

TEST_P(Actions, HaveTheEffectOfAnEventAndAreSensedAtTheSameBoundary) {
  const std::vector<std::pair<Action, description::Event>> both = {
      {SetPose{"things/box", at(0.2, 0, 0.1)}, {500ms, box_, description::PlaceAt{at(0.2, 0, 0.1)}, "e"}},
      {SetVelocity{"things/box", {1, 0, 0}, {0, 0, 1}},
       {500ms, box_, description::SetVelocity{{1, 0, 0}, {0, 0, 1}}, "e"}},
      {SetLight{"post/top", false}, {500ms, post_, description::SetEmitters{{0}, {false, {}, {}, {}, {}, {}}}, "e"}}};
  for (const auto& [action, event] : both) {
    description::Experiment with_event = experiment_;
    with_event.events.push_back(event);
    Simulation expected(with_event, 1);
    Simulation simulation(experiment_, 1);
    run(expected, 50);
    run(simulation, 50);
    EXPECT_NE(simulation.state_hash(), expected.state_hash());
    simulation.act(action);
    EXPECT_EQ(simulation.state_hash(), expected.state_hash()) << action.index();
    run(expected, 120);
    run(simulation, 120);
    EXPECT_EQ(simulation.state_hash(), expected.state_hash()) << action.index();
  }
}

TEST_P(Actions, AreSensedAsIfRobotsHadSensedOnce) {
  Simulation undisturbed(experiment_, 1);
  Simulation simulation(experiment_, 1);
  for (std::uint64_t tick = 0; tick < 60; ++tick) {
    run(undisturbed, tick);
    run(simulation, tick);
    EXPECT_EQ(simulation.act(SetLight{"post/top", true}), "set_light 'post'");  // as it is
    if (tick % 3 == 0) simulation.act(SetLight{"post/top", true});
    ASSERT_EQ(simulation.state_hash(), undisturbed.state_hash()) << tick;
  }
}

TEST_P(Actions, ObjectsAreSpawnedByTheNameOfAModel) {
  Simulation simulation(experiment_, 1);
  run(simulation, 10);
  EXPECT_EQ(simulation.act(SpawnObject{"more/box", "box", at(0.2, 0, 0.1)}), "spawn 'more/box' of model 'box'");
  const auto sensed = simulation.observation(0);
  EXPECT_TRUE(std::any_of(sensed.end() - 15, sensed.end(), [](double value) { return value > 0.2; }) ||
              std::any_of(sensed.begin(), sensed.end(), [](double value) { return value > 0.2; }));
  EXPECT_EQ(why_not(simulation, SpawnObject{"more/box", "box", at(1, 1, 0.1)}),
            "another object has the name 'more/box'");
  simulation.act(SpawnObject{"more/box", "box", at(1, 1, 0.1), true});
  simulation.act(SpawnObject{"", "box", at(1, -1, 0.1)});
  EXPECT_NEAR(simulation.object_pose(object(simulation, "more/box_1")).position.x(), 1.0, 1e-9);
  EXPECT_NEAR(simulation.object_pose(object(simulation, "box")).position.y(), -1.0, 1e-9);
  run(simulation, 40);
  EXPECT_NEAR(simulation.object_pose(object(simulation, "box")).position.z(), 0.1, 0.01);
}

TEST_P(Actions, ObjectsAreSpawnedFromTheTextOfAModelInAnyFormat) {
  Simulation simulation(experiment_, 1);
  const std::size_t models = simulation.description().models.size();
  simulation.act(SpawnObject{"a", model_of_text(crate_sdf), at(-2, 0, 0.1)});
  simulation.act(SpawnObject{"b", model_of_text(crate_yaml), at(-2, 1, 0.1)});
  simulation.act(SpawnObject{"c", model_of_text(crate_urdf), at(-2, 2, 0.1)});
  simulation.act(SpawnObject{"d", model_of_text(crate_sdf), at(-2, 3, 0.1)});
  simulation.act(SpawnObject{"e", "crate", at(-2, 4, 0.1)});
  EXPECT_EQ(simulation.description().models.size(), models + 3);
  simulation.act(SetVelocity{"d", {1, 0, 0}, Eigen::Vector3d::Zero()});
  run(simulation, 30);
  for (const char* const name : {"a", "b", "c", "e"})
    EXPECT_NEAR(simulation.object_pose(object(simulation, name)).position.x(), -2.0, 0.01) << name;
  EXPECT_GT(simulation.object_pose(object(simulation, "d")).position.x(), -1.98);
}

TEST_P(Actions, NothingIsAddedWhileWorldsShareTheirExperiment) {
  constexpr const char* refusal = "objects cannot be added to a world that shares its experiment with other worlds";
  Simulation grown(experiment_, 1);
  grown.act(SpawnObject{"more", "box", at(4, 4, 0.2)});
  Simulation first(experiment_, 1);
  std::vector<Pose> X_WM;
  for (const description::Instance& instance : experiment_.world.instances) X_WM.push_back(instance.X_WM);
  {
    Simulation second(first, experiment_.seed, X_WM);
    for (Simulation* simulation : {&first, &second}) {
      const std::uint64_t before = simulation->state_hash();
      EXPECT_EQ(why_not(*simulation, SpawnObject{"more", "box", at(4, 4, 0.2)}), refusal);
      EXPECT_EQ(why_not(*simulation, SpawnObject{"more", model_of_text(crate_sdf), at(4, 4, 0.2)}), refusal);
      EXPECT_EQ(simulation->state_hash(), before);
      EXPECT_EQ(simulation->objects().size(), experiment_.world.instances.size());
    }
    EXPECT_THROW(second.restore(grown.save()), SnapshotError);
  }
  first.act(SpawnObject{"more", "box", at(4, 4, 0.2)});
  EXPECT_EQ(first.state_hash(), grown.state_hash());
}

TEST_P(Actions, AnInvalidModelTextIsRejectedWithLineAndReason) {
  const auto reason = [&](const std::string& text) -> std::string {
    try {
      model_of_text(text);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "it is one";
  };
  const std::string ours = "<sdf version='1.9' xmlns:cohort='https://cohort-sim.org/sdf/1'>";
  EXPECT_NE(reason(ours + "\n<model name='m'>\n<lnk name='l'/></model></sdf>").find("line 3: "), std::string::npos);
  EXPECT_NE(reason("<sdf version='1.9'><world name='w'/></sdf>").find("expected one <model>"), std::string::npos);
  EXPECT_NE(reason("<a").find("the text of the model"), std::string::npos);
  EXPECT_NE(reason("a: [").find("the text of the model"), std::string::npos);
  EXPECT_NE(reason("\xff<").find("the text of the model"), std::string::npos);
  EXPECT_NE(reason("<sdf version='1.9'><model name='m'><include><uri>/etc/hostname</uri></include></model></sdf>")
                .find("there is no '/etc/hostname'"),
            std::string::npos);
  Simulation simulation(experiment_, 1);
  EXPECT_EQ(why_not(simulation, SpawnObject{"x", "bax", at(0, 0, 1)}).substr(0, 46),
            "the world has no model 'bax'; did you mean 'bo");
}

TEST_P(Actions, SpawnedRobotsGetTheNextIdAndTheirTeamsPolicyAndSenseAtOnce) {
  Simulation simulation(experiment_, 1);
  run(simulation, 10);
  EXPECT_EQ(simulation.act(SpawnObject{"team/late", "tracked_robot", at(1, 0.3, 0)}),
            "spawn 'team/late' of model 'tracked_robot' in team 'team'");
  ASSERT_EQ(simulation.robot_count(), 3u);
  EXPECT_EQ(simulation.robot_name(2), "team/late");
  EXPECT_EQ(simulation.policy(2).period, 2u);
  EXPECT_EQ(simulation.kind_of(2), simulation.kind_of(0));
  EXPECT_EQ(simulation.kinds().size(), 2u) << "as before";
  EXPECT_EQ(simulation.experiment().teams[0].robots, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_TRUE(simulation.is_due(2, 10));
  EXPECT_EQ(simulation.observation(2).size(), simulation.observation(0).size());
  const auto senses = [](double value) { return value != 0.0; };
  EXPECT_TRUE(std::ranges::any_of(simulation.observation(2), senses)) << "it is due at this tick";
  run(simulation, 60);
  EXPECT_GT(simulation.robot_pose(2).position.x(), 1.01) << "it drives";

  // Gone is gone: the next has another id, and another name.
  simulation.act(RemoveObject{"team/late"});
  EXPECT_FALSE(simulation.is_present(2));
  simulation.act(SpawnObject{"team/later", "tracked_robot", at(1, 0.3, 0)});
  EXPECT_EQ(simulation.robot_name(3), "team/later");
}

TEST_P(Actions, SpawnedRobotsAreTheSameForAnyThreadCountAndAfterRestore) {
  const auto with_newcomers = [&](unsigned threads) {
    auto simulation = std::make_unique<Simulation>(experiment_, threads);
    run(*simulation, 11);
    simulation->act(SpawnObject{"crate", model_of_text(crate_sdf), at(4, 4, 0.2)});
    simulation->act(SpawnObject{"team/late", "tracked_robot", at(0.2, 0.15, 0)});
    run(*simulation, 20);
    simulation->act(SpawnObject{"team/later", "tracked_robot", at(1, 0.3, 0)});
    simulation->act(RemoveObject{"team/late"});
    run(*simulation, 30);
    return simulation;
  };
  const auto alone = with_newcomers(1);
  const auto together = with_newcomers(4);
  EXPECT_EQ(alone->state_hash(), together->state_hash());
  Simulation restored(experiment_, 2);
  restored.restore(alone->save());
  EXPECT_EQ(restored.state_hash(), alone->state_hash());
  EXPECT_TRUE(restored.save() == alone->save());
  ASSERT_EQ(restored.robot_count(), 4u);
  EXPECT_FALSE(restored.is_present(2));
  run(*alone, 80);
  run(restored, 80);
  EXPECT_EQ(restored.state_hash(), alone->state_hash());
}

TEST_P(Actions, ARobotJoinsTheRequestedTeam) {
  description::Team others{"others", {}, "none", {}};
  others.policy.period = 3;
  experiment_.teams.push_back(others);
  Simulation simulation(experiment_, 1);
  const auto spawn = [](const std::string& name, const std::string& model, const std::string& team) {
    return SpawnObject{name, model, at(1, 1, 0.1), false, team};
  };
  EXPECT_EQ(simulation.act(spawn("a", "tracked_robot", "others")),
            "spawn 'a' of model 'tracked_robot' in team 'others'");
  EXPECT_EQ(simulation.policy(2).period, 3u);
  EXPECT_EQ(why_not(simulation, spawn("b", "tracked_robot", "other")),
            "there is no team 'other'; did you mean 'others'?");
  EXPECT_EQ(why_not(simulation, spawn("b", "tracked_robot", "")),
            "'tracked_robot' is a robot: expected one of the teams team, others");
  EXPECT_EQ(why_not(simulation, spawn("b", "box", "others")),
            "the model 'box' is not a robot, so it cannot join a team");
  EXPECT_EQ(simulation.robot_count(), 3u);
  const auto again =
      std::get<SpawnObject>(action_from_bytes(to_bytes(spawn("a", "tracked_robot", "others")), model_of_text));
  EXPECT_EQ(again.team, "others");
}

TEST_P(Actions, RemovedObjectsAreGoneForGood) {
  experiment_.events.push_back({100ms, box_, description::SetPresence{true}, "enable"});
  Simulation simulation(experiment_, 1);
  run(simulation, 5);
  EXPECT_EQ(simulation.act(RemoveObject{"things/box"}), "remove 'things/box'");
  EXPECT_FALSE(simulation.objects().is_present(box_));
  EXPECT_EQ(why_not(simulation, RemoveObject{"things/box"}), "'things/box' is not in the world");
  EXPECT_NE(why_not(simulation, SpawnObject{"things/box", "box", at(0, 1, 1)}).find("names are not reused"),
            std::string::npos);
  run(simulation, 10);
  EXPECT_EQ(simulation.happened(), std::vector<std::string>{"enable 'things/box' does nothing: it has been removed"});
  EXPECT_FALSE(simulation.objects().is_present(box_));
  simulation.act(RemoveObject{"team/a"});
  EXPECT_FALSE(simulation.is_present(0));
  run(simulation, 20);
}

TEST_P(Actions, AForceActsForItsDuration) {
  Simulation simulation(experiment_, 1);
  run(simulation, 30);
  const double before = simulation.object_pose(box_).position.x();
  EXPECT_EQ(simulation.act(ApplyForce{"things/box", "link", {-200, 0, 0}, Eigen::Vector3d::Zero(), 30ms}),
            "apply_force 'things/box'");
  run(simulation, 33);
  const double speed = simulation.world().link_twist(BodyId{box_}, LinkId{0}).linear_W.x();
  EXPECT_LT(speed, -1.5);
  EXPECT_LT(simulation.object_pose(box_).position.x(), before);
  run(simulation, 34);
  EXPECT_GT(simulation.world().link_twist(BodyId{box_}, LinkId{0}).linear_W.x(), speed);  // friction alone from here on
}

TEST_P(Actions, LightsAreSetByTheirNameOrThatOfTheirObject) {
  Simulation simulation(experiment_, 1);
  const auto lit = [&] { return simulation.emitters().lit_lamps().size(); };
  EXPECT_EQ(lit(), 2u);
  simulation.act(SetLight{"post/foot", false});
  EXPECT_EQ(lit(), 1u);
  simulation.act(SetLight{"post", false});
  EXPECT_EQ(lit(), 0u);
  simulation.act(SetLight{"post/top", true, 3.0, Eigen::Vector3d(1, 0, 0)});
  ASSERT_EQ(lit(), 1u);
  EXPECT_EQ(simulation.emitters().lamp(simulation.emitters().lit_lamps()[0]).light.intensity, 3.0);
  EXPECT_EQ(why_not(simulation, SetLight{"post/tap", true}), "'post' has no light 'tap'; did you mean 'top'?");
  EXPECT_NE(why_not(simulation, SetLight{"post/hum", true}).find("'post' has no light 'hum'"), std::string::npos);
  EXPECT_NE(why_not(simulation, SetLight{"things/box", true}).find("'things/box' has no light"), std::string::npos);
}

TEST_P(Actions, ReportWhyTheyFailAndChangeNothing) {
  Simulation simulation(experiment_, 1);
  run(simulation, 22);
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  Pose skewed = at(0, 0, 1);
  skewed.orientation.coeffs() *= 2.0;
  const std::vector<std::tuple<Action, std::string, ActionFault>> refused = {
      {RemoveObject{"thing/box"}, "there is no object 'thing/box'; did you mean 'things/box'?",
       ActionFault::object_not_found},
      {RemoveObject{"late"}, "'late' is not in the world", ActionFault::object_not_found},
      {RemoveObject{"a\nb"}, "the name of the object contains a control character", ActionFault::object_not_found},
      {RemoveObject{"\xc3("}, "the name of the object is not valid UTF-8", ActionFault::object_not_found},
      {RemoveObject{std::string(300, 'x')}, "the name of the object is longer than 255 bytes",
       ActionFault::object_not_found},
      {SetPose{"things/box", at(infinity, 0, 0)}, "the pose is not finite", ActionFault::invalid_pose},
      {SetPose{"things/box", at(0, 2e6, 0)}, "expected a position within 1,000 km of the origin",
       ActionFault::invalid_pose},
      {SetPose{"things/box", skewed}, "expected a unit quaternion as the orientation of the pose",
       ActionFault::invalid_pose},
      {SetVelocity{"post", zero, zero}, "'post' is static", ActionFault::immovable},
      {SetVelocity{"things/box", {std::nan(""), 0, 0}, zero}, "the velocity is not finite", ActionFault::invalid_value},
      {ApplyForce{"post", "", zero, zero, 1s}, "'post' is static", ActionFault::immovable},
      {ApplyForce{"things/box", "lynk", zero, zero, 1s}, "'things/box' has no link 'lynk'; did you mean 'link'?",
       ActionFault::link_not_found},
      {ApplyForce{"things/box", "", {0, infinity, 0}, zero, 1s}, "the force is not finite", ActionFault::invalid_value},
      {ApplyForce{"things/box", "", zero, zero, -1ns}, "expected a duration from 0 s to one year",
       ActionFault::invalid_value},
      {SetLight{"post", true, -1.0}, "expected an intensity of at least 0", ActionFault::invalid_value},
      {SetLight{"post", true, {}, Eigen::Vector3d(2, 0, 0)}, "expected red, green and blue from 0 to 1",
       ActionFault::invalid_value},
      {SpawnObject{"/x", "box", at(0, 0, 1)}, "'/x' is not a valid name: expected parts separated by slashes",
       ActionFault::name_invalid},
      {SpawnObject{"", "", at(0, 0, 1)}, "expected the name of one of the world's models, or a model",
       ActionFault::unknown_model},
      {SpawnObject{"post", model_of_text(crate_sdf), at(0, 0, 1)}, "another object has the name 'post'",
       ActionFault::name_not_unique},
  };
  const std::uint64_t hash = simulation.state_hash();
  const std::vector<std::byte> saved = simulation.save();
  for (const auto& [action, reason, fault] : refused) {
    EXPECT_EQ(why_not(simulation, action), reason);
    EXPECT_EQ(simulation.act(std::span(&action, 1)).front().fault, fault) << reason;
    EXPECT_EQ(simulation.state_hash(), hash) << reason;
    EXPECT_TRUE(simulation.save() == saved) << reason;
  }
}

TEST_P(Actions, AreRejectedForQuarantinedObjectsExceptRemoval) {
  experiment_.world.physics.lowest = -0.5;
  Simulation simulation(experiment_, 1);
  simulation.act(SetPose{"things/box", at(50, 0, 0.1)});
  simulation.act(SetVelocity{"things/box", {1e200, 0, 0}, Eigen::Vector3d::Zero()});
  run(simulation, 2);
  ASSERT_TRUE(simulation.objects().is_quarantined(box_));
  EXPECT_EQ(why_not(simulation, SetPose{"things/box", at(0, 0, 1)}), "'things/box' is quarantined");
  simulation.act(RemoveObject{"things/box"});
  EXPECT_FALSE(simulation.objects().is_present(box_));
}

TEST_P(Actions, AreTheSameForAnyThreadCountAndAfterRestore) {
  const auto act = [](Simulation& simulation) {
    const std::vector<Action> actions = {
        SpawnObject{"crate", model_of_text(crate_sdf), at(-0.4, 0, 0.1)},
        SpawnObject{
            "ramp",
            model_of_text("<sdf version='1.9'><model name='m'><static>1</static><link name='l'><collision name='c'>"
                          "<geometry><box><size>1 1 0.1</size></box></geometry></collision></link></model></sdf>"),
            at(0.5, 3, 0.05)},
        SpawnObject{"lamp", "post", at(-2, -2, 0.2)},
        SetLight{"lamp/top", true, 2.0},
        RemoveObject{"post"},
        ApplyForce{"crate", "", {0, 20, 0}, {0, 0, 1}, 500ms},
        SetPose{"team/b", at(0.5, 0.5, 0, 1)},
        RemoveObject{"nobody"}};
    const std::vector<ActionResult> results = simulation.act(actions);
    for (std::size_t i = 0; i + 1 < results.size(); ++i) EXPECT_TRUE(results[i].is_done) << results[i].text;
    EXPECT_FALSE(results.back().is_done);
  };
  Simulation one(experiment_, 1), four(experiment_, 4), again(experiment_, 2);
  run(one, 30);
  run(four, 30);
  const std::uint64_t before = one.state_hash();
  act(one);
  act(four);
  EXPECT_NE(one.state_hash(), before);
  EXPECT_EQ(one.state_hash(), four.state_hash());
  run(one, 41);
  run(four, 41);
  const std::vector<std::byte> snapshot = one.save();
  again.restore(snapshot);
  EXPECT_EQ(again.state_hash(), one.state_hash());
  EXPECT_TRUE(again.save() == snapshot);
  for (Simulation* const simulation : {&one, &four, &again}) simulation->act(SetPose{"crate", at(-0.5, 0, 0.1)});
  EXPECT_EQ(again.state_hash(), one.state_hash());
  for (Simulation* const simulation : {&one, &four, &again}) run(*simulation, 150);
  EXPECT_EQ(four.state_hash(), one.state_hash());
  EXPECT_EQ(again.state_hash(), one.state_hash());
  EXPECT_TRUE(again.save() == one.save());
}

TEST_P(Actions, PendingForcesAndRemovalsArePartOfTheHash) {
  Simulation pushed(experiment_, 1), pushed_longer(experiment_, 1);
  pushed.act(ApplyForce{"things/box", "", {1, 0, 0}, Eigen::Vector3d::Zero(), 100ms});
  pushed_longer.act(ApplyForce{"things/box", "", {1, 0, 0}, Eigen::Vector3d::Zero(), 110ms});
  EXPECT_NE(pushed.state_hash(), pushed_longer.state_hash());
  description::Experiment disabling = experiment_;
  disabling.events.push_back({0s, box_, description::SetPresence{false}, "disable"});
  Simulation disabled(disabling, 1), removed(experiment_, 1);
  removed.act(RemoveObject{"things/box"});
  EXPECT_NE(disabled.state_hash(), removed.state_hash());
}

TEST(PlanarActions, ChangeNothingWithoutGround) {
  description::Experiment experiment;
  experiment.world.physics.fidelity = description::Fidelity::planar;
  place(experiment.world, static_shape("floor", description::Box{{2, 2, 0.1}}), "floor", at(0, 0, -0.05));
  place(experiment.world,
        loose("box", description::Box{Eigen::Vector3d::Constant(0.2)}, solid_box(2.0, Eigen::Vector3d::Constant(0.2))),
        "box", at(0, 0, 0.1));
  Simulation simulation(experiment, 1);
  const std::uint64_t hash = simulation.state_hash();
  const std::vector<std::byte> saved = simulation.save();
  EXPECT_THROW(simulation.act(SetPose{"box", at(5, 0, 0.1)}), std::invalid_argument);
  EXPECT_THROW(simulation.act(SpawnObject{"other", "box", at(5, 0, 0.1)}), std::invalid_argument);
  EXPECT_THROW(simulation.act(SpawnObject{"other", model_of_text(crate_sdf), at(5, 0, 0.1)}), std::invalid_argument);
  EXPECT_EQ(simulation.state_hash(), hash);
  EXPECT_TRUE(simulation.save() == saved);
  Simulation untouched(experiment, 1);
  simulation.act(SpawnObject{"other", model_of_text(crate_yaml), at(0.5, 0, 0.1)});
  untouched.act(SpawnObject{"other", model_of_text(crate_yaml), at(0.5, 0, 0.1)});
  for (int i = 0; i < 20; ++i) {
    simulation.step();
    untouched.step();
  }
  EXPECT_EQ(simulation.state_hash(), untouched.state_hash());
}

// A text that comes next has the index of the model that was refused.
TEST(PlanarActions, ForgetTheModelOfARejectedSpawn) {
  description::Experiment experiment;
  experiment.world.physics.fidelity = description::Fidelity::planar;
  place(experiment.world, static_shape("floor", description::Box{{2, 2, 0.1}}), "floor", at(0, 0, -0.05));
  experiment.teams.emplace_back().name = "team";
  Simulation simulation(experiment, 1), untouched(experiment, 1);
  const auto robot = std::make_shared<const description::ParsedModel>(
      description::ParsedModel{.text = "robot", .model = tracked_robot(), .materials = {""}});
  const std::string plane =
      "<sdf version='1.9'><model name='plane'><static>true</static><link name='body'><collision name='slope'><geometry>"
      "<plane><normal>0 0 1</normal></plane></geometry></collision></link></model></sdf>";
  Pose leaning = at(0.3, 0, 0.1);
  leaning.orientation = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX());
  EXPECT_THROW(simulation.act(SpawnObject{"first", robot, leaning}), std::invalid_argument);
  EXPECT_THROW(simulation.act(SpawnObject{"first", model_of_text(plane), leaning}), std::invalid_argument);
  EXPECT_EQ(simulation.world().body_count(), simulation.objects().size());
  for (Simulation* each : {&simulation, &untouched}) {
    each->act(SpawnObject{"other", model_of_text(crate_yaml), at(0.5, 0, 0.1)});
    for (int i = 0; i < 20; ++i) each->step();
  }
  EXPECT_EQ(simulation.state_hash(), untouched.state_hash());
}

// ---- As bytes ----

std::vector<Action> one_of_each() {
  return {SpawnObject{"a/b", model_of_text(crate_yaml), at(1, 2, 3, 0.5), true},
          RemoveObject{"x"},
          SetPose{"y", at(-1, 0, 2)},
          SetVelocity{"z", {1, 2, 3}, {4, 5, 6}},
          SetLight{"lamp", false},
          SetLight{"lamp", true, 2.5, Eigen::Vector3d(0.1, 0.2, 0.3)},
          ApplyForce{"w", "link", {1, 0, -1}, {0, 2, 0}, 250ms}};
}

TEST(ActionBytes, ParseToTheSameAction) {
  for (const Action& action : one_of_each()) {
    const std::vector<std::byte> bytes = to_bytes(action);
    const Action again = action_from_bytes(bytes, model_of_text);
    EXPECT_EQ(again.index(), action.index());
    EXPECT_TRUE(to_bytes(again) == bytes);
  }
  const auto spawn = std::get<SpawnObject>(action_from_bytes(to_bytes(one_of_each()[0]), model_of_text));
  EXPECT_EQ(spawn.name, "a/b");
  EXPECT_EQ(std::get<description::ParsedModelPtr>(spawn.model)->text, crate_yaml);
  EXPECT_EQ(spawn.X_WM.position, Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(spawn.allow_renaming);
  const auto light = std::get<SetLight>(action_from_bytes(to_bytes(one_of_each()[5]), model_of_text));
  EXPECT_TRUE(light.on);
  EXPECT_EQ(light.intensity, 2.5);
  EXPECT_EQ(light.color, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(std::get<ApplyForce>(action_from_bytes(to_bytes(one_of_each()[6]), model_of_text)).duration, 250ms);
}

// Older recordings do not say whether a model is a name or a text.
TEST(ActionBytes, OfOlderRecordingsContainNamesOrTexts) {
  const auto again = [](const SpawnObject& spawn) {
    std::vector<std::byte> bytes = to_bytes(spawn);
    bytes[0] = std::byte{0};
    return std::get<SpawnObject>(action_from_bytes(bytes, model_of_text)).model;
  };
  EXPECT_EQ(std::get<std::string>(again({"a", "tracked_robot", at(0, 0, 0)})), "tracked_robot");
  EXPECT_EQ(std::get<std::string>(again({"a", "colon: in a name", at(0, 0, 0)})), "colon: in a name");
  EXPECT_EQ(std::get<description::ParsedModelPtr>(again({"a", model_of_text(crate_sdf), at(0, 0, 0)}))->text,
            crate_sdf);
}

TEST(ActionBytes, DistinguishNamesFromTextsWithAnyContent) {
  for (const std::string name : {"<sdf/>", "a: b", "x\ny", "{}"})
    EXPECT_EQ(std::get<std::string>(
                  std::get<SpawnObject>(action_from_bytes(to_bytes(SpawnObject{"a", name, at(0, 0, 0)}), {})).model),
              name);
}

TEST(ActionBytes, AreRejectedWithAnInvalidModelText) {
  auto broken = std::make_shared<description::ParsedModel>();
  broken->text = "<sdf version='1.9'/>";
  const std::vector<std::byte> bytes = to_bytes(SpawnObject{"a", broken, at(0, 0, 0)});
  EXPECT_THROW(action_from_bytes(bytes, model_of_text), std::invalid_argument);
  EXPECT_THROW(action_from_bytes(bytes, {}), std::invalid_argument);
}

TEST(ActionBytes, AreRejectedIfTooShortTooLongOrOfAnotherKind) {
  for (const Action& action : one_of_each()) {
    std::vector<std::byte> bytes = to_bytes(action);
    for (std::size_t size = 0; size < bytes.size(); ++size)
      EXPECT_THROW(action_from_bytes(std::span(bytes).first(size), model_of_text), std::invalid_argument) << size;
    bytes.push_back(std::byte{0});
    EXPECT_THROW(action_from_bytes(bytes, model_of_text), std::invalid_argument);
    bytes.pop_back();
    bytes[0] = std::byte{99};
    EXPECT_THROW(action_from_bytes(bytes, model_of_text), std::invalid_argument);
  }
  std::vector<std::byte> light = to_bytes(SetLight{"lamp", false});
  light[light.size() - 3] = std::byte{2};
  EXPECT_THROW(action_from_bytes(light, model_of_text), std::invalid_argument);
}

}  // namespace
}  // namespace cohort
