#pragma once

#include <atomic>
#include <string>

#include "client_sdk/hosting/controller_host.hpp"
#include "client_sdk/include/cohort/client.hpp"
#include "client_sdk/src/run_watch.hpp"

namespace cohort {

/// Attaches to a server, drives robots by `handler` until the run ends, and returns why it ended; tells what anything
/// but `finished` is about. `name` is shown by the server if the options have none. Waits for a server that is not
/// there yet. Blocks; the handler runs on the calling thread, unless `inline_step`. `stop` may be set from a signal
/// handler. Throws wire::WireError if the server's address or the identity cannot be used. `watch`: told when the run
/// is over, or null.
ClientEnd run_client(FrameHandler& handler, const std::string& name, const ClientOptions& options,
                     const std::atomic<bool>& stop, RunWatch* watch);

/// Runs controllers of one kind like that.
ClientEnd run_client(const ControllerKind& kind, const ClientOptions& options, const std::atomic<bool>& stop);

/// The `main` of a program with controllers of one kind: as that of <cohort/controller.hpp>.
int run_controller(const ControllerKind& kind, int argc, char** argv);

}  // namespace cohort
