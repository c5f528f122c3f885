// SPDX-License-Identifier: Apache-2.0
#include "server/messages/command_messages.hpp"

#include <cmath>
#include <numeric>
#include <stdexcept>

#include "idl/messages/cohort_device_messages.hpp"
#include "server/messages/device_message_list.hpp"

namespace cohort::messages {
namespace {

using Commanded = std::vector<double>;

Commanded values_of(const ros::ColorRGBA& color) { return {color.r, color.g, color.b}; }
Commanded values_of(const ros::Float64& value) { return {value.data}; }
Commanded values_of(const ros::Bool& flag) { return {flag.data ? 1.0 : 0.0}; }
Commanded values_of(const cohort_msgs::Sound& sound) { return {sound.frequency, sound.intensity}; }

class Commands {
 public:
  Commands(const description::Model& model, std::span<const Channel> channels) : model_(model), channels_(channels) {}

  // Adds messages for the whole ring, and for each LED.
  void operator()(const description::LedRing& leds) {
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < leds.count; ++i)
      for (const std::size_t place : places(leds.name + "/" + std::to_string(i) + "/color", 3)) all.push_back(place);
    add<ros::ColorRGBA>(leds, {"leds"}, all);
    for (std::size_t i = 0; i < leds.count; ++i)
      add<ros::ColorRGBA>(leds, {"leds", leds.name + "_" + std::to_string(i), DeviceTopic::Naming::never},
                          {all[3 * i], all[3 * i + 1], all[3 * i + 2]});
  }
  void operator()(const description::Gripper& gripper) {
    add<ros::Float64>(gripper, {"gripper", "opening"}, places(gripper.name + "/0/opening", 1));
  }
  void operator()(const description::Loudspeaker& loudspeaker) {
    const std::size_t frequency = place(loudspeaker.name + "/0/frequency");
    add<cohort_msgs::Sound>(loudspeaker, {"sound"}, {frequency, place(loudspeaker.name + "/0/intensity")});
  }
  // An empty message stops sending.
  void operator()(const description::RangeAndBearing& sender) {
    std::vector<std::size_t> all = places(sender.name + "/0/message", sender.message_size);
    all.push_back(place(sender.name + "/0/sending"));
    add<ros::Float64MultiArray>(
        sender, {"message"}, std::move(all),
        [size = sender.message_size, name = sender.name](const ros::Float64MultiArray& message) {
          Commanded values = message.data;
          const bool is_sending = !values.empty();
          if (is_sending && values.size() != size)
            throw std::invalid_argument("the message for '" + name + "' has " + std::to_string(values.size()) +
                                        " values; expected " + std::to_string(size) + ", or none to stop sending");
          values.resize(size);
          values.push_back(is_sending ? 1.0 : 0.0);
          return values;
        });
  }
  void operator()(const description::UserAction& action) {
    add<ros::Float64>(action, {"action", "", DeviceTopic::Naming::always}, places(action.name + "/0/value", 1));
  }
  void operator()(const description::DetachableJoint& joint) {
    add<ros::Bool>(joint, {"attached"}, places(joint.name + "/0/attached", 1));
  }
  template <class Other>
  void operator()(const Other&) {}

  std::vector<CommandMessage> take() {
    const std::vector<std::string> names = topic_names(topics_);
    for (std::size_t i = 0; i < messages_.size(); ++i) messages_[i].name = names[i];
    return std::move(messages_);
  }

 private:
  std::size_t place(const std::string& channel) const { return offset_of(channels_, channel, model_); }
  std::vector<std::size_t> places(const std::string& channel, std::size_t size) const {
    std::vector<std::size_t> result(size);
    std::iota(result.begin(), result.end(), place(channel));
    return result;
  }

  template <RosMessage Message, class Device>
  void add(const Device& device, DeviceTopic topic, std::vector<std::size_t> places) {
    add<Message>(device, std::move(topic), std::move(places),
                 [](const Message& message) { return values_of(message); });
  }
  // `values_in(message)` returns a value for each index, or one colour for all LEDs.
  template <RosMessage Message, class Device, class ValuesIn>
  void add(const Device& device, DeviceTopic topic, std::vector<std::size_t> places, const ValuesIn& values_in) {
    topics_.emplace_back(std::move(topic), device.name);
    const auto read = [places, values_in, name = device.name](CdrReader& reader, std::span<double> command) {
      const Commanded values = values_in(reader.get<Message>());
      for (const double value : values)
        if (!std::isfinite(value))
          throw std::invalid_argument("a value of the command for '" + name + "' is not finite");
      for (std::size_t i = 0; i < places.size(); ++i) command[places[i]] = values[i % values.size()];
    };
    messages_.push_back({"", device.name, Message::type, definition<Message>(), std::move(places), read});
  }

  const description::Model& model_;
  std::span<const Channel> channels_;
  std::vector<CommandMessage> messages_;
  std::vector<std::pair<DeviceTopic, std::string>> topics_;  // topic and device of each message
};

}  // namespace

std::vector<CommandMessage> command_messages(const description::Model& model, std::span<const Channel> command) {
  Commands commands(model, command);
  for (const description::Device& device : model.devices) std::visit(commands, device);
  return commands.take();
}

}  // namespace cohort::messages
