// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>

#include "client_sdk/src/control/control_client.hpp"
#include "idl/messages/ros_simulation_messages.hpp"
#include "idl/wire/control_messages.hpp"

namespace cohort::ros2 {

/// A client that controls a run, and gives an answer even if the server does not reply. Not thread-safe.
class RunControl {
 public:
  /// Waits end while `stop` is set. Throws ControlError.
  RunControl(const ControlOptions& options, const std::atomic<bool>& stop) : client_(attach(options)), stop_(stop) {}

  /// Requests an operation and returns the reply. If none arrives, returns a failed reply that says why.
  wire::Reply ask(const wire::Operation& operation, std::chrono::milliseconds at_most = usual_limit);
  /// Returns whether the server was connected and has disappeared.
  bool server_is_gone() const { return client_.server_is_gone(); }

  static constexpr std::chrono::milliseconds usual_limit{30'000};
  /// For operations whose duration depends on controllers or on loading a world.
  static constexpr std::chrono::milliseconds no_limit = std::chrono::hours(24 * 365);

 private:
  ControlClient client_;
  const std::atomic<bool>& stop_;
};

/// Returns the result of a request in the format of the services, with the server's error message.
messages::ros::simulation::Result result_of(const wire::Reply& reply);

}  // namespace cohort::ros2
