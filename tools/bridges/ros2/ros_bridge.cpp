// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/ros_bridge.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <thread>
#include <utility>
#include <variant>

#include "idl/messages/ros_geometry_messages.hpp"
#include "idl/messages/ros_type_hash.hpp"
#include "tools/bridges/common/gave_up.hpp"

namespace cohort::ros2 {
namespace {

namespace ros = messages::ros;
using description::RosSync;
using namespace std::chrono_literals;
using WallClock = std::chrono::steady_clock;

constexpr auto asked_every = 50ms;       // period of checks for a stop
constexpr auto announced_within = 20ms;  // is looked for so often
constexpr auto told_every = 10s;         // period of messages about awaited nodes
constexpr auto told_first = 2s;
constexpr auto told_again_after = 1s;  // a first frame that may have been lost

}  // namespace

RosBridge::RosBridge(Options options, const std::atomic<bool>& stop)
    : options_(std::move(options)),
      stop_(stop),
      participant_(options_.participant),
      graph_(participant_, [this] { note_change(); }),
      clock_(participant_, topic_endpoint("/clock", ros::Clock::type, messages::type_hash<ros::Clock>())) {
  format_ = gid_format();
  if (options_.services) {
    const auto note = [this](std::variant<SpawnedRobot, std::string> change) {
      const std::lock_guard lock(entity_changes_mutex_);
      entity_changes_.push_back(std::move(change));
      inbox_.wake();
    };
    options_.services->listener = {[note](SpawnedRobot robot) { note(std::move(robot)); },
                                   [note](const std::string& entity) { note(entity); }};
    services_.emplace(participant_, graph_, *options_.services, stop_);
  }
  if (services_ && format_) services_->announce(*format_);
}

ClientEnd RosBridge::run() {
  Client client(options_.client);
  while (!stop_) {
    std::array<pollfd, 2> ready{pollfd{client.descriptor(), POLLIN, 0}, pollfd{inbox_.descriptor(), POLLIN, 0}};
    ::poll(ready.data(), ready.size(), static_cast<int>(asked_every / 1ms));
    inbox_.clear();
    take_entity_changes(client);
    look_at_graph();
    take_messages();
    const std::optional<ClientEvent> event = client.next(0ms);
    if (!event) continue;
    if (const auto* ended = std::get_if<ClientEnded>(&*event)) {
      end_program();
      return ended->end;
    }
    try {
      if (const auto* lease = std::get_if<LeaseStart>(&*event)) begin(client, *lease);
      if (const auto* frame = std::get_if<Frame>(&*event)) answer(client, *frame);
      // The state of nodes is in the nodes, and is not saved here.
      if (const auto* save = std::get_if<SaveState>(&*event)) save->state->leave_out();
    } catch (const bridges::GaveUp&) {
      // The client says why, if it was not asked to stop.
    } catch (const std::exception& error) {
      client.fail(error.what());
    }
  }
  end_program();
  return ClientEnd::interrupted;
}

std::optional<GidFormat> RosBridge::gid_format() const {
  if (options_.gid_format) return options_.gid_format;
  const auto seen = graph_.gid_format();
  // Nodes in virtual time must have received the announcement before their clocks wait.
  return seen || options_.command.empty() ? seen : GidFormat::since_iron;
}

// Announcements are kept for later participants, and nodes of Humble that get short Gids list no nodes any more. So
// nothing is announced before a participant shows how long Gids are here, nor after the last one has gone.
void RosBridge::announce() {
  is_announced_ = true;
  if (format_)
    participant_.announce(*format_);
  else
    participant_.withdraw();
}

void RosBridge::take_messages() {
  for (const RosInbox::Message& message : inbox_.take())
    if (message.input < robot_of_input_.size() && robot_of_input_[message.input] != nullptr) {
      RosRobot& robot = *robot_of_input_[message.input];
      robot.take(message.input - robot.first_input(), message.bytes, message.writer);
    }
}

// On any thread.
void RosBridge::note_change() {
  graph_has_changed_ = true;
  inbox_.wake();
}

void RosBridge::look_at_graph() {
  for (const auto& robot : robots_) robot->tell_mistakes();
  if (!graph_has_changed_.exchange(false)) return;
  WritersByTopic writers;
  for (RosEndpoint& endpoint : graph_.endpoints())
    if (endpoint.is_writer) writers[endpoint.topic].push_back(std::move(endpoint));
  bool has_changed = false;
  for (const auto& robot : robots_) has_changed |= robot->follow(participant_, writers);
  if (const auto format = gid_format(); format != format_) {
    format_ = format;
    if (services_ && format_) services_->announce(*format_);
    has_changed = true;
  }
  if (has_changed && is_announced_) announce();
}

void RosBridge::answer(Client& client, const Frame& frame) {
  const bool is_first = std::exchange(is_first_frame_, false);
  shown_.clear();
  for (FrameRobot& robot : frame.robots)
    if (const auto found = robot_of_id_.find(robot.robot->start.robot); found != robot_of_id_.end())
      shown_.push_back({&robot, found->second});
  if (is_first && !options_.command.empty() && !program_) start_program(client, frame);
  if (is_first) wait_for_peers(client, frame);
  if (program_) program_->begin_frame(frame.time, end_of(frame), std::exchange(is_other_run_, false));
  tell(frame);
  cdr_.clear();
  cdr_.add(ros::Clock{ros::time(frame.time)});
  clock_.write(cdr_.bytes());
  if (program_) let_program_work(client);
  wait_for_commands(client, frame);
  for (const Shown& each : shown_) each.robot->answer(each.frame->command);
  client.answer();
}

void RosBridge::tell(const Frame& frame) {
  for (const Shown& each : shown_) {
    RosRobot& robot = *each.robot;
    std::optional<WorldPose> truth;
    if (robot.publications().wants_true_pose()) {
      if (!true_poses_) true_poses_ = std::make_unique<TruePoses>(options_.client);
      truth = true_poses_->pose(each.frame->robot->start.robot, robot.name(), frame.tick);
    }
    robot.tell_frame(*each.frame, frame.tick, frame.time, truth);
  }
}

void RosBridge::start_program(const Client& client, const Frame& frame) {
  program_ =
      std::make_unique<RosProgram>(RosProgram::Options{options_.command, options_.participant.domain.number, frame.time,
                                                       [this, &client] { return is_over(client); }, options_.tell});
  // Waits that the program does until its nodes are there take the time of the first frame. Discovery takes real time.
  constexpr auto longest_look = 5s;
  const std::size_t others = graph_.node_count();
  program_->begin_frame(frame.time, end_of(frame), false);
  for (auto since = WallClock::now(); program_->runs() && WallClock::now() - since < longest_look;) {
    program_->settle();
    if (program_->is_due()) {
      program_->go_on();
      since = WallClock::now();
      continue;
    }
    look_at_graph();
    const bool has_all = program_->nodes() > 0 && graph_.node_count() >= others + program_->nodes();
    if (has_all && graph_.is_complete() && participant_.is_announced_to(graph_.participants())) {
      program_->settle();  // a node may acknowledge what is announced to it before it has made use of it
      return;
    }
    inbox_.wait(announced_within);
  }
  if (program_->runs())
    options_.tell("no node of '" + options_.command + "' has appeared in ROS domain " +
                  std::to_string(options_.participant.domain.number) + ": the run begins without it");
}

void RosBridge::let_program_work(const Client& client) {
  program_->settle();
  wait_until_received(client);
  program_->settle();
  while (program_->go_on()) take_messages();
  look_at_graph();
}

// DDS sends lost messages again, some time later, to reliable readers.
void RosBridge::wait_until_received(const Client& client) const {
  constexpr auto at_most = 1s;
  const auto since = WallClock::now();
  const auto is_received = [](const auto& robot) { return robot->publications().is_received(); };
  while (!std::ranges::all_of(robots_, is_received) && WallClock::now() - since < at_most) {
    if (is_over(client)) throw bridges::GaveUp{};
    std::this_thread::sleep_for(100us);
  }
}

// The time of the next frame of any of the robots.
std::chrono::nanoseconds RosBridge::end_of(const Frame& frame) const {
  std::uint64_t next = std::numeric_limits<std::uint64_t>::max();
  for (const auto& robot : robots_) {
    const auto& [waits, period, phase, delay] = robot->policy();
    const std::uint64_t ahead = period - (frame.tick + period - phase) % period;
    next = std::min(next, frame.tick + ahead);
  }
  return next * step_;
}

void RosBridge::end_program() {
  constexpr auto ends_by_itself_within = 2s;
  if (program_) program_->end(stop_ ? 0s : ends_by_itself_within);
  program_.reset();
}

// Frames are told to those who are there. So the first one waits until nodes that are to answer have come, and know
// everything that is told here.
void RosBridge::wait_for_peers(const Client& client, const Frame& frame) {
  const auto since = WallClock::now();
  auto next_told = since + told_first;
  for (;;) {
    const RosRobot* awaited = nullptr;
    for (const Shown& each : shown_) {
      const RosRobot& robot = *each.robot;
      if (robot.settings().sync != RosSync::command || robot.is_given_up_after(WallClock::now() - since)) continue;
      const bool is_ready =
          robot.has_commander() && participant_.is_announced_to(graph_.listeners(robot.commanding_participants()));
      if (!is_ready) awaited = &robot;
    }
    if (awaited == nullptr) return;
    if (is_over(client)) throw bridges::GaveUp{};
    inbox_.wait(announced_within);
    look_at_graph();
    take_messages();
    if (WallClock::now() < next_told) continue;
    next_told = WallClock::now() + told_every;
    tell_awaited(*awaited, frame);
  }
}

void RosBridge::tell_awaited(const RosRobot& robot, const Frame& frame) const {
  const std::string who = robot.commanders();
  options_.tell("robot " + robot.name() + ": the run waits " +
                (who.empty()
                     ? "for a node that publishes " + robot.command_topic()
                     : "at tick " + std::to_string(frame.tick) + " for " + robot.command_topic() + " from " + who));
}

// The first robot whose command is not there and is still waited for.
RosRobot* RosBridge::awaited(std::chrono::nanoseconds waited) const {
  for (const Shown& each : shown_)
    if (!each.robot->is_answered() && !each.robot->is_given_up_after(waited)) return each.robot;
  return nullptr;
}

void RosBridge::wait_for_commands(const Client& client, const Frame& frame) {
  const auto since = WallClock::now();
  const auto waited = [&] { return WallClock::now() - since; };
  auto next_told = since + told_first;
  auto next_again = since + told_again_after;
  for (;;) {
    take_messages();
    RosRobot* const robot = awaited(waited());
    if (robot == nullptr) break;
    if (is_over(client)) throw bridges::GaveUp{};
    inbox_.wait(asked_every);
    look_at_graph();
    for (const Shown& each : shown_)
      if (!each.robot->is_answered()) each.robot->tell_again(false);
    if (WallClock::now() > next_again && robot->may_be_unheard()) {
      next_again += 2 * (next_again - since);
      robot->tell_again(true);
    }
    if (WallClock::now() < next_told) continue;
    next_told = WallClock::now() + told_every;
    tell_awaited(*robot, frame);
  }
  for (const Shown& each : shown_)
    if (!each.robot->is_answered()) each.robot->go_on_unanswered(frame.tick);
}

}  // namespace cohort::ros2
