// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/plugins/counterparts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "server/core/infinity.hpp"
#include "server/core/text.hpp"

// The parameters and their defaults are documented at the classes of the namespace gz::sim::systems of
// https://gazebosim.org/api/sim, and for classic plugins in the headers of
// https://github.com/ros-simulation/gazebo_ros_pkgs/tree/ros2/gazebo_plugins/include/gazebo_plugins.
namespace cohort::parsing {

namespace {

// Defaults for values that neither a plugin nor the limits of a joint give (docs/gazebo.md).
constexpr double usual_effort = 1000.0;           // [N m] or [N], as the greatest command of Gazebo's own controllers
constexpr double usual_velocity = 100.0;          // [rad/s] or [m/s]
constexpr double usual_position_velocity = 10.0;  // for position control

double mass_of(const Model& model) {
  double mass = 0.0;
  for (const Link& link : model.links) mass += link.inertial.mass;
  return mass;
}

using JointParameters = std::vector<std::pair<const Joint*, const Element*>>;

// Returns the smallest of these limits in <limit> of the joints, or else `fallback`.
double least_limit(const JointParameters& joints, double JointAxis::*limit, double fallback) {
  double least = infinity;
  for (const auto& [joint, parameter] : joints) least = std::min(least, joint->axis.*limit);
  return std::isfinite(least) ? least : fallback;
}

constexpr ParameterNames left_names = {"left_joint", "leftJoint"};
constexpr ParameterNames right_names = {"right_joint", "rightJoint"};

// Reads what all wheeled drives have: wheels, motors and maximum velocities.
void take_wheels(ModelPlugin& plugin, ModelPlugin::Values& values) {
  JointParameters wheels = plugin.joints(left_names);
  const JointParameters right = plugin.joints(right_names);
  wheels.insert(wheels.end(), right.begin(), right.end());
  for (const ParameterNames& names : {left_names, right_names})
    if (!plugin.first(names))
      plugin.report().problem(plugin.element(), "missing: the joint of a wheel", *names.begin());

  const double separation = plugin.number_or(1.0, {"wheel_separation", "wheelSeparation"});
  const auto diameter = plugin.number({"wheel_diameter", "wheelDiameter"});
  const double radius = plugin.number_or(diameter.value_or(0.4) / 2.0, {"wheel_radius"});
  // Enough for each wheel to lift the whole vehicle, since wheels in Gazebo have unlimited torque.
  const double strong = std::max(mass_of(plugin.model()) * 9.8 * radius, 1e-6);
  const double torque = plugin.number_or(least_limit(wheels, &JointAxis::max_effort, strong),
                                         {"max_wheel_torque", "wheelTorque", "torque"});
  const double spin = least_limit(wheels, &JointAxis::max_velocity, usual_velocity);
  const double linear = plugin.number_or(spin * radius, {"max_linear_velocity", "max_velocity"});
  const double angular = plugin.number_or(2.0 * spin * radius / separation, {"max_angular_velocity", "max_velocity"});
  // The limits backwards equal those forwards, so a minimum is read if it is the opposite of the maximum.
  const auto is_opposite = [&](const char* name, double greatest) {
    const Element* const least = plugin.element()->child(name);
    return least && parse_real(text_of_parameter(least)) == -greatest;
  };
  if (is_opposite("min_velocity", linear)) plugin.all({"min_velocity"});
  if (is_opposite("min_linear_velocity", linear)) plugin.all({"min_linear_velocity"});
  if (is_opposite("min_angular_velocity", angular)) plugin.all({"min_angular_velocity"});

  values.take("left_joint", left_names)
      .take("right_joint", right_names)
      .set("wheel_separation", separation)
      .set("wheel_radius", radius)
      .set("max_torque", torque)
      .set("max_linear", linear)
      .set("max_angular", angular);
}

}  // namespace

void diff_drive(ModelPlugin& plugin) {
  ModelPlugin::Values values = plugin.as<DifferentialDrive>();
  take_wheels(plugin, values);
  values.finish("cmd_vel");
}

void ackermann_steering(ModelPlugin& plugin) {
  ModelPlugin::Values values = plugin.as<AckermannDrive>();
  take_wheels(plugin, values);
  const double limit = plugin.number_or(0.5, {"steering_limit"});
  JointParameters steering = plugin.joints({"left_steering_joint"});
  const JointParameters right = plugin.joints({"right_steering_joint"});
  steering.insert(steering.end(), right.begin(), right.end());
  values.take("left_steering_joint", {"left_steering_joint"})
      .take("right_steering_joint", {"right_steering_joint"})
      .take("wheel_base", {"wheel_base"}, "1")
      .take("kingpin_width", {"kingpin_width"}, "0.8")
      // The limit of Gazebo applies to the sine: asin(wheel base / turning radius).
      .set("steering_limit", std::atan(std::sin(std::min(limit, 0.5 * std::numbers::pi))))
      .set("max_steering_velocity", least_limit(steering, &JointAxis::max_velocity, usual_position_velocity))
      .set("max_steering_torque", least_limit(steering, &JointAxis::max_effort, usual_effort))
      .finish("cmd_vel");
}

namespace {

// Completes a motor that represents the controller of one joint.
void finish_motor(ModelPlugin::Values values, const Joint& joint, const Element* parameter, double velocity,
                  double effort) {
  values.set("joint", text_of_parameter(parameter), parameter)
      .set("max_velocity", least_limit({{&joint, parameter}}, &JointAxis::max_velocity, velocity))
      .set("max_effort", least_limit({{&joint, parameter}}, &JointAxis::max_effort, effort))
      .finish(text_of_parameter(parameter));
}

constexpr ParameterNames joint_names = {"joint_name", "jointName"};

void need_joint(ModelPlugin& plugin) {
  if (!plugin.first(joint_names))
    plugin.report().problem(plugin.element(), "missing: the joint that the plugin moves", *joint_names.begin());
}

}  // namespace

void joint_controller(ModelPlugin& plugin) {
  need_joint(plugin);
  const double effort = plugin.text_or("false", {"use_force_commands"}) == "true"
                            ? plugin.number_or(usual_effort, {"cmd_max"})
                            : usual_effort;
  for (const auto& [joint, parameter] : plugin.joints(joint_names))
    finish_motor(plugin.as<VelocityMotor>(), *joint, parameter, usual_velocity, effort);
}

void joint_position_controller(ModelPlugin& plugin) {
  need_joint(plugin);
  // The maximum output of the controller is a velocity or an effort.
  const bool gives_velocity = plugin.text_or("false", {"use_velocity_commands"}) == "true";
  const auto greatest = plugin.number({"cmd_max"});
  const double velocity = gives_velocity ? greatest.value_or(usual_position_velocity) : usual_position_velocity;
  const double effort = gives_velocity ? usual_effort : greatest.value_or(usual_effort);
  for (const auto& [joint, parameter] : plugin.joints(joint_names))
    finish_motor(plugin.as<PositionMotor>(), *joint, parameter, velocity, effort);
}

void joint_state_publisher(ModelPlugin& plugin) {
  const auto encode = [&](const std::string& name, const Element* where) {
    plugin.as<JointEncoder>().set("joint", name, where).finish(name);
  };
  if (plugin.first(joint_names)) {
    for (const auto& [joint, parameter] : plugin.joints(joint_names)) encode(text_of_parameter(parameter), parameter);
    return;
  }
  for (const Joint& joint : plugin.model().joints)
    if (plugin.has_joint(joint) && facts_of(joint.type).axes > 0) encode(plugin.without_scope(joint.name), nullptr);
}

namespace {

// The body that carries a propeller on the joint `joint`, and the pose of the child of the joint in it.
struct Carrier {
  std::string link;
  Pose X_LC;
};
std::optional<Carrier> carrier_of(ModelPlugin& plugin, const Joint& joint, const Element* parameter) {
  if (joint.parent == Joint::world) {
    plugin.report().problem(parameter, "expected a propeller joint whose parent is a link, not the world");
    return std::nullopt;
  }
  const Link& parent = plugin.model().links[joint.parent];
  return Carrier{plugin.without_scope(parent.name), parent.X_ML.inverse() * plugin.model().links[joint.child].X_ML};
}

}  // namespace

void multicopter_motor_model(ModelPlugin& plugin) {
  need_joint(plugin);
  plugin.all({"linkName"});  // it is that of the joint
  if (const Element* const type = plugin.first({"motorType"}); type && text_of_parameter(type) != "velocity")
    plugin.report().warning(type, "is not supported: motors are commanded by velocity");
  for (const auto& [joint, parameter] : plugin.joints(joint_names))
    if (const auto carrier = carrier_of(plugin, *joint, parameter))
      plugin.as<Rotor>()
          .set("link", carrier->link, parameter)
          .set("pose", carrier->X_LC)
          .take("direction", {"turningDirection"}, "cw")
          .take("max_velocity", {"maxRotVelocity"}, "838")
          .take("motor_constant", {"motorConstant"}, "8.54858e-06")
          .take("moment_constant", {"momentConstant"}, "0.016")
          .take("drag_coefficient", {"rotorDragCoefficient"}, "1e-4")
          .take("rolling_moment_coefficient", {"rollingMomentCoefficient"}, "1e-6")
          .take("time_constant_up", {"timeConstantUp"}, "0.0125")
          .take("time_constant_down", {"timeConstantDown"}, "0.025")
          .finish(text_of_parameter(parameter));
}

// Returns the smallest rotation from the z axis to `axis`, of length 1. (That of Eigen would decompose a matrix, which
// takes a third of the compile time of this file.)
Eigen::Quaterniond from_z_to(const Eigen::Vector3d& axis) {
  constexpr double nearly_opposite = 1e-12;
  if (1.0 + axis.z() < nearly_opposite) return {0.0, 1.0, 0.0, 0.0};
  return Eigen::Quaterniond(1.0 + axis.z(), -axis.y(), axis.x(), 0.0).normalized();
}

void thruster(ModelPlugin& plugin) {
  need_joint(plugin);
  const double density = plugin.number_or(1000.0, {"fluid_density"});
  const double diameter = plugin.number_or(0.02, {"propeller_diameter"});
  const double coefficient = plugin.number_or(1.0, {"thrust_coefficient"});
  const double greatest = plugin.number_or(1000.0, {"max_thrust_cmd"});
  const double least = plugin.number_or(-1000.0, {"min_thrust_cmd"}, ExtensionValue::real);
  const double squared = diameter * diameter;
  const double motor_constant = density * coefficient * squared * squared;
  for (const auto& [joint, parameter] : plugin.joints(joint_names)) {
    const auto carrier = carrier_of(plugin, *joint, parameter);
    if (!carrier) continue;
    const Pose X_LJ = carrier->X_LC * joint->X_LJ;
    const Eigen::Quaterniond to_axis = from_z_to(X_LJ.orientation * joint->axis.direction);
    plugin.as<Rotor>()
        .set("link", carrier->link, parameter)
        .set("pose", Pose{X_LJ.position, to_axis})
        .set("max_velocity", std::sqrt(greatest / motor_constant))
        .set("min_velocity", -std::sqrt(std::max(-least, 0.0) / motor_constant))
        .set("motor_constant", motor_constant)
        .set("density", density)
        .finish(text_of_parameter(parameter));
  }
}

namespace {

// Returns the link on which a plugin acts; nothing, with a report, if it names none.
std::optional<std::string> link_of(ModelPlugin& plugin) {
  const Element* const parameter = plugin.first({"link_name"});
  if (!parameter) {
    plugin.report().problem(plugin.element(), "missing: the link on which the plugin acts", "link_name");
    return std::nullopt;
  }
  const std::string name = text_of_parameter(parameter);
  std::vector<std::string> names;
  for (const Link& link : plugin.model().links) {
    if (plugin.has_link(link, name)) return name;
    names.push_back(link.name);
  }
  plugin.report().problem(parameter, "the model has no link '" + name + "'" + suggestion(name, names));
  return std::nullopt;
}

}  // namespace

void lift_drag(ModelPlugin& plugin) {
  const std::optional<std::string> link = link_of(plugin);
  const Eigen::Vector3d forward = plugin.vector({"forward"}).value_or(Eigen::Vector3d::UnitX());
  const Eigen::Vector3d upward = plugin.vector({"upward"}).value_or(Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d aside = upward.cross(forward);
  constexpr double parallel = 1e-6;
  if (!(aside.norm() > parallel * upward.norm() * forward.norm())) {
    plugin.report().problem(plugin.element(), "expected <forward> and <upward> to be nonzero and not parallel");
    return;
  }
  Eigen::Matrix3d axes;
  axes.col(0) = forward.normalized();
  axes.col(1) = aside.normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  const Pose X_LF{plugin.vector({"cp"}).value_or(Eigen::Vector3d::Zero()), Eigen::Quaterniond(axes)};
  ModelPlugin::Values values = plugin.as<Fin>();
  values.set("pose", X_LF)
      .take("area", {"area"}, "1")
      .take("alpha0", {"a0"}, "0")
      .take("cla", {"cla"}, "1")
      .take("cda", {"cda"}, "0.01")
      .take("cla_stall", {"cla_stall"}, "0")
      .take("cda_stall", {"cda_stall"}, "1")
      // Beyond a quarter turn, the flow comes from behind.
      .set("alpha_stall", std::min(plugin.number_or(0.5 * std::numbers::pi, {"alpha_stall"}), 0.5 * std::numbers::pi));
  if (link) values.finish("lift_drag", *link);
}

// Gazebo gives damping as derivatives of the force, which are negative for damping.
void hydrodynamics(ModelPlugin& plugin) {
  const std::optional<std::string> link = link_of(plugin);
  const auto damping = [&](const std::initializer_list<ParameterNames>& axes) {
    std::string text;
    for (const ParameterNames& names : axes) {
      const double value = plugin.number_or(0.0, names, ExtensionValue::real);
      if (value > 0.0)
        plugin.report().problem(plugin.first(names),
                                "expected a value of at most 0; a positive value would accelerate the link");
      text += shortest_text(std::abs(value)) + " ";
    }
    return text;
  };
  ModelPlugin::Values values = plugin.as<Drag>();
  values.set("damping", damping({{"xU"}, {"yV"}, {"zW"}}))
      .set("quadratic_damping", damping({{"xUU", "xUabsU"}, {"yVV", "yVabsV"}, {"zWW", "zWabsW"}}))
      .set("angular_damping", damping({{"kP"}, {"mQ"}, {"nR"}}))
      .set("quadratic_angular_damping", damping({{"kPP", "kPabsP"}, {"mQQ", "mQabsQ"}, {"nRR", "nRabsR"}}));
  plugin.all({"water_density", "waterDensity"});  // it defines no damping
  if (link) values.finish("hydrodynamics", *link);
}

void detachable_joint(ModelPlugin& plugin) {
  plugin.all({"detach_topic", "attach_topic", "output_topic"});
  plugin.as<DetachableJoint>()
      .take("link", {"parent_link"})
      .take("child", {"child_model"})
      .take("child_link", {"child_link"})
      .take("may_be_missing", {"suppress_child_warning"}, "false")
      .take("initially_attached", {"initial_attach"}, "true")
      .finish(plugin.text_or("detachable_joint", {"child_model"}));
}

void linear_battery(ModelPlugin& plugin) {
  constexpr double seconds_of_hour = 3600.0;
  const auto voltage = plugin.number({"voltage"});
  const auto open_circuit = plugin.number({"open_circuit_voltage_constant_coef"});
  const auto capacity = plugin.number({"capacity"});  // [A h]
  if (!voltage && !open_circuit) plugin.report().problem(plugin.element(), "missing: a voltage > 0", "voltage");
  if (!capacity) plugin.report().problem(plugin.element(), "missing: a capacity > 0 in A h", "capacity");
  const Element* const charge = plugin.first({"initial_charge"});
  const double charged = plugin.number_or(capacity.value_or(1.0), {"initial_charge"}, ExtensionValue::non_negative);
  const std::string name = plugin.text_or("battery", {"battery_name"});
  if (!capacity || (!voltage && !open_circuit)) return;
  plugin.as<Battery>()
      .set("capacity", *capacity * seconds_of_hour * voltage.value_or(open_circuit.value_or(0.0)))
      .set("charge", charged / *capacity, charge)
      .take("idle_power", {"power_load"}, "0")
      .finish(name);
}

// Sets water up to the next layer; layers below this density are air.
void buoyancy(Plugin& plugin, World& world) {
  constexpr double lightest_water = 100.0;  // [kg/m^3]
  constexpr double above_all = 1e6;         // [m]
  double density = plugin.number_or(1000.0, {"uniform_fluid_density"});
  double level = above_all;
  if (const Element* const layers = plugin.first({"graded_buoyancy"})) {
    Plugin graded(layers, plugin.report());
    density = graded.number_or(1000.0, {"default_density"});
    const std::vector<const Element*> changes = graded.all({"density_change"});
    if (!changes.empty()) {
      Plugin change(changes.front(), plugin.report());
      level = change.number_or(0.0, {"above_depth"}, ExtensionValue::real);
      world.air.density = change.number_or(world.air.density, {"density"}, ExtensionValue::non_negative);
      change.warn_of_unread();
    }
    if (changes.size() > 1) plugin.report().warning(changes[1], "is not supported: the only fluids are water and air");
    graded.warn_of_unread();
  }
  if (density < lightest_water)
    world.air.density = density;
  else
    world.water = Water{level, density, Eigen::Vector3d::Zero()};
}

void wind_effects(Plugin& plugin, World& world) {
  if (const auto factor = plugin.number({"force_approximation_scaling_factor"}, ExtensionValue::non_negative))
    world.air.wind_force = *factor;
}

}  // namespace cohort::parsing
