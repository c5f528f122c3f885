// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "server/parsing/experiment/read_experiment.hpp"
#include "server/run/exchange.hpp"
#include "server/run/session_snapshot.hpp"
#include "tests/fuzz/edits.hpp"

namespace {

using namespace cohort;

const description::Experiment& experiment() {
  static const description::Experiment chain =
      parsing::read_experiment(COHORT_SOURCE_DIR "/worlds/experiments/assembly.yaml");
  return chain;
}

session::SessionSnapshot snapshot() {
  Simulation simulation(experiment(), 1);
  session::Exchange exchange(simulation);
  for (std::uint32_t robot = 0; robot < simulation.robot_count(); ++robot) {
    std::vector<double> command(simulation.command(robot).begin(), simulation.command(robot).end());
    for (double& value : command) value += 0.1;
    if (!simulation.check_command(robot, command)) simulation.set_command(robot, command);
  }
  constexpr int ticks = 50;
  for (int tick = 0; tick < ticks; ++tick) simulation.step();
  return session::take_snapshot(experiment(), simulation, exchange);
}

void restore(const session::SessionSnapshot& from) {
  Simulation simulation(experiment(), 1);
  try {
    session::restore(from, simulation);
    session::Exchange exchange(simulation);
    session::restore(from, exchange);
  } catch (const SnapshotError&) {
    return;
  }
  constexpr int ticks = 3;
  for (int tick = 0; tick < ticks; ++tick) simulation.step();
  Simulation again(experiment(), 1);
  again.restore(simulation.save());
  if (again.state_hash() != simulation.state_hash()) std::abort();
}

}  // namespace

/// A snapshot with any change is refused with SnapshotError, or is a world that goes on.
// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it so.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const session::SessionSnapshot whole = snapshot();
  const std::span<const std::uint8_t> input(data, size);
  session::SessionSnapshot changed = whole;
  changed.simulation = fuzz::edited(whole.simulation, input);
  restore(changed);
  changed = whole;
  changed.exchange = fuzz::edited(whole.exchange, input);
  restore(changed);
  try {
    session::snapshot_from_bytes(fuzz::edited(session::to_bytes(whole), input));
    session::snapshot_from_bytes(std::as_bytes(input));
  } catch (const SnapshotError&) {
  }
  return 0;
}
