// SPDX-License-Identifier: Apache-2.0
#include "server/gripping/grippers.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "server/core/state_visitors.hpp"

namespace cohort::gripping {
namespace {

using Eigen::Vector3d;

// The limit of a ring's inclination to the jaw, as a cosine.
constexpr double least_parallel = 0.5;
// Rays that search for the surface of a grippable collision, at each of three heights.
constexpr int rays_a_height = 9;

void improve(std::optional<Target>& best, const Target& target) {
  const auto key = [](const Target& t) { return std::tuple(t.distance, t.body, t.link); };
  if (!best || key(target) < key(*best)) best = target;
}

// Returns the axes of a connection: z along `axis_W`, x as close to `forward_W` as possible.
Eigen::Quaterniond axes_of(const Vector3d& axis_W, const Vector3d& forward_W) {
  Eigen::Matrix3d R;
  R.col(2) = axis_W;
  R.col(1) = axis_W.cross(forward_W).normalized();
  R.col(0) = R.col(1).cross(axis_W);
  return Eigen::Quaterniond(R).normalized();
}

}  // namespace

Grippers::Grippers(const description::World& description, physics::World& world)
    : description_(description), world_(world), step_(std::chrono::duration<double>(description.step).count()) {
  for (std::size_t body = 0; body < description.instances.size(); ++body)
    add_body(BodyId{body}, description.models[description.instances[body].model]);
}

void Grippers::add_body(BodyId body, const description::Model& model) {
  for (std::size_t device = 0; device < model.devices.size(); ++device) {
    const auto* gripper = std::get_if<description::Gripper>(&model.devices[device]);
    if (gripper == nullptr) continue;
    const auto [known, is_new] =
        numbers_.try_emplace({world_.slot_of(body), DeviceId{device}}, static_cast<std::uint32_t>(grippers_.size()));
    if (is_new) grippers_.emplace_back();
    grippers_[known->second] = {.body = body, .device = gripper};
  }
  for (const description::GripRing& ring : model.grip_rings) largest_ring_ = std::max(largest_ring_, ring.radius);
}

void Grippers::command(std::uint32_t number, double opening) {
  Gripper& gripper = grippers_[number];
  if (gripper.connection != nothing && !world_.connections().holds(gripper.connection)) {
    gripper.connection = nothing;
    gripper.is_spent = 1;
  }
  const double most = step_ / gripper.device->closing_time;
  const double before = gripper.opening;
  gripper.opening += std::clamp(opening - before, -most, most);
  if (gripper.opening >= letting_go) {
    if (gripper.connection != nothing) world_.connections().disconnect(gripper.connection);
    gripper.connection = nothing;
    gripper.is_spent = 0;
  } else if (gripper.connection != nothing) {
    if (gripper.opening != before) set_give(gripper);
  } else if (gripper.is_spent == 0 && world_.is_active(gripper.body)) {
    if (const std::optional<Target> target = find_target(number)) grasp(gripper, *target);
  }
}

void Grippers::grasp(Gripper& gripper, const Target& target) {
  const Vector3d forward_W = jaw_pose(gripper).orientation * Vector3d::UnitX();
  const Pose X_WP{target.p_W, axes_of(target.axis_W, forward_W)};
  const Pose X_LP = world_.link_pose(gripper.body, LinkId{gripper.device->link}).inverse() * X_WP;
  gripper.connection =
      world_.connections().connect({gripper.body, LinkId{gripper.device->link}}, X_LP, {target.body, target.link},
                                   {gripper.device->breaking_force, gripper.device->breaking_torque});
  set_give(gripper);
}

void Grippers::set_give(const Gripper& gripper) {
  physics::ConnectionGive give;
  give.holding_force = gripper.device->holding_force;
  give.holding_torque.setConstant(gripper.device->holding_torque);
  give.holding_torque.z() *= 1.0 - gripper.opening / letting_go;
  world_.connections().set_give(gripper.connection, give);
}

Pose Grippers::jaw_pose(const Gripper& gripper) const {
  return world_.link_pose(gripper.body, LinkId{gripper.device->link}) * gripper.device->X_LG;
}

bool Grippers::is_gripping(std::uint32_t gripper) const {
  const ConnectionId connection = grippers_[gripper].connection;
  return connection != nothing && world_.connections().holds(connection);
}

double Grippers::force(std::uint32_t gripper) const {
  return is_gripping(gripper) ? world_.connections().wrench(grippers_[gripper].connection).force_W.norm() : 0.0;
}

bool Grippers::is_something_between(std::uint32_t number) const {
  const Gripper& gripper = grippers_[number];
  if (gripper.device->light_barrier == description::Gripper::LightBarrier::simple)
    return is_gripping(number) || find_target(number).has_value();
  const Pose X_WG = jaw_pose(gripper);
  const double half = 0.5 * gripper.device->jaw_width;
  const Vector3d from_W = X_WG * Vector3d(0.5 * gripper.device->depth, -half, 0.0);
  const Vector3d direction_W = X_WG.orientation * Vector3d::UnitY();
  return world_.scene().cast_ray(from_W, direction_W, gripper.device->jaw_width, gripper.body).has_value();
}

std::optional<Target> Grippers::find_target(std::uint32_t number) const {
  const Gripper& gripper = grippers_[number];
  const Pose X_WG = jaw_pose(gripper);
  const Vector3d around = Vector3d::Constant(gripper.device->depth + gripper.device->height + largest_ring_);
  std::optional<Target> best;
  std::vector<BodyId> bodies;
  world_.scene().for_each_overlap({X_WG.position - around, X_WG.position + around}, [&](std::uint32_t index) {
    const geometry::Solid& solid = world_.scene().solid(index);
    if (solid.body == gripper.body) return;
    if (!description_.models[world_.model_of(solid.body)].grip_rings.empty()) bodies.push_back(solid.body);
    if (solid.surface().is_grippable) consider_solid(gripper, X_WG, index, best);
  });
  std::sort(bodies.begin(), bodies.end());
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  for (const BodyId body : bodies) consider_rings(gripper, X_WG, body, best);
  return best;
}

// Considers the nearest point of each ring. The lateral angle is that of the ring's middle, as seen from the jaw.
void Grippers::consider_rings(const Gripper& gripper, const Pose& X_WG, BodyId body,
                              std::optional<Target>& best) const {
  const description::Gripper& device = *gripper.device;
  for (const description::GripRing& ring : description_.models[world_.model_of(body)].grip_rings) {
    const Pose X_WR = world_.link_pose(body, LinkId{ring.link}) * ring.X_LR;
    const Vector3d axis_W = X_WR.orientation * Vector3d::UnitZ();
    if (std::abs(axis_W.dot(X_WG.orientation * Vector3d::UnitZ())) < least_parallel) continue;
    Vector3d outwards_W = X_WG.position - X_WR.position;
    outwards_W -= axis_W * axis_W.dot(outwards_W);
    if (outwards_W.norm() == 0.0) continue;
    const Vector3d p_W = X_WR.position + ring.radius * outwards_W.normalized();
    const Vector3d p_G = X_WG.inverse() * p_W;
    const Vector3d middle_G = X_WG.inverse() * X_WR.position;
    const double distance = std::sqrt(p_G.x() * p_G.x() + p_G.y() * p_G.y());
    if (distance > device.depth || std::abs(p_G.z()) > device.height) continue;
    if (std::abs(std::atan2(middle_G.y(), middle_G.x())) > device.half_angle) continue;
    improve(best, {body, LinkId{ring.link}, X_WR.position, axis_W, distance});
  }
}

void Grippers::consider_solid(const Gripper& gripper, const Pose& X_WG, std::uint32_t index,
                              std::optional<Target>& best) const {
  const description::Gripper& device = *gripper.device;
  const geometry::Solid& solid = world_.scene().solid(index);
  const Vector3d axis_W = X_WG.orientation * Vector3d::UnitZ();
  for (const double height : {0.0, device.height, -device.height}) {
    const Vector3d from_W = X_WG * Vector3d(0.0, 0.0, height);
    for (int i = 0; i < rays_a_height; ++i) {
      const double bearing = device.half_angle * (2.0 * i / (rays_a_height - 1) - 1.0);
      const Vector3d direction_W = X_WG.orientation * Vector3d(std::cos(bearing), std::sin(bearing), 0.0);
      const auto hit = world_.scene().cast_ray_among({&index, 1}, from_W, direction_W, device.depth);
      if (hit)
        improve(best, {solid.body, LinkId{solid.link()}, from_W + hit->distance * direction_W, axis_W, hit->distance});
    }
  }
}

template <class Self, class Visit>
void Grippers::visit_state(Self& self, Visit&& visit) {
  for (auto& gripper : self.grippers_) {
    visit(gripper.opening);
    visit(gripper.connection.value);
    visit(gripper.is_spent);
  }
}

void Grippers::hash(StateHash& hash) const {
  for (const Gripper& gripper : grippers_) {
    hash.add(gripper.opening);
    hash.add(std::uint64_t{gripper.connection.value} << 1 | std::uint64_t{gripper.is_spent});
  }
}

void Grippers::save(SnapshotWriter& writer) const {
  visit_state(*this, [&](const auto& value) { writer.add(value); });
}

void Grippers::restore(SnapshotReader& reader) {
  visit_state(*this, StateRestorer{reader});
  for (const Gripper& gripper : grippers_) {
    if (gripper.opening < 0.0 || gripper.opening > 1.0 || gripper.is_spent > 1)
      throw SnapshotError("snapshot: invalid opening of a gripper");
    if (gripper.connection != nothing && gripper.connection.value >= world_.connections().made())
      throw SnapshotError("snapshot: a gripper has an unknown connection");
  }
}

}  // namespace cohort::gripping
