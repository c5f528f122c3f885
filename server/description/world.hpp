#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/description/model.hpp"

namespace cohort::description {

/// One placed copy of a model.
struct Instance {
  std::string name;       ///< scoped, unique in the world, such as `explorers/sbot_7`
  std::size_t model = 0;  ///< index into World::models
  Pose X_WM;
};

/// A world with every include and population expanded. A robot's id is its place in `robots`.
struct World {
  std::string name;
  std::filesystem::path file;
  std::chrono::nanoseconds step{10'000'000};
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};  ///< [m/s^2]
  std::vector<Model> models;
  std::vector<Instance> instances;
  std::vector<std::size_t> robots;  ///< indices into `instances`, in their order
  std::vector<Problem> warnings;    ///< what the file asks for and is not simulated

  const Instance& robot(std::uint32_t id) const { return instances[robots[id]]; }
  const Model& robot_model(std::uint32_t id) const { return models[robot(id).model]; }
};

/// Reads an SDF world with libsdformat and expands its includes and, by `seed`, its `cohort:population` elements. The
/// instances are the models and includes in document order, then the populations in theirs. `model://NAME` is looked
/// for in the folders of the environment variable COHORT_MODEL_PATH, in `robots` and `objects` in the folder of the
/// file and in its parents, four levels up, and in `last_model_folders`; other URIs are paths relative to the file.
/// docs/worlds.md has the details. Throws InputError with every problem found. Callable from any thread; calls wait for
/// each other.
World read_world(const std::filesystem::path& file, std::uint64_t seed,
                 const std::vector<std::filesystem::path>& last_model_folders = {});

}  // namespace cohort::description
