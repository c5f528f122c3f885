// SPDX-License-Identifier: Apache-2.0
#include "server/recording/replay.hpp"

#include <algorithm>

#include "server/recording/mcap/format/mcap_error.hpp"
#include "server/simulation/action.hpp"

namespace cohort::recording {

Replay::Replay(const Recording& recording, unsigned threads)
    : recording_(recording), threads_(threads), ticks_(recording.ticks()) {}

Replay::~Replay() = default;

void Replay::begin_world(const WorldBegins& begins) {
  simulation_.reset();
  experiment_.reset();
  experiment_ = std::make_unique<description::Experiment>(recording_.experiment({begins, {}}));
  simulation_ = std::make_unique<Simulation>(*experiment_, threads_);
}

bool Replay::advance() {
  if (recorded_ && simulation_) apply_commands();
  const std::optional<RecordedTick> before = std::exchange(recorded_, ticks_.next());
  if (!recorded_) return false;
  const auto fail = [&](const std::string& problem) { throw McapError(recording_.file(), 0, problem); };

  if (recorded_->begins) {
    begin_world(*recorded_->begins);
    if (recorded_->snapshot)
      simulation_->restore(std::as_bytes(std::span(recorded_->snapshot->data)));
    else if (recorded_->tick != simulation_->tick())
      fail("the world begins at tick " + std::to_string(recorded_->tick) + " without a snapshot");
  } else {
    if (simulation_ == nullptr) fail("the beginning of the world is lost");
    if (before && recorded_->tick != before->tick + 1)
      fail("tick " + std::to_string(recorded_->tick) + " follows tick " + std::to_string(before->tick) +
           ": the ticks between them are lost, so the replay ends here");
    simulation_->step();
  }
  take_actions();
  return true;
}

void Replay::apply_commands() {
  const Commands& changes = recorded_->commands;
  const auto fail = [&](const std::string& problem) {
    throw McapError(recording_.file(), 0, "the commands of tick " + std::to_string(recorded_->tick) + problem);
  };
  const std::size_t count = changes.robots.size();
  for (std::size_t i = 0; i < count;) {
    const std::uint32_t robot = changes.robots[i];
    if (robot >= simulation_->robot_count()) fail(" do not match the robots of the world");
    const std::span<const double> before = simulation_->command(robot);
    std::vector<double> command(before.begin(), before.end());
    for (; i < count && changes.robots[i] == robot; ++i) {
      if (changes.places[i] >= command.size()) fail(" do not match the robots of the world");
      command[changes.places[i]] = changes.values[i];
    }
    if (const auto fault = simulation_->check_command(robot, command)) fail(" are invalid: " + fault->text);
    simulation_->set_command(robot, command);
  }
}

// Actions that were refused when they were recorded are refused again, and change nothing.
void Replay::take_actions() {
  std::vector<cohort::Action> actions;
  actions.reserve(recorded_->actions.size());
  try {
    for (const ActionTaken& taken : recorded_->actions)
      actions.push_back(action_from_bytes(std::as_bytes(std::span(taken.action)), experiment_->read_model));
  } catch (const std::invalid_argument& error) {
    throw McapError(recording_.file(), 0,
                    "an action at tick " + std::to_string(recorded_->tick) + " cannot be read: " + error.what());
  }
  if (!actions.empty()) simulation_->act(actions);
}

bool Replay::seek(std::chrono::nanoseconds log_time) {
  // Finds the start: the beginning of a world, or a snapshot.
  const Recording::World* world = &recording_.worlds().front();
  for (const Recording::World& each : recording_.worlds())
    if (each.log_time <= log_time) world = &each;
  std::chrono::nanoseconds start = world->log_time;
  const auto& snapshots = recording_.snapshots();
  const auto after = std::ranges::upper_bound(snapshots, log_time);
  if (after != snapshots.begin()) start = std::max(start, *std::prev(after));

  recorded_.reset();
  simulation_.reset();
  ticks_ = recording_.ticks(start);
  if (start > world->log_time) {
    recorded_ = ticks_.next();
    if (!recorded_ || !recorded_->snapshot)
      throw McapError(recording_.file(), 0, "the snapshot at " + std::to_string(start.count()) + " ns cannot be read");
    begin_world(world->begins);
    simulation_->restore(std::as_bytes(std::span(recorded_->snapshot->data)));
  } else if (!advance()) {
    return false;
  }
  while (recorded_->log_time < log_time)
    if (!advance()) return false;
  return true;
}

Verification verify(Replay& replay, std::chrono::nanoseconds from, std::chrono::nanoseconds to,
                    const std::function<bool(std::chrono::nanoseconds)>& progress) {
  Verification result;
  try {
    for (bool goes_on = replay.seek(from); goes_on && replay.recorded().log_time <= to; goes_on = replay.advance()) {
      const RecordedTick& recorded = replay.recorded();
      if (!progress(recorded.log_time)) break;
      if (!recorded.state_hash) continue;
      if (const std::uint64_t hash = replay.simulation().state_hash(); hash != *recorded.state_hash) {
        result.difference = {recorded.tick, recorded.log_time, *recorded.state_hash, hash};
        return result;
      }
      ++result.boundaries;
    }
  } catch (const std::exception& error) {
    result.problem = error.what();
  }
  return result;
}

}  // namespace cohort::recording
