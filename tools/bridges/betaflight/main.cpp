// SPDX-License-Identifier: Apache-2.0

// cohort-betaflight-bridge: Betaflight's SITL program flies quadcopters of a simulation (docs/bridges/betaflight.md).

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tools/bridges/betaflight/copter.hpp"
#include "tools/bridges/betaflight/program_link.hpp"
#include "tools/bridges/betaflight/sitl_program.hpp"
#include "tools/bridges/common/bridge_program.hpp"

namespace {

using namespace cohort;

// Stick settings that the pilot expects (pilot.hpp), and one PID loop for each millisecond.
const std::vector<std::string> pilots_configuration{
    "aux 0 0 0 1700 2100 0 0",  // AUX1 arms
    "aux 1 1 1 1700 2100 0 0",  // AUX2: the mode ANGLE
    "set pid_process_denom = 2", "set angle_limit = 30", "set rates_type = ACTUAL", "set roll_rc_rate = 50",
    "set roll_srate = 50",       "set roll_expo = 0",    "set pitch_rc_rate = 50",  "set pitch_srate = 50",
    "set pitch_expo = 0",        "set yaw_rc_rate = 20", "set yaw_srate = 20",      "set yaw_expo = 0",
};

std::vector<std::string> commands_in(const std::string& file) {
  if (file.empty()) return pilots_configuration;
  std::ifstream in(file);
  if (!in) throw bridges::UsageError("cannot read '" + file + "'");
  std::vector<std::string> commands;
  for (std::string line; std::getline(in, line);)
    if (!line.empty() && !line.starts_with('#')) commands.push_back(line);
  // Dumps end with it; the bridge saves after the last command.
  if (!commands.empty() && commands.back() == "save") commands.pop_back();
  return commands;
}

const std::string& one_of(const std::vector<std::string>& values, std::size_t robot, std::size_t robots,
                          const std::string& option) {
  if (values.size() != robots) throw bridges::UsageError(option + " expects one address for each robot");
  return values[robot];
}

}  // namespace

int main(int argc, char** argv) {
  std::string path, folder = "betaflight", configuration;
  bool has_virtual_time = true;
  std::vector<std::string> listen{"127.0.0.1"}, at{"127.0.0.1"};

  bridges::BridgeProgram program("cohort-betaflight-bridge", "flight controller",
                                 "Connects Betaflight's SITL program to quadcopters of a simulation.");
  program.patience().at_most = std::chrono::milliseconds(1000);
  CLI::App& app = program.app();
  auto* run =
      app.add_option("--run", path,
                     "Betaflight's SITL program, which is started once for each robot in its own network namespace")
          ->type_name("PROGRAM");
  app.add_option("--folder", folder, "Folder with a subfolder for the configuration and log of each program")
      ->type_name("DIR")
      ->capture_default_str()
      ->needs(run);
  app.add_option("--configure", configuration,
                 "File with Betaflight CLI commands that configure new subfolders (default: the commands that the "
                 "bridge's pilot needs)")
      ->type_name("FILE")
      ->needs(run);
  app.add_option("--listen", listen,
                 "Without --run: IPv4 addresses at which the bridge receives servo packets, one for each robot")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("ADDRESS[,ADDRESS...]")
      ->capture_default_str()
      ->excludes(run);
  app.add_option("--at", at, "Without --run: IPv4 addresses of the programs, one for each robot")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("ADDRESS[,ADDRESS...]")
      ->capture_default_str()
      ->excludes(run);
  program.add_choice<bool>(
      "--time", has_virtual_time, {{"simulated", true}, {"wall", false}},
      "Clock of the programs that --run starts: simulated time (simulated, the default) or wall time (wall)");
  program.add_choice<bridges::Silence>(
      "--without-program", program.patience().silence,
      {{"wait", bridges::Silence::wait}, {"stand", bridges::Silence::stand}, {"hold", bridges::Silence::hold}},
      "Response to a silent program: stop simulated time (wait, the default), or after --patience continue the run "
      "with the motors stopped (stand) or with their last commands (hold)");
  app.add_option_function<unsigned>(
         "--patience", [&](unsigned given) { program.patience().at_most = std::chrono::milliseconds(given); },
         "Maximum wall time to wait for a servo packet, unless --without-program is wait (default: 1000)")
      ->type_name("MS")
      ->check(CLI::Range(1U, 60000U), "", "");
  app.footer(
      "Example: cohort serve worlds/experiments/betaflight.yaml & cohort-betaflight-bridge --robots 0..2 --run "
      "PROGRAM");

  return program.run(argc, argv, [&](const std::vector<std::string>& robots, std::size_t i) -> bridges::Driver {
    if (path.empty()) {
      auto socket = betaflight::open_servo_socket(one_of(listen, i, robots.size(), "--listen"));
      const std::string& address = one_of(at, i, robots.size(), "--at");
      return {std::make_unique<betaflight::Copter>(program.patience(), address),
              std::make_unique<betaflight::ProgramLink>(std::move(socket), address)};
    }
    auto started = std::make_unique<betaflight::Program>(betaflight::Program::Options{
        path, std::filesystem::absolute(folder) / robots[i], has_virtual_time, commands_in(configuration)});
    auto link = std::make_unique<betaflight::ProgramLink>(started->servo_socket(), "127.0.0.1");
    return {std::make_unique<betaflight::Copter>(program.patience(), std::move(started)), std::move(link)};
  });
}
