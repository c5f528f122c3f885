#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "server/description/event.hpp"
#include "server/description/experiment.hpp"
#include "server/description/world.hpp"
#include "server/physics/world/physics_world.hpp"
#include "server/simulation/action.hpp"
#include "server/simulation/objects.hpp"

namespace cohort {

/// What an action looks names up in.
struct ActionScope {
  const description::World& description;
  const physics::World& world;
  const Objects& objects;
};

/// An action that does not bring anything new, as an event of now. Throws std::invalid_argument with the reason if it
/// makes no sense: no such object, one that is not in the world or is quarantined, not free to move, a number that is
/// not finite.
description::Event event_of(const Action& action, const ActionScope& scope);

/// The name that a new object gets. Throws std::invalid_argument if it is no name, or is taken.
std::string name_of_new(const SpawnObject& spawn, const std::string& model, const Objects& objects);

/// The team, by its index, that a new object of `model` joins; nothing if it is no robot. Throws std::invalid_argument
/// if it is not clear which, or there is none of that name.
std::optional<std::size_t> team_of_new(const SpawnObject& spawn, std::size_t model,
                                       const description::Experiment& experiment);

/// With a unit quaternion. Throws std::invalid_argument if it is no pose, or beyond what is simulated.
Pose checked_pose(const Pose& X_WM);

}  // namespace cohort
