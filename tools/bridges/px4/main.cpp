// SPDX-License-Identifier: Apache-2.0

// cohort-px4-bridge: PX4, its SITL or its hardware, drives robots of a simulation (docs/bridges/px4.md).

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cmath>
#include <memory>
#include <vector>

#include "tools/bridges/autopilots/autopilot_program.hpp"
#include "tools/bridges/px4/autopilot.hpp"

int main(int argc, char** argv) {
  using namespace cohort;
  bridges::BridgeProgram program("cohort-px4-bridge", "firmware",
                                 "Connects PX4 to robots of a simulation through MAVLink's simulator messages.");
  const autopilots::AutopilotProgram options(program, "tcp", 4560, 1);
  px4::Autopilot::Options px4;
  std::vector<double> home{px4.home.latitude, px4.home.longitude, px4.home.altitude};
  program.app()
      .add_option("--home", home,
                  "Position of the world's origin on Earth: latitude and longitude in degrees, altitude above sea "
                  "level in metres (default: that of PX4)")
      ->delimiter(',')
      ->expected(3)
      ->allow_extra_args(false)
      ->check(CLI::Range(-1e5, 1e5))
      ->type_name("LATITUDE,LONGITUDE,ALTITUDE");
  program.add_serial().excludes(program.app().get_option("--listen"))->excludes(program.app().get_option("--port"));
  program.app().footer("Example: cohort serve worlds/experiments/px4.yaml & cohort-px4-bridge --robots 0,1");
  return program.run(
      argc, argv,
      [&] {
        if (std::abs(home[0]) > 89.0 || std::abs(home[1]) > 180.0)
          throw bridges::UsageError(
              "--home expects a latitude from -89 to 89 degrees and a longitude from -180 to 180");
        px4.home = {home[0], home[1], home[2]};
        px4.is_hardware = program.has_serial();
        px4.outputs = options.outputs();
        return std::make_unique<px4::Autopilot>(program.patience(), px4);
      },
      [&](std::size_t robot, std::size_t) { return options.link_of(robot); });
}
