// What changes in a world between steps, from outside.

#include <algorithm>

#include "server/physics/stepper.hpp"

namespace cohort::physics {

void Stepper::release_connections_of(std::uint32_t member) {
  for (Connection& connection : connections_)
    if (connection.a().member == member || connection.b().member == member) connection.release();
}

void Stepper::remove_body(std::uint32_t index) {
  Body& body = bodies_[index];
  if (!is_active(index)) return;
  if (body.member != Anchors::nobody) return take_out(members_[body.member]);
  body.is_out = true;
  for (const std::uint32_t solid : body.solids) {
    scene_.remove(solid);
    collision_.remove(solid);
  }
}

void Stepper::put_back_body(std::uint32_t index) {
  Body& body = bodies_[index];
  if (is_active(index)) return;
  if (body.member == Anchors::nobody) {
    body.is_out = false;
    for (const std::uint32_t solid : body.solids) scene_.put_back(solid);
    return;
  }
  Member& member = members_[body.member];
  const bool is_sound = member.is_finite && member.is_inside;
  if (!is_sound) body.multibody->stop();
  member.is_active = member.is_finite = member.is_inside = true;
  place_solids_of(member);
  for (const Part& part : member.parts) scene_.put_back(part.solid);
}

void Stepper::place_body(std::uint32_t index, const Pose& X_WM) {
  Body& body = bodies_[index];
  body.X_WM = X_WM;
  body.is_placed_again = true;
  if (body.member == Anchors::nobody) {
    std::size_t next = 0;
    for (const description::Link& link : description_.models[body.model].links)
      for (const description::Collision& collision : link.collisions) {
        collision_.remove(body.solids[next]);
        scene_.set_pose(body.solids[next++], X_WM * link.X_ML * collision.X_LC);
      }
    return scene_.build();
  }
  release_connections_of(body.member);
  body.multibody->place(X_WM);
  const Member& member = members_[body.member];
  for (const Part& part : member.parts) collision_.remove(part.solid);
  place_solids_of(member);
  scene_.update();
}

void Stepper::push_body(std::uint32_t body, std::size_t link, const Wrench& wrench) {
  const Mechanism::LinkPlace& place = bodies_[body].multibody->mechanism().link(link);
  const description::Inertial& inertial = description_.models[bodies_[body].model].links[link].inertial;
  const Eigen::Vector3d point_W = link_pose(body, link) * inertial.X_LI.position;
  const Push push{bodies_[body].member, place.segment, point_W, wrench};
  const auto is_before = [](const Push& one, const Push& two) { return one.member < two.member; };
  pushes_.insert(std::upper_bound(pushes_.begin(), pushes_.end(), push, is_before), push);
}

void Stepper::add_pushes_of(std::uint32_t member, Problem& problem) const {
  const auto is_of = [](const Push& push, std::uint32_t which) { return push.member < which; };
  for (auto push = std::lower_bound(pushes_.begin(), pushes_.end(), member, is_of);
       push != pushes_.end() && push->member == member; ++push)
    problem.equations(anchors_.index_of_member[member])
        .push(push->segment, push->point_W, step_ * push->wrench.force_W, step_ * push->wrench.torque_W);
}

}  // namespace cohort::physics
