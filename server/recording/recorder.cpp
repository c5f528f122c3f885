// SPDX-License-Identifier: Apache-2.0
#include "server/recording/recorder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "server/recording/facts.hpp"
#include "server/recording/mcap/writing/disk_file.hpp"

namespace cohort::recording {
namespace {

std::optional<PeriodicTicks> ticks_at_rate(double rate, std::chrono::nanoseconds step) {
  return rate > 0.0 ? std::optional(PeriodicTicks::at_rate(rate, step)) : std::nullopt;
}

std::optional<PeriodicTicks> ticks_every(std::chrono::nanoseconds interval, std::chrono::nanoseconds step) {
  return interval.count() > 0 ? std::optional(PeriodicTicks(interval, step)) : std::nullopt;
}

std::vector<RecordedChannel> recorded(const std::vector<cohort::Channel>& channels) {
  std::vector<RecordedChannel> result;
  result.reserve(channels.size());
  for (const cohort::Channel& channel : channels) result.push_back({channel.name, channel.unit, channel.size});
  return result;
}

ros::TransformStamped transform(const std::string& frame, const Pose& X_PF, const ros::Time& now,
                                const std::string& parent = "world") {
  const auto& p = X_PF.position;
  const auto& q = X_PF.orientation;
  return {{now, parent}, frame, {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}}};
}

// Returns the state of the joints with one coordinate.
ros::JointState joint_state(const description::Model& model, const physics::World& world, std::uint32_t body,
                            ros::Header header) {
  ros::JointState state;
  state.header = std::move(header);
  for (std::size_t joint = 0; joint < model.joints.size(); ++joint) {
    const description::JointType type = model.joints[joint].type;
    if (type != description::JointType::revolute && type != description::JointType::prismatic) continue;
    state.name.push_back(model.joints[joint].name);
    const physics::JointState now = world.joint_state(BodyId{body}, JointId{joint});
    state.position.push_back(now.position);
    state.velocity.push_back(now.velocity);
    state.effort.push_back(now.effort);
  }
  return state;
}

std::vector<std::uint8_t> bytes_of(std::span<const std::byte> bytes) {
  std::vector<std::uint8_t> result(bytes.size());
  std::ranges::transform(bytes, result.begin(), [](std::byte byte) { return std::to_integer<std::uint8_t>(byte); });
  return result;
}

}  // namespace

template <messages::RosMessage Message>
Recorder::Topic Recorder::add_topic(const std::string& topic, bool is_latched) {
  return {add_ros_channel(file_, topic, add_ros_schema<Message>(file_), is_latched)};
}

Recorder::Recorder(const std::filesystem::path& file, const description::Experiment& experiment)
    : Recorder(std::make_shared<DiskFile>(file), {}, experiment, experiment.recorded) {}

Recorder::Recorder(std::shared_ptr<ByteStore> store, RecordingOptions options,
                   const description::Experiment& experiment, description::Recorded recorded)
    : file_(std::move(store), std::move(options)),
      recorded_(std::move(recorded)),
      world_(add_topic<WorldBegins>(WorldBegins::topic, true)),
      roster_(add_topic<Roster>(Roster::topic, true)),
      boundary_(add_topic<Boundary>(Boundary::topic)),
      commands_(add_topic<Commands>(Commands::topic)),
      action_(add_topic<ActionTaken>(ActionTaken::topic)),
      event_(add_topic<RecordedEvent>(RecordedEvent::topic)),
      miss_(add_topic<RecordedMiss>(RecordedMiss::topic)),
      snapshot_(add_topic<RecordedSnapshot>(RecordedSnapshot::topic)),
      clock_(add_topic<ros::Clock>("/clock")),
      transforms_(add_topic<ros::TFMessage>("/tf")) {
  file_.add_metadata({facts_name, facts_of(experiment)});
  if (experiment.inputs == nullptr) return;
  file_.add_metadata({inputs_name, entries_of(*experiment.inputs)});
  for (const description::KeptFile& input : experiment.inputs->files) file_.add_attachment(attachment_of(input));
}

// Running out of memory ends the recording, and not the run.
template <class Act>
void Recorder::unless_memory_lacks(const Act& act) {
  try {
    act();
  } catch (const std::bad_alloc&) {
    file_.end_early("out of memory");
  }
}

