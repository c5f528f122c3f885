// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "server/description/experiment.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "tests/support/worlds/written_worlds.hpp"

// Tests of breakable joints, user actions, and events for them and for emitters.
namespace cohort::description {
namespace {

using namespace std::chrono_literals;

// ---- Breakable joints ----

// A world with a moving box with a link `arm`, and two static walls, on line 2; the joint is on lines 3 and 4.
class WorldsWithJoints : public Description {
 protected:
  static std::string content(const std::string& keys, const std::string& name = "hook") {
    return "<model name=\"box\">" + links("ab") + joint("j", "a", "b") + "</model>" +
           static_model_sdf(collision("<sphere><radius>0.1</radius></sphere>"), "team/wall") +
           static_model_sdf(collision("<sphere><radius>0.1</radius></sphere>"), "floor") +
           "\n<cohort:breakable_joint name=\"" + name + "\">\n" + keys + "</cohort:breakable_joint>";
  }
};

TEST_F(WorldsWithJoints, ReadEndsPoseAndLimits) {
  const World world = read(content(
      "<cohort:first>box</cohort:first><cohort:first_link>b</cohort:first_link><cohort:second>team/wall"
      "</cohort:second><cohort:pose>1 2 3 0 0 0</cohort:pose><cohort:breaking_force>12</cohort:breaking_force>"));
  ASSERT_EQ(world.breakable_joints.size(), 1u);
  const BreakableJoint& joint = world.breakable_joints[0];
  EXPECT_EQ(joint.name, "hook");
  EXPECT_EQ(joint.first, 0u);
  EXPECT_EQ(joint.first_link, 1u);
  EXPECT_EQ(joint.second, 1u);
  EXPECT_EQ(joint.second_link, 0u);
  ASSERT_TRUE(joint.X_LP);
  EXPECT_EQ(joint.X_LP->position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(joint.breaking_force, 12.0);
  EXPECT_TRUE(std::isinf(joint.breaking_torque));
}

TEST_F(WorldsWithJoints, MayNameLaterObjectsAndThoseOfPopulations) {
  const World world = read(
      "<cohort:breakable_joint name=\"b\"><cohort:first>team/sbot_1</cohort:first><cohort:second>team/sbot_0"
      "</cohort:second></cohort:breakable_joint>" +
      static_model_sdf(collision("<plane/>"), "floor") +
      "<cohort:population name=\"team\"><cohort:uri>model://sbot</cohort:uri><cohort:count>2</cohort:count>"
      "<cohort:placement><cohort:grid><cohort:spacing>0.3</cohort:spacing></cohort:grid></cohort:placement>"
      "</cohort:population>");
  ASSERT_EQ(world.breakable_joints.size(), 1u);
  EXPECT_EQ(world.instances[world.breakable_joints[0].first].name, "team/sbot_1");
  EXPECT_FALSE(world.breakable_joints[0].X_LP);
}

class FlawOfABreakableJoint : public WorldsWithJoints, public testing::WithParamInterface<Flaw> {};

TEST_P(FlawOfABreakableJoint, IsReportedAloneWithItsLine) {
  Flaw flaw = GetParam();
  expect_only_flaw(flaw, write_world(content(flaw.content)));
}

std::string ends(const std::string& first, const std::string& second, const std::string& rest = "") {
  return "<cohort:first>" + first + "</cohort:first>\n<cohort:second>" + second + "</cohort:second>" + rest;
}

INSTANTIATE_TEST_SUITE_P(
    Joints, FlawOfABreakableJoint,
    testing::Values(
        Flaw{"<cohort:first>box</cohort:first>", 3, "world/cohort:breakable_joint[hook]/cohort:second", "missing"},
        Flaw{ends("bok", "floor"), 4, "world/cohort:breakable_joint[hook]/cohort:first", "did you mean 'box'?"},
        Flaw{ends("box", "flor"), 5, "world/cohort:breakable_joint[hook]/cohort:second", "did you mean 'floor'?"},
        Flaw{ends("box", "floor", "\n<cohort:first_link>c</cohort:first_link>"), 6,
             "world/cohort:breakable_joint[hook]/cohort:first_link", "'box' has no link 'c'"},
        Flaw{ends("box", "floor", "\n<cohort:second_link>c</cohort:second_link>"), 6,
             "world/cohort:breakable_joint[hook]/cohort:second_link", "'floor' has no link 'c'"},
        Flaw{ends("box", "box"), 5, "world/cohort:breakable_joint[hook]/cohort:second", "an object other than 'box'"},
        Flaw{ends("floor", "team/wall"), 3, "world/cohort:breakable_joint[hook]", "both are static"},
        Flaw{ends("box", "floor", "\n<cohort:breaking_force>0</cohort:breaking_force>"), 6,
             "world/cohort:breakable_joint[hook]/cohort:breaking_force", "> 0"},
        Flaw{ends("box", "floor", "\n<cohort:breaking_forc>1</cohort:breaking_forc>"), 6,
             "world/cohort:breakable_joint[hook]/cohort:breaking_forc", "did you mean 'cohort:breaking_force'?"}));

TEST_F(WorldsWithJoints, RejectDuplicateNames) {
  const std::string joint =
      "\n<cohort:breakable_joint name=\"hook\">" + ends("box", "floor") + "</cohort:breakable_joint>";
  expect_only_flaw({"", 6, "world/cohort:breakable_joint[hook]", "another breakable joint has the name 'hook'"},
                   write_world(content(ends("box", "floor")) + joint));
}

// ---- Actions ----

TEST_F(Description, TreatsAModelWithAnActionAsARobot) {
  const World world = read("<model name=\"m\">" + links("a") + "<cohort:action name=\"open_gate\"/></model>");
  ASSERT_EQ(world.robots.size(), 1u);
  EXPECT_EQ(std::get<UserAction>(world.models[0].devices.at(0)).name, "open_gate");
}

TEST_F(Description, RejectsKeysAndDuplicateNamesOfActions) {
  expect_only_flaw({"", 2, "world/model[m]/cohort:action[a]/cohort:link", "unknown element"},
                   write_world("<model name=\"m\">" + links("a") +
                               "<cohort:action name=\"a\"><cohort:link>a</cohort:link></cohort:action></model>"));
  expect_only_flaw({"", 3, "world/model[m]/cohort:action[a]", "another device"},
                   write_world("<model name=\"m\">" + links("a") +
                               "<cohort:action name=\"a\"/>\n<cohort:action name=\"a\"/></model>"));
}

// An experiment with robots `a`, `team/b` and `team/c`, of which b and c can open and c can call. There is a lamp in a
// stand with a siren, and a wall.
class CourseWithActions : public Description {
 protected:
  CourseWithActions() {
    const auto robot = [](const std::string& name, const std::string& actions) {
      return "<model name=\"" + name + "\">" + links("l") + actions + "</model>";
    };
    const std::string open = "<cohort:action name=\"open\"/>", call = "<cohort:action name=\"call\"/>";
    write_world(
        robot("a", "<cohort:battery name=\"b\"><cohort:capacity>1</cohort:capacity></cohort:battery>") +
        robot("team/b", open) + robot("team/c", open + call) +
        static_model_sdf("<link name=\"l\"><light name=\"lamp\" type=\"point\"/><cohort:sound name=\"siren\">"
                         "<cohort:frequency>400</cohort:frequency><cohort:intensity>1</cohort:intensity></cohort:sound>"
                         "</link>",
                         "stand") +
        static_model_sdf(collision("<sphere><radius>0.1</radius></sphere>"), "wall") +
        "<light name=\"sun\" type=\"directional\"/><cohort:breakable_joint name=\"hook\">" + ends("a", "wall") +
        "</cohort:breakable_joint>");
  }
  // The added text begins on line 4.
  std::filesystem::path write_experiment(const std::string& course) const {
    return write("e.yaml", "world: world.sdf\nduration: 10\nteams: [{name: t, robots: all, controller: x}]\n" + course);
  }
  Experiment read_course(const std::string& course) const { return parsing::read_experiment(write_experiment(course)); }
};

TEST_F(CourseWithActions, SelectsTheRobotsThatHaveTheAction) {
  const Experiment experiment = read_course(
      "events:\n"
      "  - {on: {action: open}, disable: {objects: [wall, stand]}}\n"
      "  - {at: 1, enable: {objects: wall}}\n"
      "  - {on: {action: call, robots: [0, team/*]}, move: {objects: a, pose: 1 2 3 0 0 0}}\n"
      "  - {on: {action: open, robots: team/c}, add: {model: model://sbot, name: d}}\n");
  ASSERT_EQ(experiment.events.size(), 1u);
  ASSERT_EQ(experiment.reactions.size(), 3u);
  EXPECT_EQ(experiment.reactions[0].action, "open");
  EXPECT_EQ(experiment.reactions[0].robots, (std::vector<std::uint32_t>{1, 2}));
  ASSERT_EQ(experiment.reactions[0].events.size(), 2u);
  EXPECT_EQ(experiment.reactions[0].events[0].object, 3u);
  EXPECT_EQ(experiment.reactions[0].events[1].object, 4u);
  EXPECT_EQ(experiment.reactions[0].events[1].kind, "disable");
  EXPECT_FALSE(std::get<SetPresence>(experiment.reactions[0].events[1].effect).once);
  EXPECT_EQ(experiment.reactions[1].robots, (std::vector<std::uint32_t>{2}));
  EXPECT_TRUE(std::get<SetPresence>(experiment.reactions[2].events[0].effect).once);
  EXPECT_EQ(experiment.world.instances[experiment.reactions[2].events[0].object].name, "d");
}

TEST_F(CourseWithActions, AcceptsTimedEventsForObjectsThatActionsAdd) {
  EXPECT_EQ(read_course("events:\n  - {on: {action: open}, add: {model: model://sbot, name: d}}\n"
                        "  - {at: 1, disable: {objects: d}}\n")
                .events.size(),
            1u);
}

TEST_F(CourseWithActions, SelectsEmittersByName) {
  const Experiment experiment = read_course(
      "events:\n"
      "  - {at: 1, set_emitter: {objects: '*', on: false}}\n"
      "  - {at: 2, set_emitter: {objects: stand, emitter: sir*, frequency: 500, intensity: 0}}\n"
      "  - {at: 3, set_emitter: {objects: [sun, stand], color: [0, 0.5, 1]}}\n");
  ASSERT_EQ(experiment.events.size(), 5u);  // one for each object with emitters
  const auto& off = std::get<SetEmitters>(experiment.events[0].effect);
  EXPECT_EQ(off.emitters, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(off.change.is_on, false);
  EXPECT_FALSE(off.change.intensity);
  const auto& siren = std::get<SetEmitters>(experiment.events[2].effect);
  EXPECT_EQ(siren.emitters, (std::vector<std::size_t>{1}));
  EXPECT_EQ(siren.change.frequency, 500.0);
  EXPECT_EQ(siren.change.intensity, 0.0);
  EXPECT_EQ(std::get<SetEmitters>(experiment.events[4].effect).change.color, Eigen::Vector3d(0, 0.5, 1));
}

TEST_F(CourseWithActions, PrintsBreakableJoints) {
  const Experiment experiment =
      read_course("print:\n  - {quantity: joint_force, joints: [hook, ho*]}\n  - {quantity: count}\n");
  EXPECT_EQ(experiment.prints[0].quantity, Quantity::joint_force);
  EXPECT_EQ(experiment.prints[0].joints, std::vector<std::size_t>{0});
  EXPECT_TRUE(experiment.prints[0].objects.empty());
  EXPECT_TRUE(experiment.prints[1].joints.empty());
}

class FlawOfACourseWithActions : public CourseWithActions, public testing::WithParamInterface<Flaw> {};

TEST_P(FlawOfACourseWithActions, IsReportedAloneWithFileLineAndKey) {
  const std::filesystem::path file = write_experiment(GetParam().content);
  const auto problems = problems_of([&] { parsing::read_experiment(file); });
  expect_problem(problems, file, GetParam());
  EXPECT_EQ(problems.size(), 1u) << texts_of(problems);
}

INSTANTIATE_TEST_SUITE_P(
    Courses, FlawOfACourseWithActions,
    testing::Values(
        Flaw{"events:\n  - {disable: {objects: wall}}\n", 5, "events[0].at", "or `on`"},
        Flaw{"events:\n  - at: 1\n    on: {action: open}\n    disable: {objects: wall}\n", 6, "events[0].on",
             "cannot be used together with `at`"},
        Flaw{"events:\n  - on: {action: open}\n", 5, "events[0]", "missing: one of add, spawn, remove"},
        Flaw{"events:\n  - on: open\n    disable: {objects: wall}\n", 5, "events[0].on", "expected"},
        Flaw{"events:\n  - on: {robots: all}\n    disable: {objects: wall}\n", 5, "events[0].on.action", "missing"},
        Flaw{"events:\n  - on: {action: opn}\n    disable: {objects: wall}\n", 5, "events[0].on.action",
             "did you mean 'open'?"},
        Flaw{"events:\n  - on: {action: call, robots: [a, team/b]}\n    disable: {objects: wall}\n", 5,
             "events[0].on.action", "none of the selected robots has an action 'call'"},
        Flaw{"events:\n  - on:\n      action: open\n      robots: tem/*\n    disable: {objects: wall}\n", 7,
             "events[0].on.robots", "there is no robot 'tem/*'"},
        Flaw{"events:\n  - on: {action: open, robot: all}\n    disable: {objects: wall}\n", 5, "events[0].on.robot",
             "did you mean 'robots'?"},
        Flaw{"events:\n  - on: {action: open}\n    disable: {objects: wal}\n", 6, "events[0].disable.objects",
             "did you mean 'wall'?"},
        Flaw{"events:\n  - at: 1\n    set_emitter: {objects: wall, on: true}\n", 6, "events[0].set_emitter.objects",
             "none of the objects has an emitter"},
        Flaw{"events:\n  - at: 1\n    set_emitter: {objects: stand, emitter: sirn, on: true}\n", 6,
             "events[0].set_emitter.emitter", "did you mean 'siren'?"},
        Flaw{"events:\n  - at: 1\n    set_emitter: {objects: stand}\n", 6, "events[0].set_emitter",
             "missing: a value to change"},
        Flaw{"events:\n  - at: 1\n    set_emitter: {objects: stand, emitter: lamp, frequency: 3}\n", 6,
             "events[0].set_emitter.frequency", "applies to a sound, but no such emitter is selected"},
        Flaw{"events:\n  - at: 1\n    set_emitter: {objects: stand, humidity: 3}\n", 6,
             "events[0].set_emitter.humidity", "applies to a climate_source"},
        Flaw{"events:\n  - at: 1\n    set_emitter: {objects: stand, color: 0 0 2}\n", 6, "events[0].set_emitter.color",
             "from 0 to 1"},
        Flaw{"events:\n  - at: 1\n    set_emitter: {objects: stand, on: maybe}\n", 6, "events[0].set_emitter.on",
             "true"},
        Flaw{"events:\n  - at: 1\n    set_emitter: {objects: stand, frequency: 0}\n", 6,
             "events[0].set_emitter.frequency", "> 0"},
        Flaw{"events:\n  - at: 1\n    move: {objects: a, pose: 1 2 3 0 0 1e100}\n", 6, "events[0].move.pose",
             "angles must be from -1e6 to 1e6 rad"},
        Flaw{"events:\n  - at: 1\n    move: {objects: a, pose: 1 2 3 0 0 0 1e200}\n", 6, "events[0].move.pose",
             "expected six numbers"},
        Flaw{"print:\n  - {quantity: joint_force, joints: hok}\n", 5, "print[0].joints", "did you mean 'hook'?"},
        Flaw{"print:\n  - {quantity: joint_force, objects: a}\n", 5, "print[0].objects",
             "cannot be used with the quantity"},
        Flaw{"print:\n  - {quantity: pose, joints: hook}\n", 5, "print[0].joints",
             "cannot be used with the quantity"}));

}  // namespace
}  // namespace cohort::description
