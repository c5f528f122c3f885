// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "server/description/experiment.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "tests/support/worlds/written_worlds.hpp"

namespace cohort::description {
namespace {

using namespace std::chrono_literals;

// An experiment with a robot `a`, one in a team, a static wall, and a given course.
class Schedule : public Description {
 protected:
  Schedule() {
    write_world(
        "<include><uri>model://sbot</uri><name>a</name></include><include><uri>model://sbot</uri><name>team/b"
        "</name><pose>1 0 0 0 0 0</pose></include>" +
        static_model_sdf("<pose>3 0 0 0 0 0</pose>" + collision("<sphere><radius>0.1</radius></sphere>"), "wall"));
  }
  // The added text begins on line 4.
  std::filesystem::path write_experiment(const std::string& course) const {
    return write("e.yaml", "world: world.sdf\nduration: 10\nteams: [{name: t, robots: all, controller: x}]\n" + course);
  }
  Experiment read_course(const std::string& course) const { return parsing::read_experiment(write_experiment(course)); }
};

TEST_F(Schedule, OrdersEventsByTime) {
  const Experiment experiment = read_course(
      "events:\n"
      "  - at: 2\n    add: {model: model://sbot, name: team/late, pose: [0, 1, 0, 0, 0, 1.5]}\n"
      "  - at: 1.5\n    remove: {objects: wall}\n"
      "  - at: 3\n    apply_force: {objects: [a, 'team/*'], link: turret, force: 1 2 3, torque: [4, 5, 6], for: 0.5}\n"
      "  - {at: 4, move: {objects: a, pose: 1 2 3 0 0 0.7071067811865476 0.7071067811865476}}\n"
      "  - {at: 5, set_velocity: {objects: a, linear: [0.1, 0, 0]}}\n");
  const World& world = experiment.world;
  ASSERT_EQ(world.instances.size(), 4u);
  EXPECT_EQ(world.instances[3].name, "team/late");
  EXPECT_FALSE(world.instances[3].is_present);
  EXPECT_EQ(world.robots, (std::vector<std::size_t>{0, 1, 3}));
  EXPECT_EQ(experiment.teams[0].robots, (std::vector<std::uint32_t>{0, 1, 2}));
  ASSERT_EQ(experiment.events.size(), 7u);
  EXPECT_EQ(experiment.events[0].time, 1500ms);
  EXPECT_EQ(experiment.events[0].object, 2u);
  EXPECT_FALSE(std::get<SetPresence>(experiment.events[0].effect).present);
  EXPECT_EQ(experiment.events[1].object, 3u);
  EXPECT_TRUE(std::get<SetPresence>(experiment.events[1].effect).present);
  std::vector<std::size_t> pushed;
  for (std::size_t i = 2; i < 5; ++i) {
    pushed.push_back(experiment.events[i].object);
    const auto& force = std::get<ApplyForce>(experiment.events[i].effect);
    EXPECT_EQ(force.link, 1u);
    EXPECT_EQ(force.force_W, Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(force.torque_W, Eigen::Vector3d(4, 5, 6));
    EXPECT_EQ(force.duration, 500ms);
  }
  EXPECT_EQ(pushed, (std::vector<std::size_t>{0, 1, 3}));
  EXPECT_NEAR(std::get<PlaceAt>(experiment.events[5].effect).X_WM.orientation.z(), std::sqrt(0.5), 1e-15);
  EXPECT_EQ(std::get<SetVelocity>(experiment.events[6].effect).angular_W, Eigen::Vector3d::Zero());
}

TEST_F(Schedule, SpawnsRobotsAtTimesAndByActions) {
  const Experiment experiment = read_course(
      "events:\n"
      "  - {at: 1, spawn: {model: model://sbot, name: team/late, pose: [0, 1, 0, 0, 0, 0], every: 0.5, most: 3}}\n"
      "  - {at: 2, spawn: {model: model://sbot, name: other, area: [1, 2], team: t}}\n"
      "  - {at: 1.2, remove: {objects: wall}}\n");
  EXPECT_EQ(experiment.world.instances.size(), 3u) << "nothing is there that has not come";
  EXPECT_EQ(experiment.world.spawnable_models.size(), 2u);
  ASSERT_EQ(experiment.spawners.size(), 2u);
  EXPECT_EQ(experiment.spawners[0].model, 0u) << "the model of a, read once";
  EXPECT_EQ(experiment.spawners[0].X_WM.position, Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(experiment.spawners[0].team, "t");
  EXPECT_EQ(experiment.spawners[0].most, 3u);
  EXPECT_EQ(experiment.spawners[1].most, 1u);
  EXPECT_EQ(experiment.spawners[1].area, Eigen::Vector2d(1, 2));
  std::vector<std::chrono::nanoseconds> times;
  for (const Event& event : experiment.events) times.push_back(event.time);
  EXPECT_EQ(times, (std::vector<std::chrono::nanoseconds>{1s, 1200ms, 1500ms, 2s, 2s}));
}

TEST_F(Schedule, ReadsWhatIsRecorded) {
  const Recorded defaults = read_course("").recorded;
  EXPECT_EQ(defaults.observed, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(defaults.pose_rate, 10.0);
  EXPECT_EQ(defaults.observation_rate, 0.0);
  EXPECT_EQ(defaults.snapshot_interval, 30s);
  const Recorded written =
      read_course("record: {poses: 0, observations: 25, robots: ['team/*'], snapshots: 1.5}\n").recorded;
  EXPECT_EQ(written.observed, (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(written.pose_rate, 0.0);
  EXPECT_EQ(written.observation_rate, 25.0);
  EXPECT_EQ(written.snapshot_interval, 1500ms);
}

TEST_F(Schedule, ReadsStopsPrintsAndHistory) {
  const Experiment experiment = read_course(
      "stop:\n  - inside: {objects: a, min: [0, 0], max: 1 1, for: 2}\n  - at_rest:  {}\n"
      "print:\n  - {quantity: pose, objects: team/*, every: 0.5}\n  - {quantity: count}\n"
      "history: {objects: [a, wall], length: 3}\nstep: 0.02\nthreads: 3\n");
  ASSERT_EQ(experiment.stops.size(), 2u);
  EXPECT_EQ(experiment.stops[0].holds_for, 2s);
  EXPECT_EQ(std::get<AllInside>(experiment.stops[0].what).upper, Eigen::Vector2d(1, 1));
  EXPECT_EQ(experiment.stops[1].objects.size(), 3u);
  ASSERT_EQ(experiment.prints.size(), 2u);
  EXPECT_EQ(experiment.prints[0].quantity, Quantity::pose);
  EXPECT_EQ(experiment.prints[0].objects, std::vector<std::size_t>{1});
  EXPECT_EQ(experiment.prints[1].every, 1s);
  EXPECT_EQ(experiment.history.length, 3u);
  EXPECT_EQ(experiment.history.objects, (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(experiment.world.step, 20ms);
  EXPECT_EQ(experiment.threads, 3u);
}

class FlawOfACourse : public Schedule, public testing::WithParamInterface<Flaw> {};

TEST_P(FlawOfACourse, IsReportedAloneWithFileLineAndKey) {
  const std::filesystem::path file = write_experiment(GetParam().content);
  const auto problems = problems_of([&] { parsing::read_experiment(file); });
  expect_problem(problems, file, GetParam());
  EXPECT_EQ(problems.size(), 1u) << texts_of(problems);
}

INSTANTIATE_TEST_SUITE_P(
    Courses, FlawOfACourse,
    testing::Values(
        Flaw{"events: 3\n", 4, "events", "expected a list"},
        Flaw{"events:\n  - {remove: {objects: a}}\n", 5, "events[0].at", "missing"},
        Flaw{"events:\n  - {at: 1}\n", 5, "events[0]", "missing: one of add, spawn, remove"},
        Flaw{"events:\n  - {at: -1, remove: {objects: a}}\n", 5, "events[0].at", "expected a time from 0 s"},
        Flaw{"events:\n  - at: 1\n    remov: {objects: a}\n", 6, "events[0].remov", "did you mean 'remove'?"},
        Flaw{"events:\n  - at: 1\n    remove: {objects: a}\n    disable: {objects: a}\n", 7, "events[0].disable",
             "exactly one key of this kind"},
        Flaw{"events:\n  - at: 1\n    remove: {objects: c}\n", 6, "events[0].remove.objects", "there is no object 'c'"},
        Flaw{"events:\n  - at: 1\n    remove: {object: a}\n", 6, "events[0].remove.object", "did you mean 'objects'?"},
        Flaw{"events:\n  - at: 1\n    move: {objects: a}\n", 6, "events[0].move.pose", "missing"},
        Flaw{"events:\n  - at: 1\n    move: {objects: a, pose: [1, 2]}\n", 6, "events[0].move.pose", "six numbers"},
        Flaw{"events:\n  - at: 1\n    spawn: {model: model://sbit, name: n}\n", 6, "events[0].spawn",
             "no model 'sbit'"},
        Flaw{"events:\n  - at: 1\n    spawn: {model: model://sbot}\n", 6, "events[0].spawn.name", "missing"},
        Flaw{"events:\n  - at: 1\n    spawn: {model: model://sbot, name: /n}\n", 6, "events[0].spawn.name",
             "expected a name shorter than 250 bytes"},
        Flaw{"events:\n  - at: 1\n    spawn: {model: model://sbot, name: n, team: u}\n", 6, "events[0].spawn.team",
             "there is no team 'u'; did you mean 't'?"},
        Flaw{"events:\n  - at: 1\n    spawn: {model: model://sbot, name: n, area: [-1, 0]}\n", 6,
             "events[0].spawn.area", "expected a size >= 0 m"},
        Flaw{"events:\n  - at: 1\n    spawn: {model: model://sbot, name: n, most: 3}\n", 6, "events[0].spawn.most",
             "cannot be used without `every`"},
        Flaw{"events:\n  - at: 1\n    spawn: {model: model://sbot, name: n, every: 1, most: 10001}\n", 6,
             "events[0].spawn.most", "at most 10000 new objects"},
        Flaw{"events:\n  - at: 0\n    spawn: {model: model://sbot, name: n}\n", 6, "events[0].spawn",
             "objects cannot be spawned at 0 s"},
        Flaw{"events:\n  - at: -1\n    spawn: {model: model://sbot, name: n}\n", 5, "events[0].at",
             "expected a time from 0 s"},
        Flaw{"events:\n  - at: 1\n    add: {model: model://sbit, name: n}\n", 6, "events[0].add", "no model 'sbit'"},
        Flaw{"events:\n  - at: 1\n    add: {model: model://sbot, name: a}\n", 6, "events[0].add", "another object"},
        Flaw{"events:\n  - at: 1\n    set_velocity: {objects: wall}\n", 6, "events[0].set_velocity.objects",
             "is static"},
        Flaw{"events:\n  - at: 1\n    apply_force: {objects: a, link: turet, for: 1}\n", 6,
             "events[0].apply_force.link", "did you mean 'turret'?"},
        Flaw{"events:\n  - {at: 1, remove: {objects: a}}\n  - {at: 2, enable: {objects: a}}\n", 6, "events[1].enable",
             "'a' has been removed before this event"},
        Flaw{"events:\n  - {at: 2, add: {model: model://sbot, name: c}}\n  - {at: 1, remove: {objects: c}}\n", 6,
             "events[1].remove", "'c' has not been added before this event"},
        Flaw{"stop:\n  - outside: {}\n", 5, "stop[0].outside", "unknown key"},
        Flaw{"stop:\n  - inside: {objects: a, min: 1 1, max: 0 0}\n", 5, "stop[0].inside.min", "exceeds max"},
        Flaw{"stop:\n  - beyond: {objects: a, point: 0 0, direction: 0 0}\n", 5, "stop[0].beyond.direction",
             "not zero"},
        Flaw{"print:\n  - {quantity: poses}\n", 5, "print[0].quantity", "did you mean 'pose'?"},
        Flaw{"print: {quantity: pose}\n", 4, "print", "expected a list"},
        Flaw{"history: {objects: a}\n", 4, "history.length", "missing"},
        Flaw{"history: {length: 0}\n", 4, "history.length", "from 1"},
        Flaw{"record: {pose: 10}\n", 4, "record.pose", "did you mean 'poses'?"},
        Flaw{"record: {robots: [c]}\n", 4, "record.robots", "no robot"},
        Flaw{"record: {observations: -1}\n", 4, "record.observations", "0"},
        Flaw{"step: 0.5e-9\n", 4, "step", "whole number of nanoseconds"}, Flaw{"step: 2\n", 4, "step", "at most 1 s"},
        Flaw{"threads: 0\n", 4, "threads", "from 1"}, Flaw{"stopp: []\n", 4, "stopp", "did you mean 'stop'?"}));

}  // namespace
}  // namespace cohort::description
