#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "server/core/pose.hpp"
#include "server/description/device_properties.hpp"
#include "server/description/drives.hpp"
#include "server/description/fluid_devices.hpp"
#include "server/description/readout.hpp"
#include "server/description/samples.hpp"
#include "server/description/sdf_sensors.hpp"

/// What robots can do and measure, as plain data. Joints, links and devices are indices into those of the model.
/// Frames: L a link, S a sensor.
namespace cohort::description {

/// Position and velocity of one joint: observations `NAME/0/position` and `NAME/0/velocity`.
struct JointEncoder {
  std::string name;
  std::size_t joint = 0;
  Readout readout{};
};

/// Way and velocity of each track relative to the hull: observations `NAME/left/position` [m], `NAME/left/velocity`
/// [m/s] and the same of the right.
struct TreelEncoder {
  std::string name;
  std::size_t drive = 0;  ///< index into Model::devices of a TreelDrive
  Readout readout{};
};

/// How proximity is measured (thesis, section 3.2.1): by a ray along the axis of each sensor, by one at random within
/// its cone, by five in its cone, by all directions round the ring in its plane, or by looking up samples.
enum class ProximityTechnique { ray, random_ray, five_rays, shadow, samples };

/// A ring of infrared proximity sensors in the xy plane of S, looking outwards, numbered counter-clockwise from
/// `first_bearing`. Observations `NAME/I/reading`: 1 at contact, falling linearly to 0 at `range`.
struct ProximityRing {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  std::size_t count = 0;
  double first_bearing = 0.0;  ///< of sensor 0, from the x axis of S [rad]
  double spacing = 0.0;        ///< between neighbours [rad]
  double ring_radius = 0.0;    ///< where the rays start [m]
  double range = 0.0;          ///< from there [m]
  Readout readout{};
  ProximityTechnique technique = ProximityTechnique::ray;
  double cone = 0.0;                         ///< full angle of what a sensor sees, where the technique has one [rad]
  std::shared_ptr<const Samples> samples{};  ///< of the technique of this name: a reading for each sensor
};

/// Rays down from places under a link, as a ring of proximity sensors has them outwards: they see where the ground
/// ends. Observations `NAME/I/reading`: 1 at contact, falling linearly to 0 at `range`.
struct GroundSensors {
  std::string name;
  std::size_t link = 0;
  std::vector<Eigen::Vector3d> places_L;  ///< where the rays start [m]
  double range = 0.0;                     ///< [m]
  Readout readout{};
};

/// A ring of light sensors in the xy plane of S, looking outwards, numbered as those of a ProximityRing. Observations
/// `NAME/I/reading`.
struct LightSensors {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  std::size_t count = 0;
  double first_bearing = 0.0;  ///< [rad]
  double spacing = 0.0;        ///< [rad]
  double gain = 1.0;           ///< from the sum of what arrives to the argument of the sigmoid [1]
  Readout readout{};
  std::shared_ptr<const Samples> samples{};  ///< of a lamp that gives 1 at 1 m, in place of its square and cosine
};

/// Microphones that hear sounds within bands of frequency. Observations `NAME/I/intensity`, a value for each band.
struct Microphones {
  std::string name;
  std::size_t link = 0;
  std::vector<Eigen::Vector3d> places_L;
  std::vector<Eigen::Vector2d> bands;  ///< lowest and highest frequency of each [Hz]
  double gain = 1.0;
  Readout readout{};
  std::shared_ptr<const Samples> samples{};  ///< of a sound that gives 1 at 1 m, in place of its square
};

/// What a mass on springs measures: acceleration less gravity, observation `NAME/0/acceleration`, x y z in S [m/s^2].
struct Accelerometer {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  Readout readout{};
};

/// How S leans, against gravity: observations `NAME/0/roll` and `NAME/0/pitch` [rad].
struct Inclinometer {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  Readout readout{};
};

/// LEDs of any colour around a link, numbered as the sensors of a ProximityRing. Commands `NAME/I/color`, red, green
/// and blue from 0 to 1.
struct LedRing {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  std::size_t count = 0;
  double first_bearing = 0.0;  ///< [rad]
  double spacing = 0.0;        ///< [rad]
  double ring_radius = 0.0;    ///< [m]
  double intensity = 0.0;      ///< of each as a lamp for light sensors, at full brightness [1]

