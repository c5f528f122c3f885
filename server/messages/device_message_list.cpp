// SPDX-License-Identifier: Apache-2.0
#include "server/messages/device_message_list.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

namespace cohort::messages {

std::size_t offset_of(std::span<const Channel> channels, const std::string& channel, const description::Model& model) {
  std::size_t at = 0;
  for (const Channel& each : channels) {
    if (each.name == channel) return at;
    at += each.size;
  }
  throw std::logic_error("robots of the model " + model.name + " have no " + channel);
}

std::vector<std::string> topic_names(const std::vector<std::pair<DeviceTopic, std::string>>& topics) {
  std::map<std::string, std::set<std::string>> devices;  // by group
  for (const auto& [topic, device] : topics) devices[topic.group].insert(device);
  std::vector<std::string> names;
  for (const auto& [topic, device] : topics) {
    using Naming = DeviceTopic::Naming;
    const bool is_one_of_several = topic.naming == Naming::if_several && devices[topic.group].size() > 1;
    const bool is_named = topic.naming == Naming::always || is_one_of_several;
    names.push_back(topic.group + (is_named ? "/" + device : "") + (topic.leaf.empty() ? "" : "/" + topic.leaf));
  }
  return names;
}

std::vector<DeviceMessage> DeviceMessageList::take() {
  const std::vector<std::string> names = topic_names(topics_);
  for (std::size_t i = 0; i < messages_.size(); ++i) {
    messages_[i].name = names[i];
    // A frame must not be its own parent.
    if (std::ranges::find(model_.links, messages_[i].frame, &description::Link::name) != model_.links.end())
      messages_[i].frame += "_frame";
  }
  return std::move(messages_);
}

}  // namespace cohort::messages
