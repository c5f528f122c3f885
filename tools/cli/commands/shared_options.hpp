// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "server/parsing/files/xacro.hpp"
#include "tools/cli/common/command_line.hpp"
#include "tools/cli/running/run_options.hpp"

/// Options that several commands share.
namespace cohort::tool {

/// Time limits for a server.
inline constexpr std::chrono::milliseconds for_ever{std::chrono::hours{24 * 365}};
inline constexpr std::chrono::milliseconds for_a_reply{30'000};

/// The address of a server, and the identity of the client.
struct Connection {
  std::string server = "127.0.0.1";
  std::vector<std::uint32_t> domains{};  ///< domains of the server; empty: 0
  std::filesystem::path secure{};        ///< folder of an identity; empty: without security

  /// Returns the domain of a client that uses one domain.
  std::uint32_t domain() const { return domains.empty() ? 0 : domains.front(); }
};

inline constexpr const char* domain_of_server =
    "DDS domain of the server; the first domain if it has several (default: 0)";

void add_server_option(CommandLine line, std::string& server);
void add_domain_option(CommandLine line, std::vector<std::uint32_t>& domains, const std::string& text);
void add_secure_option(CommandLine line, std::filesystem::path& folder, const std::string& text);

/// Adds options for reading files: further folders from which worlds may read, and whether `xacro` expands the file on
/// the command line.
void add_reading_options(CommandLine line, bool& runs_xacro);
inline parsing::Xacro xacro_of(bool runs_xacro) { return runs_xacro ? parsing::Xacro::run : parsing::Xacro::refused; }

/// Adds the option that replaces values of an experiment or its world. Each text is PATH=VALUE.
void add_set_option(CommandLine line, std::vector<std::string>& settings);

/// The robots that a client drives, and its connection.
struct ClientSide {
  std::vector<std::string> robots{};  ///< selectors
  Connection connection{};            ///< with one of its domains
};
void add_client_options(CommandLine line, ClientSide& client);

/// Adds the option that selects robots of a recording.
void add_robots_of_recording(CommandLine line, std::vector<std::string>& robots);
/// Adds options for the contents of a recording. `prefix`: prefix of the options' names.
void add_recorded_options(CommandLine line, RecordOptions& options, const std::string& prefix);
/// Adds the option of a viewpoint. `subject`: beginning of its help text.
void add_viewpoint_option(CommandLine line, const std::string& name, const std::string& subject, Viewpoint& viewpoint);

}  // namespace cohort::tool
