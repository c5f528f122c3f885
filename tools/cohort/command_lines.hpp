#pragma once

#include <CLI/CLI.hpp>

#include "tools/cohort/commands.hpp"

/// What the command lines of larger commands hold. `command` is filled in when they are parsed.
namespace cohort::tool {

void add_security_commands(CLI::App& app, SecurityCommand& command);
void add_ctl_commands(CLI::App& app, CtlCommand& command);
void add_doctor_options(CLI::App& app, DoctorCommand& command);
void add_view_options(CLI::App& app, ViewCommand& command);

}  // namespace cohort::tool
