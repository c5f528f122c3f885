#include "idl/wire/control_messages.hpp"

#include <array>
#include <utility>

namespace cohort::wire {
namespace {

constexpr std::array<std::pair<Operation, const char*>, 23> names = {{
    {Operation::get_simulator_features, "GetSimulatorFeatures"},
    {Operation::get_simulation_state, "GetSimulationState"},
    {Operation::set_simulation_state, "SetSimulationState"},
    {Operation::step_simulation, "StepSimulation"},
    {Operation::reset_simulation, "ResetSimulation"},
    {Operation::get_entities, "GetEntities"},
    {Operation::get_entity_state, "GetEntityState"},
    {Operation::set_entity_state, "SetEntityState"},
    {Operation::spawn_entity, "SpawnEntity"},
    {Operation::delete_entity, "DeleteEntity"},
    {Operation::get_status, "GetStatus"},
    {Operation::set_speed, "SetSpeed"},
    {Operation::set_light, "SetLight"},
    {Operation::apply_force, "ApplyForce"},
    {Operation::save_snapshot, "SaveSnapshot"},
    {Operation::get_data, "GetData"},
    {Operation::put_data, "PutData"},
    {Operation::load_snapshot, "LoadSnapshot"},
    {Operation::start_recording, "StartRecording"},
    {Operation::get_recording, "GetRecording"},
    {Operation::stop_recording, "StopRecording"},
    {Operation::go_back, "GoBack"},
    {Operation::get_history, "GetHistory"},
}};

}  // namespace

std::string name_of(Operation operation) {
  for (const auto& [each, name] : names)
    if (each == operation) return name;
  return {};
}

bool is_query(Operation operation) {
  switch (operation) {
    case Operation::get_simulator_features:
    case Operation::get_simulation_state:
    case Operation::get_entities:
    case Operation::get_entity_state:
    case Operation::get_status:
    case Operation::get_data:
    case Operation::put_data:
    case Operation::get_recording:
    case Operation::stop_recording:
    case Operation::get_history: return true;
    default: return false;
  }
}

bool is_looking_on(Operation operation) {
  if (operation == Operation::put_data) return false;
  return is_query(operation) || operation == Operation::save_snapshot || operation == Operation::start_recording;
}

}  // namespace cohort::wire
