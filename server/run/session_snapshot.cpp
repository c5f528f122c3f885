// SPDX-License-Identifier: Apache-2.0
#include "server/run/session_snapshot.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>

#include "idl/include/cohort/version.h"
#include "idl/text/printable.hpp"
#include "server/core/bounded_file.hpp"
#include "server/core/hash.hpp"
#include "server/run/exchange.hpp"
#include "server/run/snapshot_size.hpp"
#include "server/simulation/simulation.hpp"

namespace cohort::session {
namespace {

constexpr std::uint64_t mark = 0x544f485354524843;  // "CHRTSHOT"
constexpr std::uint32_t format = 4;
constexpr std::uint32_t format_without_commit = 3;  // can also be read
constexpr std::size_t hash_size = sizeof(std::uint64_t);

std::uint64_t hash_of(std::span<const std::byte> bytes) {
  StateHash hash;
  hash.add(std::uint64_t{bytes.size()});
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, std::min(sizeof word, bytes.size() - at));
    hash.add(word);
  }
  return hash.value();
}

template <class Bytes>
void add_bytes(SnapshotWriter& writer, const Bytes& bytes) {
  writer.add_count(bytes.size());
  writer.add_all(bytes.data(), bytes.size());
}

template <class Bytes>
Bytes read_bytes(SnapshotReader& reader) {
  Bytes bytes;
  bytes.resize(reader.read_count(1));
  reader.read_all(bytes.data(), bytes.size());
  return bytes;
}

void add_states(SnapshotWriter& writer, const ControllerStates& states) {
  writer.add_count(states.size());
  for (const auto& state : states) {
    writer.add(state.has_value());
    if (!state) continue;
    add_bytes(writer, state->controller);
    add_bytes(writer, state->bytes);
  }
}

ControllerStates read_states(SnapshotReader& reader) {
  ControllerStates states(reader.read_count(sizeof(bool)));
  for (auto& state : states) {
    bool is_there = false;
    reader.read(is_there);
    if (!is_there) continue;
    state.emplace();
    state->controller = read_bytes<std::string>(reader);
    state->bytes = read_bytes<std::vector<std::byte>>(reader);
    if (state->bytes.size() > largest_state)
      throw SnapshotError("snapshot: the state of a controller has " + std::to_string(state->bytes.size()) +
                          " bytes, expected at most " + std::to_string(largest_state));
  }
  return states;
}

}  // namespace

SessionSnapshot take_snapshot(const description::Experiment& experiment, const Simulation& simulation,
                              const Exchange& exchange, ControllerStates controllers) {
  SnapshotWriter writer;
  exchange.save(writer);
  return {.experiment = experiment.name,
          .seed = experiment.seed,
          .tick = simulation.tick(),
          .simulation = simulation.save(),
          .exchange = writer.bytes(),
          .controllers = std::move(controllers)};
}

std::vector<RobotState> states_of(const SessionSnapshot& snapshot, std::span<const std::uint32_t> robots) {
  std::vector<RobotState> states;
  for (const std::uint32_t robot : robots)
    if (robot < snapshot.controllers.size() && snapshot.controllers[robot])
      states.push_back({robot, snapshot.controllers[robot]});
  return states;
}

std::vector<std::string> what_is_left_out(const SessionSnapshot& snapshot, const description::Experiment& experiment) {
  std::vector<std::string> sentences;
  if (snapshot.tick == 0) return sentences;
  for (const description::Team& team : experiment.teams)
    if (states_of(snapshot, team.robots).size() < team.robots.size())
      sentences.push_back("the snapshot does not contain the state of the controllers of team '" + team.name + "' (" +
                          team.controller + "): a run that continues from it starts them without state");
  return sentences;
}

std::vector<std::byte> to_bytes(const SessionSnapshot& snapshot) {
  SnapshotWriter writer;
  writer.add(mark);
  writer.add(format);
  add_bytes(writer, snapshot.build.version);
  add_bytes(writer, snapshot.build.commit);
  add_bytes(writer, snapshot.build.arithmetic);
  add_bytes(writer, snapshot.experiment);
  writer.add(snapshot.seed);
  writer.add(snapshot.tick);
  add_bytes(writer, snapshot.simulation);
  add_bytes(writer, snapshot.exchange);
  add_states(writer, snapshot.controllers);
  writer.add(hash_of(writer.bytes()));
  return writer.bytes();
}

