// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/figures/figures.hpp"
#include "tests/figures/stand.hpp"

namespace cohort::figures {
namespace {

constexpr double depth = 0.015;
constexpr double jaw_height = 0.02;  // in the turret [m]
constexpr double closing_time = 0.5;
constexpr int closing_ticks = 60;
constexpr double gap = 0.005;       // between jaw and sled [m]
constexpr double sled_half = 0.01;  // [m]

description::Gripper gripper_at(double bearing) {
  description::Gripper gripper;
  gripper.name = "gripper";
  gripper.link = turret;
  gripper.X_LG = at(turret_radius * std::cos(bearing), turret_radius * std::sin(bearing), jaw_height, bearing);
  gripper.depth = depth;
  gripper.half_angle = 0.6;
  gripper.height = 0.01;
  gripper.closing_time = closing_time;
  return gripper;
}

description::Model robot_with(const description::Gripper& gripper) {
  description::Model model = held_robot();
  model.devices.push_back(description::VelocityMotor{"turret", 0, 1.5, 0.3});
  model.devices.push_back(gripper);
  model.devices.push_back(description::TractionSensor{"traction", 0, {}});
  return model;
}

// Slides along its x axis and pulls itself away by a commanded force.
description::Model sled() {
  constexpr double mass = 5.0;
  description::Model model;
  model.name = "sled";
  description::Inertial inertial;
  inertial.mass = mass;
  inertial.inertia = 0.01 * Eigen::Matrix3d::Identity();
  description::Surface surface{0.5, 0.0};
  surface.is_grippable = true;
  model.links.push_back(
      {"sled", {}, inertial, {{"block", {}, description::Box{{2.0 * sled_half, 0.02, 0.02}}, surface}}});
  description::Joint joint;
  joint.name = "rail";
  joint.type = description::JointType::prismatic;
  joint.parent = description::Joint::world;
  joint.child = 0;
  joint.axis.direction = Eigen::Vector3d::UnitX();
  model.joints.push_back(joint);
  model.devices.push_back(description::EffortMotor{"pull", 0, 20.0});
  return model;
}

// The sled before the jaw, which has closed.
class Pull {
 public:
  explicit Pull(const description::Gripper& gripper, double bearing = 0.0) {
    const double away = turret_radius + gap + sled_half;
    stand_.add(robot_with(gripper));
    stand_.add(sled(), at(away * std::cos(bearing), away * std::sin(bearing), turret_height + jaw_height, bearing));
    stand_.command("gripper/0/opening", {0.0});
    stand_.step(closing_ticks);
  }
  void by(double force) {
    stand_.command("pull/0/effort", {force}, 1);
    stand_.step(20);
  }
  double read(const std::string& channel) { return stand_.read(channel); }

 private:
  Stand stand_;
};

Panel opening() {
  Stand stand;
  stand.add(robot_with(gripper_at(0.0)));
  stand.command("gripper/0/opening", {1.0});
  stand.step(closing_ticks);
  const double start = stand.time();
  stand.command("gripper/0/opening", {0.0});
  Series series{"", {}};
  for (int tick = 0; tick <= closing_ticks; ++tick) {
    if (tick % 3 == 0) series.measured.emplace_back(stand.time() - start, stand.read("gripper/0/opening"));
    stand.step();
  }
  series.closed_form = [](double t) { return std::max(0.0, 1.0 - t / closing_time); };
  series.tolerance = 1e-9;
  return {"Gripper: commanded to close", "line: 1 - t / 0.5 s", "time t [s]", "opening", {series}};
}

Panel light_barrier() {
  Panel panel{
      "Light barrier", "lines: depth of the jaw, half of it", "distance of a block of 2 cm [m]", "object detected", {}};
  using Kind = description::Gripper::LightBarrier;
  for (const Kind kind : {Kind::simple, Kind::beam}) {
    const auto measure = [&](double d) {
      Stand stand;
      description::Gripper gripper = gripper_at(0.0);
      gripper.light_barrier = kind;
      stand.add(robot_with(gripper));
      stand.add(sled(), at(turret_radius + d + sled_half, 0, turret_height + jaw_height));
      return stand.read("gripper/0/grippable");
    };
    const double reach = kind == Kind::simple ? depth : 0.5 * depth;
    panel.series.push_back(measured_at(
        evenly(0.0002, 0.0202, 41), measure, [reach](double d) { return d <= reach ? 1.0 : 0.0; }, exact,
        kind == Kind::simple ? "simple" : "beam"));
  }
  return panel;
}

Series pulled(const description::Gripper& gripper, const std::string& channel, std::function<double(double)> expected) {
  Pull pull(gripper);
  const auto measure = [&](double force) {
    pull.by(force);
    return pull.read(channel);
  };
  return measured_at(evenly(0.0, 10.0, 21), measure, std::move(expected), 1e-6);
}

Panel slipping() {
  static constexpr double holding = 6.0;
  description::Gripper gripper = gripper_at(0.0);
  gripper.holding_force = holding;
  return {"Gripper: slips above 6 N",
          "line: min(F, 6 N)",
          "pull F [N]",
          "force in the gripper [N]",
          {pulled(gripper, "gripper/0/force", [](double force) { return std::min(force, holding); })}};
}

Panel breaking() {
  static constexpr double limit = 5.25;
  description::Gripper gripper = gripper_at(0.0);
  gripper.breaking_force = limit;
  return {"Gripper: releases above 5.25 N",
          "line: F, then 0",
          "pull F [N]",
          "force in the gripper [N]",
          {pulled(gripper, "gripper/0/force", [](double force) { return force < limit ? force : 0.0; })}};
}

Panel traction() {
  return {"Traction sensor: intensity",
          "line: equal",
          "pull at the gripper [N]",
          "intensity [N]",
          {pulled(gripper_at(0.0), "traction/0/intensity", std::identity())}};
}

// A grip yields so little that the rounding of places gives forces of a ten-millionth of a newton.
Panel direction() {
  const auto measure = [](double bearing) {
    Pull pull(gripper_at(degree * bearing), degree * bearing);
    pull.by(5.0);
    return pull.read("traction/0/direction") / degree;
  };
  return {"Traction sensor: direction",
          "line: equal",
          "direction of a pull of 5 N [degrees]",
          "direction [degrees]",
          {measured_at(evenly(-165.0, 165.0, 23), measure, std::identity(), 3e-6)}};
}

}  // namespace

Page gripping() {
  return {"gripping",
          "Gripper, light barrier and traction sensor",
          {opening(), light_barrier(), slipping(), breaking(), traction(), direction()}};
}

}  // namespace cohort::figures