void Recorder::begin(const description::Experiment& experiment, const Simulation& simulation, Beginning reason) {
  if (experiment_ != nullptr) {
    ++run_;
    log_offset_ = last_log_time_ + experiment.world.step - simulation.time();
  }
  experiment_ = &experiment;
  simulation_ = &simulation;
  const std::chrono::nanoseconds step = experiment.world.step;
  pose_ticks_ = ticks_at_rate(recorded_.pose_rate, step);
  joint_ticks_ = ticks_at_rate(recorded_.joint_rate, step);
  observation_ticks_ = ticks_at_rate(recorded_.observation_rate, step);
  snapshot_ticks_ = ticks_every(recorded_.snapshot_interval, step);
  for (Observed& observed : observed_)
    for (Measured& sensor : observed.sensors) sensor.times.begin(0);
  unless_memory_lacks([&] {
    const bool is_first = observed_.empty() && observation_ticks_;
    if (is_first) add_observed();
    write(world_, WorldBegins{run_, static_cast<std::uint8_t>(reason), experiment.seed, simulation.tick(),
                              experiment.duration.count(), log_offset_.count()});
    write_roster();
    if (is_first) write_static_places();
    if (reason == Beginning::restored || reason == Beginning::attached) write_snapshot(Importance::essential);
  });
}

void Recorder::add_observed() {
  const std::span<const RobotKind> kinds = simulation_->kinds();
  sensors_.resize(kinds.size());
  std::set<std::uint32_t> seen;
  for (std::uint32_t robot = 0; robot < simulation_->robot_count(); ++robot)
    if (const std::uint32_t kind = simulation_->kind_of(robot); seen.insert(kind).second) {
      sensors_[kind] =
          messages::device_messages(simulation_->description().robot_model(robot), kinds[kind].observation);
      // If all joints are recorded, their topic has the true values and not those of the encoders.
      if (joint_ticks_) std::erase_if(sensors_[kind], [](const auto& sensor) { return sensor.name == "joint_states"; });
    }
  static_transforms_ = add_topic<ros::TFMessage>("/tf_static", true);
  std::vector<SchemaId> schemas;
  for (const RobotKind& kind : kinds)
    schemas.push_back(file_.add_schema(observation_type(kind.model), "ros2msg", observation_schema(kind.observation)));
  std::map<std::string, SchemaId> schema_of;  // by type
  for (const std::uint32_t robot : recorded_.observed) {
    const std::string name = "/" + simulation_->robot_name(robot);
    const std::uint32_t kind = simulation_->kind_of(robot);
    Observed& observed = observed_.emplace_back();
    observed.robot = robot;
    observed.topic = {add_ros_channel(file_, name + observation_topic_end, schemas[kind])};
    for (const messages::DeviceMessage& sensor : sensors_[kind]) {
      if (!schema_of.contains(sensor.type))
        schema_of[sensor.type] = file_.add_schema(sensor.type, "ros2msg", messages::schema_text(sensor.definition));
      observed.sensors.push_back({{add_ros_channel(file_, name + "/" + sensor.name, schema_of[sensor.type])},
                                  MeasurementTimes(sensor, *simulation_, robot)});
    }
  }
}

void Recorder::write_roster() {
  Roster roster;
  for (const RobotKind& kind : simulation_->kinds())
    roster.kinds.push_back({kind.model, recorded(kind.observation), recorded(kind.command)});
  for (std::uint32_t robot = 0; robot < simulation_->robot_count(); ++robot) {
    const std::span<const double> command = simulation_->command(robot);
    roster.robots.push_back(
        {simulation_->robot_name(robot), "", simulation_->kind_of(robot), {command.begin(), command.end()}});
  }
  for (const description::Team& team : simulation_->experiment().teams)
    for (const std::uint32_t robot : team.robots) roster.robots[robot].team = team.name;
  write(roster_, roster);
  robots_told_ = simulation_->robot_count();
}

template <messages::RosMessage Message>
void Recorder::write(Topic& topic, const Message& message, Importance importance) {
  cdr_.clear();
  cdr_.add(message);
  write_bytes(topic, cdr_.bytes(), importance);
}

void Recorder::write_bytes(Topic& topic, ByteView bytes, Importance importance) {
  const std::chrono::nanoseconds time = simulation_->time();
  last_log_time_ = time + log_offset_;
  file_.write_message(topic.channel, topic.sequence++, last_log_time_, time, bytes, importance);
}

void Recorder::event(std::string_view kind, std::string_view text, std::uint64_t count) {
  unless_memory_lacks([&] {
    write(event_, RecordedEvent{simulation_->tick(), std::string(kind), std::string(text), count});
  });
}

void Recorder::miss(const RecordedMiss& miss) {
  unless_memory_lacks([&] { write(miss_, miss); });
}

void Recorder::action(std::string_view text, std::span<const std::byte> action) {
  unless_memory_lacks([&] { write(action_, ActionTaken{simulation_->tick(), std::string(text), bytes_of(action)}); });
}

