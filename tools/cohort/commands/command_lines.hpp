#pragma once

#include <CLI/CLI.hpp>

#include "tools/cohort/commands/commands.hpp"

/// What the command lines of larger commands hold. `command` is filled in when they are parsed.
namespace cohort::tool {

/// Options that commands have in common. A server's address, of $COHORT_SERVER if it is not said;
void add_server_option(CLI::App& app, std::string& server);
/// an identity's folder, of $COHORT_SECURE;
void add_secure_option(CLI::App& app, std::filesystem::path& folder, const char* text);
/// and DDS domains, of $COHORT_DOMAIN.
void add_domains(CLI::App& app, std::vector<std::uint32_t>& domains, const std::string& text);

void add_security_commands(CLI::App& app, SecurityCommand& command);
void add_ctl_commands(CLI::App& app, CtlCommand& command);
void add_doctor_options(CLI::App& app, DoctorCommand& command);
void add_view_options(CLI::App& app, ViewCommand& command);

}  // namespace cohort::tool
