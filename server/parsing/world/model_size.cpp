// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/world/model_size.hpp"

#include <cmath>
#include <optional>

#include "server/core/text.hpp"
#include "server/geometry/shapes/shapes.hpp"

namespace cohort::parsing {
namespace {

// The size of a robot of 2 cm, the smallest in use, if its sizes in millimetres are read as metres.
constexpr double largest_size = 20.0;

// Returns the size of the model's collisions along its axes.
std::optional<Eigen::Vector3d> size_of(const Model& model) {
  std::optional<geometry::Bounds> bounds;
  for (const Link& link : model.links)
    for (const Collision& collision : link.collisions) {
      const geometry::Bounds each = geometry::bounds_of(collision.shape, link.X_ML * collision.X_LC);
      if (bounds)
        bounds->include(each);
      else
        bounds = each;
    }
  if (!bounds) return std::nullopt;
  return bounds->upper - bounds->lower;
}

}  // namespace

void warn_of_sizes(World& world) {
  for (const Model& model : world.models) {
    if (model.is_static || (!model.is_robot() && model.joints.empty())) continue;
    const auto size = size_of(model);
    if (!size || !size->allFinite() || size->maxCoeff() <= largest_size) continue;
    const auto text = [&](int axis) { return shortest_text(std::round(10.0 * (*size)[axis]) / 10.0); };
    world.warnings.push_back({world.file, 0, "model[" + model.name + "]",
                              "is " + text(0) + " x " + text(1) + " x " + text(2) +
                                  " m large; sizes are in metres. If its file has millimetres, multiply all sizes by "
                                  "0.001, for a mesh with <scale>"});
  }
}

}  // namespace cohort::parsing
