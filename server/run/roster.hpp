// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "idl/wire/messages.hpp"
#include "server/description/experiment.hpp"
#include "server/simulation/simulation.hpp"

/// The description of a simulation's robots in protocol messages.
namespace cohort::session {

/// Returns one description for each kind of robot; RobotDescription::description is its index in Simulation::kinds().
std::vector<wire::RobotDescription> describe_kinds(const Simulation& simulation);

/// Returns a hash of the contents of a description without `description` itself: all servers give equal descriptions
/// the same number. Different descriptions get the same number with a probability of one in four billion.
std::uint32_t number_of(const wire::RobotDescription& kind);

/// Adds the robots to an Admit, with the settings of their teams. The seed for a controller's own randomness depends
/// only on the experiment's seed and the robot's name.
void admit_robots(wire::Admit& admit, const description::Experiment& experiment, const Simulation& simulation,
                  std::span<const std::uint32_t> robots);

}  // namespace cohort::session
