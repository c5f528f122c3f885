// SPDX-License-Identifier: Apache-2.0

// Changes from outside to a world between steps, and the lowest height, which depends on them.

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "server/physics/islands/multibody_world.hpp"
#include "server/physics/world/corrections.hpp"

namespace cohort::physics {
namespace {

// Returns the lowest height at which a static solid can carry a body. A sloping plane descends up to the end of the
// world; a wall or a ceiling carries nothing below its origin.
double lowest_of(const geometry::Scene& scene, std::uint32_t index) {
  constexpr double least_upwards = 1e-9;
  const geometry::Solid& solid = scene.solid(index);
  if (!std::holds_alternative<description::Plane>(solid.shape())) return scene.bounds(index).lower.z();
  const double height = solid.X_WC.position.z();
  const Eigen::Vector3d up_W = solid.X_WC.orientation * Eigen::Vector3d::UnitZ();
  if (up_W.z() < least_upwards) return height;
  return height - 2.0 * furthest_from_origin * up_W.head<2>().lpNorm<1>() / up_W.z();
}

}  // namespace

// Sets the lowest allowed height, unless the world specifies it: well below all static solids, present or not, and well
// below the place of every body. Without a static solid, there is no ground that a body could miss, and no limit.
void MultibodyWorld::find_lowest() {
  constexpr double below_all = 10.0;  // [m]
  is_lowest_known_ = true;
  if (std::isfinite(description_.physics.lowest)) return;
  constexpr double none = std::numeric_limits<double>::infinity();
  double lowest_static = none;
  double lowest_place = none;
  const geometry::Scene& scene = assembly_.scene;
  const auto is_released = [&](BodyId body) { return bodies_[body.value].slot == World::released; };
  for (std::uint32_t solid = 0; solid < scene.size(); ++solid)
    if (!assembly_.anchors.moves(solid) && !is_released(scene.solid(solid).body))
      lowest_static = std::min(lowest_static, lowest_of(scene, solid));
  for (const Member& member : assembly_.members) {
    if (is_released(member.body)) continue;
    const PlacedBody& body = bodies_[member.body.value];
    const Pose X_WL = body.X_WM * description_.models[body.model].links[0].X_ML;
    lowest_place = std::min(lowest_place, X_WL.position.z());
  }
  assembly_.settings.lowest = lowest_static == none ? -none : std::min(lowest_static, lowest_place) - below_all;
}

void MultibodyWorld::set_present(BodyId body, bool is_present) {
  if (is_present)
    put_back_body(body);
  else
    remove_body(body);
}

void MultibodyWorld::remove_body(BodyId index) {
  PlacedBody& body = bodies_[index.value];
  if (!is_active(index)) return;
  if (!is_static(index)) return assembly_.take_out(wake(index).member);
  sleep_.wake_all();
  body.is_out = true;
  assembly_.connections.release_of_body(index.value);
  for (std::uint32_t solid = body.first_solid; solid < body.end_of_solids; ++solid) {
    assembly_.scene.remove(solid);
    assembly_.collision.remove(solid);
  }
}

void MultibodyWorld::put_back_body(BodyId index) {
  PlacedBody& body = bodies_[index.value];
  if (is_active(index)) return;
  if (!is_static(index)) return assembly_.put_back(body.member);
  sleep_.wake_all();
  body.is_out = false;
  for (std::uint32_t solid = body.first_solid; solid < body.end_of_solids; ++solid) assembly_.scene.put_back(solid);
}

void MultibodyWorld::release_body(BodyId index) {
  is_lowest_known_ = false;
  slots_.release(bodies_[index.value], link_pose(index, LinkId{0}), description_);
}

void MultibodyWorld::place_body(BodyId index, const Pose& X_WM) {
  PlacedBody& body = bodies_[index.value];
  body.X_WM = X_WM;
  body.is_placed_again = true;
  is_lowest_known_ = false;
  if (!is_static(index)) return assembly_.place(wake(index).member, X_WM);
  sleep_.wake_all();
  assembly_.connections.release_of_body(index.value);
  std::uint32_t next = body.first_solid;
  for (const description::Link& link : description_.models[body.model].links)
    for (const description::Collision& collision : link.collisions) {
      assembly_.collision.remove(next);
      assembly_.scene.set_pose(next++, X_WM * link.X_ML * collision.X_LC);
    }
  assembly_.scene.build();
}

void MultibodyWorld::push_body(BodyId body, LinkId link, const Wrench& wrench) {
  wake(body);
  const description::Inertial& inertial = description_.models[bodies_[body.value].model].links[link.value].inertial;
  assembly_.pushes.add({bodies_[body.value].member, multibody(body).mechanism().link(link.value).segment, link.value,
                        link_pose(body, link) * inertial.X_LI.position, wrench});
}

}  // namespace cohort::physics
