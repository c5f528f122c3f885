// SPDX-License-Identifier: Apache-2.0

// Results of the shipped experiments, in numbers.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "server/parsing/experiment/read_experiment.hpp"
#include "tests/support/worlds/shipped_experiment.hpp"

namespace cohort {
namespace {

/// An experiment after its run, with records of the run.
class Shipped {
 public:
  explicit Shipped(const std::string& name, double seconds = 0.0)
      : run_(name, {}, seconds, [this](const test::ShippedExperiment& run) { watch(run.simulation); }) {}

  Eigen::Vector3d position(const std::string& object) const { return run_.position(object); }
  Pose pose(const std::string& object) const { return run_.pose(object); }
  bool has_quarantined() const { return run_.has_quarantined(); }
  // Returns a channel of robot 0 at the end.
  std::vector<double> observed(const std::string& channel) const {
    const std::span<const double> values = simulation.observation(0);
    std::size_t offset = 0;
    for (const Channel& each : simulation.kinds()[simulation.kind_of(0)].observation) {
      if (each.name == channel) {
        const std::span<const double> its = values.subspan(offset, each.size);
        return {its.begin(), its.end()};
      }
      offset += each.size;
    }
    return {};
  }

  double lowest = 1e9;                               // least height of any robot's origin
  double least_upright = 1.0;                        // least z of any robot's up axis
  std::vector<Eigen::Vector2d> path_of_the_first;    // positions of robot 0, tick by tick
  std::set<std::pair<int, int>> cells_of_the_first;  // column and row, of a square of 2.5 m, where robot 0 was

 private:
  void watch(const Simulation& its) {
    for (std::uint32_t robot = 0; robot < its.robot_count(); ++robot) {
      const Pose X_WL = its.robot_pose(robot);
      lowest = std::min(lowest, X_WL.position.z());
      least_upright = std::min(least_upright, (X_WL.orientation * Eigen::Vector3d::UnitZ()).z());
      constexpr double edge = 0.5;
      if (robot == 0) path_of_the_first.emplace_back(X_WL.position.head<2>());
      if (robot == 0)
        cells_of_the_first.insert({static_cast<int>(std::floor((X_WL.position.x() + 1.25) / edge)),
                                   static_cast<int>(std::floor((X_WL.position.y() + 1.25) / edge))});
    }
  }
  test::ShippedExperiment run_;

 public:
  const description::Experiment& experiment = run_.experiment;
  const Simulation& simulation = run_.simulation;
  const session::RunResult& result = run_.result;
};

TEST(ShippedExperiments, AreAllReadAndStepped) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(test::shipped_experiments)) {
    SCOPED_TRACE(entry.path().string());
    const description::Experiment experiment = test::with_dynamics_of_test(parsing::read_experiment(entry.path()));
    EXPECT_TRUE(experiment.world.warnings.empty());
    Simulation simulation(experiment, 1);
    for (int i = 0; i < 20; ++i) simulation.step();
    EXPECT_TRUE(simulation.quarantined().empty());
    names.insert(entry.path().stem());
  }
  EXPECT_GE(names.size(), 14u);
}

TEST(ShippedExperiments, RobotsCrossATroughOfThreeCentimetresButNotOfFifteen) {
  const Shipped run("trough");
  EXPECT_EQ(run.result.stop_reason, "beyond: 'narrow'");
  EXPECT_NEAR(run.position("narrow").z(), 0.2, 0.005);
  EXPECT_LT(run.position("wide").x(), 0.75);
  EXPECT_LT(run.position("wide").z(), 0.19);
}

TEST(ShippedExperiments, RobotsFallIntoAHole) {
  const Shipped run("hole");
  EXPECT_EQ(run.result.stop_reason, "beyond: 'passes'");
  EXPECT_LT(run.position("falls").z(), 0.2);
  EXPECT_NEAR(run.position("passes").z(), 0.3, 0.005);
}