void Recorder::boundary() {
  unless_memory_lacks([this] {
    if (simulation_->robot_count() != robots_told_) write_roster();
    write(boundary_, Boundary{simulation_->tick(), simulation_->state_hash()});
    keep_commands();
    if (is_now(snapshot_ticks_) && simulation_->tick() > 0) write_snapshot(Importance::display);
    if (is_now(pose_ticks_)) write_poses();
    if (is_now(joint_ticks_)) write_joints();
    if (observation_ticks_) write_observations();
  });
}

void Recorder::commands(std::span<const std::uint32_t> robots) {
  unless_memory_lacks([&] { write_commands(robots); });
}

void Recorder::write_commands(std::span<const std::uint32_t> robots) {
  changes_.tick = simulation_->tick();
  changes_.robots.clear();
  changes_.places.clear();
  changes_.values.clear();
  for (const std::uint32_t robot : robots) {
    const std::span<const double> now = simulation_->command(robot);
    const double* const before = commands_before_.data() + command_offsets_[robot];
    for (std::uint32_t place = 0; place < now.size(); ++place) {
      if (std::bit_cast<std::uint64_t>(now[place]) == std::bit_cast<std::uint64_t>(before[place])) continue;
      changes_.robots.push_back(robot);
      changes_.places.push_back(place);
      changes_.values.push_back(now[place]);
    }
  }
  if (!changes_.values.empty()) write(commands_, changes_);
}

void Recorder::keep_commands() {
  const std::uint32_t robots = simulation_->robot_count();
  command_offsets_.resize(robots);
  commands_before_.clear();
  for (std::uint32_t robot = 0; robot < robots; ++robot) {
    const std::span<const double> values = simulation_->command(robot);
    command_offsets_[robot] = commands_before_.size();
    commands_before_.insert(commands_before_.end(), values.begin(), values.end());
  }
}

void Recorder::write_snapshot(Importance importance) {
  write(snapshot_, RecordedSnapshot{simulation_->tick(), bytes_of(simulation_->save())}, importance);
}

void Recorder::write_poses() {
  const ros::Time now = ros::time(simulation_->time());
  write(clock_, ros::Clock{now}, Importance::display);
  ros::TFMessage message;
  const Objects& objects = simulation_->objects();
  for (std::uint32_t object = 0; object < objects.size(); ++object) {
    if (!objects.is_present(object) || is_static(object)) continue;
    message.transforms.push_back(transform(objects.name(object), simulation_->object_pose(object), now));
  }
  write(transforms_, message, Importance::display);
}

// Writes the joints of all objects that have some, with the poses of all links except the root, which is among the
// poses.
void Recorder::write_joints() {
  const ros::Time now = ros::time(simulation_->time());
  ros::TFMessage places;
  const Objects& objects = simulation_->objects();
  for (std::uint32_t object = 0; object < objects.size(); ++object) {
    const description::Model& model = simulation_->description().models[simulation_->world().model_of(BodyId{object})];
    if (!objects.is_present(object) || model.joints.empty()) continue;
    for (std::size_t link = 1; link < model.links.size(); ++link)
      places.transforms.push_back(transform(objects.name(object) + "/" + model.links[link].name,
                                            simulation_->world().link_pose(BodyId{object}, LinkId{link}), now));
    const ros::JointState state = joint_state(model, simulation_->world(), object, {now, objects.name(object)});
    if (!state.name.empty()) write(topic_of_joints(object), state, Importance::display);
  }
  if (!places.transforms.empty()) write(transforms_, places, Importance::display);
}

Recorder::Topic& Recorder::topic_of_joints(std::uint32_t object) {
  const std::string& name = simulation_->objects().name(object);
  const auto known = joints_.find(name);
  if (known != joints_.end()) return known->second;
  if (joint_schema_ == 0) joint_schema_ = add_ros_schema<ros::JointState>(file_);
  return joints_[name] = {add_ros_channel(file_, "/" + name + "/joint_states", joint_schema_)};
}

bool Recorder::is_static(std::uint32_t object) const {
  return simulation_->description().models[simulation_->world().model_of(BodyId{object})].is_static;
}

// An observation that falls on a tick at which the robot is not due is recorded when it is due next.
bool Recorder::is_observed_now(std::uint32_t robot) const {
  const std::uint64_t tick = simulation_->tick();
  if (!simulation_->is_present(robot) || !simulation_->is_due(robot, tick)) return false;
  const std::uint32_t period = simulation_->policy(robot).period;
  return tick < period || observation_ticks_->count(tick) != observation_ticks_->count(tick - period);
}

