// SPDX-License-Identifier: Apache-2.0
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

/// Actuators and sensors of robots, as plain data. Joints, links and devices are indices into those of the model.
/// Frames: L a link, S a sensor.
namespace cohort::description {

/// Position and velocity of one joint: observations `NAME/0/position` and `NAME/0/velocity`.
struct JointEncoder {
  std::string name;
  std::size_t joint = 0;
  Readout readout{};
};

/// Travel and velocity of each track relative to the hull: observations `NAME/left/position` [m], `NAME/left/velocity`
/// [m/s], and the same for the right track.
struct TreelEncoder {
  std::string name;
  std::size_t drive = 0;  ///< index into Model::devices of a TreelDrive
  Readout readout{};
};

/// Techniques for measuring proximity (thesis, section 3.2.1): one ray along the axis of each sensor, one random ray
/// within its cone, or five rays in its cone. `shadow` uses all directions around the ring in its plane, and `samples`
/// readings from a file.
enum class ProximityTechnique { ray, random_ray, five_rays, shadow, samples };

/// A ring of infrared proximity sensors in the xy plane of S that point outwards, numbered counter-clockwise from
/// `first_bearing`. Observations `NAME/I/reading`: 1 at contact, decreasing linearly to 0 at `range`.
struct ProximityRing {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  std::size_t count = 0;
  double first_bearing = 0.0;  ///< bearing of sensor 0, from the x axis of S [rad]
  double spacing = 0.0;        ///< between neighbours [rad]
  double ring_radius = 0.0;    ///< distance of the ray origins from the centre [m]
  double range = 0.0;          ///< length of the rays [m]
  Readout readout{};
  ProximityTechnique technique = ProximityTechnique::ray;
  double cone = 0.0;                         ///< full opening angle of a sensor, for techniques that use it [rad]
  std::shared_ptr<const Samples> samples{};  ///< for the technique `samples`: a reading for each sensor
};

/// Proximity sensors under a link that point down and detect where the ground ends. Observations `NAME/I/reading`: 1 at
/// contact, decreasing linearly to 0 at `range`.
struct GroundSensors {
  std::string name;
  std::size_t link = 0;
  std::vector<Eigen::Vector3d> places_L;  ///< origins of the rays [m]
  double range = 0.0;                     ///< [m]
  Readout readout{};
};

/// A ring of light sensors in the xy plane of S that point outwards, numbered like those of a ProximityRing.
/// Observations `NAME/I/reading`.
struct LightSensors {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  std::size_t count = 0;
  double first_bearing = 0.0;  ///< [rad]
  double spacing = 0.0;        ///< [rad]
  double gain = 1.0;           ///< applied to the summed intensity before the sigmoid [1]
  Readout readout{};
  std::shared_ptr<const Samples>
      samples{};  ///< for a lamp of intensity 1 at 1 m; they replace the inverse square and the cosine
};

/// Microphones that measure sounds within frequency bands. Observations `NAME/I/intensity`, a value for each band.
struct Microphones {
  std::string name;
  std::size_t link = 0;
  std::vector<Eigen::Vector3d> places_L;
  std::vector<Eigen::Vector2d> bands;  ///< minimum and maximum frequency of each [Hz]
  double gain = 1.0;
  Readout readout{};
  std::shared_ptr<const Samples> samples{};  ///< for a sound of intensity 1 at 1 m; they replace the inverse square
};

/// An accelerometer: acceleration minus gravity, observation `NAME/0/acceleration`, x y z in S [m/s^2].
struct Accelerometer {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  Readout readout{};
};

/// Tilt of S relative to gravity: observations `NAME/0/roll` and `NAME/0/pitch` [rad].
struct Inclinometer {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  Readout readout{};
};

/// LEDs of any colour around a link, numbered like the sensors of a ProximityRing. Commands `NAME/I/color`: red, green
/// and blue from 0 to 1.
struct LedRing {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  std::size_t count = 0;
  double first_bearing = 0.0;  ///< [rad]
  double spacing = 0.0;        ///< [rad]
  double ring_radius = 0.0;    ///< [m]
  double intensity = 0.0;      ///< intensity of each LED for light sensors, at full brightness [1]

