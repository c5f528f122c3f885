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

/// The tables of what models measure and emit, beside those of what they do.
namespace cohort::parsing::keys {

using enum ExtensionValue;
using enum Referent;
using enum Written;

template <>
inline constexpr auto table_of<JointEncoder> = KeyTable{
    sensor("joint_encoder", "Measures position and velocity of one joint."),
    reference("joint", &JointEncoder::joint, moving_joint, "", "the joint that is measured"),
};

template <>
inline constexpr auto table_of<TreelEncoder> = KeyTable{
    sensor("treel_encoder", "Measures way and velocity of each track relative to the hull."),
    reference("drive", &TreelEncoder::drive, drive, "", "the treel_drive that is measured"),
};

/// In the order of ProximityTechnique.
inline constexpr std::string_view proximity_techniques[] = {"ray", "random_ray", "five_rays", "shadow", "samples"};

constexpr bool is_not_of_rays(const ProximityRing& ring) { return ring.technique != ProximityTechnique::ray; }

template <>
inline constexpr auto table_of<ProximityRing> = KeyTable{
    sensor("proximity_ring", "A ring of infrared proximity sensors that look outwards."),
    link_key(&ProximityRing::link, "the link that carries it"),
    pose_key(&ProximityRing::X_LS, "of the ring in the link; the sensors look outwards in its xy plane"),
    key("count", &ProximityRing::count, count, "1", "", "number of sensors, numbered counter-clockwise"),
    key("first_bearing", &ProximityRing::first_bearing, real, "rad", "", "of sensor 0, from the ring's x axis"),
    key("spacing", &ProximityRing::spacing, real, "rad", "", "from one sensor to the next"),
    key("ring_radius", &ProximityRing::ring_radius, non_negative, "m", "", "where the rays start"),
    key("range", &ProximityRing::range, positive, "m", "", "length of the rays"),
    choice_key("technique", &ProximityRing::technique, proximity_techniques, "ray",
               "`ray`, `random_ray`, `five_rays`, `shadow` or `samples`")
        .only_if(&is_not_of_rays),
    key("cone", &ProximityRing::cone, positive, "rad", "0.6981317007977318",
        "full angle that a sensor sees, less than half a turn; of `random_ray`, `five_rays` and `shadow`")
        .only_if(&is_not_of_rays),
    reference("samples", &ProximityRing::samples, samples, no_value,
              "file of the technique `samples`: a reading for each sensor"),
};

template <>
inline constexpr auto table_of<GroundSensors> = KeyTable{
    sensor("ground_sensors", "Infrared sensors that look down."),
    link_key(&GroundSensors::link, "the link that carries them; the rays go along its -z axis"),
    key("place", &GroundSensors::places_L, vector, "m", "", "where a ray starts, in the link; any number"),
    key("range", &GroundSensors::range, positive, "m", "", "length of the rays"),
};

template <>
inline constexpr auto table_of<LightSensors> = KeyTable{
    sensor("light_sensors", "A ring of light sensors that look outwards."),
    link_key(&LightSensors::link, "the link that carries them"),
    pose_key(&LightSensors::X_LS, "of the ring in the link; the sensors look outwards in its xy plane"),
    key("count", &LightSensors::count, count, "1", "", "number of sensors, numbered counter-clockwise"),
    key("first_bearing", &LightSensors::first_bearing, real, "rad", "", "of sensor 0, from the ring's x axis"),
    key("spacing", &LightSensors::spacing, real, "rad", "", "from one sensor to the next"),
    key("gain", &LightSensors::gain, positive, "1", "1",
        "from the sum of what arrives to what the sigmoid is taken of"),
    reference("samples", &LightSensors::samples, samples, no_value,
              "file of what each sensor reads of a lamp that gives 1 at 1 m"),
};

template <>
inline constexpr auto table_of<Microphones> = KeyTable{
    sensor("microphones", "Hear sounds within bands of frequency."),
    link_key(&Microphones::link, "the link that carries them"),
    key("place", &Microphones::places_L, vector, "m", "", "of a microphone in the link; any number"),
    key("band", &Microphones::bands, point, "Hz", "0 20000", "lowest and highest frequency of a band; any number"),
    key("gain", &Microphones::gain, positive, "1", "1", "from the sum of what arrives to what the sigmoid is taken of"),
    reference("samples", &Microphones::samples, samples, no_value,
              "file of what each microphone reads of a sound that gives 1 at 1 m"),
};

template <>
inline constexpr auto table_of<Accelerometer> = KeyTable{
    sensor("accelerometer", "Measures acceleration less gravity."),
    link_key(&Accelerometer::link, "the link that carries it"),
    pose_key(&Accelerometer::X_LS, "in the link; it measures along its axes"),
};

template <>
inline constexpr auto table_of<Inclinometer> = KeyTable{
    sensor("inclinometer", "Measures roll and pitch against gravity."),
    link_key(&Inclinometer::link, "the link that carries it"),
    pose_key(&Inclinometer::X_LS, "in the link; level when its z axis points up"),
};

template <>
inline constexpr auto table_of<RangeAndBearing> = KeyTable{
    sensor("range_and_bearing", "Messages to the robots around, which know where they come from."),
    link_key(&RangeAndBearing::link, "the link that carries it"),
    pose_key(&RangeAndBearing::X_LS, "in the link: bearings are from its x axis, elevations from its xy plane"),
    key("range", &RangeAndBearing::range, positive, "m", "", "how far its messages reach"),
    key("message_size", &RangeAndBearing::message_size, count, "1", "", "values of a message"),
    key("capacity", &RangeAndBearing::capacity, count, "1", "16", "messages that are reported at a time, at the most"),
    noise_key("range_noise", &RangeAndBearing::readout, {"range"}, "m",
              "standard deviation of the Gaussian noise on ranges"),
    noise_key("bearing_noise", &RangeAndBearing::readout, {"bearing", "elevation"}, "rad",
              "the same on bearings and elevations"),
};

template <>
inline constexpr auto table_of<OmnidirectionalCamera> = KeyTable{
    sensor("omnidirectional_camera", "A camera that looks all round and reports coloured spots."),
    link_key(&OmnidirectionalCamera::link, "the link that carries it"),
    pose_key(&OmnidirectionalCamera::X_LS, "in the link: bearings are from its x axis, elevations from its xy plane"),
    key("range", &OmnidirectionalCamera::range, positive, "m", "", "how far it sees"),
    key("min_elevation", &OmnidirectionalCamera::min_elevation, real, "rad", "-1.5707963267948966",
        "lowest elevation that it sees"),
    key("max_elevation", &OmnidirectionalCamera::max_elevation, real, "rad", "1.5707963267948966",
        "highest elevation that it sees"),
    key("capacity", &OmnidirectionalCamera::capacity, count, "1", "32",
        "spots that are reported at a time, at the most"),
    noise_key("distance_noise", &OmnidirectionalCamera::readout, {"distance"}, "m",
              "standard deviation of the Gaussian noise on distances"),
    noise_key("bearing_noise", &OmnidirectionalCamera::readout, {"bearing", "elevation"}, "rad",
              "the same on bearings and elevations"),
};

template <>
inline constexpr auto table_of<PanoramicCamera> = KeyTable{
    sensor("panorama", "A camera that looks all round and gives an image."),
    link_key(&PanoramicCamera::link, "the link that carries it"),
    pose_key(&PanoramicCamera::X_LS, "in the link: columns start at its x axis, elevations at its xy plane"),
    key("width", &PanoramicCamera::width, count, "1", "", "columns, evenly all round; at least 4"),
    key("height", &PanoramicCamera::height, count, "1", "", "rows, evenly from one elevation to the other"),
    key("min_elevation", &PanoramicCamera::min_elevation, real, "rad", "-0.7853981633974483",
        "lower edge of the image"),
    key("max_elevation", &PanoramicCamera::max_elevation, real, "rad", "0.7853981633974483", "upper edge of the image"),
    key("range", &PanoramicCamera::range, positive, "m", no_value, "nothing is seen beyond; without end if absent"),
    key("sky", &PanoramicCamera::sky, vector, "1", "0.6 0.75 0.95", "colour where nothing is seen"),
};

template <>
inline constexpr auto table_of<ClimateSensor> = KeyTable{
    sensor("climate_sensor", "Temperature and humidity of the air."),
    link_key(&ClimateSensor::link, "the link that carries it"),
    key("place", &ClimateSensor::p_LS, vector, "m", "0 0 0", "in the link"),
    noise_key("temperature_noise", &ClimateSensor::readout, {"temperature"}, "K",
              "standard deviation of the Gaussian noise on temperatures"),
    noise_key("humidity_noise", &ClimateSensor::readout, {"humidity"}, "1", "the same on humidities"),
};

template <>
inline constexpr auto table_of<Battery> = KeyTable{
    sensor("battery", "Feeds the robot, which stops when it is empty."),
    key("capacity", &Battery::capacity, positive, "J", "", "energy of a full one"),
    key("charge", &Battery::charge, fraction, "1", "1", "at first, of the capacity"),
    key("idle_power", &Battery::idle_power, non_negative, "W", "0", "of all that is not a motor"),
    key("motor_efficiency", &Battery::motor_efficiency, positive, "1", "1",
        "mechanical power to what motors take; at most 1"),
};

/// In the order of Gripper::LightBarrier.
inline constexpr std::string_view light_barriers[] = {"simple", "beam"};

template <>
inline constexpr auto table_of<Gripper> = KeyTable{
    actuator("gripper", "Grasps what is grippable, and holds it."),
    link_key(&Gripper::link, "the link that carries it"),
    pose_key(&Gripper::X_LG, "of the jaw in the link; x outwards, its sides open along y"),
    key("depth", &Gripper::depth, positive, "m", "", "how far from there something may be to be grasped"),
    key("half_angle", &Gripper::half_angle, positive, "rad", "", "how far aside of x"),
    key("height", &Gripper::height, positive, "m", "", "how far above or below"),
    key("closing_time", &Gripper::closing_time, positive, "s", "0.5", "from open to closed"),
    key("holding_force", &Gripper::holding_force, positive, "N", "60", "along each axis; above it slips"),
    key("holding_torque", &Gripper::holding_torque, positive, "N m", "3", "the same about each axis"),
    key("breaking_force", &Gripper::breaking_force, positive, "N", no_value, "above it lets go; never if absent"),
    key("breaking_torque", &Gripper::breaking_torque, positive, "N m", no_value, "above it lets go; never if absent"),
    choice_key("light_barrier", &Gripper::light_barrier, light_barriers, "simple",
               "`simple`: whether something could be grasped; `beam`: whether a ray between the sides meets anything"),
    key("jaw_width", &Gripper::jaw_width, positive, "m", "0.03", "length of the beam, through the middle of the depth"),
};

template <>
inline constexpr auto table_of<TorqueSensor> = KeyTable{
    sensor("torque_sensor", "Measures what a joint's motor gives."),
    reference("joint", &TorqueSensor::joint, moving_joint, "", "the joint whose motor is measured"),
};

template <>
inline constexpr auto table_of<TractionSensor> = KeyTable{
    sensor("traction_sensor", "Measures the force between two links, in the plane of the parent."),
    reference("joint", &TractionSensor::joint, joint, "", "the joint between the two links"),
};

template <>
inline constexpr auto table_of<UserAction> = KeyTable{
    actuator("action", "Something that a robot does and no joint stands for."),
};

template <>
inline constexpr auto table_of<GripRing> = KeyTable{
    Extension{"grip_ring", "link", true, "A circle that grippers hold on to.", {}, "actuators"},
    pose_key(&GripRing::X_LR, "of the circle in the link; it lies in its xy plane"),
    key("radius", &GripRing::radius, positive, "m", "", "of the circle"),
};

template <>
inline constexpr auto table_of<Fin> = KeyTable{
    Extension{
        "fin", "link", true, "A surface that gives lift and drag: a wing, a rudder, a sail, a keel.", {}, "physics"},
    pose_key(&Fin::X_LF, "of its centre of pressure in the link: x forward along the chord, z up"),
    key("area", &Fin::area, positive, "m^2", "", "of the surface"),
    key("alpha0", &Fin::alpha0, real, "rad", "0", "added to the angle of attack"),
    key("cla", &Fin::cla, non_negative, "1/rad", "", "slope of the coefficient of lift"),
    key("cda", &Fin::cda, non_negative, "1/rad", "0.01", "slope of the coefficient of drag"),
    key("alpha_stall", &Fin::alpha_stall, positive, "rad", "1.5707963267948966", "angle of attack at which it stalls"),
    key("cla_stall", &Fin::cla_stall, real, "1/rad", "0", "slope of the coefficient of lift beyond"),
    key("cda_stall", &Fin::cda_stall, real, "1/rad", "1", "slope of the coefficient of drag beyond"),
};

template <>
inline constexpr auto table_of<Drag> = KeyTable{
    Extension{"drag", "link", true, "What resists the motion of a link through air or water.", {}, "physics"},
    pose_key(&Drag::X_LD, "in the link: where the force acts, and the axes"),
    key("damping", &Drag::damping, vector, "N s/m", "0 0 0", "force against its velocity along each axis"),
    key("quadratic_damping", &Drag::quadratic_damping, vector, "N s^2/m^2", "0 0 0",
        "the same for the square of the velocity"),
    key("angular_damping", &Drag::angular_damping, vector, "N m s/rad", "0 0 0",
        "torque against its angular velocity about each axis"),
    key("quadratic_angular_damping", &Drag::quadratic_angular_damping, vector, "N m s^2/rad^2", "0 0 0",
        "the same for its square"),
    key("density", &Drag::density, positive, "kg/m^3", no_value,
        "of the fluid that these are of: in another they act in proportion; the same in any if absent"),
};

template <>
inline constexpr auto table_of<Sound> = KeyTable{
    emitter("sound", "A tone that microphones hear."),
    pose_key(&Emitter::X_LE, "in the link"),
    key("frequency", &Sound::frequency, positive, "Hz", "", "of the tone"),
    key("intensity", &Sound::intensity, positive, "1", "",
        "what arrives at 1 m; it falls off with the square of the distance"),
    key("range", &Sound::range, positive, "m", no_value, "nothing is heard beyond; without end if absent"),
    key("on", &Emitter::is_on, flag, "", "true", "whether it sounds at first"),
};

template <>
inline constexpr auto table_of<Marker> = KeyTable{
    emitter("marker", "A coloured spot that cameras see."),
    pose_key(&Emitter::X_LE, "in the link"),
    key("color", &Marker::color, vector, "1", "", "red, green and blue, from 0 to 1"),
    key("on", &Emitter::is_on, flag, "", "true", "whether it can be seen at first"),
};

template <>
inline constexpr auto table_of<ClimateSource> = KeyTable{
    emitter("climate_source", "Warmth or moisture around a point."),
    pose_key(&Emitter::X_LE, "in the link"),
    key("temperature", &ClimateSource::temperature, real, "K", "0", "added in its middle"),
    key("humidity", &ClimateSource::humidity, real, "1", "0", "relative, added in its middle"),
    key("spread", &ClimateSource::spread, positive, "m", "",
        "at a distance d it adds exp(-d^2 / (2 spread^2)) of that"),
    key("on", &Emitter::is_on, flag, "", "true", "whether it acts at first"),
};

/// Of every sensor.
inline constexpr auto readout_keys = std::tuple{
    key("noise", &Noise::deviation, non_negative, "the reading's", "0",
        "standard deviation of the Gaussian noise on each reading", unless_default),
    key("uniform_noise", &Noise::uniform, non_negative, "the reading's", "0",
        "greatest size of the uniform noise on each reading", unless_default),
    key("bias", &Noise::bias, real, "the reading's", "0", "added to each reading", unless_default),
    key("bias_noise", &Noise::bias_deviation, non_negative, "the reading's", "0",
        "standard deviation of a bias that each reading draws once in a run", unless_default),
    key("precision", &Noise::precision, non_negative, "the reading's", "0",
        "readings are whole multiples of it; 0: they have any value", unless_default),
    key("drop_out", &Readout::drop_out, fraction, "1", "0",
        "probability that a report does not come; the one before it then holds", unless_default),
    key("rate", &Readout::period, positive, "Hz", no_value,
        "how often it measures, to the nearest tick; every tick if absent"),
    key("latency", &Readout::latency, non_negative, "s", "0", "from measurement to report, to the nearest tick",
        unless_default),
};

/// All that the element of a kind may hold.
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

/// Calls `visit` with the type of each kind in a variant that has a table, in its order.
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
