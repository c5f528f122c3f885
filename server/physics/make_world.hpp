#pragma once

#include <memory>

#include "server/physics/world/physics_world.hpp"

namespace cohort::physics {

/// The world that the fidelity of `description` asks for. Keeps a reference to both. Throws std::invalid_argument for a
/// model that cannot be simulated. `like`: a world of another copy of the same description, with which this one shares
/// what follows from the models alone; null: none.
std::unique_ptr<World> make_world(const description::World& description, WorkerPool& workers,
                                  const World* like = nullptr);

}  // namespace cohort::physics
