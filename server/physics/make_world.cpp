// SPDX-License-Identifier: Apache-2.0
#include "server/physics/make_world.hpp"

#include "server/physics/islands/multibody_world.hpp"
#include "server/physics/planar/planar_world.hpp"

namespace cohort::physics {

std::unique_ptr<World> make_world(const description::World& description, WorkerPool& workers, const World* like,
                                  std::span<const Pose> X_WM) {
  if (description.physics.fidelity == description::Fidelity::planar)
    return std::make_unique<PlanarWorld>(description, workers, dynamic_cast<const PlanarWorld*>(like), X_WM);
  return std::make_unique<MultibodyWorld>(description, workers, dynamic_cast<const MultibodyWorld*>(like), X_WM);
}

}  // namespace cohort::physics
