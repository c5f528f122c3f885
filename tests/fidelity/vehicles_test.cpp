// SPDX-License-Identifier: Apache-2.0

// Vehicles made for Gazebo, with its plugins, follow their kinematics.

#include <gtest/gtest.h>

#include <cmath>

#include "server/parsing/world/read_world.hpp"
#include "server/simulation/simulation.hpp"
#include "tests/support/files.hpp"
#include "tests/support/worlds/sensing_world.hpp"

namespace cohort::test {
namespace {

using description::Dynamics;
using description::Fidelity;
using Eigen::Vector3d;

constexpr const char* ground =
    "<model name='ground'><static>true</static><link name='link'><collision name='c'><geometry><plane/></geometry>"
    "</collision></link></model>";

std::string box_inertial(double mass, double inertia) {
  const std::string i = std::to_string(inertia);
  return "<inertial><mass>" + std::to_string(mass) + "</mass><inertia><ixx>" + i + "</ixx><iyy>" + i + "</iyy><izz>" +
         i + "</izz></inertia></inertial>";
}
std::string wheel(const std::string& name, double x, double y, double radius) {
  return "<link name='" + name + "'><pose>" + std::to_string(x) + " " + std::to_string(y) + " " +
         std::to_string(radius) + " -1.5707963267948966 0 0</pose>" + box_inertial(0.5, 0.002) +
         "<collision name='c'><geometry><cylinder><radius>" + std::to_string(radius) +
         "</radius><length>0.02</length></cylinder></geometry></collision></link>";
}
// Rotated so that a positive velocity drives forwards: the z axis of a wheel's link points to the left.
std::string axle(const std::string& name, const std::string& parent, const std::string& child) {
  return "<joint name='" + name + "' type='revolute'><parent>" + parent + "</parent><child>" + child +
         "</child><axis><xyz>0 0 1</xyz></axis></joint>";
}
std::string ball(const std::string& name, double x, double radius) {
  return "<link name='" + name + "'><pose>" + std::to_string(x) + " 0 " + std::to_string(radius) + " 0 0 0</pose>" +
         box_inertial(0.2, 0.001) + "<collision name='c'><geometry><sphere><radius>" + std::to_string(radius) +
         "</radius></sphere></geometry><surface><friction><ode><mu>0</mu></ode></friction></surface></collision></link>"
         "<joint name='" +
         name + "_joint' type='ball'><parent>chassis</parent><child>" + name + "</child></joint>";
}
std::string chassis(const std::string& size, const std::string& pose) {
  return "<link name='chassis'><pose>" + pose + "</pose>" + box_inertial(8.0, 0.2) +
         "<collision name='c'><geometry><box><size>" + size + "</size></box></geometry></collision></link>";
}

std::string two_wheels(const std::string& plugin) {
  return "<model name='robot'>" + chassis("0.4 0.24 0.1", "0 0 0.12 0 0 0") + wheel("left", 0, 0.16, 0.1) +
         wheel("right", 0, -0.16, 0.1) + ball("front", 0.15, 0.05) + ball("back", -0.15, 0.05) +
         axle("left_joint", "chassis", "left") + axle("right_joint", "chassis", "right") + plugin + "</model>";
}
constexpr const char* diff_drive =
    "<plugin filename='gz-sim-diff-drive-system' name='gz::sim::systems::DiffDrive'><left_joint>left_joint</left_joint>"
    "<right_joint>right_joint</right_joint><wheel_separation>0.32</wheel_separation><wheel_radius>0.1</wheel_radius>"
    "<topic>cmd_vel</topic></plugin>";

std::string steered(const std::string& side, double y) {
  return "<link name='" + side + "_knuckle'><pose>0.5 " + std::to_string(y) + " 0.1 0 0 0</pose>" +
         box_inertial(0.3, 0.002) + "</link>" + wheel("front_" + side, 0.5, y, 0.1) + "<joint name='" + side +
         "_steering' type='revolute'><parent>chassis</parent><child>" + side +
         "_knuckle</child><axis><xyz>0 0 1</xyz><limit><lower>-0.9</lower><upper>0.9</upper></limit></axis></joint>" +
         axle("front_" + side + "_joint", side + "_knuckle", "front_" + side);
}
const std::string car =
    "<model name='robot'>" + chassis("0.7 0.2 0.1", "0.25 0 0.2 0 0 0") + wheel("left", 0, 0.2, 0.1) +
    wheel("right", 0, -0.2, 0.1) + axle("left_joint", "chassis", "left") + axle("right_joint", "chassis", "right") +
    steered("left", 0.2) + steered("right", -0.2) +
    "<plugin filename='libignition-gazebo6-ackermann-steering-system.so' "
    "name='ignition::gazebo::systems::AckermannSteering'><left_joint>left_joint</left_joint>"
    "<right_joint>right_joint</right_joint><left_steering_joint>left_steering</left_steering_joint>"
    "<right_steering_joint>right_steering</right_steering_joint><kingpin_width>0.4</kingpin_width>"
    "<steering_limit>0.6</steering_limit><wheel_base>0.5</wheel_base><wheel_separation>0.4</wheel_separation>"
    "<wheel_radius>0.1</wheel_radius></plugin></model>";

struct Motion {
  double linear = 0.0;   // velocity of the robot's origin along its x axis [m/s]
  double angular = 0.0;  // [rad/s]
};

class Vehicles : public ::testing::TestWithParam<std::pair<Fidelity, Dynamics>> {
 protected:
  void load(const std::string& content) {
    const auto file = folder_.path() / "world.sdf";
    write_file(file, "<sdf version='1.9'><world name='w'>" + std::string(ground) + content + "</world></sdf>");
    world_.experiment.world = parsing::read_world(file, 1);
    world_.world().physics.fidelity = GetParam().first;
    world_.world().physics.dynamics = GetParam().second;
    EXPECT_TRUE(world_.world().warnings.empty()) << world_.world().warnings.front().text();
  }
  // Returns the motion over one second, after the commands have acted for `time` [s].
  Motion drive(double linear, double angular, double time) {
    world_.command(0, "cmd_vel/0/linear", {linear});
    world_.command(0, "cmd_vel/0/angular", {angular});
    const int second = static_cast<int>(std::chrono::seconds(1) / world_.world().step);
    world_.step(static_cast<int>(time * second));
    Motion motion;
    for (int tick = 0; tick < second; ++tick) {
      const Pose before = pose();
      world_.step();
      const Pose turned{Vector3d::Zero(), before.orientation.conjugate() * pose().orientation};
      motion.linear += (before.orientation.conjugate() * (pose().position - before.position)).x();
      motion.angular += 2.0 * std::atan2(turned.orientation.z(), turned.orientation.w());
    }
    return motion;
  }
  double height() { return pose().position.z(); }
  double forward() { return pose().position.x(); }

