// SPDX-License-Identifier: Apache-2.0

// cohort-epuck2-bridge: programs that use the WiFi interface of an e-puck2 drive robots of a simulation
// (docs/bridges/epuck2.md).

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tools/bridges/common/bridge_program.hpp"
#include "tools/bridges/epuck2/robot.hpp"

int main(int argc, char** argv) {
  using namespace cohort;
  std::vector<std::string> addresses{"127.0.0.1"};
  std::uint16_t first_port = 1000;
  epuck2::Packets packets = epuck2::Packets::both;

  bridges::BridgeProgram program(
      "cohort-epuck2-bridge", "program",
      "Connects programs that use the WiFi interface of an e-puck2 to robots of a simulation.");
  CLI::App& app = program.app();
  app.add_option("--listen", addresses,
                 "IPv4 address of this machine at which programs connect, or one for each robot, separated by commas")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("ADDRESS[,ADDRESS...]")
      ->capture_default_str();
  app.add_option(
         "--port", first_port,
         "TCP port of the first robot; with one address, the other robots use the next ports. 0: any free ports")
      ->type_name("N")
      ->capture_default_str();
  program.offer_to_run_programs();
  program.add_choice<bridges::Silence>(
      "--without-program", program.patience().silence,
      {{"wait", bridges::Silence::wait}, {"stand", bridges::Silence::stand}},
      "Response when a program has disconnected: stop simulated time until another one sends commands (wait, the "
      "default), or stop the robot and continue the run (stand)");
  program.add_choice<epuck2::Packets>(
      "--packets", packets, {{"both", epuck2::Packets::both}, {"in-turn", epuck2::Packets::in_turn}},
      "Answer to a request for image and sensors: both packets (both, the default), or one of them in turn (in-turn), "
      "for programs that read a single packet after each command");
  program.add_serial().excludes(app.get_option("--listen"))->excludes(app.get_option("--port"));
  app.footer("Example: cohort serve worlds/experiments/epuck2.yaml & cohort-epuck2-bridge --robots 0..3");

  return program.run(
      argc, argv, [&] { return std::make_unique<epuck2::Robot>(program.patience(), packets); },
      [&](std::size_t robot, std::size_t robots) {
        const bool counts_ports = addresses.size() == 1;
        if (!counts_ports && addresses.size() != robots)
          throw bridges::UsageError("--listen expects one address, or one for each robot");
        const std::size_t port = counts_ports && first_port != 0 ? first_port + robot : first_port;
        if (port > 65535) throw bridges::UsageError("--port: the port of the last robot exceeds 65535");
        return "tcp:" + addresses[counts_ports ? 0 : robot] + ":" + std::to_string(port);
      });
}
