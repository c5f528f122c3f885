// SPDX-License-Identifier: Apache-2.0
#include "server/serving/scene_broadcast.hpp"

#include <algorithm>

#include "idl/messages/cdr.hpp"

namespace cohort::session {
namespace {

using namespace std::chrono_literals;

constexpr auto interval = 33ms;
constexpr auto watcher_count_interval = 200ms;
// A newcomer may miss what is sent before it knows the server, which can take seconds on a busy machine.
constexpr auto still_interval = 1s;
constexpr int share_of_time = 20;
// Larger messages omit data that is only useful in small worlds.
constexpr std::size_t largest_extra = 128 << 10;

std::span<const std::uint8_t> bytes_of(const messages::Bytes& bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

std::size_t values_of(const Simulation& simulation) {
  std::size_t values = 0;
  for (std::uint32_t robot = 0; robot < simulation.robot_count(); ++robot) {
    const RobotKind& kind = simulation.kinds()[simulation.kind_of(robot)];
    values += kind.observation_size + kind.command_size;
  }
  return values;
}

messages::Bytes robots_of(const Simulation& simulation, const viewing::SceneMaker& maker) {
  if (sizeof(double) * values_of(simulation) > largest_extra) return {};
  messages::SceneRobots robots;
  robots.robots.reserve(simulation.robot_count());
  for (std::uint32_t robot = 0; robot < simulation.robot_count(); ++robot) robots.robots.push_back(maker.robot(robot));
  return messages::encode(robots);
}

messages::Bytes contacts_of(const viewing::SceneMaker& maker) {
  messages::Bytes contacts = messages::encode(maker.contacts());
  return contacts.size() > largest_extra ? messages::Bytes() : contacts;
}

}  // namespace

SceneBroadcast::SceneBroadcast(wire::Participant& participant, const std::string& partition)
    : descriptions_(participant, partition), updates_(participant, partition) {}

bool SceneBroadcast::is_watched(Clock::time_point now) {
  if (now - watchers_counted_at_ > watcher_count_interval) {
    watchers_counted_at_ = now;
    const std::uint32_t before = std::exchange(watchers_, updates_.matched());
    has_newcomers_ = has_newcomers_ || watchers_ > before;
  }
  return watchers_ > 0;
}

void SceneBroadcast::publish(const Shown& shown, When when) {
  const Clock::time_point begin = Clock::now();
  if (!is_watched(begin)) return;
  if (when == When::due && begin < next_) return;
  if (when == When::for_newcomers && !has_newcomers_ && begin < next_ + still_interval) return;
  has_newcomers_ = false;
  if (!maker_ || run_ != shown.run || maker_->is_outdated()) describe(shown);
  update(shown);
  const Clock::time_point end = Clock::now();
  next_ = end + std::max<Clock::duration>(interval, share_of_time * (end - begin));
}

// The message also reaches viewers that connect later, as long as the server runs.
void SceneBroadcast::end(const std::string& how, const std::string& why) {
  maker_.reset();  // its simulation may be destroyed
  messages::Scene scene;
  scene.revision = ++revision_;
  scene.end = how;
  scene.end_text = why;
  const messages::Bytes bytes = messages::encode(scene);
  descriptions_.write({run_, revision_, bytes_of(bytes)});
}

void SceneBroadcast::describe(const Shown& shown) {
  run_ = shown.run;
  maker_.emplace(shown.simulation, ++revision_);
  const messages::Bytes scene = messages::encode(maker_->scene());
  descriptions_.write({shown.run, revision_, bytes_of(scene)});
}

void SceneBroadcast::update(const Shown& shown) {
  const Simulation& simulation = shown.simulation;
  const messages::Bytes frame = messages::encode(maker_->frame(shown.run, simulation.state_hash()));
  const messages::Bytes signals = messages::encode(maker_->signals());
  const messages::Bytes contacts = contacts_of(*maker_);
  const messages::Bytes robots = robots_of(simulation, *maker_);
  updates_.write({shown.run, revision_, simulation.tick(), bytes_of(frame), bytes_of(signals), bytes_of(contacts),
                  bytes_of(robots)});
}

}  // namespace cohort::session