TEST(ShippedExperiments, RobotsClimbAStepOfOneCentimetreButNotOfSix) {
  const Shipped run("step");
  EXPECT_EQ(run.result.stop_reason, "beyond: 'climbs'");
  EXPECT_NEAR(run.position("climbs").z(), 0.01, 0.003);
  EXPECT_LT(run.position("stays").x(), 0.5);
  EXPECT_LT(run.position("stays").z(), 0.03);
}

TEST(ShippedExperiments, TwoRobotsPushTheBarIntoTheNest) {
  const Shipped run("pushing");
  EXPECT_EQ(run.result.stop_reason, "inside: 1 object");
  EXPECT_NEAR(run.position("things/bar").x(), 1.0, 0.01);
  EXPECT_LT(std::abs(run.position("things/bar").y()), 0.1);
  EXPECT_LT(run.result.sim_time, std::chrono::seconds(30));
}

TEST(ShippedExperiments, ATurtleBotDrivesACircleAndScansTheHouse) {
  const Shipped run("turtlebot3", 25.0);
  const Eigen::Vector2d centre(-1.5, -0.7);  // 0.15 m/s at 0.3 rad/s
  for (const Eigen::Vector2d& at : run.path_of_the_first) ASSERT_NEAR((at - centre).norm(), 0.5, 0.03);
  EXPECT_GT(run.least_upright, 0.999);
  EXPECT_FALSE(run.has_quarantined());
  const std::vector<double> ranges = run.observed("scan/0/ranges");
  ASSERT_EQ(ranges.size(), 360u);
  EXPECT_GT(std::ranges::min(ranges), 0.2) << "it does not see itself";
  EXPECT_LT(std::ranges::min(ranges), 1.5);
  EXPECT_EQ(run.observed("imu/0/angular_velocity").size(), 3u);
  EXPECT_NEAR(run.observed("imu/0/angular_velocity")[2], 0.3, 0.02);
  EXPECT_NEAR(run.observed("wheel_left/0/velocity")[0], (0.15 - 0.3 * 0.08) / 0.033, 0.1);
  EXPECT_NEAR(run.observed("wheel_right/0/velocity")[0], (0.15 + 0.3 * 0.08) / 0.033, 0.1);
}

TEST(ShippedExperiments, TheRoverDrivesTheCircleOfItsWheelSpeeds) {
  const Shipped run("rover");
  // Wheels of 0.035 m turn at 4 and 5 rad/s; their tyres touch the ground somewhere between 0.14 and 0.18 m apart.
  const double speed = 0.035 * 4.5, difference = 0.035 * 1.0;
  Eigen::Vector2d farthest(0.0, 0.0);
  for (const Eigen::Vector2d& at : run.path_of_the_first)
    if (at.norm() > farthest.norm()) farthest = at;
  EXPECT_GT(farthest.norm(), 2.0 * speed * 0.14 / difference);
  EXPECT_LT(farthest.norm(), 2.0 * speed * 0.18 / difference);
  EXPECT_GT(farthest.y(), std::abs(farthest.x()));
  EXPECT_NEAR(run.position("rover").z(), 0.0, 0.005);
  EXPECT_GT(run.least_upright, 0.98);
}

TEST(ShippedExperiments, WheelsAndTreelsDriveTheSameCircle) {
  struct Circle {
    double diameter = 0.0;  // [m]
    double heading = 0.0;   // total rotation [rad]
  };
  const auto drive = [](description::Fidelity fidelity) {
    description::Experiment experiment = parsing::read_experiment(test::shipped_experiments / "wheels.yaml");
    EXPECT_EQ(experiment.world.physics.fidelity, description::Fidelity::articulated);
    experiment.world.physics.fidelity = fidelity;
    Simulation simulation(experiment, 1);
    std::vector<double> command(simulation.kinds()[0].command_size, 0.0);
    command[0] = 0.08;
    command[1] = 0.12;
    simulation.set_command(0, command);
    Circle circle;
    double before = 0.0;
    for (int tick = 0; tick < 1000; ++tick) {
      simulation.step();
      const Pose X_WL = simulation.robot_pose(0);
      circle.diameter = std::max(circle.diameter, X_WL.position.norm());
      const Eigen::Vector3d forward_W = X_WL.orientation * Eigen::Vector3d::UnitX();
      const double heading = std::atan2(forward_W.y(), forward_W.x());
      circle.heading += std::remainder(heading - before, 2.0 * M_PI);
      before = heading;
    }
    return circle;
  };
  // The middles of the two sides are 0.08 m apart.
  constexpr double turn_rate = 0.04 / 0.08, diameter = 2.0 * 0.1 / turn_rate;
  const Circle tracks = drive(description::Fidelity::treel);
  EXPECT_NEAR(tracks.diameter, diameter, 0.01 * diameter);
  EXPECT_NEAR(tracks.heading, turn_rate * 10.0, 0.02 * turn_rate * 10.0);
  // Wheels of 12 mm touch the ground anywhere along their width.
  const Circle wheels = drive(description::Fidelity::articulated);
  EXPECT_NEAR(wheels.diameter, tracks.diameter, 0.05 * diameter);
  EXPECT_NEAR(wheels.heading, tracks.heading, 0.05 * turn_rate * 10.0);
}

