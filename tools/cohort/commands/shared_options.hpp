#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "server/parsing/files/xacro.hpp"
#include "tools/cohort/cli/command_line.hpp"
#include "tools/cohort/running/run_options.hpp"

/// Options that several commands have.
namespace cohort::tool {

/// How long a server is waited for.
inline constexpr std::chrono::milliseconds for_ever{std::chrono::hours{24 * 365}};
inline constexpr std::chrono::milliseconds for_a_reply{30'000};

/// Where a server is, and who asks.
struct Connection {
  std::string server = "127.0.0.1";
  std::vector<std::uint32_t> domains{};  ///< of the server; empty: 0
  std::filesystem::path secure{};        ///< folder of an identity; empty: without security

  /// The one that is used by those who use one.
  std::uint32_t domain() const { return domains.empty() ? 0 : domains.front(); }
};

inline constexpr const char* domain_of_server = "DDS domain of the server, the first if it has several (default: 0)";

void add_server_option(CommandLine line, std::string& server);
void add_domain_option(CommandLine line, std::vector<std::uint32_t>& domains, const std::string& text);
void add_secure_option(CommandLine line, std::filesystem::path& folder, const std::string& text);

/// What files are read and how: folders that worlds may read beside their own, and whether the program `xacro` expands
/// the file that the command line names.
void add_reading_options(CommandLine line, bool& runs_xacro);
inline parsing::Xacro xacro_of(bool runs_xacro) { return runs_xacro ? parsing::Xacro::run : parsing::Xacro::refused; }

/// Where robots of a server are driven from.
struct ClientSide {
  std::vector<std::string> robots{};  ///< selectors
  Connection connection{};            ///< with one of its domains
};
void add_client_options(CommandLine line, ClientSide& client);

/// Whose data of a recording.
void add_robots_of_recording(CommandLine line, std::vector<std::string>& robots);
/// What is recorded. `prefix`: of the options' names.
void add_recorded_options(CommandLine line, RecordOptions& options, const std::string& prefix);
/// `subject`: of what it is, as a sentence begins with it.
void add_viewpoint_option(CommandLine line, const std::string& name, const std::string& subject, Viewpoint& viewpoint);

}  // namespace cohort::tool
