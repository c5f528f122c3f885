// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/shared_options.hpp"

#include <cstdlib>

#include "idl/text/domains.hpp"
#include "server/parsing/files/missing_meshes.hpp"
#include "tools/cli/common/checks.hpp"

namespace cohort::tool {

void add_server_option(CommandLine line, std::string& server) {
  line.add_option("--server", server, "Address of the server")
      .envname("COHORT_SERVER")
      .capture_default_str()
      .type_name("ADDRESS");
}

void add_domain_option(CommandLine line, std::vector<std::uint32_t>& domains, const std::string& text) {
  line.add_option_function<std::string>(
          "--domain", [&domains](const std::string& value) { domains = parse_domains(value); }, text)
      .envname("COHORT_DOMAIN")
      .check(domain_range())
      .type_name("N|A..B");
}

void add_secure_option(CommandLine line, std::filesystem::path& folder, const std::string& text) {
  line.add_option("--secure", folder, text).envname("COHORT_SECURE").type_name("DIR");
}

void add_client_options(CommandLine line, ClientSide& client) {
  line.add_option("--robots", client.robots,
                  "Robots to drive: all, an id, ids A..B, or a name with *, separated by commas")
      .required()
      .comma_separated()
      .type_name("SEL[,SEL...]");
  add_server_option(line, client.connection.server);
  add_domain_option(line, client.connection.domains,
                    "DDS domain of the server, or a range from which Cohort chooses one (default: 0)");
  add_secure_option(line, client.connection.secure, "Folder of this client's identity (default: $COHORT_SECURE)");
}

void add_reading_options(CommandLine line, bool& runs_xacro) {
  line.add_option_function<std::string>(
          "--allow-files",
          [](const std::string& folders) {
            ::setenv("COHORT_ALLOW_FILES", folders.c_str(), 1);
          },  // the parser reads this variable
          "Additional folders from which the world may read files, separated by colons (default: $COHORT_ALLOW_FILES)")
      .type_name("DIR[:DIR...]");
  line.add_option_function<std::string>(
          "--missing-meshes",
          [](const std::string& replacement) { ::setenv(parsing::missing_meshes_variable, replacement.c_str(), 1); },
          "Replace collisions whose mesh file is missing by a cube of 0.1 m, or leave them out (default: "
          "$COHORT_MISSING_MESHES, or an error)")
      .check(one_of({"box", "skip"}))
      .type_name("box|skip");
  line.add_flag("--xacro", runs_xacro,
                "Expand FILE with xacro, which executes code in FILE: use this only for trusted files");
}

void add_set_option(CommandLine line, std::vector<std::string>& settings) {
  line.add_option("--set", settings,
                  "Replace a value of the experiment or its world, such as teams.swarm.parameters.gain=2 or "
                  "'world.gravity=[0, 0, -1.6]'; may be repeated")
      .one_value()
      .type_name("PATH=VALUE");
}

void add_robots_of_recording(CommandLine line, std::vector<std::string>& robots) {
  line.add_option("--robots", robots, "Robots to include, selected as with --robots of 'cohort host' (default: all)")
      .comma_separated()
      .type_name("SEL[,SEL...]");
}

void add_recorded_options(CommandLine line, RecordOptions& options, const std::string& prefix) {
  constexpr double most_hertz = 1e9;
  line.add_option(prefix + "poses", options.pose_rate, "Poses to record per simulated second (0: none)")
      .check(number_from_zero(most_hertz))
      .type_name("HZ");
  line.add_option(prefix + "joints", options.joint_rate,
                  "Joint states and link poses to record per simulated second (0: none)")
      .check(number_from_zero(most_hertz))
      .type_name("HZ");
  line.add_option(prefix + "observations", options.observation_rate,
                  "Observations of each robot to record per simulated second (0: none)")
      .check(number_from_zero(most_hertz))
      .type_name("HZ");
  line.add_option(prefix + "robots", options.robots,
                  "Robots whose observations are recorded, selected as with --robots of 'cohort host'")
      .comma_separated()
      .type_name("SEL[,SEL...]");
  line.add_option(prefix + "snapshots", options.snapshot_interval,
                  "Simulated time between recorded snapshots, in seconds (0: none)")
      .check(number_from_zero(most_seconds, "seconds"))
      .type_name("S");
  line.add_flag(
      prefix + "rosbag2", options.makes_rosbag2,
      "At the end, write metadata.yaml beside the recording, so that 'ros2 bag' can read its folder as a bag");
}

void add_viewpoint_option(CommandLine line, const std::string& name, const std::string& subject, Viewpoint& viewpoint) {
  line.add_option_function<std::string>(
          name,
          [&viewpoint](const std::string& view) { viewpoint = view == "side" ? Viewpoint::side : Viewpoint::above; },
          subject + ": above (the default) or side")
      .check(one_of({"above", "side"}))
      .type_name("above|side");
}

}  // namespace cohort::tool
