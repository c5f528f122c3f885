#pragma once

#include <string_view>

#include "server/description/model.hpp"
#include "server/parsing/keys/key_table.hpp"
#include "server/parsing/parsing.hpp"

/// The tables of what models do: drives, motors, rotors, LEDs, loudspeakers.
namespace cohort::parsing::keys {

using enum ExtensionValue;
using enum Referent;
using enum Written;

template <>
inline constexpr auto table_of<TreelDrive> = KeyTable{
    actuator("treel_drive", "Two tracks that share one rigid body, as of the s-bot."),
    reference("link", &TreelDrive::link, root_link, "", "the body of the tracks; the root link"),
    key("half_gauge", &TreelDrive::half_gauge, positive, "m", "",
        "distance of the ground points from the x axis of the link"),
    key("half_contact_length", &TreelDrive::half_contact_length, positive, "m", "",
        "distance of the ground points from the y axis of the link"),
    key("ground_height", &TreelDrive::ground_height, real, "m", "", "z of the ground points in the link"),
    key("wheel_radius", &TreelDrive::wheel_radius, positive, "m", "", "from the torque of a motor to traction"),
    key("max_torque", &TreelDrive::max_torque, positive, "N m", "", "of each side's motor"),
    key("max_velocity", &TreelDrive::max_velocity, positive, "m/s", "", "of each track along the ground"),
    key("friction", &TreelDrive::friction, non_negative, "1", "",
        "Coulomb coefficient of the tracks; a pair of surfaces has the smaller one"),
    reference("left_wheel", &TreelDrive::left_wheels, wheel_joint, no_value,
              "joint of a wheel that the left track stands for; any number"),
    reference("right_wheel", &TreelDrive::right_wheels, wheel_joint, no_value,
              "joint of a wheel that the right track stands for; any number"),
};

template <class Motor>
constexpr auto velocity_motor(std::string_view element, std::string_view about) {
  return KeyTable{
      actuator(element, about),
      reference("joint", &Motor::joint, driven_joint, "", "the joint that it turns or slides; at most one motor each"),
      key("max_velocity", &Motor::max_velocity, positive, "rad/s or m/s", "", "greatest velocity"),
      key("max_effort", &Motor::max_effort, positive, "N m or N", "", "greatest torque or force"),
      key("rotor_inertia", &Motor::rotor_inertia, non_negative, "kg m^2 or kg", "0",
          "of what turns in the motor, as the joint feels it", unless_default),
  };
}
template <>
inline constexpr auto table_of<VelocityMotor> =
    velocity_motor<VelocityMotor>("velocity_motor", "A motor with a velocity loop on one joint.");

template <>
inline constexpr auto table_of<PositionMotor> =
    velocity_motor<PositionMotor>("position_motor", "A motor that takes one joint to a position and holds it there.");

template <>
inline constexpr auto table_of<EffortMotor> = KeyTable{
    actuator("effort_motor", "A motor that gives a torque or a force on one joint."),
    reference("joint", &EffortMotor::joint, driven_joint, "",
              "the joint that it turns or slides; at most one motor each"),
    key("max_effort", &EffortMotor::max_effort, positive, "N m or N", "", "greatest torque or force"),
    key("rotor_inertia", &EffortMotor::rotor_inertia, non_negative, "kg m^2 or kg", "0",
        "of what turns in the motor, as the joint feels it", unless_default),
};

template <class Drive>
constexpr auto left_joint_key = reference("left_joint", &Drive::left_joints, driven_joint, no_value,
                                          "joint of a wheel on the left that is driven; any number");
template <class Drive>
constexpr auto right_joint_key = reference("right_joint", &Drive::right_joints, driven_joint, no_value,
                                           "the same on the right");
template <class Drive>
constexpr auto max_linear_key = key("max_linear", &Drive::max_linear, positive, "m/s", "",
                                    "greatest velocity, both ways");
template <class Drive>
constexpr auto max_angular_key = key("max_angular", &Drive::max_angular, positive, "rad/s", "",
                                     "greatest velocity of turning, both ways");
template <class Drive>
constexpr auto wheel_separation_key = key("wheel_separation", &Drive::wheel_separation, positive, "m", "",
                                          "between the left wheels and the right ones");
template <class Drive>
constexpr auto wheel_radius_key = key("wheel_radius", &Drive::wheel_radius, positive, "m", "", "of each wheel");
template <class Drive>
constexpr auto max_torque_key = key("max_torque", &Drive::max_torque, positive, "N m", "",
                                    "of the motor of each wheel");

template <>
inline constexpr auto table_of<DifferentialDrive> = KeyTable{
    actuator("differential_drive", "A motor on each wheel of a vehicle that turns by their difference."),
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
    actuator("ackermann_drive", "A vehicle that steers two of its wheels, as a car does."),
    left_joint_key<AckermannDrive>,
    right_joint_key<AckermannDrive>,
    reference("left_steering_joint", &AckermannDrive::left_steering_joint, driven_joint, "",
              "joint that steers the left wheel, counter-clockwise at a positive position"),
    reference("right_steering_joint", &AckermannDrive::right_steering_joint, driven_joint, "", "the same on the right"),
    wheel_separation_key<AckermannDrive>,
    wheel_radius_key<AckermannDrive>,
    max_torque_key<AckermannDrive>,
    key("wheel_base", &AckermannDrive::wheel_base, positive, "m", "",
        "from the rear axle, which does not steer, to the steered wheels"),
    key("kingpin_width", &AckermannDrive::kingpin_width, positive, "m", "", "between the axes of the steering joints"),
    key("steering_limit", &AckermannDrive::steering_limit, positive, "rad", "",
        "greatest angle of a wheel in the middle of the two, less than a quarter turn"),
    max_linear_key<AckermannDrive>,
    max_angular_key<AckermannDrive>,
    key("max_steering_velocity", &AckermannDrive::max_steering_velocity, positive, "rad/s", "",
        "of each steering joint"),
    key("max_steering_torque", &AckermannDrive::max_steering_torque, positive, "N m", "", "the same"),
};

template <>
inline constexpr auto table_of<Belt> = KeyTable{
    actuator("belt", "The surface of a link that runs round it: a conveyor, or the track of a vehicle."),
    reference("link", &Belt::link, belt_link, "", "the link; at most one belt each"),
    key("axis", &Belt::axis_L, vector, "1", "0 1 0",
        "in the link: the surface runs as that of a wheel that turns about it, with y to the left forward on top"),
    key("max_velocity", &Belt::max_velocity, positive, "m/s", "", "greatest velocity, both ways"),
    key("velocity", &Belt::velocity, real, "m/s", "0", "while nobody commands it", unless_default),
};

template <>
inline constexpr auto table_of<TrackedDrive> = KeyTable{
    actuator("tracked_drive", "Belts on both sides of a vehicle that turns by their difference."),
    reference("left_link", &TrackedDrive::left_links, belt_link, no_value,
              "a link on the left whose surface runs about its y axis; any number"),
    reference("right_link", &TrackedDrive::right_links, belt_link, no_value, "the same on the right"),
    key("track_separation", &TrackedDrive::track_separation, positive, "m", "",
        "between the middles of the left tracks and of the right ones"),
    key("steering_efficiency", &TrackedDrive::steering_efficiency, positive, "1", "1",
        "share of the difference of the tracks that turns it, at most 1; the rest slips"),
    key("max_velocity", &TrackedDrive::max_velocity, positive, "m/s", no_value,
        "of each track; a command that asks for more gets this; no limit if absent"),
    max_linear_key<TrackedDrive>,
    max_angular_key<TrackedDrive>,
};

template <>
inline constexpr auto table_of<DetachableJoint> = KeyTable{
    actuator("detachable_joint", "Holds a link of another object fast, until it is told to let go."),
    link_key(&DetachableJoint::link, "the link that holds"),
    key("child", &DetachableJoint::child, object, "", "", "the object that is held, by its scoped name"),
    key("child_link", &DetachableJoint::child_link, object, "", no_value, "of it; its root link if absent"),
    key("may_be_missing", &DetachableJoint::may_be_missing, flag, "", "false",
        "if the world has no such object: nothing is held, without a warning", unless_default),
};

/// In the order of Rotor::Direction.
inline constexpr std::string_view rotor_directions[] = {"ccw", "cw"};

template <>
inline constexpr auto table_of<Rotor> = KeyTable{
    actuator("rotor", "A propeller in air or water, with its motor."),
    link_key(&Rotor::link, "the link that feels its thrust and its reaction"),
    pose_key(&Rotor::X_LR, "in the link; the thrust of a positive velocity is along its z axis"),
    choice_key("direction", &Rotor::direction, rotor_directions, "ccw",
               "how it turns at a positive velocity, seen against the z axis: `ccw` or `cw`"),
    key("max_velocity", &Rotor::max_velocity, positive, "rad/s", "", "greatest velocity"),
    key("min_velocity", &Rotor::min_velocity, real, "rad/s", "0",
        "least velocity, at most 0; below 0 it is reversible"),
    key("motor_constant", &Rotor::motor_constant, positive, "N s^2/rad^2", "", "thrust for each square of velocity"),
    key("moment_constant", &Rotor::moment_constant, non_negative, "m", "0",
        "reaction torque for each newton of thrust"),
    key("drag_coefficient", &Rotor::drag_coefficient, non_negative, "N s^2/(rad m)", "0",
        "force against what moves it across its axis, for each rad/s and m/s", unless_default),
    key("rolling_moment_coefficient", &Rotor::rolling_moment_coefficient, non_negative, "N s^2/rad", "0",
        "torque for the same", unless_default),
    key("time_constant_up", &Rotor::time_constant_up, non_negative, "s", "0",
        "of the motor, while its velocity rises; 0: at once"),
    key("time_constant_down", &Rotor::time_constant_down, non_negative, "s", "0", "the same while it falls"),
    key("density", &Rotor::density, positive, "kg/m^3", no_value,
        "of the fluid that the coefficients are of: in another they act in proportion; the same in any if absent"),
};

template <>
inline constexpr auto table_of<LedRing> = KeyTable{
    actuator("led_ring", "LEDs of any colour around a link."),
    link_key(&LedRing::link, "the link that carries it"),
    pose_key(&LedRing::X_LS, "of the ring in the link; the LEDs stand in its xy plane"),
    key("count", &LedRing::count, count, "1", "", "number of LEDs, numbered counter-clockwise"),
    key("first_bearing", &LedRing::first_bearing, real, "rad", "0", "of LED 0, from the ring's x axis"),
    key("spacing", &LedRing::spacing, real, "rad", "", "from one LED to the next"),
    key("ring_radius", &LedRing::ring_radius, non_negative, "m", "", "where the LEDs are"),
    key("intensity", &LedRing::intensity, non_negative, "1", "0",
        "what arrives of a white one at 1 m, for light sensors; 0: cameras alone see it"),
};

template <>
inline constexpr auto table_of<Loudspeaker> = KeyTable{
    actuator("loudspeaker", "A tone of any frequency and intensity."),
    link_key(&Loudspeaker::link, "the link that carries it"),
    pose_key(&Loudspeaker::X_LE, "in the link"),
    key("max_frequency", &Loudspeaker::max_frequency, positive, "Hz", "20000",
        "greatest frequency that can be commanded"),
    key("max_intensity", &Loudspeaker::max_intensity, positive, "1", "1",
        "greatest intensity that can be commanded: what arrives at 1 m"),
};

}  // namespace cohort::parsing::keys