  std::vector<DeviceEmitter> emitters() const;
};

/// A loudspeaker. Commands `NAME/0/frequency` [Hz] and `NAME/0/intensity` [1].
struct Loudspeaker {
  std::string name;
  std::size_t link = 0;
  Pose X_LE;
  double max_frequency = 0.0;  ///< [Hz]
  double max_intensity = 0.0;  ///< at 1 m [1]

  std::vector<DeviceEmitter> emitters() const;
};

/// A range-and-bearing device as in ARGoS: it sends messages to all robots within range and line of sight, which
/// measure the position of the sender. Commands `NAME/0/sending` and `NAME/0/message`; observation `NAME/0/count`, and
/// for each received message, nearest first, `NAME/I/range` [m], `NAME/I/bearing` and `NAME/I/elevation` [rad] in S,
/// and `NAME/I/message`.
struct RangeAndBearing {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  double range = 0.0;            ///< maximum range of messages [m]
  std::size_t message_size = 0;  ///< number of values in a message
  std::size_t capacity = 0;      ///< maximum number of messages in a report
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

/// An omnidirectional camera that reports coloured spots: visible markers and LEDs of other objects. Observation
/// `NAME/0/count`, and for each spot, nearest first, `NAME/I/bearing` and `NAME/I/elevation` [rad] in S,
/// `NAME/I/distance` [m] and `NAME/I/color`.
struct OmnidirectionalCamera {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  double range = 0.0;          ///< [m]
  double min_elevation = 0.0;  ///< above the xy plane of S [rad]
  double max_elevation = 0.0;
  std::size_t capacity = 0;  ///< maximum number of spots in a report
  Readout readout{};
};

/// A panoramic camera that produces an image: rows from the highest elevation to the lowest, each counter-clockwise
/// from the x axis of S. Observation `NAME/0/image`: red, green and blue of each pixel, from 0 to 1.
struct PanoramicCamera {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  std::size_t width = 0;   ///< pixels
  std::size_t height = 0;  ///< pixels
  double min_elevation = 0.0;
  double max_elevation = 0.0;
  double range = std::numeric_limits<double>::infinity();  ///< maximum distance at which things are seen [m]
  Eigen::Vector3d sky = Eigen::Vector3d::Zero();           ///< colour where nothing is seen
  Readout readout{};
};

/// A battery that powers the robot: observations `NAME/0/charge` [1] and `NAME/0/power` [W]. When it is empty, commands
/// have no effect: every channel has its neutral value.
struct Battery {
  std::string name;
  double capacity = 0.0;          ///< [J]
  double charge = 1.0;            ///< initial fraction of the capacity [1]
  double idle_power = 0.0;        ///< consumption of everything except motors [W]
  double motor_efficiency = 1.0;  ///< ratio of mechanical to electrical power of motors [1]
  Readout readout{};
};

/// A jaw that grasps grippable objects: a GripRing, or a grippable collision. G is between its open sides, with x
/// pointing outwards. Command `NAME/0/opening`, from 0 (closed) to 1; observations `NAME/0/opening` (the actual value),
/// `NAME/0/gripping` and `NAME/0/grippable` (0 or 1), `NAME/0/force` [N].
struct Gripper {
  /// How an object between the sides is detected: by whether it could be grasped, or by a ray from one side to the
  /// other.
  enum class LightBarrier { simple, beam };

