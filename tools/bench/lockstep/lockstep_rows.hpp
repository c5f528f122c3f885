#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/bench/measuring/measure.hpp"

/// What the barrier costs: a server and its client processes in lockstep over DDS, beside raw UDP that moves as many
/// bytes between as many processes. docs/bench.md says how and why.
namespace cohort::bench {

/// How robots share processes.
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
  double seconds = 1.0;  ///< wall time of each repetition of each way
  unsigned repetitions = 5;
  bool inline_step = true;  ///< of the clients (ClientOptions)
  bool look_ahead = false;  ///< measure that, in place of the rows; there is no graph of it
};

/// One repetition of one way. Times in seconds of the wall clock.
struct LockstepTurn {
  double ticks_a_second = 0.0;
  double barrier_median = 0.0;  ///< from the first frame of a tick sent to the last answer needed
  double barrier_p99 = 0.0;
  double barrier_mean = 0.0;
  double server_cpu = 0.0;   ///< of all threads, a tick [s]
  double clients_cpu = 0.0;  ///< of all clients together, a tick [s]
};

/// All robots of one number and placement.
struct LockstepRow {
  std::uint32_t robots = 0;
  ClientPlacement placement = ClientPlacement::one;
  std::uint32_t processes = 0;
  std::size_t observation_bytes = 0;  ///< payload of all Observations of a tick
  std::size_t command_bytes = 0;      ///< of all Commands
  std::vector<LockstepTurn> cohort;   ///< one for each repetition
  std::vector<LockstepTurn> udp;      ///< in turns with them

  /// Of tick rates, Cohort's to raw UDP's.
  Spread ratio() const;
  /// Of the mean time of a barrier, raw UDP's to Cohort's: what is left when the world's own part of a tick is not
  /// counted.
  Spread barrier_ratio() const;
};
/// Over the repetitions of one way.
Spread spread_of(const std::vector<LockstepTurn>& turns, double LockstepTurn::*quantity);

/// A tick in which the physics and the controllers compute for the same time.
struct LookAheadRow {
  std::uint32_t delay = 0;     ///< of the controllers [ticks]
  double work = 0.0;           ///< of physics and of the controllers alike, CPU time of a tick [s]
  std::vector<double> median;  ///< wall time of a tick, one for each repetition [s]
};

}  // namespace cohort::bench
