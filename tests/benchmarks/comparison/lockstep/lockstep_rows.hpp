// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/benchmarks/comparison/measuring/measure.hpp"

/// The cost of the lockstep barrier. A server and its client processes in lockstep over DDS are compared with raw UDP
/// that moves the same bytes between the same number of processes. docs/bench.md describes the method.
namespace cohort::bench {

/// The distribution of robots over processes.
enum class ClientPlacement {
  one,     ///< all in one process
  eights,  ///< one process for each 8 robots
  each,    ///< one process for each robot
};
const std::vector<std::pair<std::string, ClientPlacement>>& placements();
std::string name_of(ClientPlacement placement);
std::uint32_t process_count(ClientPlacement placement, std::uint32_t robots);

struct LockstepOptions {
  std::vector<std::uint32_t> robots{1, 8, 32, 128, 512};
  std::vector<ClientPlacement> placements{ClientPlacement::one, ClientPlacement::eights, ClientPlacement::each};
  double seconds = 1.0;  ///< wall time of each repetition of each method [s]
  unsigned repetitions = 5;
  bool inline_step = true;  ///< option of the clients (ClientOptions)
  bool look_ahead = false;  ///< measure look-ahead instead of the rows; without a graph
};

/// A repetition of one of the two methods. Times are wall times in seconds.
struct LockstepTurn {
  double ticks_a_second = 0.0;
  double barrier_median = 0.0;  ///< from the first frame of a tick sent to the last answer needed
  double barrier_p99 = 0.0;
  double barrier_mean = 0.0;
  double server_cpu = 0.0;   ///< CPU time of all threads per tick [s]
  double clients_cpu = 0.0;  ///< CPU time of all clients together per tick [s]
};

/// The results for one number of robots and one placement.
struct LockstepRow {
  std::uint32_t robots = 0;
  ClientPlacement placement = ClientPlacement::one;
  std::uint32_t processes = 0;
  std::size_t observation_bytes = 0;  ///< payload of all Observations of a tick
  std::size_t command_bytes = 0;      ///< payload of all Commands of a tick
  std::vector<LockstepTurn> cohort;   ///< one for each repetition
  std::vector<LockstepTurn> udp;      ///< alternating with `cohort`

  /// Returns the ratio of Cohort's tick rate to that of raw UDP.
  Spread ratio() const;
  /// Returns the ratio of raw UDP's mean barrier time to Cohort's, which leaves out the time that the world takes in a
  /// tick.
  Spread barrier_ratio() const;
};
/// Returns the spread over the repetitions of one method.
Spread spread_of(const std::vector<LockstepTurn>& turns, double LockstepTurn::*quantity);

/// Ticks in which physics and controllers compute for the same time.
struct LookAheadRow {
  std::uint32_t delay = 0;     ///< delay of the controllers [ticks]
  double work = 0.0;           ///< CPU time of physics and of the controllers per tick, each [s]
  std::vector<double> median;  ///< wall time of a tick, one for each repetition [s]
};

}  // namespace cohort::bench