TEST(ShippedExperiments, TheHexapodWalksAheadAndStaysUpright) {
  const Shipped run("hexapod");
  EXPECT_GT(run.position("hexapod").x(), 1.0);
  EXPECT_LT(std::abs(run.position("hexapod").y()), 0.5);
  EXPECT_GT(run.least_upright, 0.6);
}

TEST(ShippedExperiments, TheArmReachesItsAngles) {
  const Shipped run("arm");
  const std::uint32_t arm = *run.simulation.objects().find("arm");
  const description::Model& model = run.experiment.world.robot_model(0);
  const double expected[] = {0.6, 1.1, 1.0};
  int joint = 0;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    if (model.joints[i].type != description::JointType::revolute) continue;
    EXPECT_NEAR(run.simulation.world().joint_state(BodyId{arm}, JointId{i}).position, expected[joint++], 0.05)
        << model.joints[i].name;
  }
  EXPECT_EQ(joint, 3);
  EXPECT_NEAR(run.position("ball").z(), 0.03, 0.01) << "it fell from where the event put it";
}

TEST(ShippedExperiments, QuadcoptersRiseToTheirHeightsAndStayUpright) {
  const Shipped run("quadcopters");
  const double heights[] = {1.0, 1.5, 2.0, 2.5};
  for (int i = 0; i < 4; ++i) {
    const Pose X_WL = run.pose("copter_" + std::to_string(i));
    EXPECT_NEAR(X_WL.position.z(), heights[i], 0.02);
    EXPECT_GT((X_WL.orientation * Eigen::Vector3d::UnitZ()).z(), 0.999);
    EXPECT_NEAR(X_WL.position.x(), -1.5 + i, i == 2 ? 2.0 : 0.01) << "the gust leaves one of them drifting";
  }
  EXPECT_LT(run.least_upright, 0.95) << "the gust";
  EXPECT_GT(run.least_upright, 0.5);
}

TEST(ShippedExperiments, QuadcoptersForBetaflightHoverAndLandByThemselves) {
  const double heights[] = {1.0, 1.25, 1.5};
  const Shipped hovering("betaflight", 20.0);
  const Shipped landed("betaflight");
  for (int i = 0; i < 3; ++i) {
    const std::string copter = "copter_" + std::to_string(i);
    EXPECT_NEAR(hovering.position(copter).z(), heights[i], 0.05);
    EXPECT_NEAR(landed.position(copter).z(), 0.0, 0.05);
  }
  EXPECT_GT(landed.least_upright, 0.9);
}

TEST(ShippedExperiments, QuadcoptersForAutopilotsHoverByThemselves) {
  for (const char* const experiment : {"ardupilot", "px4"}) {
    const Shipped run(experiment, 15.0);
    EXPECT_NEAR(run.position("copter_0").z(), 2.0, 0.1) << experiment;
    EXPECT_NEAR(run.position("copter_1").z(), 3.0, 0.1) << experiment;
    EXPECT_GT(run.least_upright, 0.9) << experiment;
  }
}

