// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <string>

#include "client_sdk/hosting/controller_host.hpp"
#include "client_sdk/include/cohort/client.hpp"
#include "client_sdk/src/claims.hpp"
#include "client_sdk/src/run_watch.hpp"

namespace cohort {

/// Attaches to a server, drives robots with `handler` until the run ends, and returns the reason. Logs every reason
/// other than `finished`. The server shows `name` if the options have none. Waits until there is a server. Blocks; the
/// handler runs on the calling thread, unless `inline_step` is set. A signal handler may set `stop`. `watch` is
/// notified when the run is over, and `claims` can replace the selectors of the options; both may be null. Throws
/// wire::WireError if the server's address or the identity cannot be used.
ClientEnd run_client(FrameHandler& handler, const std::string& name, const ClientOptions& options,
                     const std::atomic<bool>& stop, RunWatch* watch, Claims* claims = nullptr);

/// Runs controllers of one kind in the same way.
ClientEnd run_client(const ControllerKind& kind, const ClientOptions& options, const std::atomic<bool>& stop);

/// Runs the `main` of a program with controllers of one kind, as in <cohort/controller.hpp>.
int run_controller(const ControllerKind& kind, int argc, char** argv);

}  // namespace cohort
