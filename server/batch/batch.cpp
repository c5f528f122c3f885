// SPDX-License-Identifier: Apache-2.0
#include "server/batch/batch.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "server/description/input_error.hpp"

namespace cohort {
namespace {

constexpr std::size_t pose_size = 7;

std::uint64_t last_tick_of(const description::Experiment& experiment) {
  if (experiment.duration.count() == 0) return std::numeric_limits<std::uint64_t>::max();
  return static_cast<std::uint64_t>(experiment.duration / experiment.world.step);
}

// The arrays of a batch have rows for the initial robots only, and its worlds share the experiment that new objects
// would be added to.
void refuse_spawners(const description::Experiment& experiment) {
  if (experiment.spawners.empty()) return;
  throw std::invalid_argument("an event spawns '" + experiment.spawners.front().name +
                              "_1' and so on, but the worlds of a batch cannot spawn objects: "
                              "expected `add` in place of `spawn`");
}

// Returns a chunk size that is small enough to keep all workers busy to the end, and large enough that the handover
// costs almost nothing.
std::size_t worlds_a_chunk(std::size_t worlds, unsigned threads) {
  constexpr std::size_t chunks_a_thread = 8;
  return std::clamp<std::size_t>(worlds / (threads * chunks_a_thread), 1, 16);
}

}  // namespace

Batch::Batch(const description::Experiment& experiment, std::size_t worlds, unsigned threads)
    : first_(experiment, 1), placer_(experiment.world), last_tick_(last_tick_of(experiment)), workers_(threads) {
  refuse_spawners(experiment);
  if (worlds == 0) throw std::invalid_argument("a batch needs at least one world");
  for (const description::Instance& instance : experiment.world.instances) described_poses_.push_back(instance.X_WM);
  for (std::size_t world = 0; world < worlds; ++world)
    worlds_.push_back(std::make_unique<Simulation>(first_, experiment.seed, described_poses_));
  robots_ = worlds_[0]->robot_count();
  for (const RobotKind& kind : kinds()) {
    observation_size_ = std::max(observation_size_, kind.observation_size);
    command_size_ = std::max(command_size_, kind.command_size);
  }
  observations_.resize(worlds * robots_ * observation_size_);
  commands_.resize(worlds * robots_ * command_size_);
  poses_.resize(worlds * robots_ * pose_size);
  done_.resize(worlds);
  failures_.resize(worlds);
  for (std::size_t world = 0; world < worlds; ++world) {
    fill_neutral(world);
    take(world);
  }
}

Batch::~Batch() = default;

std::vector<Pose> Batch::placed(std::uint64_t seed) const {
  std::vector<Pose> X_WM = described_poses_;
  try {
    if (!placer_.place(seed, std::span(X_WM).subspan(placer_.first(), placer_.count())))
      throw std::invalid_argument("seed " + std::to_string(seed) + " results in other population sizes than seed " +
                                  std::to_string(first_.experiment().seed));
  } catch (const description::InputError& error) {
    throw std::invalid_argument("seed " + std::to_string(seed) + ": " + error.what());
  }
  return X_WM;
}

void Batch::reset(std::size_t world, std::uint64_t seed) {
  expect_world(world);
  reset(world, seed, placed(seed));
}

void Batch::reset(std::size_t world, std::uint64_t seed, std::span<const Pose> X_WM) {
  expect_world(world);
  worlds_[world] = std::make_unique<Simulation>(first_, seed, X_WM);
  done_[world] = 0;
  std::ranges::fill(std::span(observations_).subspan(world * robots_ * observation_size_, robots_ * observation_size_),
                    0.0);
  fill_neutral(world);
  take(world);
}

void Batch::step(std::uint64_t ticks, std::span<const std::uint8_t> only, const std::atomic<bool>* stop) {
  if (ticks == 0) throw std::invalid_argument("expected at least one tick");
  if (!only.empty() && only.size() != worlds())
    throw std::invalid_argument("the selection has " + std::to_string(only.size()) + " worlds, expected " +
                                std::to_string(worlds()));
  const auto is_stepped = [&](std::size_t world) { return !stands_still(world) && (only.empty() || only[world] != 0); };
  for (std::size_t world = 0; world < worlds(); ++world)
    if (is_stepped(world)) check_commands(world);
  // The order alternates, as the worlds that were visited last are still in the cache.
  is_on_its_way_back_ = !is_on_its_way_back_;
  const auto visit = [&](std::size_t begin, std::size_t end, unsigned) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t world = is_on_its_way_back_ ? worlds() - 1 - i : i;
      if (is_stepped(world)) run(world, ticks, stop);
    }
  };
  workers_.for_each_chunk(worlds(), worlds_a_chunk(worlds(), workers_.threads()), visit);
  const auto first_failure = std::ranges::find_if(failures_, [](const std::string& text) { return !text.empty(); });
  if (first_failure == failures_.end()) return;
  const std::string text = "world " + std::to_string(first_failure - failures_.begin()) + ": " + *first_failure;
  for (std::string& each : failures_) each.clear();
  throw std::runtime_error(text);
}

