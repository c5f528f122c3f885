#pragma once

#include <memory>
#include <span>

#include "server/physics/world/physics_world.hpp"

namespace cohort::physics {

/// The world that the fidelity of `description` asks for. Keeps a reference to both. Throws std::invalid_argument for a
/// model that cannot be simulated. `like`: a world of the same description or a copy of it, with which this one shares
/// what follows from the models alone; null: none. `X_WM`: of each instance, in place of the description's; empty:
/// those.
std::unique_ptr<World> make_world(const description::World& description, WorkerPool& workers,
                                  const World* like = nullptr, std::span<const Pose> X_WM = {});

}  // namespace cohort::physics