  std::vector<DeviceEmitter> emitters() const;
};

/// Commands `NAME/0/frequency` [Hz] and `NAME/0/intensity` [1].
struct Loudspeaker {
  std::string name;
  std::size_t link = 0;
  Pose X_LE;
  double max_frequency = 0.0;  ///< [Hz]
  double max_intensity = 0.0;  ///< what arrives at 1 m [1]

  std::vector<DeviceEmitter> emitters() const;
};

/// Messages to the robots around, as ARGoS's range-and-bearing system has them: whoever is near enough and in sight
/// hears them and knows where they came from. Commands `NAME/0/sending` and `NAME/0/message`; observations
/// `NAME/0/count` and, of as many as were heard, the nearest first, `NAME/I/range` [m], `NAME/I/bearing` and
/// `NAME/I/elevation` [rad] in S, `NAME/I/message`.
struct RangeAndBearing {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  double range = 0.0;            ///< that its messages reach [m]
  std::size_t message_size = 0;  ///< values of a message
  std::size_t capacity = 0;      ///< messages that are reported at a time
  Readout readout{};

  std::vector<DeviceEmitter> emitters() const;
};

/// Temperature [K] and relative humidity [1] of the air: observations `NAME/0/temperature` and `NAME/0/humidity`.
struct ClimateSensor {
  std::string name;
  std::size_t link = 0;
  Eigen::Vector3d p_LS = Eigen::Vector3d::Zero();
  Readout readout{};
};

/// A camera that looks all round and reports coloured spots: markers and LEDs of others that are in sight. Observations
/// `NAME/0/count` and, of as many spots, the nearest first, `NAME/I/bearing` and `NAME/I/elevation` [rad] in S,
/// `NAME/I/distance` [m] and `NAME/I/color`.
struct OmnidirectionalCamera {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  double range = 0.0;          ///< [m]
  double min_elevation = 0.0;  ///< above the xy plane of S [rad]
  double max_elevation = 0.0;
  std::size_t capacity = 0;  ///< spots that are reported at a time
  Readout readout{};
};

/// A camera that looks all round and gives an image: rows from the highest elevation to the lowest, each from the x
/// axis of S counter-clockwise. Observation `NAME/0/image`: red, green and blue of each pixel, from 0 to 1.
struct PanoramicCamera {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  std::size_t width = 0;   ///< pixels
  std::size_t height = 0;  ///< pixels
  double min_elevation = 0.0;
  double max_elevation = 0.0;
  double range = std::numeric_limits<double>::infinity();  ///< what is further away is not seen [m]
  Eigen::Vector3d sky = Eigen::Vector3d::Zero();           ///< where nothing is seen
  Readout readout{};
};

/// What feeds the robot: observations `NAME/0/charge` [1] and `NAME/0/power` [W]. When it is empty, commands do nothing
/// any more: every channel has its neutral value.
struct Battery {
  std::string name;
  double capacity = 0.0;          ///< [J]
  double charge = 1.0;            ///< at first, of the capacity [1]
  double idle_power = 0.0;        ///< of all that is not a motor [W]
  double motor_efficiency = 1.0;  ///< mechanical power to what motors take [1]
  Readout readout{};
};

/// A jaw that grasps what is grippable: a GripRing, or a collision that is. G is between its open sides, x outwards.
/// Command `NAME/0/opening`, from 0, closed, to 1; observations `NAME/0/opening` as it is, `NAME/0/gripping` and
/// `NAME/0/grippable` (0 or 1), `NAME/0/force` [N].
struct Gripper {
  /// How it is found out that there is something between the sides: whether something could be grasped, or by a ray
  /// from one to the other.
  enum class LightBarrier { simple, beam };

