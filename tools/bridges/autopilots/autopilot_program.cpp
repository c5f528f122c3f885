// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/autopilots/autopilot_program.hpp"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <chrono>
#include <utility>

namespace cohort::autopilots {

AutopilotProgram::AutopilotProgram(bridges::BridgeProgram& program, std::string kind, unsigned port, unsigned port_step)
    : kind_(std::move(kind)), port_(port), port_step_(port_step) {
  CLI::App& app = program.app();
  bridges::Patience& patience = program.patience();
  patience.at_most = std::chrono::seconds(1);
  app.add_option("--listen", address_, "IPv4 address of this machine at which autopilots connect")
      ->type_name("ADDRESS")
      ->capture_default_str();
  app.add_option("--port", port_,
                 "Port of the first robot; the port of each further robot is " + std::to_string(port_step) +
                     " higher, as with several instances of the autopilot. 0: any free ports")
      ->type_name("N")
      ->check(CLI::Range(0U, 65535U))
      ->capture_default_str();
  app.add_option_function<std::vector<std::string>>(
         "--output",
         [this](const std::vector<std::string>& texts) {
           for (const std::string& text : texts) outputs_.push_back(output_in(text));
         },
         "Map an output of the autopilot to a command channel (repeatable); replaces the outputs of the robot's model")
      ->type_name("NUMBER=CHANNEL:LOW..HIGH")
      ->allow_extra_args(false)
      ->check(
          [](const std::string& text) {
            try {
              output_in(text);
              return std::string();
            } catch (const std::exception& error) {
              return std::string(error.what());
            }
          },
          "", "");
  program.add_choice<bridges::Silence>(
      "--without-firmware", patience.silence,
      {{"wait", bridges::Silence::wait}, {"stand", bridges::Silence::stand}, {"hold", bridges::Silence::hold}},
      "Response to a silent or disconnected autopilot: stop simulated time (wait, the default), or continue the run "
      "with neutral commands (stand) or the last commands (hold). Before the first command: always wait");
  app.add_option_function<double>(
         "--patience",
         [&patience](double seconds) {
           patience.at_most = std::chrono::ceil<std::chrono::milliseconds>(std::chrono::duration<double>(seconds));
         },
         "Wall time after which an autopilot counts as silent (default: 1)")
      ->type_name("S")
      ->check(CLI::Range(0.001, 3600.0));
}

std::string AutopilotProgram::link_of(std::size_t robot) const {
  const std::size_t port = port_ == 0 ? 0 : port_ + robot * port_step_;
  if (port > 65535) throw bridges::UsageError("--port: the port of the last robot exceeds 65535");
  return kind_ + ":" + address_ + ":" + std::to_string(port);
}

}  // namespace cohort::autopilots
