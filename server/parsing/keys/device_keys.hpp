// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <variant>

#include "server/description/model.hpp"
#include "server/parsing/keys/actuator_keys.hpp"
#include "server/parsing/keys/key_table.hpp"
#include "server/parsing/parsing.hpp"

/// Tables of sensors and emitters, in addition to those of actuators.
namespace cohort::parsing::keys {

using enum ExtensionValue;
using enum Referent;
using enum Written;

template <>
inline constexpr auto table_of<JointEncoder> = KeyTable{
    sensor("joint_encoder", "A sensor that measures the position and velocity of one joint."),
    reference("joint", &JointEncoder::joint, moving_joint, "", "measured joint"),
};

template <>
inline constexpr auto table_of<TreelEncoder> = KeyTable{
    sensor("treel_encoder", "A sensor that measures the travel and velocity of each track relative to the hull."),
    reference("drive", &TreelEncoder::drive, drive, "", "measured `treel_drive`"),
};

/// In the order of ProximityTechnique.
inline constexpr std::string_view proximity_techniques[] = {"ray", "random_ray", "five_rays", "shadow", "samples"};

constexpr bool is_not_of_rays(const ProximityRing& ring) { return ring.technique != ProximityTechnique::ray; }

template <>
inline constexpr auto table_of<ProximityRing> = KeyTable{
    sensor("proximity_ring", "A ring of infrared proximity sensors that point outwards."),
    link_key(&ProximityRing::link, "link that carries the device"),
    pose_key(&ProximityRing::X_LS, "pose of the ring in the link frame; the sensors point outwards in its xy plane"),
    key("count", &ProximityRing::count, count, "1", "", "number of sensors, which are numbered counter-clockwise"),
    key("first_bearing", &ProximityRing::first_bearing, real, "rad", "",
        "bearing of sensor 0, measured from the x axis of the ring"),
    key("spacing", &ProximityRing::spacing, real, "rad", "", "angle between neighbouring sensors"),
    key("ring_radius", &ProximityRing::ring_radius, non_negative, "m", "",
        "distance of the ray origins from the centre of the ring"),
    key("range", &ProximityRing::range, positive, "m", "", "length of the rays"),
    choice_key("technique", &ProximityRing::technique, proximity_techniques, "ray",
               "measurement technique: `ray`, `random_ray`, `five_rays`, `shadow` or `samples`")
        .only_if(&is_not_of_rays),
    key("cone", &ProximityRing::cone, positive, "rad", "0.6981317007977318",
        "full opening angle of a sensor, less than half a turn; used by `random_ray`, `five_rays` and `shadow`")
        .only_if(&is_not_of_rays),
    reference("samples", &ProximityRing::samples, samples, no_value,
              "sample file for the technique `samples`, with readings for each sensor"),
};

template <>
inline constexpr auto table_of<GroundSensors> = KeyTable{
    sensor("ground_sensors", "Infrared sensors that point down."),
    link_key(&GroundSensors::link, "link that carries the sensors; the rays point along its -z axis"),
    key("place", &GroundSensors::places_L, vector, "m", "",
        "origin of the ray of one sensor in the link frame; may be repeated"),
    key("range", &GroundSensors::range, positive, "m", "", "length of the rays"),
};

template <>
inline constexpr auto table_of<LightSensors> = KeyTable{
    sensor("light_sensors", "A ring of light sensors that point outwards."),
    link_key(&LightSensors::link, "link that carries the sensors"),
    pose_key(&LightSensors::X_LS, "pose of the ring in the link frame; the sensors point outwards in its xy plane"),
    key("count", &LightSensors::count, count, "1", "", "number of sensors, which are numbered counter-clockwise"),
    key("first_bearing", &LightSensors::first_bearing, real, "rad", "",
        "bearing of sensor 0, measured from the x axis of the ring"),
    key("spacing", &LightSensors::spacing, real, "rad", "", "angle between neighbouring sensors"),
    key("gain", &LightSensors::gain, positive, "1", "1", "gain applied to the summed intensity before the sigmoid"),
    reference("samples", &LightSensors::samples, samples, no_value,
              "sample file with the readings of each sensor for a lamp with intensity 1 at 1 m"),
};

template <>
inline constexpr auto table_of<Microphones> = KeyTable{
    sensor("microphones", "Microphones that measure sounds within frequency bands."),
    link_key(&Microphones::link, "link that carries the sensors"),
    key("place", &Microphones::places_L, vector, "m", "",
        "position of a microphone in the link frame; may be repeated"),
    key("band", &Microphones::bands, point, "Hz", "0 20000",
        "minimum and maximum frequency of a band; may be repeated"),
    key("gain", &Microphones::gain, positive, "1", "1", "gain applied to the summed intensity before the sigmoid"),
    reference("samples", &Microphones::samples, samples, no_value,
              "sample file with the readings of each microphone for a sound with intensity 1 at 1 m"),
};

template <>
inline constexpr auto table_of<Accelerometer> = KeyTable{
    sensor("accelerometer", "A sensor that measures acceleration minus gravity."),
    link_key(&Accelerometer::link, "link that carries the device"),
    pose_key(&Accelerometer::X_LS, "pose in the link frame; the sensor measures along its axes"),
};

template <>
inline constexpr auto table_of<Inclinometer> = KeyTable{
    sensor("inclinometer", "A sensor that measures roll and pitch relative to gravity."),
    link_key(&Inclinometer::link, "link that carries the device"),
    pose_key(&Inclinometer::X_LS, "pose in the link frame; the sensor is level when its z axis points up"),
};

template <>
inline constexpr auto table_of<RangeAndBearing> = KeyTable{
    sensor("range_and_bearing",
           "A transceiver for messages between nearby robots; the receiver also measures the range and bearing of the "
           "sender."),
    link_key(&RangeAndBearing::link, "link that carries the device"),
    pose_key(&RangeAndBearing::X_LS,
             "pose in the link frame; bearings are measured from its x axis, elevations from its xy plane"),
    key("range", &RangeAndBearing::range, positive, "m", "",
        "maximum range at which other robots receive its messages"),
    key("message_size", &RangeAndBearing::message_size, count, "1", "", "number of values in a message"),
    key("capacity", &RangeAndBearing::capacity, count, "1", "16", "maximum number of messages in a report"),
    noise_key("range_noise", &RangeAndBearing::readout, {"range"}, "m",
              "standard deviation of the Gaussian noise on ranges"),
    noise_key("bearing_noise", &RangeAndBearing::readout, {"bearing", "elevation"}, "rad",
              "standard deviation of the Gaussian noise on bearings and elevations"),
};

template <>
inline constexpr auto table_of<OmnidirectionalCamera> = KeyTable{
    sensor("omnidirectional_camera", "An omnidirectional camera that reports coloured spots."),
    link_key(&OmnidirectionalCamera::link, "link that carries the device"),
    pose_key(&OmnidirectionalCamera::X_LS,
             "pose in the link frame; bearings are measured from its x axis, elevations from its xy plane"),
    key("range", &OmnidirectionalCamera::range, positive, "m", "", "maximum distance at which spots are detected"),
    key("min_elevation", &OmnidirectionalCamera::min_elevation, real, "rad", "-1.5707963267948966",
        "minimum elevation of the field of view"),
    key("max_elevation", &OmnidirectionalCamera::max_elevation, real, "rad", "1.5707963267948966",
        "maximum elevation of the field of view"),
    key("capacity", &OmnidirectionalCamera::capacity, count, "1", "32", "maximum number of spots in a report"),
    noise_key("distance_noise", &OmnidirectionalCamera::readout, {"distance"}, "m",
              "standard deviation of the Gaussian noise on distances"),
    noise_key("bearing_noise", &OmnidirectionalCamera::readout, {"bearing", "elevation"}, "rad",
              "standard deviation of the Gaussian noise on bearings and elevations"),
};

template <>
inline constexpr auto table_of<PanoramicCamera> = KeyTable{
    sensor("panorama", "A panoramic camera that produces an image."),
    link_key(&PanoramicCamera::link, "link that carries the device"),
    pose_key(
        &PanoramicCamera::X_LS,
        "pose in the link frame; the first column is at its x axis, and elevations are measured from its xy plane"),
    key("width", &PanoramicCamera::width, count, "1", "",
        "number of columns, evenly spaced over the full turn; at least 4"),
    key("height", &PanoramicCamera::height, count, "1", "", "number of rows, evenly spaced between the two elevations"),
    key("min_elevation", &PanoramicCamera::min_elevation, real, "rad", "-0.7853981633974483",
        "elevation of the lower edge of the image"),
    key("max_elevation", &PanoramicCamera::max_elevation, real, "rad", "0.7853981633974483",
        "elevation of the upper edge of the image"),
    key("range", &PanoramicCamera::range, positive, "m", no_value,
        "maximum distance at which surfaces and spots are visible; unlimited if absent"),
    key("sky", &PanoramicCamera::sky, vector, "1", "0.6 0.75 0.95",
        "colour of pixels whose ray hits nothing: red, green and blue, from 0 to 1"),
};

template <>
inline constexpr auto table_of<ClimateSensor> = KeyTable{
    sensor("climate_sensor", "A sensor that measures the temperature and humidity of the air."),
    link_key(&ClimateSensor::link, "link that carries the device"),
    key("place", &ClimateSensor::p_LS, vector, "m", "0 0 0", "position in the link frame"),
    noise_key("temperature_noise", &ClimateSensor::readout, {"temperature"}, "K",
              "standard deviation of the Gaussian noise on temperatures"),
    noise_key("humidity_noise", &ClimateSensor::readout, {"humidity"}, "1",
              "standard deviation of the Gaussian noise on humidities"),
};

template <>
inline constexpr auto table_of<Battery> = KeyTable{
    sensor("battery", "A battery that powers the robot; when it is empty, all commands become neutral."),
    key("capacity", &Battery::capacity, positive, "J", "", "energy of the full battery"),
    key("charge", &Battery::charge, fraction, "1", "1", "initial charge as a fraction of the capacity"),
    key("idle_power", &Battery::idle_power, non_negative, "W", "0",
        "power consumption of everything except the motors"),
    key("motor_efficiency", &Battery::motor_efficiency, positive, "1", "1",
        "ratio of mechanical output power to electrical input power of the motors; at most 1"),
};

/// In the order of Gripper::LightBarrier.
inline constexpr std::string_view light_barriers[] = {"simple", "beam"};

template <>
inline constexpr auto table_of<Gripper> = KeyTable{
    actuator("gripper", "A gripper that grasps and holds grippable objects."),
    link_key(&Gripper::link, "link that carries the device"),
    pose_key(&Gripper::X_LG, "pose of the jaw in the link frame; x points outwards, and the jaw opens along y"),
    key("depth", &Gripper::depth, positive, "m", "",
        "maximum distance from the origin of the jaw, in its xy plane, at which an object can be grasped"),
    key("half_angle", &Gripper::half_angle, positive, "rad", "",
        "maximum angle from the x axis of the jaw, to either side, at which an object can be grasped"),
    key("height", &Gripper::height, positive, "m", "",
        "maximum distance above or below the xy plane of the jaw at which an object can be grasped"),
    key("closing_time", &Gripper::closing_time, positive, "s", "0.5", "time to close fully"),
    key("holding_force", &Gripper::holding_force, positive, "N", "60",
        "maximum holding force along each axis; the grip slips under a greater load"),
    key("holding_torque", &Gripper::holding_torque, positive, "N m", "3",
        "maximum holding torque about each axis; the grip slips under a greater load"),
    key("breaking_force", &Gripper::breaking_force, positive, "N", no_value,
        "force above which the gripper releases the object; never if absent"),
    key("breaking_torque", &Gripper::breaking_torque, positive, "N m", no_value,
        "torque above which the gripper releases the object; never if absent"),
    choice_key("light_barrier", &Gripper::light_barrier, light_barriers, "simple",
               "what sets the observation `grippable`: an object that can be grasped (`simple`), or anything in a beam "
               "between the sides of the jaw (`beam`)"),
    key("jaw_width", &Gripper::jaw_width, positive, "m", "0.03",
        "length of the beam (`light_barrier`), which crosses the jaw at half the depth"),
};

template <>
inline constexpr auto table_of<TorqueSensor> = KeyTable{
    sensor("torque_sensor", "A sensor that measures the motor torque or force of a joint."),
    reference("joint", &TorqueSensor::joint, moving_joint, "", "joint whose motor torque or force is measured"),
};

template <>
inline constexpr auto table_of<TractionSensor> = KeyTable{
    sensor("traction_sensor", "A sensor that measures the force between two links in the xy plane of the parent link."),
    reference("joint", &TractionSensor::joint, joint, "", "joint between the two links"),
};

template <>
inline constexpr auto table_of<UserAction> = KeyTable{
    actuator("action", "An action of a robot that involves no joint, such as pressing a button."),
};

template <>
inline constexpr auto table_of<GripRing> = KeyTable{
    Extension{"grip_ring", "link", true, "A ring that grippers can grasp.", {}, "actuators"},
    pose_key(&GripRing::X_LR, "pose of the ring in the link frame; the ring is in its xy plane"),
    key("radius", &GripRing::radius, positive, "m", "", "radius of the ring"),
};

template <>
inline constexpr auto table_of<Fin> = KeyTable{
    Extension{"fin",
              "link",
              true,
              "A surface that generates lift and drag, such as a wing, rudder, sail or keel.",
              {},
              "physics"},
    pose_key(&Fin::X_LF, "pose of the centre of pressure in the link frame; x points forward along the chord, z up"),
    key("area", &Fin::area, positive, "m^2", "", "area of the surface"),
    key("alpha0", &Fin::alpha0, real, "rad", "0", "offset added to the angle of attack"),
    key("cla", &Fin::cla, non_negative, "1/rad", "", "slope of the lift coefficient"),
    key("cda", &Fin::cda, non_negative, "1/rad", "0.01", "slope of the drag coefficient"),
    key("alpha_stall", &Fin::alpha_stall, positive, "rad", "1.5707963267948966",
        "angle of attack at which the surface stalls"),
    key("cla_stall", &Fin::cla_stall, real, "1/rad", "0", "slope of the lift coefficient beyond stall"),
    key("cda_stall", &Fin::cda_stall, real, "1/rad", "1", "slope of the drag coefficient beyond stall"),
};

template <>
inline constexpr auto table_of<Drag> = KeyTable{
    Extension{"drag", "link", true, "Drag on a link that moves through air or water.", {}, "physics"},
    pose_key(&Drag::X_LD,
             "pose in the link frame: the point at which the force acts, and the axes of the coefficients"),
    key("damping", &Drag::damping, vector, "N s/m", "0 0 0", "linear drag along each axis: force per unit of velocity"),
    key("quadratic_damping", &Drag::quadratic_damping, vector, "N s^2/m^2", "0 0 0",
        "quadratic drag along each axis: force per unit of squared velocity"),
    key("angular_damping", &Drag::angular_damping, vector, "N m s/rad", "0 0 0",
        "linear angular drag about each axis: torque per unit of angular velocity"),
    key("quadratic_angular_damping", &Drag::quadratic_angular_damping, vector, "N m s^2/rad^2", "0 0 0",
        "quadratic angular drag about each axis: torque per unit of squared angular velocity"),
    key("density", &Drag::density, positive, "kg/m^3", no_value,
        "density of the fluid in which the coefficients were determined, to scale them in other fluids; if absent, "
        "they are the same in every fluid"),
};

template <>
inline constexpr auto table_of<Sound> = KeyTable{
    emitter("sound", "A tone that microphones measure."),
    pose_key(&Emitter::X_LE, "pose in the link frame"),
    key("frequency", &Sound::frequency, positive, "Hz", "", "frequency of the tone"),
    key("intensity", &Sound::intensity, positive, "1", "",
        "intensity at 1 m; it decreases with the square of the distance"),
    key("range", &Sound::range, positive, "m", no_value,
        "maximum distance at which microphones detect the sound; unlimited if absent"),
    key("on", &Emitter::is_on, flag, "", "true", "initial state: `true` if the sound is on"),
};

template <>
inline constexpr auto table_of<Marker> = KeyTable{
    emitter("marker", "A coloured spot that cameras detect."),
    pose_key(&Emitter::X_LE, "pose in the link frame"),
    key("color", &Marker::color, vector, "1", "", "red, green and blue, from 0 to 1"),
    key("on", &Emitter::is_on, flag, "", "true", "initial state: `true` if the marker is visible"),
};

template <>
inline constexpr auto table_of<ClimateSource> = KeyTable{
    emitter("climate_source", "A source of warmth or moisture around a point."),
    pose_key(&Emitter::X_LE, "pose in the link frame"),
    key("temperature", &ClimateSource::temperature, real, "K", "0", "temperature added at the centre"),
    key("humidity", &ClimateSource::humidity, real, "1", "0", "relative humidity added at the centre"),
    key("spread", &ClimateSource::spread, positive, "m", "",
        "standard deviation of the Gaussian decay: at a distance d from the centre, the source adds exp(-d^2 / (2 "
        "spread^2)) times its central value"),
    key("on", &Emitter::is_on, flag, "", "true", "initial state: `true` if the source is on"),
};

/// Keys of every sensor.
inline constexpr auto readout_keys = std::tuple{
    key("noise", &Noise::deviation, non_negative, "of the reading", "0",
        "standard deviation of the Gaussian noise on each reading", unless_default),
    key("uniform_noise", &Noise::uniform, non_negative, "of the reading", "0",
        "maximum magnitude of the uniform noise on each reading", unless_default),
    key("bias", &Noise::bias, real, "of the reading", "0", "offset added to each reading", unless_default),
    key("bias_noise", &Noise::bias_deviation, non_negative, "of the reading", "0",
        "standard deviation of a random bias, drawn once per run for each reading", unless_default),
    key("precision", &Noise::precision, non_negative, "of the reading", "0",
        "resolution, to multiples of which readings are rounded; 0 for no rounding", unless_default),
    key("drop_out", &Readout::drop_out, fraction, "1", "0",
        "probability that a report is lost; the previous report is then repeated", unless_default),
    key("rate", &Readout::period, positive, "Hz", no_value, "mean measurement rate; every tick if absent"),
    key("latency", &Readout::latency, non_negative, "s", "0", "mean time from measurement to report", unless_default),
};

/// All keys of the element of a kind.
template <class Kind>
inline constexpr auto keys_of = [] {
  if constexpr (Senses<Kind>)
    return std::tuple_cat(table_of<Kind>.keys, readout_keys);
  else
    return table_of<Kind>.keys;
}();

template <class Kind>
inline constexpr auto extension_keys =
    std::apply([](const auto&... each) { return std::array<ExtensionKey, sizeof...(each)>{each...}; }, keys_of<Kind>);

template <class Kind>
inline constexpr Extension extension_of = [] {
  Extension extension = table_of<Kind>.head;
  extension.keys = extension_keys<Kind>;
  return extension;
}();

/// Calls `visit` with the type of each kind in a variant that has a table, in the order of the variant.
template <class Visit, class... Kinds>
void for_kinds_in(std::type_identity<std::variant<Kinds...>>, const Visit& visit) {
  const auto visit_kind = [&]<class Kind>(std::type_identity<Kind> kind) {
    if constexpr (HasTable<Kind>) visit(kind);
  };
  (visit_kind(std::type_identity<Kinds>{}), ...);
}
inline constexpr std::type_identity<DeviceKinds> devices;
inline constexpr std::type_identity<decltype(Emitter::what)> emitters;

}  // namespace cohort::parsing::keys
