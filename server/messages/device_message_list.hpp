// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "server/messages/device_message.hpp"

namespace cohort::messages {

using Values = std::span<const double>;

/// Returns the offset of the channel's first value. Throws std::logic_error if there is no such channel.
std::size_t offset_of(std::span<const Channel> channels, const std::string& channel, const description::Model& model);

/// The topic of a message: `group/leaf`, with the device's name in between as `naming` says.
struct DeviceTopic {
  enum class Naming : std::uint8_t { if_several, always, never };
  std::string group;
  std::string leaf{};  ///< if empty, the topic has no such part
  Naming naming = Naming::if_several;
};

/// Returns the names of topics, each with its device.
std::vector<std::string> topic_names(const std::vector<std::pair<DeviceTopic, std::string>>& topics);

/// Collects the messages of one model.
class DeviceMessageList {
 public:
  DeviceMessageList(const description::Model& model, std::span<const Channel> observation,
                    const std::optional<GeodeticPlace>& origin)
      : model_(model), observation_(observation), origin_(origin) {}

  const description::Model& model() const { return model_; }
  const std::optional<GeodeticPlace>& origin() const { return origin_; }
  std::size_t offset(const std::string& channel) const { return offset_of(observation_, channel, model_); }

  /// Adds a message without a pose. `fill_in(message, observation)` sets everything except the header.
  template <RosMessage Message, class Device, class Fill>
  DeviceMessage& add(const Device& device, DeviceTopic topic, const Fill& fill_in) {
    topics_.emplace_back(std::move(topic), device.name);
    DeviceMessage& added = messages_.emplace_back();
    added.devices = {device.name};
    added.frame = device.name;
    added.type = Message::type;
    added.definition = definition<Message>();
    added.period = device.readout.period;
    added.add = [fill_in](CdrWriter& writer, const ros::Header& header, Values observation) {
      Message message;
      message.header = header;
      fill_in(message, observation);
      writer.add(message);
    };
    return added;
  }
  /// Adds a message of a sensor with a fixed pose on a link.
  template <RosMessage Message, class Device, class Fill>
  DeviceMessage& add_placed(const Device& device, DeviceTopic topic, const PlaceOnLink& place, const Fill& fill_in) {
    DeviceMessage& added = add<Message>(device, std::move(topic), fill_in);
    set_place(added, place);
    return added;
  }
  static void set_place(DeviceMessage& message, const PlaceOnLink& place) {
    message.place_on_link = place;
    message.place = [place](const LinkPoses& X_WL) { return X_WL(place.link) * place.X_LS; };
  }

  std::vector<DeviceMessage> take();

 private:
  const description::Model& model_;
  std::span<const Channel> observation_;
  const std::optional<GeodeticPlace>& origin_;
  std::vector<DeviceMessage> messages_;
  std::vector<std::pair<DeviceTopic, std::string>> topics_;  // topic and device of each message
};

// Devices with messages in ROS.
void add_messages(DeviceMessageList& list, const description::Lidar& lidar);
void add_messages(DeviceMessageList& list, const description::Imu& imu);
void add_messages(DeviceMessageList& list, const description::Accelerometer& sensor);
void add_messages(DeviceMessageList& list, const description::Magnetometer& sensor);
void add_messages(DeviceMessageList& list, const description::AirPressureSensor& sensor);
void add_messages(DeviceMessageList& list, const description::ForceTorqueSensor& sensor);
void add_messages(DeviceMessageList& list, const description::ClimateSensor& sensor);
void add_messages(DeviceMessageList& list, const description::Battery& battery);
void add_messages(DeviceMessageList& list, const description::NavSat& receiver);
void add_messages(DeviceMessageList& list, const description::PanoramicCamera& camera);
void add_messages(DeviceMessageList& list, const description::ProximityRing& ring);
void add_messages(DeviceMessageList& list, const description::GroundSensors& sensors);
void add_joint_states(DeviceMessageList& list);

// Devices with messages in cohort_msgs.
void add_messages(DeviceMessageList& list, const description::ContactSensor& sensor);
void add_messages(DeviceMessageList& list, const description::LightSensors& sensors);
void add_messages(DeviceMessageList& list, const description::Microphones& microphones);
void add_messages(DeviceMessageList& list, const description::RangeAndBearing& receiver);
void add_messages(DeviceMessageList& list, const description::OmnidirectionalCamera& camera);
void add_messages(DeviceMessageList& list, const description::Gripper& gripper);
void add_messages(DeviceMessageList& list, const description::Inclinometer& sensor);
void add_messages(DeviceMessageList& list, const description::TractionSensor& sensor);
void add_messages(DeviceMessageList& list, const description::TreelEncoder& encoder);
void add_messages(DeviceMessageList& list, const description::TorqueSensor& sensor);
void add_messages(DeviceMessageList& list, const description::Rotor& rotor);
void add_messages(DeviceMessageList& list, const description::Altimeter& altimeter);
void add_messages(DeviceMessageList& list, const description::LogicalCamera& camera);
/// Adds the readings of a ring whose sensors do not measure distances.
void add_ring_readings(DeviceMessageList& list, const description::ProximityRing& ring);

}  // namespace cohort::messages
