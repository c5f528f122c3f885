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

/// Services for clients on Fast DDS, through the program `cohort-ros2-services`. Without the program, or when it has
/// ended, it says so once and does nothing. One thread.
class ServiceHelper {
 public:
  struct Options {
    std::string program{};  ///< its path
    RosDomain domain{};
    std::string node = "cohort_services";  ///< the name of its node, in the namespace `/`
    std::function<void(const std::string& text)> tell;
  };
  /// Starts the program and waits until the services have their endpoints there, or `stop` is set.
  ServiceHelper(Options options, std::span<const OfferedService> services, const std::atomic<bool>& stop);

  /// Returns the participant that the helper has in the domain of ROS; nothing if there is no helper.
  std::optional<Gid> participant() const;
  /// Tells others of the node of the services.
  void announce(GidFormat format);
  /// Returns the next request, if one is there.
  std::optional<bridges::ros2::RequestReceived> request();
  void reply(const bridges::ros2::RequestReceived& to, messages::ByteView reply);
  /// Returns a descriptor to wait on for requests; −1 if there is no helper.
  int descriptor() const { return process_ ? process_->descriptor() : -1; }

 private:
  void offer(std::span<const OfferedService> services, const std::atomic<bool>& stop);
  void give_up(const std::string& why);
  // Calls `body` while there is a helper; it is given up when it has ended or speaks nonsense.
  void with_process(const std::function<void(bridges::ros2::ServiceProcess&)>& body);

  Options options_;
  std::unique_ptr<bridges::ros2::ServiceProcess> process_;
  ParticipantInfo info_;
};

}  // namespace cohort::ros2
