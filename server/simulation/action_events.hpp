// SPDX-License-Identifier: Apache-2.0
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

/// The names that an action may refer to.
struct ActionScope {
  const description::World& description;
  const physics::World& world;
  const Objects& objects;
};

/// Converts an action that adds nothing into an immediate event. Throws ActionError if it is invalid: an unknown,
/// absent or quarantined object, one that is not free to move, or a number that is not finite.
description::Event event_of(const Action& action, const ActionScope& scope);

/// Returns the name of a new object. Throws ActionError if it is invalid or taken.
std::string name_of_new(const SpawnObject& spawn, const std::string& model, const Objects& objects);

/// Returns the index of the team that a new object of `model` joins; nothing if it is not a robot. Throws
/// ActionError if the team is ambiguous or unknown.
std::optional<std::size_t> team_of_new(const SpawnObject& spawn, std::size_t model,
                                       const description::Experiment& experiment);

/// Returns the pose with a normalized quaternion. Throws ActionError if it is invalid, or out of the
/// simulated range.
Pose checked_pose(const Pose& X_WM);

}  // namespace cohort