TEST(ShippedExperiments, TheBoatStaysUprightAndCirclesTheBuoy) {
  const Shipped run("autopilot_boat");
  EXPECT_NEAR(run.position("boat").z(), -0.05, 0.02);
  EXPECT_GT(run.least_upright, 0.99);
  std::set<int> quarters;
  for (const Eigen::Vector2d& place : run.path_of_the_first) {
    const Eigen::Vector2d from_buoy = place - Eigen::Vector2d(0.2, 3.1);
    EXPECT_NEAR(from_buoy.norm(), 3.1, 0.5);
    quarters.insert((from_buoy.x() > 0.0 ? 2 : 0) + (from_buoy.y() > 0.0 ? 1 : 0));
  }
  EXPECT_EQ(quarters.size(), 4u);
}

TEST(ShippedExperiments, KilobotsCircleMoreSlowlyNearTheLamp) {
  const Shipped run("kilobot", 5.0);
  const auto way = [&run](int robot, double x, double y) {
    return (run.position("swarm/kilobot_" + std::to_string(robot)) - Eigen::Vector3d(x, y, 0.0)).norm();
  };
  const double near_it = way(14, 0.12, 0.0), far_from_it = way(10, -0.12, 0.0);
  EXPECT_NEAR(far_from_it, 0.038, 0.008) << "at 0.85 cm/s, in a bow";
  EXPECT_LT(near_it, 0.85 * far_from_it);
  EXPECT_GT(near_it, 0.3 * far_from_it);
  EXPECT_GT(run.least_upright, 0.99);
}

TEST(ShippedExperiments, ThePorterOpensTheGateSwitchesTheLampOffAndPushesTheBarOff) {
  const Shipped run("gate");
  EXPECT_EQ(run.result.stop_reason, "beyond: 'porter'");
  std::vector<session::RunEvent> events;
  for (const session::RunEvent& event : run.result.events)
    if (event.kind == "event") events.push_back(event);
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0].text, "open_gate of 'porter': disable 'gate'");
  EXPECT_EQ(events[1].text, "switch_off of 'porter': set_emitter 'lamp'");
  EXPECT_TRUE(events[2].text.starts_with("joint 'bracket' broke at 5.7")) << events[2].text << ", `direct` says 5.75";
  // The gate opens where two readings of 1 - d / 0.2, weighted by 0.6, exceed a half; the bar breaks where the hull
  // hits it.
  EXPECT_NEAR(run.path_of_the_first[events[0].tick].x(), 0.49 - 0.058 - 0.117, 0.02);
  EXPECT_NEAR(run.path_of_the_first[events[2].tick].x(), 1.2 - 0.006 - 0.05, 0.02);
  EXPECT_FALSE(run.simulation.objects().is_present(*run.simulation.objects().find("gate")));
  EXPECT_TRUE(run.simulation.emitters().lit_lamps().empty());
  EXPECT_LT(run.position("bar").z(), 0.02) << "it was 3 cm high";
  EXPECT_GT(run.position("bar").x(), 1.205) << "it hung at 1.2 m";
}

TEST(ShippedExperiments, AFormationDrivesAheadAsOne) {
  const Shipped run("formation", 5.0);
  for (std::uint32_t robot = 0; robot < run.simulation.robot_count(); ++robot) {
    const Eigen::Vector3d way =
        run.simulation.robot_pose(robot).position - run.experiment.world.robot(robot).X_WM.position;
    EXPECT_NEAR(way.x(), 0.5, 0.05);
    EXPECT_NEAR(way.y(), 0.0, 0.01);
  }
}

TEST(ShippedExperiments, TheMouseFindsTheExit) {
  const Shipped run("maze");
  EXPECT_EQ(run.result.stop_reason, "beyond: 'mouse'");
  EXPECT_GE(run.cells_of_the_first.size(), 5u);
  for (const auto& [column, row] : run.cells_of_the_first) {
    EXPECT_GE(std::min(column, row), 0);
    EXPECT_LE(row, 4);
    if (column > 4) {
      EXPECT_EQ(row, 4) << "that is not the exit";
    }
  }
}

}  // namespace
}  // namespace cohort