  SensingWorld world_;

 private:
  Pose pose() {
    Simulation& simulation = world_.simulation();
    const BodyId body = simulation.body_of(0);
    const description::World& world = world_.world();
    const Pose& X_ML = world.models[world.instances[body.value].model].links[0].X_ML;
    return simulation.world().link_pose(body, LinkId{0}) * X_ML.inverse();
  }
  ScratchFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Every, Vehicles,
                         ::testing::Values(std::pair(Fidelity::articulated, Dynamics::cohort),
                                           std::pair(Fidelity::articulated, Dynamics::bullet),
                                           std::pair(Fidelity::treel, Dynamics::bullet)));

TEST_P(Vehicles, WithDiffDriveReachTheCommandedTwist) {
  load(two_wheels(diff_drive));
  for (const auto& [linear, angular] : {std::pair(0.5, 0.5), std::pair(0.5, 0.0), std::pair(-0.5, -0.6)}) {
    const Motion motion = drive(linear, angular, 2.0);
    EXPECT_NEAR(motion.linear, linear, 0.02 * std::abs(linear));
    EXPECT_NEAR(motion.angular, angular, 0.02 * std::abs(angular) + 1e-4);
  }
  EXPECT_NEAR(height(), 0.0, 0.01) << "it stays on its wheels";
}

TEST_P(Vehicles, WithAckermannSteeringTurnAtTheirKinematicRadius) {
  load(car);
  for (const double radius : {1.5, -2.5}) {
    const Motion motion = drive(0.5, 0.5 / radius, 2.0);
    EXPECT_NEAR(motion.linear / motion.angular, radius, 0.05 * std::abs(radius));
    EXPECT_NEAR(motion.linear, 0.5, 0.02);
  }
  const Motion tightest = drive(0.3, 3.0, 2.0);
  EXPECT_NEAR(tightest.linear / tightest.angular, 0.5 / std::sin(0.6), 0.05) << "no tighter than it steers";
  EXPECT_NEAR(height(), 0.0, 0.01);
}

std::string track(const std::string& side, double y) {
  std::string link = "<link name='" + side + "'><pose>0 " + std::to_string(y) + " 0.05 0 0 0</pose>" +
                     box_inertial(2.0, 0.05) +
                     "<collision name='c'><geometry><box><size>0.5 0.1 0.1</size></box></geometry></collision>";
  for (const std::string x : {"0.25", "-0.25"})
    link += "<collision name='c" + x + "'><pose>" + x + " 0 0 1.5707963267948966 0 0</pose><geometry><cylinder>" +
            "<radius>0.05</radius><length>0.1</length></cylinder></geometry></collision>";
  return link + "</link><joint name='" + side + "_joint' type='fixed'><parent>chassis</parent><child>" + side +
         "</child></joint><plugin filename='gz-sim-track-controller-system' "
         "name='gz::sim::systems::TrackController'><link>" +
         side + "</link><min_velocity>-1</min_velocity><max_velocity>1</max_velocity></plugin>";
}
const std::string tracked =
    "<model name='robot'>" + chassis("0.6 0.24 0.1", "0 0 0.12 0 0 0") + track("left", 0.2) + track("right", -0.2) +
    "<plugin filename='gz-sim-tracked-vehicle-system' name='gz::sim::systems::TrackedVehicle'><left_track><link>left"
    "</link></left_track><right_track><link>right</link></right_track><tracks_separation>0.4</tracks_separation>"
    "<tracks_height>0.1</tracks_height><steering_efficiency>0.38</steering_efficiency></plugin></model>";

TEST_P(Vehicles, WithTracksDriveAndTurnAsCommanded) {
  load(tracked);
  for (const double linear : {0.5, -0.3}) {
    const Motion motion = drive(linear, 0.0, 1.0);
    EXPECT_NEAR(motion.linear, linear, 0.01 * std::abs(linear));
    EXPECT_NEAR(motion.angular, 0.0, 1e-3);
  }
  for (const double angular : {0.5, -0.5}) {
    const Motion motion = drive(0.0, angular, 1.0);
    EXPECT_NEAR(motion.linear, 0.0, 0.01);
    EXPECT_NEAR(motion.angular, angular, 0.1 * std::abs(angular)) << "with the efficiency of its tracks";
  }
  const Motion fastest = drive(1.0, 0.9, 1.0);
  EXPECT_LT(fastest.linear, 0.95) << "the outer track is no faster than it may be";
  EXPECT_NEAR(height(), 0.0, 0.002);
}

std::string stone(int index, double x, double y, double size) {
  const std::string edge = std::to_string(size);
  return "<model name='stone" + std::to_string(index) + "'><pose>" + std::to_string(x) + " " + std::to_string(y) + " " +
         std::to_string(0.5 * size) + " 0 0 " + std::to_string(0.1 * index) +
         "</pose><link name='link'><inertial auto='true'><density>2500</density></inertial><collision name='c'>"
         "<geometry><box><size>" +
         edge + " " + edge + " " + edge + "</size></box></geometry></collision></link></model>";
}

// Stones between tracks and floor carry the vehicle: they are not pressed into the floor, at any step.
class OverStones : public Vehicles {
 protected:
  void expect_that_stones_carry(std::chrono::milliseconds step) {
    std::string stones;
    for (int i = 0; i < 32; ++i) {
      const int row = i / 4;
      const double y = (i % 2 == 0 ? 1.0 : -1.0) * (i % 4 < 2 ? 0.17 : 0.23);
      stones += stone(i, 0.4 + 0.06 * row, y, 0.01 + 0.004 * (i % 5));
    }
    load(tracked + stones);
    world_.world().step = step;
    world_.command(0, "cmd_vel/0/linear", {0.4});
    double deepest = 0.0;
    double highest = 0.0;
    for (auto ticks = std::chrono::seconds(2) / step; ticks > 0; --ticks) {
      world_.step();
      highest = std::max(highest, height());
      for (const physics::Contact& contact : world_.simulation().world().contacts())
        if (contact.body_a == BodyId{0} || contact.body_b == BodyId{0}) deepest = std::max(deepest, -contact.distance);
    }
    EXPECT_LT(deepest, 3e-4);
    EXPECT_GT(highest, 0.01) << "it was on the stones";
  }
};
INSTANTIATE_TEST_SUITE_P(Every, OverStones,
                         ::testing::Values(std::pair(Fidelity::articulated, Dynamics::cohort),
                                           std::pair(Fidelity::articulated, Dynamics::bullet)));

TEST_P(OverStones, TracksDriveWithLongSteps) { expect_that_stones_carry(std::chrono::milliseconds(10)); }
TEST_P(OverStones, TracksDriveWithShortSteps) { expect_that_stones_carry(std::chrono::milliseconds(2)); }

TEST_P(Vehicles, WithATrackControllerCarryTheirLoad) {
  load(
      "<model name='conveyor'><pose>0 0 0.5 0 0 0</pose><link name='base'>" + box_inertial(5.0, 0.5) +
      "<collision name='c'><geometry><box><size>5 0.4 0.1</size></box></geometry></collision></link><joint name='tie' "
      "type='fixed'><parent>world</parent><child>base</child></joint><plugin filename='gz-sim-track-controller-system' "
      "name='gz::sim::systems::TrackController'><link>base</link></plugin></model><model name='box'><pose>0 0 0.6 0 0 "
      "0</pose><link name='link'>" +
      box_inertial(1.0, 0.002) +
      "<collision name='c'><geometry><box><size>0.1 0.1 0.1</size></box></geometry></collision></link></model>");
  world_.command(0, "base/0/velocity", {0.5});
  world_.step(200);
  EXPECT_NEAR(world_.simulation().world().link_twist(BodyId{2}, LinkId{0}).linear_W.x(), 0.5, 1e-3);
}

TEST_P(Vehicles, WithJointControllersMoveJointsAsCommanded) {
  load("<model name='arm'><pose>0 0 1 0 0 0</pose><link name='base'>" + box_inertial(1.0, 0.1) +
       "</link><link name='a'>" + box_inertial(1.0, 0.1) + "</link><link name='b'>" + box_inertial(1.0, 0.1) +
       "</link><joint name='tie' type='fixed'><parent>world</parent><child>base</child></joint>" +
       axle("spin", "base", "a") + axle("place", "base", "b") +
       "<plugin filename='gz-sim-joint-controller-system' name='v'><joint_name>spin</joint_name></plugin>"
       "<plugin filename='gz-sim-joint-position-controller-system' name='p'><joint_name>place</joint_name></plugin>"
       "<plugin filename='gz-sim-joint-state-publisher-system' name='s'/></model>");
  world_.command(0, "spin/0/velocity", {2.0});
  world_.command(0, "place/0/position", {0.7});
  world_.step(100);
  EXPECT_NEAR(world_.read(0, "spin/0/velocity"), 2.0, 0.01);
  EXPECT_NEAR(world_.read(0, "place/0/position"), 0.7, 0.001);
}

// Four of RotorS's motors lift 1.5 kg.
TEST_P(Vehicles, WithMulticopterMotorsFly) {
  std::string copter =
      "<model name='copter'><pose>0 0 1 0 0 0</pose><link name='base'>" + box_inertial(1.46, 0.02) + "</link>";
  for (int i = 0; i < 4; ++i) {
    const std::string number = std::to_string(i);
    copter += "<link name='rotor_" + number + "'><pose>" + (i < 2 ? "0.2 " : "-0.2 ") + (i % 2 == 0 ? "0.2" : "-0.2") +
              " 0.05 0 0 0</pose>" + box_inertial(0.01, 1e-4) + "</link>" +
              axle("joint_" + number, "base", "rotor_" + number) +
              "<plugin filename='libignition-gazebo-multicopter-motor-model-system.so' name='m" + number +
              "'><jointName>joint_" + number + "</jointName><linkName>rotor_" + number +
              "</linkName><turningDirection>" + (i == 0 || i == 3 ? "ccw" : "cw") + "</turningDirection></plugin>";
  }
  load(copter + "</model>");
  const double velocity = std::sqrt(1.5 * 9.8 / 4.0 / 8.54858e-06);  // it hovers
  for (int i = 0; i < 4; ++i) world_.command(0, "joint_" + std::to_string(i) + "/0/velocity", {1.1 * velocity});
  world_.step(100);
  EXPECT_GT(height(), 1.5) << "1/2 0.21 g t^2 is 1 m, less drag and what the motors take to get there";
  EXPECT_LT(height(), 2.1);
}

TEST_P(Vehicles, WithAThrusterSwim) {
  load(
      "<plugin filename='gz-sim-buoyancy-system' name='gz::sim::systems::Buoyancy'><uniform_fluid_density>1000"
      "</uniform_fluid_density></plugin><model name='boat'><pose>0 0 1 0 0 0</pose><link name='hull'>" +
      box_inertial(7.999, 0.1) +
      "<collision name='c'><geometry><box><size>0.4 0.2 0.1</size></box></geometry></collision></link>"
      "<link name='propeller'><pose>-0.3 0 0 0 1.5707963267948966 0</pose>" +
      box_inertial(0.001, 1e-5) + "</link>" + axle("shaft", "hull", "propeller") +
      "<plugin filename='gz-sim-thruster-system' name='t'><joint_name>shaft</joint_name><propeller_diameter>0.1"
      "</propeller_diameter><thrust_coefficient>0.04</thrust_coefficient></plugin><plugin "
      "filename='gz-sim-hydrodynamics-system' name='h'><link_name>hull</link_name><xU>-10</xU><yV>-10</yV><zW>-10</zW>"
      "<kP>-5</kP><mQ>-5</mQ><nR>-5</nR></plugin></model>");
  const double motor_constant = 1000.0 * 0.04 * 1e-4;
  world_.command(0, "shaft/0/velocity", {std::sqrt(5.0 / motor_constant)});  // 5 N, as 10 N s/m at 0.5 m/s
  world_.step(500);
  const double before = forward();
  world_.step(100);
  EXPECT_NEAR(forward() - before, 0.5, 0.02);
}

}  // namespace
}  // namespace cohort::test
