// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/messages/ros_simulation_queries.hpp"
#include "idl/messages/ros_simulation_services.hpp"
#include "tools/bridges/ros2/simulation/run_control.hpp"

/// Answers of the services for the run as a whole.
namespace cohort::ros2 {

namespace simulation = messages::ros::simulation;

simulation::GetSimulatorFeatures::Response answer(RunControl& run, const simulation::GetSimulatorFeatures::Request&);
simulation::GetSimulationState::Response answer(RunControl& run, const simulation::GetSimulationState::Request&);
simulation::SetSimulationState::Response answer(RunControl& run, const simulation::SetSimulationState::Request& asked);
simulation::StepSimulation::Response answer(RunControl& run, const simulation::StepSimulation::Request& asked);
simulation::ResetSimulation::Response answer(RunControl& run, const simulation::ResetSimulation::Request& asked);
simulation::LoadWorld::Response answer(RunControl& run, const simulation::LoadWorld::Request&);
simulation::UnloadWorld::Response answer(RunControl& run, const simulation::UnloadWorld::Request&);
simulation::GetAvailableWorlds::Response answer(RunControl& run, const simulation::GetAvailableWorlds::Request&);

}  // namespace cohort::ros2
