// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/messages/ros_geometry_messages.hpp"

/// Messages of the ROS 2 package cohort_msgs (idl/cohort_msgs), for devices that have no standard ROS message. Angles
/// are in the frame of the header, counter-clockwise from its x axis; elevations are above its xy plane.
namespace cohort::messages::cohort_msgs {

using ros::ColorRGBA;
using ros::Header;
using ros::Point;
using ros::Pose;
using ros::Vector3;

/// Readings of a ring of light sensors, or of proximity sensors with a sample file. The bearing of sensor i is
/// `first_bearing` + i * `bearing_increment`.
struct RingReadings {
  Header header{};
  double first_bearing = 0;        ///< [rad]
  double bearing_increment = 0;    ///< [rad]
  std::vector<double> readings{};  ///< from 0 to 1, or in the unit of the sample file
  static constexpr const char* type = "cohort_msgs/msg/RingReadings";
  static constexpr auto fields = std::tuple(
      field("header", &RingReadings::header), field("first_bearing", &RingReadings::first_bearing),
      field("bearing_increment", &RingReadings::bearing_increment), field("readings", &RingReadings::readings));
  bool operator==(const RingReadings&) const = default;
};

/// Sound at microphones, all in the same frequency bands.
struct Sounds {
  Header header{};
  std::vector<Point> places{};                ///< positions of the microphones [m]
  std::vector<double> lowest_frequencies{};   ///< [Hz]
  std::vector<double> highest_frequencies{};  ///< [Hz]
  std::vector<double> intensities{};          ///< from 0 to 1: all bands of the first microphone, then of the next
  static constexpr const char* type = "cohort_msgs/msg/Sounds";
  static constexpr auto fields = std::tuple(field("header", &Sounds::header), field("places", &Sounds::places),
                                            field("lowest_frequencies", &Sounds::lowest_frequencies),
                                            field("highest_frequencies", &Sounds::highest_frequencies),
                                            field("intensities", &Sounds::intensities));
  bool operator==(const Sounds&) const = default;
};

/// A message from a neighbour, and the position of the neighbour.
struct NeighborMessage {
  double range = 0;      ///< [m]
  double bearing = 0;    ///< [rad]
  double elevation = 0;  ///< [rad]
  std::vector<double> message{};
  static constexpr const char* type = "cohort_msgs/msg/NeighborMessage";
  static constexpr auto fields =
      std::tuple(field("range", &NeighborMessage::range), field("bearing", &NeighborMessage::bearing),
                 field("elevation", &NeighborMessage::elevation), field("message", &NeighborMessage::message));
  bool operator==(const NeighborMessage&) const = default;
};

/// Messages from neighbours, the nearest first.
struct RangeAndBearing {
  Header header{};
  std::vector<NeighborMessage> messages{};
  static constexpr const char* type = "cohort_msgs/msg/RangeAndBearing";
  static constexpr auto fields =
      std::tuple(field("header", &RangeAndBearing::header), field("messages", &RangeAndBearing::messages));
  bool operator==(const RangeAndBearing&) const = default;
};

/// A coloured spot that a camera sees.
struct Spot {
  double bearing = 0;    ///< [rad]
  double elevation = 0;  ///< [rad]
  double distance = 0;   ///< [m]
  ColorRGBA color{};
  static constexpr const char* type = "cohort_msgs/msg/Spot";
  static constexpr auto fields = std::tuple(field("bearing", &Spot::bearing), field("elevation", &Spot::elevation),
                                            field("distance", &Spot::distance), field("color", &Spot::color));
  bool operator==(const Spot&) const = default;
};

/// Spots, the nearest first.
struct Spots {
  Header header{};
  std::vector<Spot> spots{};
  static constexpr const char* type = "cohort_msgs/msg/Spots";
  static constexpr auto fields = std::tuple(field("header", &Spots::header), field("spots", &Spots::spots));
  bool operator==(const Spots&) const = default;
};

struct GripperState {
  Header header{};
  double opening = 0;      ///< from 0 (closed) to 1 (open)
  bool gripping = false;   ///< true if it holds something
  bool grippable = false;  ///< true if there is something between the jaws
  double force = 0;        ///< force on the held object [N]
  static constexpr const char* type = "cohort_msgs/msg/GripperState";
  static constexpr auto fields =
      std::tuple(field("header", &GripperState::header), field("opening", &GripperState::opening),
                 field("gripping", &GripperState::gripping), field("grippable", &GripperState::grippable),
                 field("force", &GripperState::force));
  bool operator==(const GripperState&) const = default;
};

/// Inclination of the header's frame relative to gravity.
struct Inclination {
  Header header{};
  double roll = 0;   ///< [rad]
  double pitch = 0;  ///< [rad]
  static constexpr const char* type = "cohort_msgs/msg/Inclination";
  static constexpr auto fields = std::tuple(field("header", &Inclination::header), field("roll", &Inclination::roll),
                                            field("pitch", &Inclination::pitch));
  bool operator==(const Inclination&) const = default;
};

/// Force that the child link of a joint exerts on the parent link, in the xy plane of the parent.
struct Traction {
  Header header{};
  double direction = 0;  ///< [rad]
  double intensity = 0;  ///< [N]
  Vector3 force{};       ///< [N]
  static constexpr const char* type = "cohort_msgs/msg/Traction";
  static constexpr auto fields =
      std::tuple(field("header", &Traction::header), field("direction", &Traction::direction),
                 field("intensity", &Traction::intensity), field("force", &Traction::force));
  bool operator==(const Traction&) const = default;
};

/// Position and velocity of both tracks of a vehicle relative to its hull.
struct TrackEncoders {
  Header header{};
  double left_position = 0;   ///< [m]
  double left_velocity = 0;   ///< [m/s]
  double right_position = 0;  ///< [m]
  double right_velocity = 0;  ///< [m/s]
  static constexpr const char* type = "cohort_msgs/msg/TrackEncoders";
  static constexpr auto fields = std::tuple(
      field("header", &TrackEncoders::header), field("left_position", &TrackEncoders::left_position),
      field("left_velocity", &TrackEncoders::left_velocity), field("right_position", &TrackEncoders::right_position),
      field("right_velocity", &TrackEncoders::right_velocity));
  bool operator==(const TrackEncoders&) const = default;
};

/// The state of a contact sensor on a collision.
struct Contact {
  Header header{};
  bool touching = false;
  double force = 0;  ///< [N]
  static constexpr const char* type = "cohort_msgs/msg/Contact";
  static constexpr auto fields = std::tuple(field("header", &Contact::header), field("touching", &Contact::touching),
                                            field("force", &Contact::force));
  bool operator==(const Contact&) const = default;
};

/// Effort of a joint's motor.
struct Effort {
  Header header{};
  std::string joint{};
  double effort = 0;  ///< [N m], or [N] for a prismatic joint
  static constexpr const char* type = "cohort_msgs/msg/Effort";
  static constexpr auto fields =
      std::tuple(field("header", &Effort::header), field("joint", &Effort::joint), field("effort", &Effort::effort));
  bool operator==(const Effort&) const = default;
};

struct RotorVelocity {
  Header header{};
  double velocity = 0;  ///< [rad/s]
  static constexpr const char* type = "cohort_msgs/msg/RotorVelocity";
  static constexpr auto fields =
      std::tuple(field("header", &RotorVelocity::header), field("velocity", &RotorVelocity::velocity));
  bool operator==(const RotorVelocity&) const = default;
};

struct Altitude {
  Header header{};
  double vertical_position = 0;  ///< relative to the initial position of the sensor [m]
  double vertical_velocity = 0;  ///< [m/s]
  static constexpr const char* type = "cohort_msgs/msg/Altitude";
  static constexpr auto fields =
      std::tuple(field("header", &Altitude::header), field("vertical_position", &Altitude::vertical_position),
                 field("vertical_velocity", &Altitude::vertical_velocity));
  bool operator==(const Altitude&) const = default;
};

/// Position fix of a satellite navigation receiver in a world without geographic coordinates: east, north and up from
/// the world's origin.
struct LocalFix {
  Header header{};
  Point position{};    ///< [m]
  Vector3 velocity{};  ///< [m/s]
  static constexpr const char* type = "cohort_msgs/msg/LocalFix";
  static constexpr auto fields = std::tuple(field("header", &LocalFix::header), field("position", &LocalFix::position),
                                            field("velocity", &LocalFix::velocity));
  bool operator==(const LocalFix&) const = default;
};

/// An object that a logical camera sees.
struct VisibleObject {
  std::uint32_t object = 0;  ///< number of the object in the world
  Pose pose{};               ///< [m]
  static constexpr const char* type = "cohort_msgs/msg/VisibleObject";
  static constexpr auto fields =
      std::tuple(field("object", &VisibleObject::object), field("pose", &VisibleObject::pose));
  bool operator==(const VisibleObject&) const = default;
};

/// Objects, the nearest first.
struct VisibleObjects {
  Header header{};
  std::vector<VisibleObject> objects{};
  static constexpr const char* type = "cohort_msgs/msg/VisibleObjects";
  static constexpr auto fields =
      std::tuple(field("header", &VisibleObjects::header), field("objects", &VisibleObjects::objects));
  bool operator==(const VisibleObjects&) const = default;
};

/// The command of a loudspeaker.
struct Sound {
  double frequency = 0;  ///< [Hz]
  double intensity = 0;  ///< intensity at 1 m [1]
  static constexpr const char* type = "cohort_msgs/msg/Sound";
  static constexpr auto fields =
      std::tuple(field("frequency", &Sound::frequency), field("intensity", &Sound::intensity));
  bool operator==(const Sound&) const = default;
};

}  // namespace cohort::messages::cohort_msgs
