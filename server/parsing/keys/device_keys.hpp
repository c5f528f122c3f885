#pragma once

#include <array>
#include <cstddef>

#include "server/parsing/keys/extensions.hpp"

/// The part of the table of extensions that is about what models do, measure and emit.
namespace cohort::parsing {

template <class Item, std::size_t first, std::size_t second>
constexpr std::array<Item, first + second> joined(const Item (&a)[first], const Item (&b)[second]) {
  std::array<Item, first + second> all{};
  for (std::size_t i = 0; i < first; ++i) all[i] = a[i];
  for (std::size_t i = 0; i < second; ++i) all[first + i] = b[i];
  return all;
}

namespace keys {

using enum ExtensionValue;

/// Of every sensor.
inline constexpr ExtensionKey readout[] = {
    {"noise", non_negative, "the reading's", "0", "standard deviation of the Gaussian noise on each reading"},
    {"uniform_noise", non_negative, "the reading's", "0", "greatest size of the uniform noise on each reading"},
    {"bias", real, "the reading's", "0", "added to each reading"},
    {"bias_noise", non_negative, "the reading's", "0",
     "standard deviation of a bias that each reading draws once in a run"},
    {"precision", non_negative, "the reading's", "0", "readings are whole multiples of it; 0: they have any value"},
    {"drop_out", fraction, "1", "0", "probability that a report does not come; the one before it then holds"},
    {"rate", positive, "Hz", no_value, "how often it measures, to the nearest tick; every tick if absent"},
    {"latency", non_negative, "s", "0", "from measurement to report, to the nearest tick"},
};

template <std::size_t count>
constexpr auto sensor(const ExtensionKey (&own)[count]) {
  return joined(own, readout);
}

inline constexpr ExtensionKey treel_drive[] = {
    {"link", name, "", "", "the body of the tracks; the root link"},
    {"half_gauge", positive, "m", "", "distance of the ground points from the x axis of the link"},
    {"half_contact_length", positive, "m", "", "distance of the ground points from the y axis of the link"},
    {"ground_height", real, "m", "", "z of the ground points in the link"},
    {"wheel_radius", positive, "m", "", "from the torque of a motor to traction"},
    {"max_torque", positive, "N m", "", "of each side's motor"},
    {"max_velocity", positive, "m/s", "", "of each track along the ground"},
    {"friction", non_negative, "1", "", "Coulomb coefficient of the tracks; a pair of surfaces has the smaller one"},
    {"left_wheel", name, "", no_value, "joint of a wheel that the left track stands for; any number", true},
    {"right_wheel", name, "", no_value, "joint of a wheel that the right track stands for; any number", true},
};

/// Also of a position_motor.
inline constexpr ExtensionKey velocity_motor[] = {
    {"joint", name, "", "", "the joint that it turns or slides; at most one motor each"},
    {"max_velocity", positive, "rad/s or m/s", "", "greatest velocity"},
    {"max_effort", positive, "N m or N", "", "greatest torque or force"},
    {"rotor_inertia", non_negative, "kg m^2 or kg", "0", "of what turns in the motor, as the joint feels it"},
};

inline constexpr ExtensionKey effort_motor[] = {
    {"joint", name, "", "", "the joint that it turns or slides; at most one motor each"},
    {"max_effort", positive, "N m or N", "", "greatest torque or force"},
    {"rotor_inertia", non_negative, "kg m^2 or kg", "0", "of what turns in the motor, as the joint feels it"},
};

inline constexpr ExtensionKey led_ring[] = {
    {"link", name, "", "", "the link that carries it"},
    {"pose", pose, "m, rad", "0 0 0 0 0 0", "of the ring in the link; the LEDs stand in its xy plane"},
    {"count", count, "1", "", "number of LEDs, numbered counter-clockwise"},
    {"first_bearing", real, "rad", "0", "of LED 0, from the ring's x axis"},
    {"spacing", real, "rad", "", "from one LED to the next"},
    {"ring_radius", non_negative, "m", "", "where the LEDs are"},
    {"intensity", non_negative, "1", "0",
     "what arrives of a white one at 1 m, for light sensors; 0: cameras alone see it"},
};

inline constexpr ExtensionKey loudspeaker[] = {
    {"link", name, "", "", "the link that carries it"},
    {"pose", pose, "m, rad", "0 0 0 0 0 0", "in the link"},
    {"max_frequency", positive, "Hz", "20000", "greatest frequency that can be commanded"},
    {"max_intensity", positive, "1", "1", "greatest intensity that can be commanded: what arrives at 1 m"},
};

inline constexpr auto joint_encoder = sensor({
    {"joint", name, "", "", "the joint that is measured"},
});

inline constexpr auto treel_encoder = sensor({
    {"drive", name, "", "", "the treel_drive that is measured"},
});

/// In the order of ProximityTechnique.
inline constexpr std::string_view proximity_techniques[] = {"ray", "random_ray", "five_rays", "shadow", "samples"};

inline constexpr auto proximity_ring = sensor({
    {"link", name, "", "", "the link that carries it"},
    {"pose", pose, "m, rad", "0 0 0 0 0 0", "of the ring in the link; the sensors look outwards in its xy plane"},
    {"count", count, "1", "", "number of sensors, numbered counter-clockwise"},
    {"first_bearing", real, "rad", "", "of sensor 0, from the ring's x axis"},
    {"spacing", real, "rad", "", "from one sensor to the next"},
    {"ring_radius", non_negative, "m", "", "where the rays start"},
    {"range", positive, "m", "", "length of the rays"},
    {"technique", choice, "", "ray", "`ray`, `random_ray`, `five_rays`, `shadow` or `samples`", false,
     proximity_techniques},
    {"cone", positive, "rad", "0.6981317007977318",
     "full angle that a sensor sees, less than half a turn; of `random_ray`, `five_rays` and `shadow`"},
    {"samples", uri, "", no_value, "file of the technique `samples`: a reading for each sensor"},
});

inline constexpr auto ground_sensors = sensor({
    {"link", name, "", "", "the link that carries them; the rays go along its -z axis"},
    {"place", vector, "m", "", "where a ray starts, in the link; any number", true},
    {"range", positive, "m", "", "length of the rays"},
});

inline constexpr auto light_sensors = sensor({
    {"link", name, "", "", "the link that carries them"},
    {"pose", pose, "m, rad", "0 0 0 0 0 0", "of the ring in the link; the sensors look outwards in its xy plane"},
    {"count", count, "1", "", "number of sensors, numbered counter-clockwise"},
    {"first_bearing", real, "rad", "", "of sensor 0, from the ring's x axis"},
    {"spacing", real, "rad", "", "from one sensor to the next"},
    {"gain", positive, "1", "1", "from the sum of what arrives to what the sigmoid is taken of"},
    {"samples", uri, "", no_value, "file of what each sensor reads of a lamp that gives 1 at 1 m"},
});

inline constexpr auto microphones = sensor({
    {"link", name, "", "", "the link that carries them"},
    {"place", vector, "m", "", "of a microphone in the link; any number", true},
    {"band", point, "Hz", "0 20000", "lowest and highest frequency of a band; any number", true},
    {"gain", positive, "1", "1", "from the sum of what arrives to what the sigmoid is taken of"},
    {"samples", uri, "", no_value, "file of what each microphone reads of a sound that gives 1 at 1 m"},
});

inline constexpr auto accelerometer = sensor({
    {"link", name, "", "", "the link that carries it"},
    {"pose", pose, "m, rad", "0 0 0 0 0 0", "in the link; it measures along its axes"},
});

inline constexpr auto inclinometer = sensor({
    {"link", name, "", "", "the link that carries it"},
    {"pose", pose, "m, rad", "0 0 0 0 0 0", "in the link; level when its z axis points up"},
});

inline constexpr auto range_and_bearing = sensor({
    {"link", name, "", "", "the link that carries it"},
    {"pose", pose, "m, rad", "0 0 0 0 0 0", "in the link: bearings are from its x axis, elevations from its xy plane"},
    {"range", positive, "m", "", "how far its messages reach"},
    {"message_size", count, "1", "", "values of a message"},
    {"capacity", count, "1", "16", "messages that are reported at a time, at the most"},
    {"range_noise", non_negative, "m", "0", "standard deviation of the Gaussian noise on ranges"},
    {"bearing_noise", non_negative, "rad", "0", "the same on bearings and elevations"},
});

inline constexpr auto climate_sensor = sensor({
    {"link", name, "", "", "the link that carries it"},
    {"place", vector, "m", "0 0 0", "in the link"},
    {"temperature_noise", non_negative, "K", "0", "standard deviation of the Gaussian noise on temperatures"},
    {"humidity_noise", non_negative, "1", "0", "the same on humidities"},
});

inline constexpr auto omnidirectional_camera = sensor({
    {"link", name, "", "", "the link that carries it"},
    {"pose", pose, "m, rad", "0 0 0 0 0 0", "in the link: bearings are from its x axis, elevations from its xy plane"},
    {"range", positive, "m", "", "how far it sees"},
    {"min_elevation", real, "rad", "-1.5707963267948966", "lowest elevation that it sees"},
    {"max_elevation", real, "rad", "1.5707963267948966", "highest elevation that it sees"},
    {"capacity", count, "1", "32", "spots that are reported at a time, at the most"},
    {"distance_noise", non_negative, "m", "0", "standard deviation of the Gaussian noise on distances"},
    {"bearing_noise", non_negative, "rad", "0", "the same on bearings and elevations"},
});

inline constexpr auto panorama = sensor({
    {"link", name, "", "", "the link that carries it"},
    {"pose", pose, "m, rad", "0 0 0 0 0 0", "in the link: columns start at its x axis, elevations at its xy plane"},
    {"width", count, "1", "", "columns, evenly all round; at least 4"},
    {"height", count, "1", "", "rows, evenly from one elevation to the other"},
    {"min_elevation", real, "rad", "-0.7853981633974483", "lower edge of the image"},
    {"max_elevation", real, "rad", "0.7853981633974483", "upper edge of the image"},
    {"range", positive, "m", no_value, "nothing is seen beyond; without end if absent"},
    {"sky", vector, "1", "0.6 0.75 0.95", "colour where nothing is seen"},
});

inline constexpr auto battery = sensor({
    {"capacity", positive, "J", "", "energy of a full one"},
    {"charge", fraction, "1", "1", "at first, of the capacity"},
    {"idle_power", non_negative, "W", "0", "of all that is not a motor"},
    {"motor_efficiency", positive, "1", "1", "mechanical power to what motors take; at most 1"},
});

inline constexpr std::string_view light_barriers[] = {"simple", "beam"};

inline constexpr auto gripper = sensor({
    {"link", name, "", "", "the link that carries it"},
    {"pose", pose, "m, rad", "0 0 0 0 0 0", "of the jaw in the link; x outwards, its sides open along y"},
    {"depth", positive, "m", "", "how far from there something may be to be grasped"},
    {"half_angle", positive, "rad", "", "how far aside of x"},
    {"height", positive, "m", "", "how far above or below"},
    {"closing_time", positive, "s", "0.5", "from open to closed"},
    {"holding_force", positive, "N", "60", "along each axis; above it slips"},
    {"holding_torque", positive, "N m", "3", "the same about each axis"},
    {"breaking_force", positive, "N", no_value, "above it lets go; never if absent"},
    {"breaking_torque", positive, "N m", no_value, "above it lets go; never if absent"},
    {"light_barrier", choice, "", "simple",
     "`simple`: whether something could be grasped; `beam`: whether a ray between the sides meets anything", false,
     light_barriers},
    {"jaw_width", positive, "m", "0.03", "length of the beam, through the middle of the depth"},
});

inline constexpr auto torque_sensor = sensor({
    {"joint", name, "", "", "the joint whose motor is measured"},
});

inline constexpr auto traction_sensor = sensor({
    {"joint", name, "", "", "the joint between the two links"},
});

inline constexpr ExtensionKey grip_ring[] = {
    {"pose", pose, "m, rad", "0 0 0 0 0 0", "of the circle in the link; it lies in its xy plane"},
    {"radius", positive, "m", "", "of the circle"},
};

inline constexpr ExtensionKey sound[] = {
    {"pose", pose, "m, rad", "0 0 0 0 0 0", "in the link"},
    {"frequency", positive, "Hz", "", "of the tone"},
    {"intensity", positive, "1", "", "what arrives at 1 m; it falls off with the square of the distance"},
    {"range", positive, "m", no_value, "nothing is heard beyond; without end if absent"},
    {"on", flag, "", "true", "whether it sounds at first"},
};

inline constexpr ExtensionKey marker[] = {
    {"pose", pose, "m, rad", "0 0 0 0 0 0", "in the link"},
    {"color", vector, "1", "", "red, green and blue, from 0 to 1"},
    {"on", flag, "", "true", "whether it can be seen at first"},
};

inline constexpr ExtensionKey climate_source[] = {
    {"pose", pose, "m, rad", "0 0 0 0 0 0", "in the link"},
    {"temperature", real, "K", "0", "added in its middle"},
    {"humidity", real, "1", "0", "relative, added in its middle"},
    {"spread", positive, "m", "", "at a distance d it adds exp(-d^2 / (2 spread^2)) of that"},
    {"on", flag, "", "true", "whether it acts at first"},
};

}  // namespace keys

inline constexpr Extension device_extensions[] = {
    {"treel_drive", "model", true, "Two tracks that share one rigid body, as of the s-bot.", keys::treel_drive,
     "actuators"},
    {"velocity_motor", "model", true, "A motor with a velocity loop on one joint.", keys::velocity_motor, "actuators"},
    {"position_motor", "model", true, "A motor that takes one joint to a position and holds it there.",
     keys::velocity_motor, "actuators"},
    {"effort_motor", "model", true, "A motor that gives a torque or a force on one joint.", keys::effort_motor,
     "actuators"},
    {"led_ring", "model", true, "LEDs of any colour around a link.", keys::led_ring, "actuators"},
    {"loudspeaker", "model", true, "A tone of any frequency and intensity.", keys::loudspeaker, "actuators"},
    {"joint_encoder", "model", true, "Measures position and velocity of one joint.", keys::joint_encoder, "sensors"},
    {"treel_encoder", "model", true, "Measures way and velocity of each track relative to the hull.",
     keys::treel_encoder, "sensors"},
    {"proximity_ring", "model", true, "A ring of infrared proximity sensors that look outwards.", keys::proximity_ring,
     "sensors"},
    {"ground_sensors", "model", true, "Infrared sensors that look down.", keys::ground_sensors, "sensors"},
    {"light_sensors", "model", true, "A ring of light sensors that look outwards.", keys::light_sensors, "sensors"},
    {"microphones", "model", true, "Hear sounds within bands of frequency.", keys::microphones, "sensors"},
    {"accelerometer", "model", true, "Measures acceleration less gravity.", keys::accelerometer, "sensors"},
    {"inclinometer", "model", true, "Measures roll and pitch against gravity.", keys::inclinometer, "sensors"},
    {"range_and_bearing", "model", true, "Messages to the robots around, which know where they come from.",
     keys::range_and_bearing, "sensors"},
    {"omnidirectional_camera", "model", true, "A camera that looks all round and reports coloured spots.",
     keys::omnidirectional_camera, "sensors"},
    {"panorama", "model", true, "A camera that looks all round and gives an image.", keys::panorama, "sensors"},
    {"climate_sensor", "model", true, "Temperature and humidity of the air.", keys::climate_sensor, "sensors"},
    {"battery", "model", true, "Feeds the robot, which stops when it is empty.", keys::battery, "sensors"},
    {"gripper", "model", true, "Grasps what is grippable, and holds it.", keys::gripper, "actuators"},
    {"torque_sensor", "model", true, "Measures what a joint's motor gives.", keys::torque_sensor, "sensors"},
    {"traction_sensor", "model", true, "Measures the force between two links, in the plane of the parent.",
     keys::traction_sensor, "sensors"},
    {"action", "model", true, "Something that a robot does and no joint stands for.", {}, "actuators"},
    {"grip_ring", "link", true, "A circle that grippers hold on to.", keys::grip_ring, "actuators"},
    {"grippable",
     "collision",
     false,
     "Whether grippers can hold on to it, anywhere.",
     {},
     "actuators",
     ExtensionValue::flag},
    {"sound", "link", true, "A tone that microphones hear.", keys::sound, "emitters"},
    {"marker", "link", true, "A coloured spot that cameras see.", keys::marker, "emitters"},
    {"climate_source", "link", true, "Warmth or moisture around a point.", keys::climate_source, "emitters"},
};

}  // namespace cohort::parsing
