#pragma once

#include <atomic>
#include <chrono>

#include "client_sdk/src/control/control_client.hpp"
#include "idl/messages/ros_simulation_messages.hpp"
#include "idl/wire/control_messages.hpp"

namespace cohort::ros2 {

/// A client that controls a run, with answers also where no reply comes. One thread.
class RunControl {
 public:
  /// Waits end while `stop` is set. Throws ControlError.
  RunControl(const ControlOptions& options, const std::atomic<bool>& stop) : client_(attach(options)), stop_(stop) {}

  /// Asks, and returns the reply. A reply that does not come has failed, and says why.
  wire::Reply ask(const wire::Operation& operation, std::chrono::milliseconds at_most = usual_limit);
  /// Returns whether a server was there that has gone.
  bool server_is_gone() const { return client_.server_is_gone(); }

  static constexpr std::chrono::milliseconds usual_limit{30'000};
  /// For what takes as long as controllers and new worlds do.
  static constexpr std::chrono::milliseconds no_limit = std::chrono::hours(24 * 365);

 private:
  ControlClient client_;
  const std::atomic<bool>& stop_;
};

/// Returns the result of a request as services have it, with the server's words.
messages::ros::simulation::Result result_of(const wire::Reply& reply);

}  // namespace cohort::ros2
