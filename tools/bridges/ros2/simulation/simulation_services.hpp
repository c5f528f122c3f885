// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "idl/messages/cdr.hpp"
#include "server/description/experiment.hpp"
#include "tools/bridges/ros2/simulation/entity_services.hpp"

namespace cohort::ros2 {

/// A service of ROS.
struct OfferedService {
  std::string name{};       ///< such as `/step_simulation`
  std::string type{};       ///< such as `simulation_interfaces/srv/StepSimulation`
  std::string type_hash{};  ///< `RIHS01_…`
  /// Returns the reply to a request, both in CDR. Throws messages::CdrError if the request is not of this type.
  std::function<messages::Bytes(messages::ByteView request)> answer;
};

/// The version of simulation_interfaces, which determines the layout of some messages and cannot be detected from them.
enum class InterfaceVersion {
  v1,  ///< for ROS releases up to Kilted
  v2,
};

/// The services of simulation_interfaces for a run. Their result codes are the server's; codes that ROS 2 does not
/// define become OPERATION_FAILED. Not thread-safe.
class SimulationServices {
 public:
  /// Waits end while `stop` is set. `experiment` is called at the first request that needs it. Throws ControlError.
  SimulationServices(const ControlOptions& options, EntityServices::MakeExperiment experiment, EntityListener listener,
                     InterfaceVersion version, const std::atomic<bool>& stop);
  SimulationServices(const SimulationServices&) = delete;
  SimulationServices& operator=(const SimulationServices&) = delete;

  /// Returns the services; they are valid as long as this.
  const std::vector<OfferedService>& all() const { return services_; }

 private:
  Control run_;
  EntityServices entities_;
  std::vector<OfferedService> services_;
};

/// Returns the name of a service in ROS: `/step_simulation` for `simulation_interfaces/srv/StepSimulation`.
std::string service_name(const std::string& type);

}  // namespace cohort::ros2
