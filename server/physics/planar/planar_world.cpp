// SPDX-License-Identifier: Apache-2.0
#include "server/physics/planar/planar_world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "server/core/tick_stage.hpp"
#include "server/physics/world/corrections.hpp"

namespace cohort::physics {
namespace {

constexpr std::size_t members_a_chunk = 64;
constexpr std::size_t islands_a_chunk = 32;

// The links of one body, in the form that MotionRecord requires.
struct LinksOf {
  const PlanarBodies& bodies;
  std::uint32_t member;
  Pose link_pose(std::size_t link) const { return bodies.link_pose(member, link); }
  Twist link_twist(std::size_t link) const { return bodies.link_twist(member, link); }
  Eigen::Vector3d reference() const { return {bodies.place(member).x, bodies.place(member).y, 0.0}; }
};

Wrench in_plane(const Wrench& wrench) {
  return {{wrench.force_W.x(), wrench.force_W.y(), 0.0}, {0.0, 0.0, wrench.torque_W.z()}};
}

}  // namespace

Activity PlanarWorld::activity(BodyId body) const {
  const PlacedBody& placed = bodies_[body.value];
  const bool is_in = placed.member == Anchors::nobody ? !placed.is_out : members_[placed.member].is_active;
  return is_in ? Activity::awake : Activity::out;
}

Pose PlanarWorld::link_pose(BodyId body, LinkId link) const {
  if (bodies_[body.value].member != Anchors::nobody) return planar_.link_pose(bodies_[body.value].member, link.value);
  return bodies_[body.value].X_WM * description_.models[bodies_[body.value].model].links[link.value].X_ML;
}

Twist PlanarWorld::link_twist(BodyId body, LinkId link) const {
  if (bodies_[body.value].member != Anchors::nobody && is_active(body))
    return planar_.link_twist(bodies_[body.value].member, link.value);
  return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
}

JointState PlanarWorld::joint_state(BodyId body, JointId joint) const {
  const std::uint32_t member = bodies_[body.value].member;
  if (member == Anchors::nobody) return {};
  return {planar_.joint_position(member, joint.value), planar_.joint_velocity(member, joint.value), 0.0};
}

void PlanarWorld::set_joint_state(BodyId body, JointId joint, std::span<const double> coordinates,
                                  std::span<const double> velocities) {
  const std::uint32_t member = bodies_[body.value].member;
  planar_.set_joint_state(member, joint.value, coordinates, velocities);
  find_parts_in_body(members_[member], member);
  place_solids(member);
  scene_.update();
}

// Tracks are the only outputs in a planar world.
Side PlanarWorld::side_of(std::uint32_t member, DeviceId device, std::size_t output) const {
  return std::get<DeviceOutputs::Track>(planar_.model(member).mechanism().outputs().at(device, output)).side;
}

OutputState PlanarWorld::device_state(BodyId body, DeviceId device, std::size_t output) const {
  const std::uint32_t member = bodies_[body.value].member;
  if (member == Anchors::nobody) return {};
  return grounds_[member].track(side_of(member, device, output));
}

void PlanarWorld::set_device_target(BodyId body, DeviceId device, std::size_t output, double velocity) {
  const std::uint32_t member = bodies_[body.value].member;
  grounds_[member].set_target(side_of(member, device, output), velocity);
}

void PlanarWorld::record(BodyId body) {
  if (bodies_[body.value].member == Anchors::nobody) return;
  std::unique_ptr<MotionRecord>& record = members_[bodies_[body.value].member].record;
  if (!record) record = std::make_unique<MotionRecord>(description_.models[bodies_[body.value].model]);
  has_records_ = true;
}

Eigen::Vector3d PlanarWorld::link_acceleration(BodyId body, LinkId link, const Eigen::Vector3d& p_LP) const {
  if (bodies_[body.value].member == Anchors::nobody) return Eigen::Vector3d::Zero();
  const std::unique_ptr<MotionRecord>& record = members_[bodies_[body.value].member].record;
  return record ? record->acceleration(link.value, p_LP, step_) : Eigen::Vector3d::Zero();
}

Pose PlanarWorld::pose_of(const Connection::End& end) const {
  return end.member == Anchors::nobody ? Pose{} : planar_.segment_pose(end.member, end.segment);
}

Wrench PlanarWorld::wrench(ConnectionId connection, ConnectionEnd end) const {
  const Connection* const found = connections_.find(connection.value);
  if (found == nullptr) return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  const Pose X_WSa = pose_of(found->a());
  const Pose X_WSb = pose_of(found->b());
  return in_plane(end == ConnectionEnd::a ? found->wrench_on_a(X_WSa, X_WSb, step_)
                                          : found->wrench_on_b(X_WSa, X_WSb, step_));
}

void PlanarWorld::step() {
  if (has_records_)
    for (std::uint32_t index = 0; index < members_.size(); ++index)
      if (members_[index].record) members_[index].record->before(LinksOf{planar_, index});
  StageMarks stages;
  stages.enter("collision detection");
  collision_.detect(workers_);
  find_islands();
  stages.enter("contact forces");
  workers_.for_each_chunk(islands_.count(), islands_a_chunk, [&](std::size_t begin, std::size_t end, unsigned worker) {
    for (std::size_t i = begin; i < end; ++i)
      solve_island(islands_.members(static_cast<std::uint32_t>(i)), memory_[worker]);
  });
  workers_.for_each_chunk(members_.size(), members_a_chunk, [&](std::size_t begin, std::size_t end, unsigned) {
    for (std::size_t member = begin; member < end; ++member) move(static_cast<std::uint32_t>(member));
  });
  report_contacts();
  connections_.break_overloaded(step_);
  quarantine();
  pushes_.clear();
  scene_.update();
}

void PlanarWorld::find_islands() {
  const auto count = static_cast<std::uint32_t>(members_.size());
  islands_.reset(count);
  for (std::uint32_t member = 0; member < count; ++member) {
    if (!members_[member].is_active) continue;
    for (const PlanarPair& pair : collision_.pairs_of(member))
      if (pair.member_b != Anchors::nobody) islands_.link(member, pair.member_b);
    connections_.for_each_of(member, [&](const Connection& connection) {
      if (connection.b().member != Anchors::nobody) islands_.link(member, connection.b().member);
    });
  }
  islands_.finish();
}

// A body whose state breaks is left out, and the rest of the island is solved without it.
void PlanarWorld::solve_island(std::span<const std::uint32_t> members, Memory& memory) {
  std::vector<std::uint32_t>& sound = memory.members;
  sound.clear();
  for (const std::uint32_t member : members) {
    if (!members_[member].is_active) continue;
    planar_.drive_joints(member, step_);
    members_[member].is_finite = planar_.is_sensible(member);
    if (members_[member].is_finite) sound.push_back(member);
  }
  while (!sound.empty() && !try_island(sound, memory))
    std::erase_if(sound, [&](std::uint32_t member) { return !members_[member].is_finite; });
}

// Returns false, without any change, if a body's velocities are invalid; its member is marked.
bool PlanarWorld::try_island(const std::vector<std::uint32_t>& members, Memory& memory) {
  PlanarSolver& solver = memory.solver;
  solver.clear();
  memory.before.clear();
  for (const std::uint32_t member : members) {
    memory.before.push_back({planar_.velocity(member), grounds_[member].impulse()});
    pushes_.for_each_of(member, [&](const Pushes::Push& push) {
      planar_.push(member, push.point_W, step_ * push.wrench.force_W, step_ * push.wrench.torque_W);
    });
    solver.add_member(member);
    add_rows_of(member, solver);
  }
  solver.solve(description_.physics.iterations);
  bool is_good = true;
  for (const std::uint32_t member : members) {
    members_[member].is_finite = planar_.is_sensible(member);
    is_good = is_good && members_[member].is_finite;
  }
  if (is_good) {
    solver.keep(step_);
    return true;
  }
  for (std::size_t i = 0; i < members.size(); ++i) {
    planar_.velocity(members[i]) = memory.before[i].velocity;
    grounds_[members[i]].set_impulse(memory.before[i].ground_impulse);
  }
  return false;
}

void PlanarWorld::add_rows_of(std::uint32_t member, PlanarSolver& solver) {
  const auto is_out = [&](std::uint32_t other) { return other != Anchors::nobody && !members_[other].is_finite; };
  connections_.for_each_of(member, [&](Connection& connection) {
    if (!is_out(connection.b().member)) solver.add_connection(connection, step_);
  });
  for (PlanarPair& pair : collision_.pairs_of(member)) {
    if (is_out(pair.member_b)) continue;
    const SurfacePair surfaces = surfaces_.of(scene_.solid(pair.a).surface(), scene_.solid(pair.b).surface());
    for (PlanarPoint& point : pair.contact)
      solver.add_contact(part_of(pair.a), part_of(pair.b), point, pair.z, surfaces, step_);
  }
}

void PlanarWorld::move(std::uint32_t index) {
  Member& member = members_[index];
  if (!member.is_active || !member.is_finite) return;
  if (planar_.integrate(index, step_)) find_parts_in_body(member, index);
  if (member.record) member.record->after(LinksOf{planar_, index});
  place_solids(index);
  const PlanarPlace& place = planar_.place(index);
  member.is_inside = std::abs(place.x) < furthest_from_origin && std::abs(place.y) < furthest_from_origin &&
                     planar_.segment_in_body(index, 0).position.z() >= description_.physics.lowest;
}

void PlanarWorld::find_parts_in_body(const Member& member, std::uint32_t index) {
  double radius = 0.0;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (std::uint32_t i = member.first_part; i < member.first_part + member.part_count; ++i) {
    Part& part = parts_[i];
    const Pose X_BC = planar_.segment_in_body(index, part.segment) * part.X_SC;
    // A moving solid is never a plane or a height map, so it has a footprint.
    const geometry::Footprint outline = *geometry::footprint_of(scene_.solid(part.solid).shape(), X_BC);
    part.outline_B = outline;
    parts_in_body_[i] = {X_BC, outline.centre, outline.axis};
    collision_.set_outline(part.solid, outline);
    radius = std::max(radius, outline.centre.norm() + outline.half.norm() + outline.radius);
    lowest = std::min(lowest, outline.lowest);
    highest = std::max(highest, outline.highest);
  }
  collision_.set_extent(index, radius, lowest, highest);
}

void PlanarWorld::place_solids(std::uint32_t index) {
  const Member& member = members_[index];
  const PlanarPlace& place = planar_.place(index);
  collision_.move_member(index, {place.x, place.y});
  for (std::uint32_t i = member.first_part; i < member.first_part + member.part_count; ++i) {
    const PartInBody& part = parts_in_body_[i];
    scene_.set_pose(parts_[i].solid, place * part.X_BC);
    collision_.move(parts_[i].solid, place * part.centre_B, place.rotate(part.axis_B));
  }
}

void PlanarWorld::report_contacts() {
  contacts_.clear();
  for (std::uint32_t member = 0; member < members_.size(); ++member) {
    for (const PlanarPair& pair : collision_.pairs_of(member)) {
      for (const PlanarPoint& point : pair.contact) {
        if (point.gap > 0.0 && point.normal_impulse == 0.0) continue;  // near, but not touching
        contacts_.push_back({scene_.solid(pair.a).body, scene_.solid(pair.b).body,
                             Eigen::Vector3d(point.position_W.x(), point.position_W.y(), pair.z),
                             Eigen::Vector3d(point.normal_W.x(), point.normal_W.y(), 0.0), point.gap,
                             point.normal_impulse, pair.a, pair.b});
      }
    }
  }
}

ConnectionId PlanarWorld::connect(const BodyLink& a, const Pose& X_LP, const BodyLink& b,
                                  const ConnectionLimits& limits) {
  const auto link_of = [&](const BodyLink& end) -> const Mechanism::LinkPlace& {
    return planar_.model(bodies_[end.body.value].member).mechanism().link(end.link.value);
  };
  const Mechanism::LinkPlace& place_a = link_of(a);
  const Connection::End end_a{bodies_[a.body.value].member, place_a.segment, a.link.value, place_a.X_SL * X_LP,
                              a.body.value};
  const Pose X_WP = planar_.segment_pose(end_a.member, end_a.segment) * end_a.X_SP;
  Connection::End end_b{Anchors::nobody, 0, 0, X_WP, b.body.value};
  if (const std::uint32_t member = bodies_[b.body.value].member; member != Anchors::nobody) {
    const int segment = link_of(b).segment;
    end_b = {member, segment, b.link.value, planar_.segment_pose(member, segment).inverse() * X_WP, b.body.value};
  }
  return ConnectionId{connections_.add(end_a, end_b, limits)};
}

void PlanarWorld::quarantine() {
  quarantined_.clear();
  for (std::uint32_t index = 0; index < members_.size(); ++index) {
    const Member& member = members_[index];
    if (!member.is_active || (member.is_finite && member.is_inside)) continue;
    using Reason = Quarantine::Reason;
    quarantined_.push_back({member.body, member.is_finite ? Reason::left_world : Reason::not_finite});
    take_out(index);
  }
}

void PlanarWorld::take_out(std::uint32_t index) {
  members_[index].is_active = false;
  if (members_[index].record) members_[index].record->forget();
  connections_.release_of(index);
  for (std::uint32_t i = 0; i < members_[index].part_count; ++i)
    scene_.remove(parts_[members_[index].first_part + i].solid);
  collision_.remove(index);
}

}  // namespace cohort::physics
