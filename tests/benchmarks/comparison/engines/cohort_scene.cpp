// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/engines/cohort_scene.hpp"

#include <cmath>
#include <utility>

#include "server/description/world_in_code.hpp"

namespace cohort::bench {
namespace {

using description::Cylinder;
using description::Joint;
using description::Model;
using description::Sphere;

description::Inertial inertial(const CylinderBody& body, double link_z) {
  return description::solid_cylinder(body.mass, body.radius, body.height, body.z - link_z);
}

Joint revolute(const std::string& name, std::size_t child, const Eigen::Vector3d& axis) {
  Joint joint;
  joint.name = name;
  joint.type = description::JointType::revolute;
  joint.child = child;
  joint.axis.direction = axis;
  return joint;
}

void add_wheel(Model& model, const std::string& name, double y, const Robot& robot) {
  const Pose X_ML{{0.0, y, robot.wheel_radius}};
  model.joints.push_back(revolute(name, model.links.size(), Eigen::Vector3d::UnitY()));
  model.links.push_back({name,
                         X_ML,
                         description::solid_sphere(robot.wheel_mass, robot.wheel_radius),
                         {{"tyre", {}, Sphere{robot.wheel_radius}, {robot.track_friction}}}});
  model.devices.push_back(description::VelocityMotor{name, model.joints.size() - 1,
                                                     robot.max_speed / robot.wheel_radius, robot.max_torque});
}

void add_caster(Model& model, double x, const Robot& robot) {
  const Pose X_LC{{x, 0.0, robot.caster_radius + robot.caster_clearance}};
  model.links[0].collisions.push_back(
      {x > 0.0 ? "front_caster" : "back_caster", X_LC, Sphere{robot.caster_radius}, {0.0}});
}

Model robot_model(const Robot& robot, Drive drive) {
  const bool has_wheels = drive == Drive::wheels;
  const double turret_z = robot.turret_joint_height;
  Model model;
  model.name = "robot";
  model.links.push_back(
      {"chassis",
       {},
       inertial(has_wheels ? robot.chassis_without_wheels() : robot.chassis, 0.0),
       {{"hull", {{0.0, 0.0, robot.hull_z}}, Cylinder{robot.hull_radius, robot.hull_height}, {robot.friction}}}});
  model.links.push_back({"turret",
                         {{0.0, 0.0, turret_z}},
                         inertial(robot.turret, turret_z),
                         {{"shell",
                           {{0.0, 0.0, robot.turret.z - turret_z}},
                           Cylinder{robot.turret.radius, robot.turret.height},
                           {robot.friction}}}});
  model.joints.push_back(revolute("turret", turret_link, Eigen::Vector3d::UnitZ()));
  if (has_wheels) {
    add_wheel(model, "left_wheel", robot.half_gauge, robot);
    add_wheel(model, "right_wheel", -robot.half_gauge, robot);
    add_caster(model, robot.caster_x, robot);
    add_caster(model, -robot.caster_x, robot);
  } else {
    description::TreelDrive treel;
    treel.name = "treel";
    treel.half_gauge = robot.half_gauge;
    treel.half_contact_length = robot.half_contact_length;
    treel.wheel_radius = robot.wheel_radius;
    treel.max_torque = robot.max_torque;
    treel.max_velocity = robot.max_speed;
    treel.friction = robot.track_friction;
    model.devices.push_back(std::move(treel));
  }
  model.devices.push_back(
      description::VelocityMotor{"turret", turret_joint, robot.max_turret_rate, robot.max_turret_torque});
  return model;
}

}  // namespace

void place_static(description::World& world, const description::Shape& shape, double friction, const Pose& X_WM) {
  const std::string name = "static_" + std::to_string(world.models.size());
  place(world, description::static_shape(name, shape, {friction}), name, X_WM);
}

description::World describe(const Scene& scene, description::Dynamics dynamics) {
  description::World world;
  world.name = "bench";
  world.step = std::chrono::nanoseconds(std::llround(1e9 * scene.step));
  world.gravity = {0.0, 0.0, -scene.gravity};
  world.physics.dynamics = dynamics;
  world.physics.sleeping = false;
  world.physics.strict = true;  // a failing body must be reported, not removed
  if (scene.drive == Drive::wheels) world.physics.fidelity = description::Fidelity::articulated;
  if (scene.planar) world.physics.fidelity = description::Fidelity::planar;
  place_static(world, description::Plane{}, scene.ground_friction, {});
  for (const Wall& wall : scene.walls())
    place_static(world, description::Box{wall.size}, scene.robot.friction, {wall.centre});
  world.models.push_back(robot_model(scene.robot, scene.drive));
  for (std::size_t i = 0; i < scene.robots.size(); ++i) {
    const Placement& placement = scene.robots[i];
    place(world, world.models.size() - 1, "robot_" + std::to_string(i),
          description::at(placement.x, placement.y, 0.0, placement.yaw));
  }
  return world;
}

}  // namespace cohort::bench
