// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/figures/figures.hpp"
#include "tests/figures/stand.hpp"

namespace cohort::figures {
namespace {

constexpr double g = 9.81;  // [m/s^2]

// Response of the tracked robot: both tracks push with torque / radius until the speed is there.
constexpr double mass = 0.7;                 // [kg]
constexpr double push = 2.0 * 0.02 / 0.022;  // [N]

Panel treels() {
  static constexpr double speed = 0.15;
  Stand stand;
  description::Model model = tracked_robot();
  model.devices.push_back(description::TreelEncoder{"encoder", 0, {}});
  const std::uint32_t robot = stand.add(model);
  stand.command("treel/left/velocity", {speed});
  stand.command("treel/right/velocity", {speed});
  Series ground{"hull", {}};
  Series encoder{"treel encoder", {}};
  for (int tick = 0; tick <= 16; ++tick) {
    ground.measured.emplace_back(stand.time(),
                                 stand.simulation().world().link_twist(BodyId{robot}, LinkId{chassis}).linear_W.x());
    encoder.measured.emplace_back(stand.time(), stand.read("encoder/left/velocity"));
    stand.step();
  }
  ground.closed_form = [](double t) { return std::min(speed, push / mass * t); };
  ground.tolerance = 1e-4;
  encoder.closed_form = ground.closed_form;
  encoder.tolerance = 1e-4;
  return {
      "Treels: commanded 0.15 m/s", "line: min(0.15, 2 T t / (r m))", "time t [s]", "speed [m/s]", {ground, encoder}};
}

Panel way() {
  Stand stand;
  description::Model model = tracked_robot();
  model.devices.push_back(description::TreelEncoder{"encoder", 0, {}});
  const std::uint32_t robot = stand.add(model);
  stand.command("treel/left/velocity", {0.2});
  stand.command("treel/right/velocity", {0.2});
  Series series{"", {}};
  for (int tick = 0; tick <= 100; ++tick) {
    if (tick % 5 == 0)
      series.measured.emplace_back(stand.simulation().object_pose(robot).position.x(),
                                   stand.read("encoder/left/position"));
    stand.step();
  }
  series.closed_form = [](double x) { return x; };
  series.tolerance = 1e-6;
  return {"Treel encoder", "line: equal", "distance travelled by the hull [m]", "track travel [m]", {series}};
}

Panel turret_rate() {
  static constexpr double torque = 1e-3;
  static constexpr double rate = 1.0;
  static constexpr double inertia = 0.5 * 0.3 * turret_radius * turret_radius;
  Stand stand;
  description::Model model = held_robot();
  model.devices.push_back(description::VelocityMotor{"turret", 0, 1.5, torque});
  model.devices.push_back(description::JointEncoder{"encoder", 0, {}});
  stand.add(model);
  stand.command("turret/0/velocity", {rate});
  Series series{"joint encoder", {}};
  for (int tick = 0; tick <= 80; ++tick) {
    if (tick % 4 == 0) series.measured.emplace_back(stand.time(), stand.read("encoder/0/velocity"));
    stand.step();
  }
  series.closed_form = [](double t) { return std::min(rate, torque / inertia * t); };
  series.tolerance = 1e-6;
  return {"Turret: commanded 1 rad/s", "line: min(1, T t / J), T = 1 mN m", "time t [s]", "rate [rad/s]", {series}};
}

// A robot that the world holds, with an arm of 0.2 kg whose middle is 0.05 m from its joint; positive angles lift it.
constexpr double arm_mass = 0.2;
constexpr double arm_middle = 0.05;

description::Model robot_with_arm() {
  description::Model model = held_robot();
  description::Inertial inertial;
  inertial.mass = arm_mass;
  inertial.X_LI.position.x() = arm_middle;
  inertial.inertia = 1e-4 * Eigen::Matrix3d::Identity();
  model.links.push_back({"arm", {{0.03, 0.0, turret_height + 0.02}}, inertial, {}});
  description::Joint joint;
  joint.name = "elevation";
  joint.type = description::JointType::revolute;
  joint.parent = turret;
  joint.child = 2;
  joint.axis.direction = -Eigen::Vector3d::UnitY();
  joint.axis.lower = -1.6;
  joint.axis.upper = 1.6;
  model.joints.push_back(joint);
  const std::size_t elevation = model.joints.size() - 1;
  model.devices.push_back(description::VelocityMotor{"turret", 0, 1.5, 0.3});
  model.devices.push_back(description::PositionMotor{"elevation", elevation, 1.0, 2.0});
  model.devices.push_back(description::JointEncoder{"encoder", elevation, {}});
  model.devices.push_back(description::TorqueSensor{"torque", elevation, {}});
  return model;
}

Panel elevation() {
  static constexpr double target = 0.5;
  Stand stand;
  stand.add(robot_with_arm());
  stand.command("elevation/0/position", {target});
  Series series{"joint encoder", {}};
  for (int tick = 0; tick <= 100; ++tick) {
    if (tick % 4 == 0) series.measured.emplace_back(stand.time(), stand.read("encoder/0/position"));
    stand.step();
  }
  series.closed_form = [](double t) { return std::min(target, t); };
  series.tolerance = 1e-3;
  return {"Elevation: commanded 0.5 rad", "line: min(0.5, t · 1 rad/s)", "time t [s]", "angle [rad]", {series}};
}

Panel torque() {
  const auto measure = [](double angle) {
    Stand stand;
    stand.add(robot_with_arm());
    stand.command("elevation/0/position", {degree * angle});
    stand.step(300);
    return stand.read("torque/0/torque");
  };
  const auto expected = [](double angle) { return arm_mass * g * arm_middle * std::cos(degree * angle); };
  return {"Torque sensor: an arm held up",
          "line: m g l cos a; 0.2 kg, 0.05 m",
          "angle a of the arm [degrees]",
          "torque [N m]",
          {measured_at(evenly(-80.0, 80.0, 33), measure, expected, 1e-5)}};
}

description::Model feeling_robot() {
  description::Model model = held_robot();
  model.devices.push_back(description::Accelerometer{"accelerometer", chassis, {}, {}});
  model.devices.push_back(description::Inclinometer{"inclinometer", chassis, {}, {}});
  return model;
}

Panel accelerometer() {
  Series x{"x", {}};
  Series up{"z", {}};
  for (const double pitch : evenly(-90.0, 90.0, 25)) {
    Stand stand;
    stand.add(feeling_robot(), leaning(degree * pitch));
    stand.step(2);
    x.measured.emplace_back(pitch, stand.read("accelerometer/0/acceleration", 0));
    up.measured.emplace_back(pitch, stand.read("accelerometer/0/acceleration", 2));
  }
  x.closed_form = [](double pitch) { return -g * std::sin(degree * pitch); };
  up.closed_form = [](double pitch) { return g * std::cos(degree * pitch); };
  x.tolerance = up.tolerance = 1e-6;
  return {
      "Accelerometer at rest", "lines: -g sin(pitch), g cos(pitch)", "pitch [degrees]", "acceleration [m/s²]", {x, up}};
}

Panel getting_going() {
  static constexpr double speed = 0.15;
  Stand stand;
  description::Model model = tracked_robot();
  model.devices.push_back(description::Accelerometer{"accelerometer", chassis, {{0.0, 0.0, 0.033}}, {}});
  stand.add(model);
  stand.step(20);
  const double start = stand.time();
  stand.command("treel/left/velocity", {speed});
  stand.command("treel/right/velocity", {speed});
  Series series{"", {}};
  for (int tick = 0; tick < 12; ++tick) {
    stand.step();
    series.measured.emplace_back(stand.time() - start, stand.read("accelerometer/0/acceleration"));
  }
  // The mean over the tick that ends at t.
  series.closed_form = [](double t) {
    constexpr double tick = 0.01;
    const auto reached = [](double time) { return std::min(speed, push / mass * std::max(0.0, time)); };
    return (reached(t) - reached(t - tick)) / tick;
  };
  series.tolerance = 1e-2;
  return {"Accelerometer: starting to drive",
          "line: change of speed in a tick",
          "time [s]",
          "acceleration along x [m/s²]",
          {series}};
}

Panel inclinometer() {
  Series pitch{"pitch", {}};
  Series roll{"roll", {}};
  for (const double angle : evenly(-60.0, 60.0, 25)) {
    Stand stand;
    stand.add(feeling_robot(), leaning(degree * angle));
    Pose aside = leaning(0.0);
    aside.orientation = Eigen::AngleAxisd(degree * angle, Eigen::Vector3d::UnitX());
    aside.position.y() = 1.0;
    stand.add(feeling_robot(), aside);
    pitch.measured.emplace_back(angle, stand.read("inclinometer/0/pitch") / degree);
    roll.measured.emplace_back(angle, stand.read("inclinometer/0/roll", 0, 1) / degree);
  }
  pitch.closed_form = roll.closed_form = [](double angle) { return angle; };
  pitch.tolerance = roll.tolerance = 1e-9;
  return {"Inclinometer", "line: equal", "tilt [degrees]", "reading [degrees]", {pitch, roll}};
}

}  // namespace

Page motion() {
  return {"motion",
          "Treels, joints and motion sensors",
          {treels(), way(), turret_rate(), elevation(), torque(), accelerometer(), getting_going(), inclinometer()}};
}

}  // namespace cohort::figures