void Recorder::write_observations() {
  const ros::Time now = ros::time(simulation_->time());
  ros::TFMessage places;
  for (auto& [robot, topic, sensors] : observed_) {
    if (!simulation_->is_present(robot))
      for (Measured& sensor : sensors) sensor.times.begin(simulation_->tick() + 1);
    if (!is_observed_now(robot)) continue;
    cdr_.clear();
    cdr_.add(now);
    for (const double value : simulation_->observation(robot)) cdr_.add(value);
    write_bytes(topic, cdr_.bytes(), Importance::display);
    write_sensors(robot, sensors);
    add_places(robot, places);
  }
  if (!places.transforms.empty()) write(transforms_, places, Importance::display);
}

// Writes each measurement once, with the time at which it was taken.
void Recorder::write_sensors(std::uint32_t robot, std::span<Measured> topics) {
  const std::vector<messages::DeviceMessage>& sensors = sensors_[simulation_->kind_of(robot)];
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const std::optional<std::uint64_t> measured = topics[i].times.next(*simulation_);
    if (!measured) continue;
    const ros::Time then = ros::time(experiment_->world.step * static_cast<std::int64_t>(*measured));
    cdr_.clear();
    sensors[i].add(cdr_, {then, frame_of(robot, sensors[i].frame)}, simulation_->observation(robot));
    write_bytes(topics[i].topic, cdr_.bytes(), Importance::display);
  }
}

std::string Recorder::frame_of(std::uint32_t robot, const std::string& part) const {
  return simulation_->robot_name(robot) + "/" + part;
}

// Returns the frame of a link; the root link has the frame of its robot.
std::string Recorder::frame_of_link(std::uint32_t robot, std::size_t link) const {
  if (link == 0) return simulation_->robot_name(robot);
  return frame_of(robot, simulation_->description().robot_model(robot).links[link].name);
}

// Writes the poses of sensors that are fixed to their links, once.
void Recorder::write_static_places() {
  const ros::Time now = ros::time(simulation_->time());
  ros::TFMessage places;
  std::set<std::string> known;  // a device may have several messages
  for (const Observed& observed : observed_)
    for (const messages::DeviceMessage& sensor : sensors_[simulation_->kind_of(observed.robot)]) {
      const std::string frame = frame_of(observed.robot, sensor.frame);
      if (!sensor.place_on_link || !known.insert(frame).second) continue;
      const auto& [link, X_LS] = *sensor.place_on_link;
      places.transforms.push_back(transform(frame, X_LS, now, frame_of_link(observed.robot, link)));
    }
  write(static_transforms_, places);
}

// Adds the poses of a robot's links with sensors, and of sensors that are not fixed to a link, unless they are recorded
// anyway.
void Recorder::add_places(std::uint32_t robot, ros::TFMessage& places) const {
  const ros::Time now = ros::time(simulation_->time());
  const messages::LinkPoses X_WL = [&](std::size_t link) {
    return simulation_->world().link_pose(simulation_->body_of(robot), LinkId{link});
  };
  const std::string& name = simulation_->robot_name(robot);
  if (!pose_ticks_) places.transforms.push_back(transform(name, X_WL(0), now));
  const Pose X_RW = X_WL(0).inverse();
  std::set<std::size_t> links;
  for (const messages::DeviceMessage& sensor : sensors_[simulation_->kind_of(robot)]) {
    if (sensor.place_on_link && sensor.place_on_link->link != 0)
      links.insert(sensor.place_on_link->link);
    else if (sensor.place && !sensor.place_on_link)
      places.transforms.push_back(transform(frame_of(robot, sensor.frame), X_RW * sensor.place(X_WL), now, name));
  }
  if (joint_ticks_) return;
  for (const std::size_t link : links)
    places.transforms.push_back(transform(frame_of_link(robot, link), X_RW * X_WL(link), now, name));
}

std::uint64_t Recorder::dropped() const {
  std::uint64_t count = 0;
  for (const auto& [channel, messages] : file_.dropped()) count += messages;
  return count;
}

void Recorder::finish(std::string_view end, std::string_view reason) {
  begin_finishing(end, reason);
  file_.close();
}

void Recorder::begin_finishing(std::string_view end, std::string_view reason) {
  file_.add_metadata({end_name,
                      {{"end", std::string(end)},
                       {"reason", std::string(reason)},
                       {"ticks", std::to_string(simulation_ == nullptr ? 0 : simulation_->tick())},
                       {"dropped", std::to_string(dropped())}}});
  file_.begin_closing();
}

}  // namespace cohort::recording
