// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client_sdk/include/cohort/control.hpp"
#include "idl/messages/ros_simulation_queries.hpp"
#include "idl/messages/ros_simulation_services.hpp"

/// Answers of the services for the run as a whole. The functions throw ControlError if a request to the server fails.
namespace cohort::ros2 {

namespace simulation = messages::ros::simulation;

simulation::GetSimulatorFeatures::Response answer(Control& run, const simulation::GetSimulatorFeatures::Request&);
simulation::GetSimulationState::Response answer(Control& run, const simulation::GetSimulationState::Request&);
simulation::SetSimulationState::Response answer(Control& run, const simulation::SetSimulationState::Request& asked);
simulation::StepSimulation::Response answer(Control& run, const simulation::StepSimulation::Request& asked);
simulation::ResetSimulation::Response answer(Control& run, const simulation::ResetSimulation::Request& asked);
simulation::LoadWorld::Response answer(Control& run, const simulation::LoadWorld::Request&);
simulation::UnloadWorld::Response answer(Control& run, const simulation::UnloadWorld::Request&);
simulation::GetAvailableWorlds::Response answer(Control& run, const simulation::GetAvailableWorlds::Request&);

}  // namespace cohort::ros2
