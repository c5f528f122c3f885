#pragma once

#include <atomic>

#include "client_sdk/src/attachment.hpp"

/// What the programs of Cohort have in common.
namespace cohort {

/// From now on SIGINT, SIGTERM and SIGHUP (a closed terminal; not under nohup) set what this returns. A second one of
/// them ends the process at once, whatever it is stuck in.
std::atomic<bool>& stop_on_signals();

/// The exit code of a program that was a client: docs/cli.md, "Exit codes".
int exit_code_of(ClientEnd end);

}  // namespace cohort