  std::string name;
  std::size_t link = 0;
  Pose X_LG;
  // Region in which objects are accepted, from the origin of G:
  double depth = 0.0;           ///< maximum distance [m]
  double half_angle = 0.0;      ///< maximum angle from x, to either side [rad]
  double height = 0.0;          ///< maximum distance above or below the xy plane [m]
  double closing_time = 0.5;    ///< time to close fully [s]
  double holding_force = 60.0;  ///< along each axis; above it, the grip slips [N]
  double holding_torque =
      3.0;  ///< limit for the closed gripper; about the axis of the ring, it decreases to 0 when half open [N m]
  double breaking_force = std::numeric_limits<double>::infinity();   ///< above it, the gripper releases the object [N]
  double breaking_torque = std::numeric_limits<double>::infinity();  ///< [N m]
  LightBarrier light_barrier = LightBarrier::simple;
  double jaw_width = 0.03;  ///< length of the beam, which crosses the jaw at half the depth [m]
  Readout readout{};
};

/// A joint that fixes a link of another object while a command attaches it. Command `NAME/0/attached`.
struct DetachableJoint {
  std::string name;
  std::size_t link = 0;
  std::string child;                  ///< scoped name of the object
  std::string child_link{};           ///< link of the object; empty for its root link
  bool may_be_missing = false;        ///< a missing object is not an error
  Problem child_place{};              ///< position in the file, without a message
  bool is_initially_attached = true;  ///< the command is 1 until a controller sets it, otherwise 0

  HeldChild held_child() const;
};

/// Torque of the motor of a joint: observation `NAME/0/torque` [N m], or `NAME/0/force` [N] for a prismatic joint.
struct TorqueSensor {
  std::string name;
  std::size_t joint = 0;
  Readout readout{};
};

/// Force that the child of a joint exerts on its parent, in the xy plane of the parent: observations `NAME/0/direction`
/// [rad], `NAME/0/intensity` [N] and `NAME/0/force`, x and y.
struct TractionSensor {
  std::string name;
  std::size_t joint = 0;
  Readout readout{};
};

/// An action of a robot that no joint represents. Events of the experiment, or a handler in a program that uses
/// `Simulation`, define its effect. Command `NAME/0/value`, from 0 to 1.
struct UserAction {
  std::string name;
};

/// The list of all kinds: add a new kind here. They are in the order of the manuals, with those of SDF last.
using DeviceKinds =
    std::variant<TreelDrive, VelocityMotor, PositionMotor, EffortMotor, DifferentialDrive, AckermannDrive, Belt,
                 TrackedDrive, Rotor, LedRing, Loudspeaker, JointEncoder, TreelEncoder, ProximityRing, GroundSensors,
                 LightSensors, Microphones, Accelerometer, Inclinometer, RangeAndBearing, OmnidirectionalCamera,
                 PanoramicCamera, ClimateSensor, Battery, Gripper, DetachableJoint, TorqueSensor, TractionSensor,
                 UserAction, Imu, ForceTorqueSensor, Lidar, ContactSensor, Altimeter, Magnetometer, LogicalCamera,
                 AirPressureSensor, NavSat>;

/// A device of any of these kinds. Copy and move operations are defined in one source file, since compiling them in
/// each would take seconds.
struct Device : DeviceKinds {
  using DeviceKinds::DeviceKinds;
  Device();
  Device(const Device& other);
  Device(Device&& other) noexcept;
  Device& operator=(const Device& other);
  Device& operator=(Device&& other) noexcept;
  ~Device();
};

/// Returns the readout of a device; null if it is not a sensor.
Readout* readout_of(Device& device);
const Readout* readout_of(const Device& device);
const std::string& name_of(const Device& device);

// Properties of a device of any kind; see device_properties.hpp.

/// Returns all motors of the device on joints, except those of tracks with wheels, which depend on the fidelity.
std::vector<MotorLimits> motor_limits(const Device& device);
std::vector<BeltPlace> belts_of(const Device& device);
const TrackPair* tracks_of(const Device& device);   ///< null if it has none
const Thruster* thruster_of(const Device& device);  ///< null if it is none
/// Returns the number of outputs that the device drives other than joints: tracks, belts, a rotor.
std::size_t output_count(const Device& device);
std::vector<DeviceEmitter> emitters_of(const Device& device);
std::optional<HeldChild> held_child_of(const Device& device);
/// Returns why a planar world cannot have the device, such as `planar physics does not support rotor 'NAME'`; empty if
/// it can.
std::string reason_against_planar(const Device& device);

}  // namespace cohort::description