  std::string name;
  std::size_t link = 0;
  Pose X_LG;
  // What is accepted, from the origin of G:
  double depth = 0.0;           ///< how far [m]
  double half_angle = 0.0;      ///< how far aside of x it may be [rad]
  double height = 0.0;          ///< how far above or below [m]
  double closing_time = 0.5;    ///< from open to closed [s]
  double holding_force = 60.0;  ///< along each axis; above it slips [N]
  double holding_torque = 3.0;  ///< of the closed gripper; about the ring's axis it falls to 0 half open [N m]
  double breaking_force = std::numeric_limits<double>::infinity();   ///< above it lets go [N]
  double breaking_torque = std::numeric_limits<double>::infinity();  ///< [N m]
  LightBarrier light_barrier = LightBarrier::simple;
  double jaw_width = 0.03;  ///< length of the beam, through the middle of the depth [m]
  Readout readout{};
};

/// Holds a link of another object of the world fast, until it is told to let go. Command `NAME/0/attached`, 1 at first.
struct DetachableJoint {
  std::string name;
  std::size_t link = 0;
  std::string child;            ///< scoped name of the object
  std::string child_link{};     ///< of it; empty: its root link
  bool may_be_missing = false;  ///< that there is no such object is no mistake
  Problem child_place{};        ///< where a file says so, without a message

  HeldChild held_child() const;
};

/// Of a joint's motor: observation `NAME/0/torque` [N m], or of a sliding one `NAME/0/force` [N].
struct TorqueSensor {
  std::string name;
  std::size_t joint = 0;
  Readout readout{};
};

/// What the child of a joint exerts on its parent, in the xy plane of the parent: observations `NAME/0/direction`
/// [rad], `NAME/0/intensity` [N] and `NAME/0/force`, x and y.
struct TractionSensor {
  std::string name;
  std::size_t joint = 0;
  Readout readout{};
};

/// Something that a robot does and no joint stands for: events of the experiment, or a handler of whoever uses
/// `Simulation`, say what comes of it. Command `NAME/0/value`, from 0 to 1.
struct UserAction {
  std::string name;
};

/// The register: a new kind is one more here. In the order in which manuals have them, SDF's own ones last.
using DeviceKinds =
    std::variant<TreelDrive, VelocityMotor, PositionMotor, EffortMotor, DifferentialDrive, AckermannDrive, Belt,
                 TrackedDrive, Rotor, LedRing, Loudspeaker, JointEncoder, TreelEncoder, ProximityRing, GroundSensors,
                 LightSensors, Microphones, Accelerometer, Inclinometer, RangeAndBearing, OmnidirectionalCamera,
                 PanoramicCamera, ClimateSensor, Battery, Gripper, DetachableJoint, TorqueSensor, TractionSensor,
                 UserAction, Imu, ForceTorqueSensor, Lidar, ContactSensor, Altimeter, Magnetometer, LogicalCamera,
                 AirPressureSensor>;

/// One of these. Copying and moving are in one source: each that had them to itself would compile for seconds.
struct Device : DeviceKinds {
  using DeviceKinds::DeviceKinds;
  Device();
  Device(const Device& other);
  Device(Device&& other) noexcept;
  Device& operator=(const Device& other);
  Device& operator=(Device&& other) noexcept;
  ~Device();
};

/// How the readings of a device come out; null if it senses nothing.
Readout* readout_of(Device& device);
const Readout* readout_of(const Device& device);
const std::string& name_of(const Device& device);

// What the stages ask of a device, whatever its kind: see device_properties.hpp.

/// Of all motors on joints that the device is; those of tracks with wheels depend on the fidelity and are not among
/// them.
std::vector<MotorLimits> motor_limits(const Device& device);
std::vector<BeltPlace> belts_of(const Device& device);
const TrackPair* tracks_of(const Device& device);   ///< null: it has none
const Thruster* thruster_of(const Device& device);  ///< null: it is none
/// Returns how many things other than joints the device drives: tracks, belts, a rotor.
std::size_t output_count(const Device& device);
std::vector<DeviceEmitter> emitters_of(const Device& device);
std::optional<HeldChild> held_child_of(const Device& device);
/// Why no planar world can have the device, as `rotor 'NAME' cannot be planar`; empty if one can.
std::string reason_against_planar(const Device& device);

}  // namespace cohort::description
