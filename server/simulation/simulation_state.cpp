// The state of a simulation, hashed, saved and restored.

#include "server/core/hash.hpp"
#include "server/core/random.hpp"
#include "server/core/snapshot.hpp"
#include "server/simulation/simulation.hpp"

namespace cohort {
namespace {

constexpr std::size_t bodies_a_chunk = 64;
constexpr std::uint64_t snapshot_mark = 0x746f6873'74726f68u;

}  // namespace

std::vector<std::byte> Simulation::save() const {
  SnapshotWriter writer;
  writer.add(snapshot_mark);
  writer.add(hash_name(COHORT_VERSION));
  writer.add(static_cast<std::uint64_t>(experiment_.seed));
  writer.add(static_cast<std::uint64_t>(experiment_.world.step.count()));
  writer.add(tick_);
  spawned_models_.save(writer);
  world_->save(writer);
  objects_.save(writer);
  schedule_.save(writer);
  emitters_.save(writer);
  grippers_.save(writer);
  actions_.save(writer);
  writer.add_count(robots_.size());
  for (const Robot& robot : robots_) {
    writer.add_count(robot.command.size());
    writer.add_all(robot.command.data(), robot.command.size());
    for (const SensorOfRobot& each : robot.sensors) {
      each.sensor->save(writer);
      each.readout.save(writer);
    }
  }
  writer.add_count(observations_.size());
  writer.add_all(observations_.data(), observations_.size());
  writer.add(touches_.robot_ticks);
  writer.add(touches_.obstacles);
  writer.add(touches_.robots);
  return writer.bytes();
}

void Simulation::restore(std::span<const std::byte> snapshot) {
  note_change();
  SnapshotReader reader(snapshot);
  std::uint64_t mark = 0;
  reader.read(mark);
  if (mark != snapshot_mark) throw SnapshotError("this is no snapshot");
  std::uint64_t version = 0;
  reader.read(version);
  if (version != hash_name(COHORT_VERSION))
    throw SnapshotError("the snapshot is of another version than " COHORT_VERSION);
  reader.expect_count(experiment_.seed, "as its seed");
  reader.expect_count(static_cast<std::size_t>(experiment_.world.step.count()), "ns as its step");
  reader.read(tick_);
  spawned_models_.restore(reader);
  for (std::size_t model = 0; model < experiment_.world.models.size(); ++model) grippers_.note_model(model);
  world_->restore(reader);
  objects_.restore(reader);
  schedule_.restore(reader, tick_);
  note_added();
  emitters_.restore(reader);
  emitters_.update(workers_);
  grippers_.restore(reader);
  actions_.restore(reader);
  reader.expect_count(robots_.size(), "robots");
  for (Robot& robot : robots_) {
    reader.expect_count(robot.command.size(), "commanded values of a robot");
    reader.read_all(robot.command.data(), robot.command.size());
    for (SensorOfRobot& each : robot.sensors) {
      each.sensor->restore(reader);
      each.readout.restore(reader);
    }
  }
  reader.expect_count(observations_.size(), "observed values");
  reader.read_all(observations_.data(), observations_.size());
  reader.read(touches_.robot_ticks);
  reader.read(touches_.obstacles);
  reader.read(touches_.robots);
  if (!reader.is_at_end()) throw SnapshotError("the snapshot goes on after its end");
}

std::uint64_t Simulation::state_hash() const {
  if (!state_hash_) state_hash_ = computed_state_hash();
  return *state_hash_;
}

std::uint64_t Simulation::computed_state_hash() const {
  workers_.for_each_chunk(body_hashes_.size(), bodies_a_chunk, [&](std::size_t begin, std::size_t end, unsigned) {
    for (std::size_t body = begin; body < end; ++body) {
      StateHash hash;
      world_->hash_body(static_cast<std::uint32_t>(body), hash);
      if (robot_of_body_[body] != none) {
        for (const double value : observation(robot_of_body_[body])) hash.add(value);
        const Robot& robot = robots_[robot_of_body_[body]];
        for (const double value : robot.command) hash.add(value);
        for (const SensorOfRobot& each : robot.sensors) {
          each.sensor->hash(hash);
          each.readout.hash(hash);
        }
      }
      body_hashes_[body] = hash.value();
    }
  });
  StateHash hash;
  hash.add(tick_);
  for (const std::uint64_t body_hash : body_hashes_) hash.add(body_hash);
  world_->hash_contacts(hash);
  objects_.hash(hash);
  schedule_.hash(hash);
  emitters_.hash(hash);
  grippers_.hash(hash);
  actions_.hash(hash);
  spawned_models_.hash(hash);
  return hash.value();
}

}  // namespace cohort
