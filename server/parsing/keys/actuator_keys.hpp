// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "server/description/model.hpp"
#include "server/parsing/keys/key_table.hpp"
#include "server/parsing/parsing.hpp"

/// Tables of actuators: drives, motors, rotors, LEDs, loudspeakers.
namespace cohort::parsing::keys {

using enum ExtensionValue;
using enum Referent;
using enum Written;

template <>
inline constexpr auto table_of<TreelDrive> = KeyTable{
    actuator("treel_drive", "Two tracks that share one rigid body, as on the s-bot."),
    reference("link", &TreelDrive::link, root_link, "", "link that carries the tracks; it must be the root link"),
    key("half_gauge", &TreelDrive::half_gauge, positive, "m", "",
        "distance of the contact points from the x axis of the link, which is half the track gauge"),
    key("half_contact_length", &TreelDrive::half_contact_length, positive, "m", "",
        "distance of the contact points from the y axis of the link"),
    key("ground_height", &TreelDrive::ground_height, real, "m", "",
        "z coordinate of the contact points in the link frame"),
    key("wheel_radius", &TreelDrive::wheel_radius, positive, "m", "",
        "wheel radius; traction is motor torque / wheel radius"),
    key("max_torque", &TreelDrive::max_torque, positive, "N m", "", "maximum torque of the motor on each side"),
    key("max_velocity", &TreelDrive::max_velocity, positive, "m/s", "",
        "maximum velocity of each track along the ground"),
    key("friction", &TreelDrive::friction, non_negative, "1", "",
        "Coulomb friction coefficient of the tracks; each contact uses the smaller coefficient of the two surfaces"),
    reference("left_wheel", &TreelDrive::left_wheels, wheel_joint, no_value,
              "joint of a wheel that the left track replaces; may be repeated"),
    reference("right_wheel", &TreelDrive::right_wheels, wheel_joint, no_value,
              "joint of a wheel that the right track replaces; may be repeated"),
};

template <class Motor>
constexpr auto velocity_motor(std::string_view element, std::string_view about) {
  return KeyTable{
      actuator(element, about),
      reference("joint", &Motor::joint, driven_joint, "", "driven joint; a joint can have at most one motor"),
      key("max_velocity", &Motor::max_velocity, positive, "rad/s or m/s", "", "maximum velocity"),
      key("max_effort", &Motor::max_effort, positive, "N m or N", "", "maximum torque or force"),
      key("rotor_inertia", &Motor::rotor_inertia, non_negative, "kg m^2 or kg", "0",
          "rotor inertia reflected to the joint", unless_default),
  };
}
template <>
inline constexpr auto table_of<VelocityMotor> =
    velocity_motor<VelocityMotor>("velocity_motor", "A motor that controls the velocity of one joint.");

template <>
inline constexpr auto table_of<PositionMotor> =
    velocity_motor<PositionMotor>("position_motor", "A motor that moves one joint to a position and holds it there.");

template <>
inline constexpr auto table_of<EffortMotor> = KeyTable{
    actuator("effort_motor", "A motor that applies the commanded torque or force to one joint."),
    reference("joint", &EffortMotor::joint, driven_joint, "", "driven joint; a joint can have at most one motor"),
    key("max_effort", &EffortMotor::max_effort, positive, "N m or N", "", "maximum torque or force"),
    key("rotor_inertia", &EffortMotor::rotor_inertia, non_negative, "kg m^2 or kg", "0",
        "rotor inertia reflected to the joint", unless_default),
};

template <class Drive>
constexpr auto left_joint_key = reference("left_joint", &Drive::left_joints, driven_joint, no_value,
                                          "joint of a driven wheel on the left; may be repeated");
template <class Drive>
constexpr auto right_joint_key = reference("right_joint", &Drive::right_joints, driven_joint, no_value,
                                           "joint of a driven wheel on the right; may be repeated");
template <class Drive>
constexpr auto max_linear_key = key("max_linear", &Drive::max_linear, positive, "m/s", "",
                                    "maximum linear velocity, forwards and backwards");
template <class Drive>
constexpr auto max_angular_key = key("max_angular", &Drive::max_angular, positive, "rad/s", "",
                                     "maximum angular velocity, in both directions");
template <class Drive>
constexpr auto wheel_separation_key = key("wheel_separation", &Drive::wheel_separation, positive, "m", "",
                                          "distance between the left and the right wheels");
template <class Drive>
constexpr auto wheel_radius_key = key("wheel_radius", &Drive::wheel_radius, positive, "m", "", "radius of each wheel");
template <class Drive>
constexpr auto max_torque_key = key("max_torque", &Drive::max_torque, positive, "N m", "",
                                    "maximum torque of the motor of each wheel");

template <>
inline constexpr auto table_of<DifferentialDrive> = KeyTable{
    actuator("differential_drive",
             "A drive with a motor on each wheel; the speed difference between the two sides turns the vehicle."),
    left_joint_key<DifferentialDrive>,
    right_joint_key<DifferentialDrive>,
    wheel_separation_key<DifferentialDrive>,
    wheel_radius_key<DifferentialDrive>,
    max_torque_key<DifferentialDrive>,
    max_linear_key<DifferentialDrive>,
    max_angular_key<DifferentialDrive>,
};

template <>
inline constexpr auto table_of<AckermannDrive> = KeyTable{
    actuator("ackermann_drive", "A drive that steers two wheels, like a car."),
    left_joint_key<AckermannDrive>,
    right_joint_key<AckermannDrive>,
    reference("left_steering_joint", &AckermannDrive::left_steering_joint, driven_joint, "",
              "joint that steers the left wheel; a positive position turns it counter-clockwise"),
    reference("right_steering_joint", &AckermannDrive::right_steering_joint, driven_joint, "",
              "joint that steers the right wheel; a positive position turns it counter-clockwise"),
    wheel_separation_key<AckermannDrive>,
    wheel_radius_key<AckermannDrive>,
    max_torque_key<AckermannDrive>,
    key("wheel_base", &AckermannDrive::wheel_base, positive, "m", "",
        "distance from the unsteered rear axle to the steered wheels"),
    key("kingpin_width", &AckermannDrive::kingpin_width, positive, "m", "",
        "distance between the axes of the steering joints"),
    key("steering_limit", &AckermannDrive::steering_limit, positive, "rad", "",
        "maximum steering angle of a virtual wheel midway between the two steered wheels, less than π / 2"),
    max_linear_key<AckermannDrive>,
    max_angular_key<AckermannDrive>,
    key("max_steering_velocity", &AckermannDrive::max_steering_velocity, positive, "rad/s", "",
        "maximum velocity of each steering joint"),
    key("max_steering_torque", &AckermannDrive::max_steering_torque, positive, "N m", "",
        "maximum torque of each steering joint"),
};

template <>
inline constexpr auto table_of<Belt> = KeyTable{
    actuator("belt", "A moving surface around a link: a conveyor, or the track of a vehicle."),
    reference("link", &Belt::link, belt_link, "", "link whose surface moves; a link can have at most one belt"),
    key("axis", &Belt::axis_L, vector, "1", "0 1 0",
        "axis in the link frame about which the surface moves, like the axle of a wheel; if it points to the left, the "
        "top surface moves forward"),
    key("max_velocity", &Belt::max_velocity, positive, "m/s", "", "maximum velocity, in both directions"),
    key("velocity", &Belt::velocity, real, "m/s", "0", "velocity while no command is set", unless_default),
};

template <>
inline constexpr auto table_of<TrackedDrive> = KeyTable{
    actuator("tracked_drive",
             "A drive with a belt on each side; the speed difference between the two sides turns the vehicle."),
    reference("left_link", &TrackedDrive::left_links, belt_link, no_value,
              "link on the left whose surface moves about its y axis; may be repeated"),
    reference("right_link", &TrackedDrive::right_links, belt_link, no_value,
              "link on the right whose surface moves about its y axis; may be repeated"),
    key("track_separation", &TrackedDrive::track_separation, positive, "m", "",
        "distance between the centre lines of the left and the right tracks"),
    key("steering_efficiency", &TrackedDrive::steering_efficiency, positive, "1", "1",
        "fraction of the velocity difference between the tracks that turns the vehicle, at most 1; the remainder is "
        "lost to slip"),
    key("max_velocity", &TrackedDrive::max_velocity, positive, "m/s", no_value,
        "maximum velocity of each track, to which commands are clipped; no limit if absent"),
    max_linear_key<TrackedDrive>,
    max_angular_key<TrackedDrive>,
};

template <>
inline constexpr auto table_of<DetachableJoint> = KeyTable{
    actuator("detachable_joint", "A joint that fixes a link of another object while a command attaches it."),
    link_key(&DetachableJoint::link, "link to which the object is attached"),
    key("child", &DetachableJoint::child, object, "", "", "scoped name of the attached object"),
    key("child_link", &DetachableJoint::child_link, object, "", no_value,
        "link of the attached object; its root link if absent"),
    key("may_be_missing", &DetachableJoint::may_be_missing, flag, "", "false",
        "`true` if the object may be missing from the world; nothing is then attached, without a warning",
        unless_default),
    key("initially_attached", &DetachableJoint::is_initially_attached, flag, "", "true",
        "`false` if nothing is attached until a command", unless_default),
};

/// In the order of Rotor::Direction.
inline constexpr std::string_view rotor_directions[] = {"ccw", "cw"};

template <>
inline constexpr auto table_of<Rotor> = KeyTable{
    actuator("rotor", "A propeller in air or water, with its motor."),
    link_key(&Rotor::link, "link on which thrust and reaction torque act"),
    pose_key(&Rotor::X_LR, "pose in the link frame; at a positive velocity, the thrust acts along the z axis"),
    choice_key("direction", &Rotor::direction, rotor_directions, "ccw",
               "direction of rotation at a positive velocity, viewed from +z towards the rotor: `ccw` or `cw`"),
    key("max_velocity", &Rotor::max_velocity, positive, "rad/s", "", "maximum velocity"),
    key("min_velocity", &Rotor::min_velocity, real, "rad/s", "0",
        "minimum velocity, at most 0; a rotor with a negative minimum is reversible"),
    key("motor_constant", &Rotor::motor_constant, positive, "N s^2/rad^2", "", "ratio of thrust to squared velocity"),
    key("moment_constant", &Rotor::moment_constant, non_negative, "m", "0", "ratio of reaction torque to thrust"),
    key("drag_coefficient", &Rotor::drag_coefficient, non_negative, "N s^2/(rad m)", "0",
        "drag force per rad/s of rotor velocity and per m/s of motion perpendicular to the axis", unless_default),
    key("rolling_moment_coefficient", &Rotor::rolling_moment_coefficient, non_negative, "N s^2/rad", "0",
        "rolling moment per rad/s of rotor velocity and per m/s of motion perpendicular to the axis", unless_default),
    key("time_constant_up", &Rotor::time_constant_up, non_negative, "s", "0",
        "time constant of the motor while its velocity increases; 0 for no delay"),
    key("time_constant_down", &Rotor::time_constant_down, non_negative, "s", "0",
        "time constant of the motor while its velocity decreases; 0 for no delay"),
    key("density", &Rotor::density, positive, "kg/m^3", no_value,
        "density of the fluid in which the coefficients were determined, to scale them in other fluids; if absent, "
        "they are the same in every fluid"),
};

template <>
inline constexpr auto table_of<LedRing> = KeyTable{
    actuator("led_ring", "A ring of colour LEDs around a link."),
    link_key(&LedRing::link, "link that carries the device"),
    pose_key(&LedRing::X_LS, "pose of the ring in the link frame; the LEDs are in its xy plane"),
    key("count", &LedRing::count, count, "1", "", "number of LEDs, which are numbered counter-clockwise"),
    key("first_bearing", &LedRing::first_bearing, real, "rad", "0",
        "bearing of LED 0, measured from the x axis of the ring"),
    key("spacing", &LedRing::spacing, real, "rad", "", "angle between neighbouring LEDs"),
    key("ring_radius", &LedRing::ring_radius, non_negative, "m", "",
        "distance of the LEDs from the centre of the ring"),
    key("intensity", &LedRing::intensity, non_negative, "1", "0",
        "intensity of a white LED at 1 m, for light sensors; with 0, only cameras detect the LEDs"),
};

template <>
inline constexpr auto table_of<Loudspeaker> = KeyTable{
    actuator("loudspeaker", "A loudspeaker that emits a tone of any frequency and intensity."),
    link_key(&Loudspeaker::link, "link that carries the device"),
    pose_key(&Loudspeaker::X_LE, "pose in the link frame"),
    key("max_frequency", &Loudspeaker::max_frequency, positive, "Hz", "20000", "maximum commanded frequency"),
    key("max_intensity", &Loudspeaker::max_intensity, positive, "1", "1",
        "maximum commanded intensity, measured at 1 m"),
};

}  // namespace cohort::parsing::keys