void Batch::run(std::size_t world, std::uint64_t ticks, const std::atomic<bool>* stop) {
  Simulation& simulation = *worlds_[world];
  for (std::uint32_t robot = 0; robot < robots_; ++robot) simulation.set_command(robot, command(world, robot));
  try {
    for (std::uint64_t left = ticks; left > 0 && (stop == nullptr || !*stop); --left) {
      simulation.step();
      if (simulation.stop_reason() || simulation.tick() >= last_tick_) break;
    }
  } catch (const std::exception& error) {
    failures_[world] = error.what();
    done_[world] |= failed;
  }
  take(world);
}

void Batch::check_commands(std::size_t world) const {
  for (std::uint32_t robot = 0; robot < robots_; ++robot)
    if (const auto fault = worlds_[world]->check_command(robot, command(world, robot)))
      throw std::invalid_argument("world " + std::to_string(world) + ": " + fault->text);
}

std::span<const double> Batch::command(std::size_t world, std::uint32_t robot) const {
  return {commands_.data() + (world * robots_ + robot) * command_size_, kinds()[kind_of(robot)].command_size};
}

void Batch::fill_neutral(std::size_t world) {
  for (std::uint32_t robot = 0; robot < robots_; ++robot) {
    const std::span<const double> neutral = worlds_[world]->command(robot);
    std::ranges::copy(neutral,
                      commands_.begin() + static_cast<std::ptrdiff_t>((world * robots_ + robot) * command_size_));
  }
}

// Copies the visible state of a world.
void Batch::take(std::size_t world) {
  const Simulation& simulation = *worlds_[world];
  if (simulation.stop_reason()) done_[world] |= stopped;
  if (simulation.tick() >= last_tick_) done_[world] |= timed_out;
  for (std::uint32_t robot = 0; robot < robots_; ++robot) {
    const std::size_t row = world * robots_ + robot;
    std::ranges::copy(simulation.observation(robot), observations_.data() + row * observation_size_);
    const Pose X_WL = simulation.robot_pose(robot);
    const Eigen::Quaterniond& q = X_WL.orientation;
    const double numbers[pose_size] = {
        X_WL.position.x(), X_WL.position.y(), X_WL.position.z(), q.w(), q.x(), q.y(), q.z()};
    std::ranges::copy(numbers, poses_.data() + row * pose_size);
    if (simulation.objects().is_quarantined(simulation.body_of(robot).value)) done_[world] |= quarantined;
  }
}

void Batch::expect_world(std::size_t world) const {
  if (world >= worlds())
    throw std::invalid_argument("there is no world " + std::to_string(world) + ", expected one of 0 to " +
                                std::to_string(worlds() - 1));
}

}  // namespace cohort
