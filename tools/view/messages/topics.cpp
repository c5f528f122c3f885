// SPDX-License-Identifier: Apache-2.0
#include "tools/view/messages/topics.hpp"

#include <utility>

#include "idl/messages/ros_messages.hpp"
#include "tools/view/messages/markers.hpp"
#include "tools/view/messages/view_messages.hpp"

namespace cohort::view {
namespace {

template <messages::RosMessage Message>
TopicInfo topic(const char* name) {
  const messages::RosDefinition definition = messages::definition<Message>();
  return {name, Message::type, messages::schema_text(definition)};
}

}  // namespace

const std::array<TopicInfo, topic_count>& topic_table() {
  static const std::array<TopicInfo, topic_count> table = {
      topic<messages::Scene>("/cohort/scene"),
      topic<messages::SceneFrame>("/cohort/frame"),
      topic<messages::SceneSignals>("/cohort/signals"),
      topic<messages::SceneContacts>("/cohort/contacts"),
      topic<ViewStatus>("/cohort/status"),
      topic<messages::SceneRobots>("/cohort/robots"),
      topic<ViewEvents>("/cohort/events"),
      topic<messages::ros::TFMessage>("/tf"),
      topic<MarkerArray>("/markers"),
  };
  return table;
}

void Topics::publish(Topic topic, std::chrono::nanoseconds time, recording::Bytes data) {
  {
    const std::lock_guard lock(mutex_);
    auto& newest = newest_.at(index_of(topic));
    const std::uint64_t version = newest == nullptr ? 1 : newest->version + 1;
    newest = std::make_shared<const Published>(Published{version, time, std::move(data)});
  }
  if (published_) published_();
}

std::shared_ptr<const Published> Topics::newest(Topic topic) const {
  const std::lock_guard lock(mutex_);
  return newest_.at(index_of(topic));
}

void Topics::add_reader(Topic topic) {
  ++readers_.at(index_of(topic));
  ++arrivals_;
}

void Topics::remove_reader(Topic topic) { --readers_.at(index_of(topic)); }

}  // namespace cohort::view
