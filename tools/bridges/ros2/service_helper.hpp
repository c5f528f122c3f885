// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "idl/dds/ros2/discovery_info.hpp"
#include "idl/dds/ros2/ros_domain.hpp"
#include "tools/bridges/ros2/services/service_process.hpp"
#include "tools/bridges/ros2/simulation/simulation_services.hpp"

namespace cohort::ros2 {

/// Services for clients on Fast DDS, through the program `cohort-ros2-services`. If the program is missing or has
/// ended, this is reported once, and the functions do nothing. Not thread-safe.
class ServiceHelper {
 public:
  struct Options {
    std::string program{};  ///< path of the program
    RosDomain domain{};
    std::string node = "cohort_services";  ///< the name of its node, in the namespace `/`
    std::function<void(const std::string& text)> tell;
  };
  /// Starts the program and waits until it has created the endpoints of the services, or `stop` is set.
  ServiceHelper(Options options, std::span<const OfferedService> services, const std::atomic<bool>& stop);

  /// Returns the helper's participant in the ROS domain; nullopt if there is no helper.
  std::optional<Gid> participant() const;
  /// Announces the node of the services to other participants.
  void announce(GidFormat format);
  /// Returns the next request, if one has arrived.
  std::optional<bridges::ros2::RequestReceived> request();
  void reply(const bridges::ros2::RequestReceived& to, messages::ByteView reply);
  /// Returns a descriptor to wait on for requests; −1 if there is no helper.
  int descriptor() const { return process_ ? process_->descriptor() : -1; }

 private:
  void offer(std::span<const OfferedService> services, const std::atomic<bool>& stop);
  void give_up(const std::string& why);
  // Calls `body` if there is a helper. Gives the helper up if it has ended or sends invalid frames.
  void with_process(const std::function<void(bridges::ros2::ServiceProcess&)>& body);

  Options options_;
  std::unique_ptr<bridges::ros2::ServiceProcess> process_;
  ParticipantInfo info_;
};

}  // namespace cohort::ros2
