// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "idl/messages/ros_schema.hpp"
#include "idl/messages/ros_simulation_queries.hpp"
#include "idl/messages/ros_simulation_services.hpp"

/// The package simulation_interfaces as texts, for tests whose nodes call its services.
namespace cohort::test {

/// The versions 1.x, which releases up to Kilted have, or 2.x.
enum class SimulationInterfaces { former, current };

class InterfaceTexts {
 public:
  /// Writes FOLDER/simulation_interfaces/{msg,srv}/ of the services that the bridge offers.
  InterfaceTexts(const std::filesystem::path& folder, SimulationInterfaces version) : folder_(folder / package) {
    namespace sim = messages::ros::simulation;
    std::filesystem::create_directories(folder_ / "msg");
    std::filesystem::create_directories(folder_ / "srv");
    add<sim::GetSimulatorFeatures>();
    add<sim::GetSimulationState>();
    add<sim::SetSimulationState>();
    add<sim::StepSimulation>();
    add<sim::ResetSimulation>();
    add<sim::SpawnEntity>();
    add<sim::SpawnEntities>();
    add<sim::DeleteEntity>();
    add<sim::GetEntities>();
    add<sim::GetEntitiesStates>();
    add<sim::GetEntityState>();
    add<sim::GetEntityInfo>();
    add<sim::GetCurrentWorld>();
    add<sim::GetAvailableWorlds>();
    add<sim::LoadWorld>();
    add<sim::UnloadWorld>();
    const bool is_former = version == SimulationInterfaces::former;
    is_former ? add<sim::SetEntityState, sim::SetEntityState::FormerRequest>() : add<sim::SetEntityState>();
    is_former ? add<sim::GetSpawnables, sim::GetSpawnables::Request, sim::GetSpawnables::FormerResponse>()
              : add<sim::GetSpawnables>();
  }

  static constexpr const char* package = "simulation_interfaces";

 private:
  template <class Service, class Request = typename Service::Request, class Response = typename Service::Response>
  void add() {
    const auto request = messages::definition<Request>();
    const auto response = messages::definition<Response>();
    write("srv", Service::type, request.text + "---\n" + response.text);
    add_parts(request);
    add_parts(response);
  }
  void add_parts(const messages::RosDefinition& definition) {
    for (const messages::RosDefinition& part : definition.parts) {
      if (part.type.starts_with(std::string(package) + "/")) write("msg", part.type, part.text);
      add_parts(part);
    }
  }
  void write(const std::string& kind, const std::string& type, const std::string& text) const {
    std::ofstream(folder_ / kind / (type.substr(type.rfind('/') + 1) + "." + kind)) << text;
  }

  std::filesystem::path folder_;
};

}  // namespace cohort::test
