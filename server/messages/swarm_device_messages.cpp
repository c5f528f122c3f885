// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "idl/messages/cohort_device_messages.hpp"
#include "server/messages/device_message_list.hpp"

/// Devices with messages in cohort_msgs.
namespace cohort::messages {
namespace {

template <class Device>
PlaceOnLink placed_at(const Device& device) {
  return {device.link, device.X_LS};
}

PlaceOnLink at_origin(std::size_t link) { return {link, {}}; }

template <class Ring>
void add_readings(DeviceMessageList& list, const Ring& ring, const char* topic) {
  const std::size_t at = ring.count == 0 ? 0 : list.offset(ring.name + "/0/reading");
  list.add_placed<cohort_msgs::RingReadings>(
      ring, {topic}, placed_at(ring),
      [at, count = ring.count, first = ring.first_bearing, spacing = ring.spacing](cohort_msgs::RingReadings& message,
                                                                                   Values values) {
        message.first_bearing = first;
        message.bearing_increment = spacing;
        const Values readings = values.subspan(at, count);
        message.readings.assign(readings.begin(), readings.end());
      });
}

ros::ColorRGBA color_at(Values values) {
  return {static_cast<float>(values[0]), static_cast<float>(values[1]), static_cast<float>(values[2]), 1.0F};
}

// Returns the number of valid elements out of `capacity`.
std::size_t count_at(Values values, std::size_t at, std::size_t capacity) {
  return std::min(capacity, static_cast<std::size_t>(std::max(0.0, values[at])));
}

}  // namespace

void add_ring_readings(DeviceMessageList& list, const description::ProximityRing& ring) {
  add_readings(list, ring, "proximity");
}

void add_messages(DeviceMessageList& list, const description::LightSensors& sensors) {
  add_readings(list, sensors, "light");
}

void add_messages(DeviceMessageList& list, const description::ContactSensor& sensor) {
  const std::size_t touching = list.offset(sensor.name + "/0/touching");
  const std::size_t force = list.offset(sensor.name + "/0/force");
  const Pose& X_LC = list.model().links[sensor.link].collisions[sensor.collision].X_LC;
  list.add_placed<cohort_msgs::Contact>(sensor, {"contacts", "", DeviceTopic::Naming::always}, {sensor.link, X_LC},
                                        [=](cohort_msgs::Contact& message, Values values) {
                                          message.touching = values[touching] >= 0.5;
                                          message.force = values[force];
                                        });
}

void add_messages(DeviceMessageList& list, const description::Microphones& microphones) {
  cohort_msgs::Sounds about;
  for (const Eigen::Vector3d& p_L : microphones.places_L) about.places.push_back({p_L.x(), p_L.y(), p_L.z()});
  for (const Eigen::Vector2d& band : microphones.bands) {
    about.lowest_frequencies.push_back(band.x());
    about.highest_frequencies.push_back(band.y());
  }
  const std::size_t at = about.places.empty() ? 0 : list.offset(microphones.name + "/0/intensity");
  list.add_placed<cohort_msgs::Sounds>(
      microphones, {"sounds"}, at_origin(microphones.link), [about, at](cohort_msgs::Sounds& message, Values values) {
        const ros::Header header = message.header;
        message = about;
        message.header = header;
        const Values heard = values.subspan(at, about.places.size() * about.lowest_frequencies.size());
        message.intensities.assign(heard.begin(), heard.end());
      });
}

void add_messages(DeviceMessageList& list, const description::RangeAndBearing& receiver) {
  const std::size_t at = list.offset(receiver.name + "/0/count");
  list.add_placed<cohort_msgs::RangeAndBearing>(
      receiver, {"messages"}, placed_at(receiver),
      [at, capacity = receiver.capacity, size = receiver.message_size](cohort_msgs::RangeAndBearing& message,
                                                                       Values values) {
        for (std::size_t i = 0; i < count_at(values, at, capacity); ++i) {
          const Values one = values.subspan(at + 1 + i * (3 + size), 3 + size);
          message.messages.push_back({one[0], one[1], one[2], {one.begin() + 3, one.end()}});
        }
      });
}

void add_messages(DeviceMessageList& list, const description::OmnidirectionalCamera& camera) {
  const std::size_t at = list.offset(camera.name + "/0/count");
  list.add_placed<cohort_msgs::Spots>(camera, {"spots"}, placed_at(camera),
                                      [at, capacity = camera.capacity](cohort_msgs::Spots& message, Values values) {
                                        for (std::size_t i = 0; i < count_at(values, at, capacity); ++i) {
                                          const Values one = values.subspan(at + 1 + 6 * i, 6);
                                          message.spots.push_back({one[0], one[1], one[2], color_at(one.subspan(3))});
                                        }
                                      });
}

void add_messages(DeviceMessageList& list, const description::Gripper& gripper) {
  const std::string prefix = gripper.name + "/0/";
  const std::size_t opening = list.offset(prefix + "opening"), gripping = list.offset(prefix + "gripping");
  const std::size_t force = list.offset(prefix + "force"), grippable = list.offset(prefix + "grippable");
  list.add_placed<cohort_msgs::GripperState>(gripper, {"gripper", "state"}, {gripper.link, gripper.X_LG},
                                             [=](cohort_msgs::GripperState& message, Values values) {
                                               message.opening = values[opening];
                                               message.gripping = values[gripping] >= 0.5;
                                               message.grippable = values[grippable] >= 0.5;
                                               message.force = values[force];
                                             });
}

void add_messages(DeviceMessageList& list, const description::Inclinometer& sensor) {
  const std::size_t roll = list.offset(sensor.name + "/0/roll"), pitch = list.offset(sensor.name + "/0/pitch");
  list.add_placed<cohort_msgs::Inclination>(sensor, {"inclination"}, placed_at(sensor),
                                            [=](cohort_msgs::Inclination& message, Values values) {
                                              message.roll = values[roll];
                                              message.pitch = values[pitch];
                                            });
}

// Expressed in the axes of the joint's parent, at its origin.
void add_messages(DeviceMessageList& list, const description::TractionSensor& sensor) {
  const std::string prefix = sensor.name + "/0/";
  const std::size_t direction = list.offset(prefix + "direction"), intensity = list.offset(prefix + "intensity");
  const std::size_t force = list.offset(prefix + "force");
  DeviceMessage& message =
      list.add<cohort_msgs::Traction>(sensor, {"traction"}, [=](cohort_msgs::Traction& traction, Values values) {
        traction.direction = values[direction];
        traction.intensity = values[intensity];
        traction.force = {values[force], values[force + 1], 0.0};
      });
  const std::size_t parent = list.model().joints[sensor.joint].parent;
  if (parent != description::Joint::world) DeviceMessageList::set_place(message, at_origin(parent));
}

void add_messages(DeviceMessageList& list, const description::TreelEncoder& encoder) {
  const std::size_t left = list.offset(encoder.name + "/left/position");
  const std::size_t right = list.offset(encoder.name + "/right/position");
  list.add<cohort_msgs::TrackEncoders>(encoder, {"tracks"}, [=](cohort_msgs::TrackEncoders& message, Values values) {
    message.left_position = values[left];
    message.left_velocity = values[left + 1];
    message.right_position = values[right];
    message.right_velocity = values[right + 1];
  });
}

void add_messages(DeviceMessageList& list, const description::TorqueSensor& sensor) {
  const description::Joint& joint = list.model().joints[sensor.joint];
  const bool slides = facts_of(joint.type).slides;
  const std::size_t at = list.offset(sensor.name + (slides ? "/0/force" : "/0/torque"));
  list.add<cohort_msgs::Effort>(sensor, {"effort", "", DeviceTopic::Naming::always},
                                [at, name = joint.name](cohort_msgs::Effort& message, Values values) {
                                  message.joint = name;
                                  message.effort = values[at];
                                });
}

void add_messages(DeviceMessageList& list, const description::Rotor& rotor) {
  const std::size_t at = list.offset(rotor.name + "/0/velocity");
  list.add<cohort_msgs::RotorVelocity>(
      rotor, {"rotor", "", DeviceTopic::Naming::always},
      [at](cohort_msgs::RotorVelocity& message, Values values) { message.velocity = values[at]; });
}

void add_messages(DeviceMessageList& list, const description::Altimeter& altimeter) {
  const std::size_t position = list.offset(altimeter.name + "/0/vertical_position");
  const std::size_t velocity = list.offset(altimeter.name + "/0/vertical_velocity");
  list.add_placed<cohort_msgs::Altitude>(altimeter, {"altitude"}, placed_at(altimeter),
                                         [=](cohort_msgs::Altitude& message, Values values) {
                                           message.vertical_position = values[position];
                                           message.vertical_velocity = values[velocity];
                                         });
}

void add_messages(DeviceMessageList& list, const description::LogicalCamera& camera) {
  constexpr std::size_t capacity = description::LogicalCamera::capacity;
  const std::string prefix = camera.name + "/0/";
  const std::size_t at = list.offset(prefix + "count"), object = list.offset(prefix + "object");
  const std::size_t position = list.offset(prefix + "position");
  const std::size_t orientation = list.offset(prefix + "orientation");
  list.add_placed<cohort_msgs::VisibleObjects>(
      camera, {"objects"}, placed_at(camera), [=](cohort_msgs::VisibleObjects& message, Values values) {
        for (std::size_t i = 0; i < count_at(values, at, capacity); ++i) {
          const Values p = values.subspan(position + 3 * i, 3), q = values.subspan(orientation + 4 * i, 4);
          message.objects.push_back({static_cast<std::uint32_t>(std::max(0.0, values[object + i])),
                                     {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}}});
        }
      });
}

}  // namespace cohort::messages
