// SPDX-License-Identifier: Apache-2.0
#include "server/simulation/robots.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <sstream>

#include "server/actuation/make_actuator.hpp"
#include "server/sensing/make_sensor.hpp"

namespace cohort {
namespace {

constexpr std::size_t robots_a_chunk = 32;

std::size_t total_size(const std::vector<Channel>& channels) {
  std::size_t size = 0;
  for (const Channel& channel : channels) size += channel.size;
  return size;
}

void append(std::vector<Channel>& channels, const std::vector<Channel>& more) {
  channels.insert(channels.end(), more.begin(), more.end());
}

// Returns the number of teams if the robot is in none, as in a world without teams.
std::uint32_t find_team(const description::Experiment& experiment, std::uint32_t robot) {
  const auto has_it = [&](const description::Team& team) { return std::ranges::binary_search(team.robots, robot); };
  return static_cast<std::uint32_t>(std::ranges::find_if(experiment.teams, has_it) - experiment.teams.begin());
}

std::vector<double> neutral_values(const RobotKind& kind) {
  std::vector<double> values;
  for (const Channel& channel : kind.command) values.insert(values.end(), channel.size, channel.neutral);
  return values;
}

// Computes a sensor's observation at a tick, through its signal chain; `values` are those of the last tick at which the
// robot was due.
void observe(const sensing::Sensor& sensor, sensing::SignalChain& chain, std::uint64_t tick, bool is_due,
             std::span<double> values, std::vector<double>& scratch) {
  if (chain.is_immediate()) {
    if (!chain.measures_at(tick, is_due)) return;
    // Random walks also advance at ticks at which the robot is not due, but then its readings stay.
    scratch.resize(values.size());
    const std::span<double> measured = is_due ? values : std::span<double>(scratch);
    sensor.sense(tick, measured);
    chain.disturb(tick, measured);
    return;
  }
  if (chain.measures_at(tick, is_due)) {
    scratch.resize(values.size());
    sensor.sense(tick, scratch);
    chain.disturb(tick, scratch);
    chain.take(tick, scratch);
  }
  if (is_due) chain.report(tick, values);
}

}  // namespace

Robots::Robots(const Surroundings& around, const Robots* like)
    : around_(around),
      kinds_(like != nullptr ? like->kinds_ : std::make_shared<const Kinds>()),
      described_(around.experiment.world.robots.size()),
      scratch_(around.workers.threads()) {
  robots_.reserve(described_);
  while (robots_.size() < described_) add();
}

void Robots::add() {
  const auto id = size();
  const description::World& description = around_.experiment.world;
  Robot& robot = robots_.emplace_back();
  kept_.push_back(id);
  robot.body = BodyId{description.robots[id]};
  of_body_.resize(description.instances.size(), none);
  of_body_[robot.body.value] = id;
  robot.team = find_team(around_.experiment, id);
  if (robot.team < around_.experiment.teams.size()) robot.policy = around_.experiment.teams[robot.team].policy;

  DevicesOfRobot devices = make_devices(robot);
  robot.kind = find_or_add_kind(description.robot(id).model, devices);
  const KindParts& parts = kinds_->parts[robot.kind];
  robot.sensors.reserve(devices.sensors.size());
  for (auto& [sensor, device] : devices.sensors) {
    const std::size_t place = robot.sensors.size();
    if (sensor->has_shared_view()) sharing_views_.push_back({id, place});
    robot.sensors.push_back(
        {std::move(sensor),
         sensing::SignalChain(parts.signal_plans[place], around_.seed, name(id), description::name_of(*device)),
         parts.sensor_sizes[place]});
  }
  robot.actuators.reserve(devices.actuators.size());
  for (std::unique_ptr<actuation::Actuator>& actuator : devices.actuators)
    robot.actuators.push_back({std::move(actuator), parts.actuator_sizes[robot.actuators.size()]});
  robot.observation_offset = add_observation(around_.world.slot_of(robot.body), kinds()[robot.kind].observation_size);
  robot.command = parts.neutral;
}

// A robot has the values of the one whose slot it has taken, which was of the same kind.
std::size_t Robots::add_observation(std::uint32_t slot, std::size_t size) {
  constexpr std::size_t nowhere = 0xffffffffffffffff;
  if (slot >= observation_offsets_.size()) observation_offsets_.resize(slot + 1, nowhere);
  std::size_t& offset = observation_offsets_[slot];
  assert(offset == nowhere || offset + size <= observations_.size());
  if (offset == nowhere) {
    offset = observations_.size();
    observations_.resize(offset + size);
  }
  std::fill_n(observations_.begin() + static_cast<std::ptrdiff_t>(offset), size, 0.0);
  return offset;
}

void Robots::release(std::uint32_t id) {
  Robot& robot = robots_[id];
  robot.sensors = std::vector<SensorOfRobot>();
  robot.actuators = std::vector<ActuatorOfRobot>();
  robot.command = std::vector<double>();
  std::erase(kept_, id);
  std::erase_if(sharing_views_, [&](const Place& place) { return place.robot == id; });
}

Robots::DevicesOfRobot Robots::make_devices(const Robot& robot) {
  const description::World& description = around_.experiment.world;
  const description::Model& model = description.models[description.instances[robot.body.value].model];
  DevicesOfRobot made;
  for (std::size_t device = 0; device < model.devices.size(); ++device) {
    if (auto sensor = sensing::make_sensor({around_.world, around_.emitters, description, around_.grippers, views_,
                                            robot.body, DeviceId{device}, around_.seed})) {
      if (sensor->needs_record()) around_.world.record(robot.body);
      made.sensors.emplace_back(std::move(sensor), &model.devices[device]);
    }
    if (auto actuator =
            actuation::make_actuator({around_.world, around_.emitters, description, around_.grippers,
                                      around_.detachable_joints, around_.actions, robot.body, DeviceId{device}}))
      made.actuators.push_back(std::move(actuator));
  }
  return made;
}

std::uint32_t Robots::find_or_add_kind(std::size_t model, const DevicesOfRobot& devices) {
  if (model < kinds_->of_model.size() && kinds_->of_model[model] != none) return kinds_->of_model[model];
  const description::World& description = around_.experiment.world;
  RobotKind kind{description.models[model].name, {}, {}, 0, 0, model};
  KindParts parts;
  for (const auto& [sensor, device] : devices.sensors) {
    const std::vector<Channel> channels = sensor->channels();
    const description::Readout* const readout = description::readout_of(*device);
    parts.signal_plans.push_back(std::make_shared<const sensing::SignalPlan>(
        readout != nullptr ? *readout : description::Readout{}, channels, description.step));
    parts.sensor_sizes.push_back(total_size(channels));
    append(kind.observation, channels);
  }
  for (const std::unique_ptr<actuation::Actuator>& actuator : devices.actuators) {
    const std::vector<Channel> channels = actuator->channels();
    parts.actuator_sizes.push_back(total_size(channels));
    append(kind.command, channels);
  }
  kind.observation_size = total_size(kind.observation);
  kind.command_size = total_size(kind.command);
  parts.neutral = neutral_values(kind);

  auto more = std::make_shared<Kinds>(*kinds_);
  const auto known = static_cast<std::uint32_t>(more->described.size());
  more->of_model.resize(description.models.size(), none);
  more->of_model[model] = known;
  more->described.push_back(std::move(kind));
  more->parts.push_back(std::move(parts));
  kinds_ = std::move(more);
  return known;
}

bool Robots::is_due(std::uint32_t robot, std::uint64_t tick) const {
  const description::Policy& policy = robots_[robot].policy;
  return tick >= policy.phase && (tick - policy.phase) % policy.period == 0;
}

std::span<const double> Robots::observation(std::uint32_t robot) const {
  if (is_released(robot)) return {};
  return {observations_.data() + robots_[robot].observation_offset,
          kinds_->described[robots_[robot].kind].observation_size};
}

std::optional<std::uint64_t> Robots::measurement_at(std::uint32_t robot, std::size_t place, std::uint64_t tick) const {
  std::size_t end = 0;
  for (const SensorOfRobot& each : robots_[robot].sensors) {
    end += each.size;
    if (place < end) return each.signal_chain.measurement_at(tick);
  }
  return std::nullopt;
}

std::optional<CommandFault> Robots::check_command(std::uint32_t robot, std::span<const double> values) const {
  const RobotKind& kind = kinds_->described[robots_[robot].kind];
  if (values.size() != kind.command_size) return wrong_size(robot, values.size());
  std::size_t i = 0;
  for (const Channel& channel : kind.command) {
    for (std::uint32_t k = 0; k < channel.size; ++k, ++i) {
      const bool can_act = values[i] >= channel.lower && values[i] <= channel.upper && std::isfinite(values[i]);
      if (!can_act) return unfit(robot, channel, values[i]);
    }
  }
  return std::nullopt;
}

CommandFault Robots::wrong_size(std::uint32_t robot, std::size_t size) const {
  std::ostringstream text;
  text << "the command of " << name(robot) << " has " << size << " values, expected "
       << kinds_->described[robots_[robot].kind].command_size;
  return {CommandFault::Reason::wrong_size, "", text.str()};
}

CommandFault Robots::unfit(std::uint32_t robot, const Channel& channel, double value) const {
  std::ostringstream text;
  text << name(robot) << ": " << channel.name << " is " << value << " " << channel.unit << ", expected "
       << channel.lower << " to " << channel.upper;
  const bool finite = std::isfinite(value);
  return {finite ? CommandFault::Reason::out_of_range : CommandFault::Reason::not_finite, channel.name, text.str()};
}

bool Robots::set_command(std::uint32_t robot, std::span<const double> values) {
  if (is_released(robot)) return false;
  std::vector<double>& command = robots_[robot].command;
  assert(values.size() == command.size());
  // Compares bits, as the hash does: 0.0 and -0.0 differ.
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  if (std::ranges::equal(command, values, {}, bits, bits)) return false;
  std::ranges::copy(values, command.begin());
  return true;
}

bool Robots::set_neutral_command(std::uint32_t robot) {
  return set_command(robot, kinds_->parts[robots_[robot].kind].neutral);
}

void Robots::actuate() {
  for (const std::uint32_t id : kept_) {
    Robot& robot = robots_[id];
    if (std::ranges::any_of(robot.sensors, [](const SensorOfRobot& each) { return each.sensor->disables_robot(); }))
      robot.command = kinds_->parts[robot.kind].neutral;
    std::span<const double> values = robot.command;
    for (const ActuatorOfRobot& each : robot.actuators) {
      each.actuator->apply(values.first(each.size));
      values = values.subspan(each.size);
    }
    assert(values.empty());
  }
}

void Robots::update_shared_views(std::uint64_t tick) {
  for (const auto& [robot, place] : sharing_views_) {
    const SensorOfRobot& each = robots_[robot].sensors[place];
    if (is_present(robot) && each.signal_chain.measures_at(tick, is_due(robot, tick))) each.sensor->ask_shared_view();
  }
  views_.update(around_.workers);
}

void Robots::sense(std::uint64_t tick) {
  update_shared_views(tick);
  around_.workers.for_each_chunk(
      kept_.size(), robots_a_chunk, [&](std::size_t begin, std::size_t end, unsigned worker) {
        for (std::size_t i = begin; i < end; ++i) {
          const std::uint32_t id = kept_[i];
          if (!is_present(id)) continue;
          Robot& robot = robots_[id];
          const bool is_asked = is_due(id, tick);
          const bool was_asked = tick == 0 || is_due(id, tick - 1);
          std::span<double> values(observations_.data() + robot.observation_offset,
                                   kinds_->described[robot.kind].observation_size);
          for (SensorOfRobot& each : robot.sensors) {
            each.sensor->remember(tick, was_asked);
            observe(*each.sensor, each.signal_chain, tick, is_asked, values.first(each.size), scratch_[worker]);
            values = values.subspan(each.size);
          }
          assert(values.empty());
        }
      });
}

void Robots::hash(std::uint32_t robot, StateHash& hash) const {
  if (robot >= described_) hash.add(std::uint64_t{robots_[robot].team});
  for (const double value : observation(robot)) hash.add(value);
  for (const double value : robots_[robot].command) hash.add(value);
  for (const SensorOfRobot& each : robots_[robot].sensors) {
    each.sensor->hash(hash);
    each.signal_chain.hash(hash);
  }
}

void Robots::save(SnapshotWriter& writer) const {
  writer.add_count(robots_.size());
  for (const Robot& robot : robots_) {
    writer.add_count(robot.command.size());
    writer.add_all(robot.command.data(), robot.command.size());
    for (const SensorOfRobot& each : robot.sensors) {
      each.sensor->save(writer);
      each.signal_chain.save(writer);
    }
  }
  writer.add_count(observations_.size());
  writer.add_all(observations_.data(), observations_.size());
}

void Robots::restore(SnapshotReader& reader) {
  reader.expect_count(robots_.size(), "robots");
  for (Robot& robot : robots_) {
    reader.expect_count(robot.command.size(), "commanded values of a robot");
    reader.read_all(robot.command.data(), robot.command.size());
    const auto id = static_cast<std::uint32_t>(&robot - robots_.data());
    const auto fault = check_command(id, robot.command);
    if (fault && !is_released(id)) throw SnapshotError("snapshot: invalid command: " + fault->text);
    for (SensorOfRobot& each : robot.sensors) {
      each.sensor->restore(reader);
      each.signal_chain.restore(reader);
    }
  }
  reader.expect_count(observations_.size(), "observed values");
  reader.read_all(observations_.data(), observations_.size());
}

}  // namespace cohort
