// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/messages/scene_messages.hpp"
#include "server/simulation/simulation.hpp"

namespace cohort::viewing {

inline messages::Vector vector_of(const Eigen::Vector3d& vector) {
  return {static_cast<float>(vector.x()), static_cast<float>(vector.y()), static_cast<float>(vector.z())};
}

/// Adds the models of a world, with their meshes, sensors and channels.
void add_models(const Simulation& simulation, messages::Scene& scene);

}  // namespace cohort::viewing
