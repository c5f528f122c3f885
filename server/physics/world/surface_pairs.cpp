// SPDX-License-Identifier: Apache-2.0
#include "server/physics/world/surface_pairs.hpp"

#include <algorithm>

namespace cohort::physics {

SurfacePairs::SurfacePairs(const description::World& world)
    : materials_(world.materials.size()), pairs_(materials_ * materials_) {
  for (const description::MaterialPair& pair : world.material_pairs) {
    for (const std::size_t index : {pair.first * materials_ + pair.second, pair.second * materials_ + pair.first}) {
      pairs_[index] = pair;
    }
  }
}

namespace {

SurfacePair of_coefficients(const description::Surface& a, const description::Surface& b) {
  SurfacePair both{std::min(a.friction, b.friction), a.restitution * b.restitution,
                   std::max(a.rolling_resistance, b.rolling_resistance),
                   std::max(a.spinning_resistance, b.spinning_resistance)};
  if (a.has_direction() || b.has_direction()) {
    const auto across = [](const description::Surface& s) {
      return s.has_direction() ? s.second_friction : s.friction;
    };
    both.second_friction = std::min(across(a), across(b));
    const bool by_first = a.has_direction() && (!b.has_direction() || a.friction <= b.friction);
    both.directed = by_first ? SurfacePair::Directed::by_first : SurfacePair::Directed::by_second;
  }
  if (std::min(a.stiffness, b.stiffness) < SurfacePair::rigid) {
    both.stiffness = 1.0 / (1.0 / a.stiffness + 1.0 / b.stiffness);
    both.damping = a.damping + b.damping;
  }
  both.bounce_threshold = std::max(a.bounce_threshold, b.bounce_threshold).value_or(least_bounce);
  return both;
}

}  // namespace

SurfacePair SurfacePairs::of(const description::Surface& a, const description::Surface& b) const {
  SurfacePair both = of_coefficients(a, b);
  if (a.material >= materials_ || b.material >= materials_) return both;  // added later
  if (const auto& pair = pairs_[a.material * materials_ + b.material]) {
    both.friction = pair->friction;
    both.directed = SurfacePair::Directed::neither;
    both.restitution = pair->restitution;
    both.rolling_resistance = pair->rolling_resistance;
  }
  return both;
}

description::Surface surface_of_tracks(const description::Model& model, const description::TrackPair& drive) {
  std::size_t link = drive.link;
  for (const std::vector<std::size_t>* wheels : {&drive.right_wheels, &drive.left_wheels})
    if (!wheels->empty()) link = model.joints[wheels->front()].child;
  description::Surface surface;
  if (!model.links[link].collisions.empty()) surface.material = model.links[link].collisions.front().surface.material;
  surface.friction = drive.friction;
  return surface;
}

}  // namespace cohort::physics
