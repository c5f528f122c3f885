// SPDX-License-Identifier: Apache-2.0

// Changes from outside to a planar world between steps.

#include "server/physics/planar/planar_world.hpp"

namespace cohort::physics {

void PlanarWorld::set_present(BodyId body, bool is_present) {
  if (is_present)
    put_back_body(body);
  else
    remove_body(body);
}

void PlanarWorld::remove_body(BodyId index) {
  PlacedBody& body = bodies_[index.value];
  if (!is_active(index)) return;
  if (body.member != Anchors::nobody) return take_out(body.member);
  body.is_out = true;
  connections_.release_of_body(index.value);
  for (std::uint32_t solid = body.first_solid; solid < body.end_of_solids; ++solid) scene_.remove(solid);
}

void PlanarWorld::put_back_body(BodyId index) {
  PlacedBody& body = bodies_[index.value];
  if (is_active(index)) return;
  if (body.member == Anchors::nobody) {
    body.is_out = false;
    for (std::uint32_t solid = body.first_solid; solid < body.end_of_solids; ++solid) scene_.put_back(solid);
    return;
  }
  Member& member = members_[body.member];
  if (!member.is_finite || !member.is_inside) planar_.stop(body.member);
  member.is_active = member.is_finite = member.is_inside = true;
  collision_.put_back(body.member);
  place_solids(body.member);
  for (std::uint32_t i = 0; i < member.part_count; ++i) scene_.put_back(parts_[member.first_part + i].solid);
}

void PlanarWorld::release_body(BodyId index) {
  slots_.release(bodies_[index.value], link_pose(index, LinkId{0}), description_);
}

void PlanarWorld::place_body(BodyId index, const Pose& X_WM) {
  PlacedBody& body = bodies_[index.value];
  if (body.member != Anchors::nobody) place_on_ground(body.member, X_WM);
  body.X_WM = X_WM;
  body.is_placed_again = true;
  if (body.member == Anchors::nobody) {
    connections_.release_of_body(index.value);
    std::uint32_t next = body.first_solid;
    for (const description::Link& link : description_.models[body.model].links)
      for (const description::Collision& collision : link.collisions) {
        scene_.set_pose(next, X_WM * link.X_ML * collision.X_LC);
        collision_.place_static(next++);
      }
    return scene_.build();
  }
  connections_.release_of(body.member);
  if (members_[body.member].record) members_[body.member].record->forget();
  collision_.forget(body.member);
  place_solids(body.member);
  scene_.update();
}

// Without ground the body keeps its pose.
void PlanarWorld::place_on_ground(std::uint32_t member, const Pose& X_WM) {
  const bool had_ground = members_[member].has_ground;
  SnapshotWriter before;
  PlanarBodies::visit_state(planar_, member, StateSaver{before});
  planar_.place(member, X_WM);
  find_parts_in_body(members_[member], member);
  try {
    put_on_ground(member);
  } catch (const std::invalid_argument&) {
    SnapshotReader reader(before.bytes());
    PlanarBodies::visit_state(planar_, member, StateRestorer{reader});
    planar_.update_poses(member);
    find_parts_in_body(members_[member], member);
    members_[member].has_ground = had_ground;
    throw;
  }
}

void PlanarWorld::push_body(BodyId body, LinkId link, const Wrench& wrench) {
  const std::uint32_t member = bodies_[body.value].member;
  const description::Inertial& inertial = description_.models[bodies_[body.value].model].links[link.value].inertial;
  pushes_.add({member, planar_.model(member).mechanism().link(link.value).segment, link.value,
               link_pose(body, link) * inertial.X_LI.position, wrench});
}

}  // namespace cohort::physics