SessionSnapshot snapshot_from_bytes(std::span<const std::byte> bytes) {
  SnapshotReader reader(bytes);
  std::uint64_t its_mark = 0;
  std::uint32_t its_format = 0;
  try {
    reader.read(its_mark);
    reader.read(its_format);
  } catch (const SnapshotError&) {
    throw SnapshotError("this is not a snapshot of a session: it has only " + std::to_string(bytes.size()) + " bytes");
  }
  if (its_mark != mark) throw SnapshotError("this is not a snapshot of a session: wrong first bytes");
  if (its_format != format && its_format != format_without_commit)
    throw SnapshotError("the snapshot has format " + std::to_string(its_format) + ", but this program reads format " +
                        std::to_string(format));
  SessionSnapshot snapshot;
  snapshot.build = {read_bytes<std::string>(reader), "", ""};
  const std::string& version = snapshot.build.version;
  if (std::ranges::find(versions_of_snapshots(), version) == versions_of_snapshots().end())
    throw SnapshotError("the snapshot is from version '" + printable(version, 20) +
                        "' of Cohort, which version " COHORT_VERSION " cannot read");
  const std::span<const std::byte> hashed = bytes.first(bytes.size() - hash_size);
  std::uint64_t hash = 0;
  std::memcpy(&hash, bytes.data() + hashed.size(), sizeof hash);
  if (hash != hash_of(hashed)) throw SnapshotError("the snapshot is damaged or incomplete: its hash does not match");
  if (its_format == format) {
    snapshot.build.commit = read_bytes<std::string>(reader);
    snapshot.build.arithmetic = read_bytes<std::string>(reader);
  }
  snapshot.experiment = read_bytes<std::string>(reader);
  reader.read(snapshot.seed);
  reader.read(snapshot.tick);
  snapshot.simulation = read_bytes<std::vector<std::byte>>(reader);
  snapshot.exchange = read_bytes<std::vector<std::byte>>(reader);
  snapshot.controllers = read_states(reader);
  reader.read(hash);
  if (!reader.is_at_end()) throw SnapshotError("the snapshot has extra bytes at its end");
  return snapshot;
}

void expect_same_experiment(const SessionSnapshot& snapshot, const description::Experiment& experiment) {
  if (snapshot.experiment != experiment.name)
    throw SnapshotError("the snapshot belongs to the experiment '" + snapshot.experiment + "', not to '" +
                        experiment.name + "'");
}

void restore(const SessionSnapshot& snapshot, Simulation& simulation) {
  simulation.restore(snapshot.simulation);
  if (simulation.tick() != snapshot.tick)
    throw SnapshotError("snapshot: the header has tick " + std::to_string(snapshot.tick) + ", but the world has tick " +
                        std::to_string(simulation.tick()));
  if (!snapshot.controllers.empty() && snapshot.controllers.size() != simulation.robot_count())
    throw SnapshotError("the snapshot has the controllers of " + std::to_string(snapshot.controllers.size()) +
                        " robots, but its world has " + std::to_string(simulation.robot_count()) + " robots");
}

void restore(const SessionSnapshot& snapshot, Exchange& exchange) {
  SnapshotReader reader(snapshot.exchange);
  exchange.restore(reader);
  if (!reader.is_at_end()) throw SnapshotError("snapshot: the barrier has extra bytes at its end");
}

SessionSnapshot read_snapshot(const std::filesystem::path& file) {
  std::string bytes;
  try {
    bytes = read_bounded(file, most_snapshot_bytes);
  } catch (const std::runtime_error& error) {
    throw SnapshotError(error.what());
  }
  try {
    return snapshot_from_bytes(std::as_bytes(std::span(bytes)));
  } catch (const SnapshotError& error) {
    throw SnapshotError(file.string() + ": " + error.what());
  }
}

}  // namespace cohort::session
