#include "server/physics/make_world.hpp"

#include "server/physics/islands/multibody_world.hpp"
#include "server/physics/planar/planar_world.hpp"

namespace cohort::physics {

std::unique_ptr<World> make_world(const description::World& description, WorkerPool& workers) {
  if (description.physics.fidelity == description::Fidelity::planar)
    return std::make_unique<PlanarWorld>(description, workers);
  return std::make_unique<MultibodyWorld>(description, workers);
}

}  // namespace cohort::physics
