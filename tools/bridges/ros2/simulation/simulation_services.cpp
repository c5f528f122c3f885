// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/simulation/simulation_services.hpp"

#include <cctype>
#include <utility>

#include "idl/messages/ros_type_hash.hpp"
#include "tools/bridges/ros2/simulation/service_results.hpp"
#include "tools/bridges/ros2/simulation/time_services.hpp"

namespace cohort::ros2 {
namespace {

using messages::Bytes;
using messages::ByteView;

template <class Response>
Response failed(simulation::Result result) {
  Response response;
  if constexpr (requires { response.result; }) response.result = std::move(result);
  return response;
}

// Answers a request; turns its errors into a result.
template <class Response, class Request>
Response response_to(const Request& request, const auto& answer_it) {
  try {
    return answer_it(request);
  } catch (const ControlError& error) {
    return failed<Response>(result_of(error));
  } catch (const std::exception& error) {
    return failed<Response>({simulation::Result::operation_failed, error.what()});
  }
}

template <class Service>
OfferedService offered(std::function<Bytes(ByteView)> answer_it) {
  return {service_name(Service::type), Service::type, messages::type_hash<Service>(), std::move(answer_it)};
}

// A service whose requests `answerer` answers.
template <class Service, class Answerer>
OfferedService service(Answerer& answerer) {
  return offered<Service>([&answerer](ByteView bytes) {
    const auto request = messages::decode<typename Service::Request>(bytes);
    return messages::encode(response_to<typename Service::Response>(request, [&](const auto& asked) {
      if constexpr (requires { answerer.answer(asked); })
        return answerer.answer(asked);
      else
        return answer(answerer, asked);
    }));
  });
}

// Requests of 1.x end before the flags, and set pose and twist.
simulation::SetEntityState::Request state_to_set(ByteView bytes) {
  using simulation::SetEntityState;
  messages::CdrReader reader(bytes);
  const auto former = reader.get<SetEntityState::FormerRequest>();
  constexpr std::size_t flags = 3;
  if (reader.left() >= flags) return messages::decode<SetEntityState::Request>(bytes);
  const bool sets_acceleration = former.state.acceleration != messages::ros::Accel{};
  return {former.entity, former.state, true, true, sets_acceleration};
}

OfferedService set_entity_state(EntityServices& entities) {
  using Service = simulation::SetEntityState;
  return offered<Service>([&entities](ByteView bytes) {
    return messages::encode(response_to<Service::Response>(
        state_to_set(bytes), [&](const Service::Request& request) { return entities.answer(request); }));
  });
}

OfferedService former_get_spawnables(EntityServices& entities) {
  using Service = simulation::GetSpawnables;
  return offered<Service>([&entities](ByteView bytes) {
    const auto response =
        response_to<Service::Response>(messages::decode<Service::Request>(bytes),
                                       [&](const Service::Request& request) { return entities.answer(request); });
    Service::FormerResponse former{response.result, {}};
    for (const simulation::Spawnable& each : response.spawnables)
      former.spawnables.push_back({each.entity_resource.uri, each.description, each.spawn_bounds});
    return messages::encode(former);
  });
}

}  // namespace

std::string service_name(const std::string& type) {
  std::string name;
  for (const char letter : type.substr(type.rfind('/') + 1)) {
    const auto byte = static_cast<unsigned char>(letter);
    if (std::isupper(byte) != 0) name += name.empty() ? '/' : '_';
    name += static_cast<char>(std::tolower(byte));
  }
  return name;
}

SimulationServices::SimulationServices(const ControlOptions& options, EntityServices::MakeExperiment experiment,
                                       EntityListener listener, InterfaceVersion version, const std::atomic<bool>& stop)
    : run_(options), entities_(run_, std::move(experiment), std::move(listener)) {
  run_.stop_on(&stop);
  services_ = {service<simulation::GetSimulatorFeatures>(run_),
               service<simulation::GetSimulationState>(run_),
               service<simulation::SetSimulationState>(run_),
               service<simulation::StepSimulation>(run_),
               service<simulation::ResetSimulation>(run_),
               service<simulation::SpawnEntity>(entities_),
               service<simulation::SpawnEntities>(entities_),
               service<simulation::DeleteEntity>(entities_),
               service<simulation::GetEntities>(entities_),
               service<simulation::GetEntitiesStates>(entities_),
               service<simulation::GetEntityState>(entities_),
               set_entity_state(entities_),
               service<simulation::GetEntityInfo>(entities_),
               version == InterfaceVersion::v1 ? former_get_spawnables(entities_)
                                               : service<simulation::GetSpawnables>(entities_),
               service<simulation::GetCurrentWorld>(entities_),
               service<simulation::GetAvailableWorlds>(run_),
               service<simulation::LoadWorld>(run_),
               service<simulation::UnloadWorld>(run_)};
}

}  // namespace cohort::ros2
