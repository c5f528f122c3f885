// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "server/physics/world/physics_world.hpp"

namespace cohort::physics {

/// Creates a world with the fidelity of `description`. Keeps references to `description` and `workers`. Throws
/// std::invalid_argument for a model that cannot be simulated. `like`: a world of the same description, or of a copy of
/// it, with which the new world shares data that depends only on the models; null: none. `X_WM`: poses of the
/// instances, in place of those of the description; empty: no replacement.
std::unique_ptr<World> make_world(const description::World& description, WorkerPool& workers,
                                  const World* like = nullptr, std::span<const Pose> X_WM = {});

}  // namespace cohort::physics
