// SPDX-License-Identifier: Apache-2.0
#include "idl/wire/operations.hpp"

#include <array>
#include <type_traits>
#include <utility>

namespace cohort::wire {
namespace {

constexpr std::array<std::pair<OperationCode, const char*>, 25> names = {{
    {OperationCode::get_simulator_features, "GetSimulatorFeatures"},
    {OperationCode::get_simulation_state, "GetSimulationState"},
    {OperationCode::set_simulation_state, "SetSimulationState"},
    {OperationCode::step_simulation, "StepSimulation"},
    {OperationCode::reset_simulation, "ResetSimulation"},
    {OperationCode::get_entities, "GetEntities"},
    {OperationCode::get_entity_state, "GetEntityState"},
    {OperationCode::set_entity_state, "SetEntityState"},
    {OperationCode::spawn_entity, "SpawnEntity"},
    {OperationCode::delete_entity, "DeleteEntity"},
    {OperationCode::get_status, "GetStatus"},
    {OperationCode::set_speed, "SetSpeed"},
    {OperationCode::set_light, "SetLight"},
    {OperationCode::apply_force, "ApplyForce"},
    {OperationCode::save_snapshot, "SaveSnapshot"},
    {OperationCode::get_data, "GetData"},
    {OperationCode::put_data, "PutData"},
    {OperationCode::load_snapshot, "LoadSnapshot"},
    {OperationCode::start_recording, "StartRecording"},
    {OperationCode::get_recording, "GetRecording"},
    {OperationCode::stop_recording, "StopRecording"},
    {OperationCode::go_back, "GoBack"},
    {OperationCode::get_history, "GetHistory"},
    {OperationCode::advance_time, "AdvanceTime"},
    {OperationCode::get_experiment, "GetExperiment"},
}};

}  // namespace

std::string name_of(OperationCode operation) {
  for (const auto& [each, name] : names)
    if (each == operation) return name;
  return {};
}

OperationCode code_of(const Operation& operation) {
  return std::visit(
      []<class One>(const One& one) {
        if constexpr (std::is_same_v<One, UnknownOperation>)
          return static_cast<OperationCode>(one.number);
        else
          return One::code;
      },
      operation);
}

bool is_query(OperationCode operation) {
  switch (operation) {
    case OperationCode::get_simulator_features:
    case OperationCode::get_simulation_state:
    case OperationCode::get_entities:
    case OperationCode::get_entity_state:
    case OperationCode::get_status:
    case OperationCode::get_data:
    case OperationCode::put_data:
    case OperationCode::get_recording:
    case OperationCode::stop_recording:
    case OperationCode::get_history:
    case OperationCode::get_experiment: return true;
    default: return false;
  }
}

bool is_looking_on(OperationCode operation) {
  if (operation == OperationCode::put_data) return false;
  return is_query(operation) || operation == OperationCode::save_snapshot ||
         operation == OperationCode::start_recording;
}

}  // namespace cohort::wire
