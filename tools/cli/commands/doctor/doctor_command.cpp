// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "idl/dds/transport.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/doctor/doctor.hpp"
#include "tools/cli/commands/shared_options.hpp"
#include "tools/cli/common/shown.hpp"

namespace cohort::tool {
namespace {

constexpr std::array health_names = {"ok", "warning", "problem"};

const char* name_of(Health health) { return health_names.at(static_cast<std::size_t>(health)); }

void print(const std::vector<Finding>& findings) {
  for (const Finding& finding : findings) {
    show(fmt::format("{:<8} {:<10} {}\n", name_of(finding.health), finding.check, finding.found));
    if (!finding.advice.empty()) show(fmt::format("{:19} -> {}\n", "", finding.advice));
  }
}

void print_json(const std::vector<Finding>& findings) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Finding& finding : findings)
    list.push_back({{"check", finding.check},
                    {"health", name_of(finding.health)},
                    {"found", finding.found},
                    {"advice", finding.advice}});
  show(json_text(list, 2) + "\n");
}

// Returns the identity that looks for the server: the client of the folder, or the observer if the folder has all
// identities.
std::optional<wire::Identity> identity_in(const std::filesystem::path& folder) {
  if (folder.empty()) return std::nullopt;
  const std::filesystem::path observer = folder / "clients" / "observer";
  return wire::read_identity(std::filesystem::exists(observer) ? observer : folder);
}

std::vector<Finding> examine(const DoctorCommand& command) {
  std::vector<Finding> findings = check_interfaces(command.network);
  const bool has_network = findings.front().health != Health::problem;
  std::vector<std::uint32_t> participants;
  if (!command.secure.empty()) {
    for (const Finding& finding : check_security(command.secure)) findings.push_back(finding);
    if (!std::filesystem::exists(command.secure / "identity") && findings.back().health != Health::problem)
      for (const wire::Identity& identity : wire::read_server_identities(command.secure))
        participants.push_back(identity.participant);
  } else if (!command.network.starts_with("127.")) {
    findings.push_back({"security", Health::warning,
                        "none: anyone who can reach " + command.network + " can drive the robots",
                        "'cohort security init DIR' creates identities for --secure DIR."});
  }
  if (participants.empty()) participants.push_back(0);
  findings.push_back(check_ports(command.domain(), command.network, participants));
  if (has_network) findings.push_back(check_firewall(command.domain(), command.network));
  // If a machine cannot receive its own packets, DDS cannot end its threads.
  if (findings.back().health == Health::problem && findings.back().check == "firewall") {
    findings.push_back({"server", Health::ok, "not checked: the firewall blocks it"});
  } else if (has_network) {
    try {
      findings.push_back(check_server(command, identity_in(command.secure), command.expects_server));
    } catch (const std::exception& error) {
      findings.push_back({"server", Health::problem, error.what(), "Fix the other problems first."});
    }
  }
  for (const Finding& finding : {check_buffers("/proc"), check_limits("/proc", "/sys"), check_clock("/sys"),
                                 check_processor("/sys"), check_library()})
    findings.push_back(finding);
  return findings;
}

int doctor(DoctorCommand command) {
  command.expects_server = !command.server.empty();
  if (!command.expects_server) command.server = command.network;
  const std::vector<Finding> findings = examine(command);
  if (command.json)
    print_json(findings);
  else
    print(findings);
  const auto is_problem = [](const Finding& finding) { return finding.health == Health::problem; };
  return std::ranges::any_of(findings, is_problem) ? exit_failed : exit_ok;
}

}  // namespace

Subcommand add_doctor(CommandLine app) {
  const auto command = std::make_shared<DoctorCommand>();
  CommandLine line = app.add_subcommand("doctor", "Diagnose common problems with the machine and the network");
  line.add_option("--server", command->server,
                  "Address of a server that should be running (default: look for a server on this machine)")
      .envname("COHORT_SERVER")
      .type_name("ADDRESS");
  add_domain_option(line, command->domains, domain_of_server);
  line.add_option("--network", command->network,
                  "Address of the network interface that a server on this machine would use")
      .envname("COHORT_NETWORK")
      .capture_default_str()
      .type_name("ADDRESS");
  line.add_option("--secure", command->secure,
                  "Folder created by 'cohort security', or the folder of one identity in it")
      .envname("COHORT_SECURE")
      .type_name("DIR");
  line.add_flag("--json", command->json, "Print the findings as JSON");
  line.footer("Example: cohort doctor --server 10.0.0.5 --domain 7");
  return {line, [command](Log&, const std::atomic<bool>&) { return doctor(*command); }};
}

}  // namespace cohort::tool
