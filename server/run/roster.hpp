#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "idl/wire/messages.hpp"
#include "server/description/experiment.hpp"
#include "server/simulation/simulation.hpp"

/// The robots of a simulation in the words of the wire.
namespace cohort::session {

/// One for each kind of robot; RobotDescription::description is its index in Simulation::kinds().
std::vector<wire::RobotDescription> describe_kinds(const Simulation& simulation);

/// Returns a number made from the contents of a description, `description` itself left out: any server gives the same
/// description the same number, and another one another number, but for one chance in four billion.
std::uint32_t number_of(const wire::RobotDescription& kind);

/// Gives an Admit its robots, with what their teams say of them. The seed for a controller's own randomness depends on
/// the experiment's seed and the robot's name only.
void admit_robots(wire::Admit& admit, const description::Experiment& experiment, const Simulation& simulation,
                  std::span<const std::uint32_t> robots);

}  // namespace cohort::session
