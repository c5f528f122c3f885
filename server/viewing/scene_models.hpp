#pragma once

#include "server/simulation/simulation.hpp"
#include "server/viewing/scene_messages.hpp"

namespace cohort::viewing {

inline Vector vector_of(const Eigen::Vector3d& vector) {
  return {static_cast<float>(vector.x()), static_cast<float>(vector.y()), static_cast<float>(vector.z())};
}

/// Adds the models of a world, with their meshes, sensors and channels.
void add_models(const Simulation& simulation, Scene& scene);

}  // namespace cohort::viewing
