// SPDX-License-Identifier: Apache-2.0

// Creation of the bodies of a planar world and of the ground under each.

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "server/physics/planar/planar_world.hpp"

namespace cohort::physics {
namespace {

using Eigen::Vector3d;

// A body that leans by less is upright, and ground that leans by less is level [rad].
constexpr double most_lean = 1e-3;

// Returns the mean distance of the points of a rounded rectangle from a point in the plane.
double mean_distance(const geometry::Footprint& outline, const Eigen::Vector2d& point) {
  constexpr int points_across = 32;
  const Eigen::Vector2d half = outline.half_extent();
  double sum = 0.0;
  int count = 0;
  for (int row = 0; row < points_across; ++row) {
    for (int column = 0; column < points_across; ++column) {
      const Eigen::Vector2d share((2.0 * column + 1.0) / points_across - 1.0, (2.0 * row + 1.0) / points_across - 1.0);
      const Eigen::Vector2d at = outline.centre + half.cwiseProduct(share);
      if (outline.distance(at) > 0.0) continue;
      sum += (at - point).norm();
      ++count;
    }
  }
  return count > 0 ? sum / count : 0.0;
}

}  // namespace

PlanarWorld::PlanarWorld(const description::World& description, WorkerPool& workers, const PlanarWorld* like,
                         std::span<const Pose> X_WM)
    : description_(description),
      workers_(workers),
      step_(std::chrono::duration<double>(description.step).count()),
      surfaces_(description),
      models_(description.models.size()),
      collision_(scene_) {
  if (like != nullptr) {
    models_ = like->models_;
    kinds_ = like->kinds_;
    scene_.reserve(like->scene_.size());
    collision_.reserve(like->scene_.size());
    part_of_solid_.reserve(like->scene_.size());
  }
  const Vector3d& gravity = description.gravity;
  if (gravity.head<2>().norm() > -most_lean * gravity.z())
    throw std::invalid_argument("planar physics requires gravity along -z");
  if (description.water) throw std::invalid_argument("planar physics does not support water");
  for (unsigned worker = 0; worker < workers.threads(); ++worker)
    memory_.push_back({PlanarSolver(planar_, grounds_), {}, {}});
  bodies_.reserve(description.instances.size());
  for (const description::Instance& instance : description.instances)
    create_body(instance.model, X_WM.empty() ? instance.X_WM : X_WM[bodies_.size()]);
  scene_.build();
  for (std::uint32_t member = 0; member < members_.size(); ++member) put_on_ground(member);
  for (std::size_t body = 0; body < bodies_.size(); ++body)
    if (!description.instances[body].is_present) remove_body(BodyId{body});
}

BodyId PlanarWorld::add_body(std::size_t model, const Pose& X_WM, std::optional<std::uint32_t> saved_slot) {
  if (!saved_slot) check_new(description_.models[model], X_WM);
  const BodyId body = create_body(model, X_WM, saved_slot);
  scene_.build();
  const std::uint32_t member = bodies_[body.value].member;
  if (!saved_slot && member != Anchors::nobody) put_on_ground(member);
  return body;
}

// Throws as create_body and put_on_ground would, before the body exists: if these two throw, they leave it half
// created.
void PlanarWorld::check_new(const description::Model& described, const Pose& X_WM) const {
  try {
    check_placed(described, X_WM);
    if (described.is_static) {
      for (const description::Link& link : described.links)
        for (const description::Collision& collision : link.collisions)
          PlanarCollision::check_static(collision.shape, X_WM * link.X_ML * collision.X_LC);
      return;
    }
    const PlanarModel model(described);
    if (!needs_ground(model)) return;
    PlanarBodies alone;
    const std::uint32_t index = alone.add(model, X_WM);
    double lowest = std::numeric_limits<double>::infinity();
    double highest = alone.segment_in_body(index, 0).position.z();
    for (std::size_t link = 0; link < described.links.size(); ++link) {
      const Mechanism::LinkPlace& place = model.mechanism().link(link);
      if (!place.collides) continue;
      for (const description::Collision& collision : described.links[link].collisions) {
        const Pose X_BC = alone.segment_in_body(index, place.segment) * (place.X_SL * collision.X_LC);
        const geometry::Footprint outline = *geometry::footprint_of(collision.shape, X_BC);
        lowest = std::min(lowest, outline.lowest);
        highest = std::max(highest, outline.highest);
      }
    }
    const double from = std::isfinite(lowest) ? 0.5 * (lowest + highest) : highest;
    ground_under({alone.place(index).x, alone.place(index).y, from});
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("model '" + described.name + "': " + error.what());
  }
}

void PlanarWorld::check_placed(const description::Model& model, const Pose& X_WM) const {
  const double lean = (X_WM.orientation * Vector3d::UnitZ()).head<2>().norm();
  if (model.is_robot() && (lean > most_lean || (X_WM.orientation * Vector3d::UnitZ()).z() < 0.0))
    throw std::invalid_argument("planar physics requires upright robots");
  const auto feels_wind = [](const description::Link& link) { return link.feels_wind; };
  if (description_.air.wind != Vector3d::Zero() && std::any_of(model.links.begin(), model.links.end(), feels_wind))
    throw std::invalid_argument("planar physics does not support links with <enable_wind>");
}

bool PlanarWorld::needs_ground(const PlanarModel& model) const {
  return !model.is_immovable() && description_.gravity.z() * model.mass() != 0.0;
}

BodyId PlanarWorld::create_body(std::size_t model_index, const Pose& X_WM, std::optional<std::uint32_t> saved_slot) {
  const BodyId body{bodies_.size()};
  const description::Model& model = description_.models[model_index];
  if (model_index >= models_.size()) models_.resize(model_index + 1);  // the model was added later
  try {
    if (!model.is_static && !models_[model_index]) models_[model_index] = std::make_shared<const PlanarModel>(model);
    check_placed(model, X_WM);
    PlacedBody placed;
    placed.model = static_cast<std::uint32_t>(model_index);
    placed.X_WM = X_WM;
    const bool is_slot_used = slots_.take(placed, saved_slot);
    if (is_slot_used)
      model.is_static ? renew_static(placed, body) : renew_moving(placed, body);
    else
      model.is_static ? add_static(placed, body) : add_moving(placed, body);
    bodies_.push_back(placed);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("model '" + model.name + "': " + error.what());
  }
  return body;
}

void PlanarWorld::add_static(PlacedBody& body, BodyId id) {
  const description::Model& model = description_.models[body.model];
  const std::vector<geometry::SolidKindPtr>& kinds = kinds_.of_model(body.model, model);
  body.first_solid = body.end_of_solids = static_cast<std::uint32_t>(scene_.size());
  auto kind = kinds.begin();
  for (const description::Link& link : model.links) {
    for (const description::Collision& collision : link.collisions) {
      body.end_of_solids = scene_.add(*kind++, id, false, body.X_WM * link.X_ML * collision.X_LC) + 1;
      collision_.add_static();
      part_of_solid_.emplace_back();
    }
  }
}

void PlanarWorld::renew_static(const PlacedBody& body, BodyId id) {
  std::uint32_t next = body.first_solid;
  for (const description::Link& link : description_.models[body.model].links)
    for (const description::Collision& collision : link.collisions) {
      scene_.renew(next, id, body.X_WM * link.X_ML * collision.X_LC);
      collision_.place_static(next++);
    }
}

void PlanarWorld::add_moving(PlacedBody& body, BodyId id) {
  const PlanarModel& model = *models_[body.model];
  const std::uint32_t index = planar_.add(model, body.X_WM);
  body.member = index;
  collision_.add_member(model.is_immovable());
  grounds_.emplace_back();
  Member& member = members_.emplace_back();
  member.body = id;
  member.first_part = static_cast<std::uint32_t>(parts_.size());
  const std::vector<description::Link>& links = model.mechanism().model().links;
  const std::vector<geometry::SolidKindPtr>& kinds = kinds_.of_model(body.model, model.mechanism().model());
  std::size_t next = 0;
  for (std::size_t link = 0; link < links.size(); ++link) {
    const Mechanism::LinkPlace& place = model.mechanism().link(link);
    for (const description::Collision& collision : links[link].collisions) {
      const geometry::SolidKindPtr& kind = kinds[next++];
      if (!place.collides) continue;
      const Pose X_SC = place.X_SL * collision.X_LC;
      const Pose X_WC = planar_.segment_pose(index, place.segment) * X_SC;
      const std::uint32_t solid = scene_.add(kind, id, true, X_WC);
      parts_.push_back({solid, place.segment, X_SC, {}});
      parts_in_body_.emplace_back();
      collision_.add_moving();
      part_of_solid_.push_back({index, place.segment});
      ++member.part_count;
    }
  }
  find_parts_in_body(member, index);
  place_solids(index);
}

void PlanarWorld::renew_moving(const PlacedBody& body, BodyId id) {
  const std::uint32_t index = body.member;
  Member& member = members_[index];
  planar_.renew(index, body.X_WM);
  grounds_[index] = {};
  member.body = id;
  member.is_active = member.is_finite = member.is_inside = true;
  member.has_ground = false;
  member.record.reset();
  collision_.put_back(index);
  find_parts_in_body(member, index);
  for (std::uint32_t i = member.first_part; i < member.first_part + member.part_count; ++i)
    scene_.renew(parts_[i].solid, id, planar_.segment_pose(index, parts_[i].segment) * parts_[i].X_SC);
  place_solids(index);
}

void PlanarWorld::put_on_ground(std::uint32_t index) {
  Member& member = members_[index];
  const PlanarModel& model = planar_.model(index);
  const double weight = -description_.gravity.z() * model.mass();
  member.has_ground = !needs_ground(model);
  if (member.has_ground) return;
  const std::span<const Part> parts(parts_.data() + member.first_part, member.part_count);
  const auto is_lower = [](const Part& a, const Part& b) { return a.outline_B.lowest < b.outline_B.lowest; };
  const auto lowest = std::min_element(parts.begin(), parts.end(), is_lower);

  // Search from the middle of the body: it may be placed slightly below the surface.
  double highest = planar_.segment_in_body(index, 0).position.z();
  for (const Part& part : parts) highest = std::max(highest, part.outline_B.highest);
  const double from = lowest != parts.end() ? 0.5 * (lowest->outline_B.lowest + highest) : highest;
  std::uint32_t ground = 0;
  try {
    ground = ground_under({planar_.place(index).x, planar_.place(index).y, from});
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("model '" + model.mechanism().model().name + "': " + error.what());
  }
  member.has_ground = true;
  const description::Surface& under = scene_.solid(ground).surface();
  if (const description::TrackPair* drive = model.drive()) {
    const description::Surface tracks = surface_of_tracks(model.mechanism().model(), *drive);
    const Mechanism::LinkPlace& place = model.mechanism().link(drive->link);
    grounds_[index] = PlanarGround(*drive, planar_.segment_in_body(index, place.segment) * place.X_SL,
                                   surfaces_.of(tracks, under).friction, weight, planar_.inertia(index), step_);
  } else if (lowest != parts.end()) {
    const SurfacePair surfaces = surfaces_.of(scene_.solid(lowest->solid).surface(), under);
    grounds_[index] =
        PlanarGround(surfaces.friction, weight, mean_distance(lowest->outline_B, Eigen::Vector2d::Zero()), step_);
  }
}

// Returns the first static solid below a point.
std::uint32_t PlanarWorld::ground_under(const Vector3d& origin_W) const {
  constexpr double depth = 10.0;  // [m]
  std::vector<std::uint32_t> below;
  scene_.for_each_static_overlap({origin_W - depth * Vector3d::UnitZ(), origin_W},
                                 [&](std::uint32_t solid) { below.push_back(solid); });
  const auto hit = scene_.cast_ray_among(below, origin_W, -Vector3d::UnitZ(), depth);
  if (!hit || hit->distance == 0.0) throw std::invalid_argument("planar physics requires ground under the model");
  if (hit->normal_W.head<2>().norm() > most_lean)
    throw std::invalid_argument("planar physics requires level ground under the model");
  return hit->solid;
}

}  // namespace cohort::physics
