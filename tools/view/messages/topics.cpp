#include "tools/view/messages/topics.hpp"

#include <utility>

#include "server/recording/ros_messages.hpp"
#include "tools/view/messages/markers.hpp"
#include "tools/view/messages/view_messages.hpp"

namespace cohort::view {
namespace {

template <recording::RosMessage Message>
TopicInfo topic(const char* name) {
  const recording::RosDefinition definition = recording::definition<Message>();
  return {name, Message::type, recording::schema_text(definition)};
}

}  // namespace

const std::array<TopicInfo, topic_count>& topic_table() {
  static const std::array<TopicInfo, topic_count> table = {
      topic<viewing::Scene>("/cohort/scene"),
      topic<viewing::SceneFrame>("/cohort/frame"),
      topic<viewing::SceneSignals>("/cohort/signals"),
      topic<viewing::SceneContacts>("/cohort/contacts"),
      topic<ViewStatus>("/cohort/status"),
      topic<viewing::SceneRobots>("/cohort/robots"),
      topic<ViewEvents>("/cohort/events"),
      topic<recording::ros::TFMessage>("/tf"),
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
