// SPDX-License-Identifier: Apache-2.0
#include "server/physics/planar/planar_collision.hpp"

#include <algorithm>
#include <stdexcept>

#include "server/core/state_visitors.hpp"
#include "server/physics/contact/same_point.hpp"

namespace cohort::physics {
namespace {

// As in the full model, points nearer than this are passed to the solver, which lets the bodies close the gap within
// the step [m].
constexpr double contact_margin = 0.005;

// Solids whose height ranges overlap by less pass over each other, like a body over the floor on which it stands [m].
constexpr double least_shared_height = 1e-4;
// Tolerance for planes and meshes: level within this is ground, upright within this is a wall [rad] or [m].
constexpr double level = 1e-3;

constexpr std::size_t colliders_a_chunk = 32;

bool is_before(const PlanarPair& one, const PlanarPair& two) { return one.a != two.a ? one.a < two.a : one.b < two.b; }

}  // namespace

void PlanarCollision::add_static() {
  outlines_.push_back(outline_of_static(static_cast<std::uint32_t>(outlines_.size())));
  member_of_solid_.push_back(Anchors::nobody);
}

void PlanarCollision::check_static(const description::Shape& shape, const Pose& X_WC) {
  static_cast<void>(outline_of(shape, X_WC));
}

PlanarCollision::Outline PlanarCollision::outline_of_static(std::uint32_t index) const {
  const geometry::Solid& solid = scene_.solid(index);
  return outline_of(solid.shape(), solid.X_WC);
}

PlanarCollision::Outline PlanarCollision::outline_of(const description::Shape& shape, const Pose& X_WC) {
  Outline outline;
  if (const auto* plane = std::get_if<description::Plane>(&shape)) {
    const Eigen::Vector3d normal_W = X_WC.orientation * plane->normal.normalized();
    if (std::abs(normal_W.z()) <= level) {
      const Eigen::Vector2d normal = normal_W.head<2>().normalized();
      outline = HalfPlane{normal, normal.dot(X_WC.position.head<2>())};
    } else if (normal_W.head<2>().norm() > level) {
      throw std::invalid_argument("planar physics supports only horizontal and vertical planes");
    }
  } else if (const auto footprint = geometry::footprint_of(shape, X_WC)) {
    const auto* mesh = std::get_if<description::Mesh>(&shape);
    if (mesh == nullptr || mesh->convex) {
      outline = *footprint;
    } else if (footprint->highest - footprint->lowest > level) {
      throw std::invalid_argument("planar physics supports only meshes that are flat or convex");
    }
  }
  return outline;
}

void PlanarCollision::add_member(bool is_fixed) {
  members_.push_back({.first_solid = static_cast<std::uint32_t>(outlines_.size()), .is_fixed = is_fixed});
  places_.emplace_back();
}

void PlanarCollision::add_moving() {
  ++members_.back().solid_count;
  outlines_.emplace_back(geometry::Footprint{});
  member_of_solid_.push_back(static_cast<std::uint32_t>(members_.size()) - 1);
}

void PlanarCollision::remove(std::uint32_t member) {
  members_[member].is_active = false;
  forget(member);
}

void PlanarCollision::forget(std::uint32_t member) {
  members_[member].pairs.clear();
  for (Member& other : members_)
    std::erase_if(other.pairs, [&](const PlanarPair& pair) { return pair.member_b == member; });
}

void PlanarCollision::detect(WorkerPool& workers) {
  memory_.resize(workers.threads());
  discs_.clear();
  for (std::uint32_t member = 0; member < members_.size(); ++member) {
    const Place& place = places_[member];
    if (members_[member].is_active && members_[member].solid_count > 0)
      discs_.push_back({place.centre_W.x(), place.centre_W.y(), place.radius, member});
  }
  grid_.build(discs_);
  workers.for_each_chunk(members_.size(), colliders_a_chunk, [&](std::size_t begin, std::size_t end, unsigned worker) {
    for (std::size_t member = begin; member < end; ++member)
      if (members_[member].is_active && members_[member].solid_count > 0)
        find_pairs(static_cast<std::uint32_t>(member), memory_[worker]);
  });
}

// Finds the solids with which this member may report a contact.
void PlanarCollision::find_near(std::uint32_t index, std::vector<std::uint32_t>& near) const {
  near.clear();
  const Member& member = members_[index];
  const Place& place = places_[index];
  const Eigen::Vector2d& at = place.centre_W;
  grid_.for_each_near({at.x(), at.y(), place.radius, index}, contact_margin, [&](std::uint32_t other) {
    if (other <= index) return;  // the other one reports it
    const Member& two = members_[other];
    if (member.is_fixed && two.is_fixed) return;
    for (std::uint32_t solid = two.first_solid; solid < two.first_solid + two.solid_count; ++solid)
      near.push_back(solid);
  });
  if (member.is_fixed) return;
  const Eigen::Vector3d lower(at.x() - place.radius, at.y() - place.radius, place.lowest);
  const Eigen::Vector3d upper(at.x() + place.radius, at.y() + place.radius, place.highest);
  const geometry::Bounds bounds = geometry::Bounds{lower, upper}.grown_by(contact_margin);
  scene_.for_each_static_overlap(bounds, [&](std::uint32_t solid) {
    if (!std::holds_alternative<std::monostate>(outlines_[solid])) near.push_back(solid);
  });
}

void PlanarCollision::find_pairs(std::uint32_t index, Memory& memory) {
  find_near(index, memory.near);
  Member& member = members_[index];
  const std::uint32_t end = member.first_solid + member.solid_count;
  memory.pairs.clear();
  for (std::uint32_t solid = member.first_solid; solid < end; ++solid)
    for (const std::uint32_t other : memory.near) find_contact(solid, other, memory);
  std::sort(memory.pairs.begin(), memory.pairs.end(), is_before);

  auto old = member.pairs.begin();
  for (PlanarPair& pair : memory.pairs) {
    while (old != member.pairs.end() && is_before(*old, pair)) ++old;
    if (old == member.pairs.end() || is_before(pair, *old)) continue;
    match_points(old->contact, pair.contact, [](const PlanarPoint& before, PlanarPoint& now) {
      now.normal_impulse = before.normal_impulse;
      now.friction_impulse = before.friction_impulse;
    });
  }
  member.pairs.assign(memory.pairs.begin(), memory.pairs.end());
}

void PlanarCollision::find_contact(std::uint32_t solid, std::uint32_t other, Memory& memory) {
  if (!may_collide(scene_.solid(solid).surface(), scene_.solid(other).surface())) return;
  const auto& a = std::get<geometry::Footprint>(outlines_[solid]);
  PlanarPair pair;
  double lowest = a.lowest;
  double highest = a.highest;
  if (const auto* b = std::get_if<geometry::Footprint>(&outlines_[other])) {
    lowest = std::max(lowest, b->lowest);
    highest = std::min(highest, b->highest);
    if (highest - lowest < least_shared_height) return;
    find_planar_contact(a, *b, contact_margin, pair.contact);
  } else {
    find_planar_contact(a, std::get<HalfPlane>(outlines_[other]), contact_margin, pair.contact);
  }
  if (pair.contact.count == 0) return;
  pair.a = solid;
  pair.b = other;
  pair.member_b = member_of_solid_[other];
  pair.z = 0.5 * (lowest + highest);
  memory.pairs.push_back(pair);
}

void PlanarCollision::save(SnapshotWriter& writer) const {
  writer.add_count(members_.size());
  for (const Member& member : members_) {
    writer.add_count(member.pairs.size());
    for (const PlanarPair& pair : member.pairs) {
      writer.add(pair.a);
      writer.add(pair.b);
      writer.add(pair.z);
      writer.add(pair.contact.count);
      for (const PlanarPoint& point : pair.contact)
        PlanarPoint::visit_state(point, [&](const double& number) { writer.add(number); });
    }
  }
}

void PlanarCollision::restore(SnapshotReader& reader) {
  reader.expect_count(members_.size(), "bodies that move");
  for (Member& member : members_) {
    member.pairs.clear();
    constexpr std::size_t least_bytes = 20;
    for (std::size_t count = reader.read_count(least_bytes); count > 0; --count) {
      PlanarPair& pair = member.pairs.emplace_back();
      reader.read(pair.a);
      reader.read(pair.b);
      reader.read(pair.z);
      reader.read(pair.contact.count);
      if (pair.a < member.first_solid || pair.a >= member.first_solid + member.solid_count ||
          pair.b >= outlines_.size() || pair.contact.count < 0 || pair.contact.count > PlanarPoints::most)
        throw SnapshotError("snapshot: invalid contact");
      pair.member_b = member_of_solid_[pair.b];
      for (PlanarPoint& point : pair.contact) PlanarPoint::visit_state(point, StateRestorer{reader});
    }
  }
}

}  // namespace cohort::physics
