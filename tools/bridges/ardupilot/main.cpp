// SPDX-License-Identifier: Apache-2.0

// cohort-ardupilot-bridge: ArduPilot's SITL drives robots of a simulation (docs/bridges/ardupilot.md).

#include <memory>

#include "tools/bridges/ardupilot/sitl.hpp"
#include "tools/bridges/autopilots/autopilot_program.hpp"

int main(int argc, char** argv) {
  using namespace cohort;
  bridges::BridgeProgram program("cohort-ardupilot-bridge", "firmware",
                                 "Connects ArduPilot's SITL to robots of a simulation through its JSON interface.");
  const autopilots::AutopilotProgram options(program, "udp", 9002, 10);
  program.app().footer(
      "Example: cohort serve worlds/experiments/ardupilot.yaml & cohort-ardupilot-bridge --robots 0,1");
  return program.run(
      argc, argv, [&] { return std::make_unique<ardupilot::Sitl>(program.patience(), options.outputs()); },
      [&](std::size_t robot, std::size_t) { return options.link_of(robot); });
}
