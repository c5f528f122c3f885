// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "server/simulation/simulation.hpp"

namespace cohort::test {

/// Commands all robots by a function of robot and tick.
inline void command_by_sines(Simulation& simulation) {
  std::vector<double> values;
  for (std::uint32_t robot = 0; robot < simulation.robot_count(); ++robot) {
    values.clear();
    const double phase = 0.013 * static_cast<double>(simulation.tick()) + robot;
    for (const Channel& channel : simulation.kinds()[simulation.kind_of(robot)].command) {
      const double middle = 0.5 * (channel.lower + channel.upper), reach = 0.25 * (channel.upper - channel.lower);
      for (std::uint32_t i = 0; i < channel.size; ++i)
        values.push_back(middle + reach * std::sin(phase + static_cast<double>(values.size())));
    }
    simulation.set_command(robot, values);
  }
}

}  // namespace cohort::test
