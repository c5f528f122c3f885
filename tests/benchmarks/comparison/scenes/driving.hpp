// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "server/core/random.hpp"

namespace cohort::bench {

struct Command {
  double left = 0.0;    ///< speed of the track over ground [m/s]
  double right = 0.0;   ///< the same
  double turret = 0.0;  ///< relative to the chassis [rad/s]
};

/// Random driving: each robot gets a new command every 5 to 19 control ticks, uniform in +-0.2 m/s for each track and
/// +-1 rad/s for the turret. Commands depend only on seed, robot and tick, so all engines get the same ones.
class RandomDriving {
 public:
  RandomDriving(std::uint64_t seed, std::uint32_t robots);

  /// Calls `set(robot, command)` for each robot with a new command at this tick. Call it for consecutive ticks, from 0.
  template <class Set>
  void update(std::uint64_t tick, Set&& set) {
    for (std::uint32_t robot = 0; robot < random_.size(); ++robot)
      if (next_draw_[robot] == tick) set(robot, draw(robot, tick));
  }

 private:
  Command draw(std::uint32_t robot, std::uint64_t tick);

  std::vector<RandomStream> random_;
  std::vector<std::uint64_t> next_draw_;  // tick
};

}  // namespace cohort::bench
