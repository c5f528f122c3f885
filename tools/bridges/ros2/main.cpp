// SPDX-License-Identifier: Apache-2.0

// cohort-ros2-bridge: nodes of ROS 2 drive robots of a simulation (docs/ros2.md).

#include <chrono>
#include <filesystem>
#include <string>

#include "client_sdk/include/cohort/control.hpp"
#include "idl/dds/ros2/ros_names.hpp"
#include "idl/text/standard_streams.hpp"
#include "server/messages/experiment_inputs.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "tools/bridges/common/bridge_program.hpp"
#include "tools/bridges/ros2/ros_bridge.hpp"

namespace {

using namespace cohort;

ControlOptions control_options(const ClientOptions& client) {
  return {client.server, client.domain, client.secure, client.name};
}

// Requests the files of the server's experiment, and reads the experiment from them.
std::shared_ptr<const description::Experiment> experiment_of(const ClientOptions& client) {
  Control control(control_options(client));
  control.stop_on(&stop_on_signals());
  control.set_time_limit(std::chrono::hours(24));  // the server may not be running yet
  const ExperimentFiles files = control.experiment_files();
  return std::make_shared<const description::Experiment>(parsing::read_experiment(
      std::make_shared<const description::KeptFiles>(messages::kept_files(files)), files.seed, files.duration));
}

// Returns the ROS domain of the environment. Reports an invalid one like an error in the command line.
ros2::RosDomain domain_of_environment() {
  try {
    return ros2::RosDomain::from_environment();
  } catch (const std::invalid_argument& error) {
    throw bridges::UsageError(error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  using description::RosSync;
  RosSync sync = RosSync::free;
  std::uint32_t domain = 0;
  std::string distribution = "auto";
  bool has_no_services = false;

  bridges::BridgeProgram program("cohort-ros2-bridge", "node", "Connects ROS 2 nodes to robots of a simulation.");
  CLI::App& app = program.app();
  app.get_option("--robots")->default_str("as in the experiment");
  app.add_option("--ros-domain", domain,
                 "ROS domain (default: that of the experiment, or else $ROS_DOMAIN_ID, or else 0)")
      ->check(CLI::Range(0, 232))
      ->type_name("N");
  program.add_choice<RosSync>("--sync", sync, {{"free", RosSync::free}, {"command", RosSync::command}},
                              "When the bridge answers the observations of a tick: immediately, with the newest "
                              "command (free), or after a new command (command). Default: as in the experiment");
  program.offer_to_run_programs(
      "Shell command that starts nodes with simulated time as their clock: the bridge answers observations when the "
      "nodes have finished all work that is due at their tick");
  app.get_option("--run")->excludes(app.get_option("--sync"));
  const std::map<std::string, std::string> distributions = {
      {"auto", "auto"},     {"humble", "humble"},   {"iron", "iron"},      {"jazzy", "jazzy"},
      {"kilted", "kilted"}, {"lyrical", "lyrical"}, {"rolling", "rolling"}};
  program.add_choice<std::string>("--ros-distro", distribution, distributions,
                                  "ROS 2 distribution of the nodes (default: auto, which detects it)");
  app.add_flag("--no-services", has_no_services, "Do not offer the services of simulation_interfaces");
  app.footer("Example: cohort serve worlds/experiments/turtlebot3.yaml --speed 1 & cohort-ros2-bridge");
  return program.run(argc, argv, [&](ClientOptions client) {
    ros2::RosBridge::Options options;
    options.participant = {domain_of_environment(), "/", "cohort"};
    options.experiment = [client] { return experiment_of(client); };
    const auto experiment = options.experiment();
    if (app.get_option("--robots")->count() == 0) client.robots = experiment->ros2.robots;
    if (app.get_option("--sync")->count() > 0) options.sync = sync;
    if (app.get_option("--ros-domain")->count() > 0)
      options.participant.domain.number = domain;
    else if (experiment->ros2.domain)
      options.participant.domain.number = *experiment->ros2.domain;
    if (distribution != "auto")
      options.gid_format = distribution == "humble" ? ros2::GidFormat::humble : ros2::GidFormat::since_iron;
    options.command = program.command();
    options.tell = [](const std::string& text) { print_message(text); };
    if (!has_no_services) {
      ros2::SimulationControl::Options& services = options.services.emplace();
      services.control = control_options(client);
      services.experiment = options.experiment;
      if (distribution == "lyrical" || distribution == "rolling") services.version = ros2::InterfaceVersion::v2;
      services.helper = {
          .program = std::filesystem::read_symlink("/proc/self/exe").replace_filename("cohort-ros2-services"),
          .domain = options.participant.domain,
          .tell = options.tell};
    }
    options.client = std::move(client);
    return ros2::RosBridge(std::move(options), stop_on_signals()).run();
  });
}
