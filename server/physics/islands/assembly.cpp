// SPDX-License-Identifier: Apache-2.0
#include "server/physics/islands/assembly.hpp"

#include <algorithm>
#include <cmath>

#include "server/core/infinity.hpp"
#include "server/core/is_unit.hpp"
#include "server/core/state_visitors.hpp"
#include "server/physics/world/corrections.hpp"

namespace cohort::physics {
namespace {

// Returns false for velocities so large that the next step would overflow [m/s or rad/s].
bool is_sensible(const double* velocities, int count) {
  constexpr double senseless = 1e6;
  double sum = 0.0;
  for (int i = 0; i < count; ++i) sum += std::abs(velocities[i]);
  return sum < senseless;
}

// Returns the reach of the body with its joints fully extended; a prismatic joint without a limit counts as one metre.
double reach_of(const Member& member) {
  double reach = 0.0;
  const Mechanism& mechanism = member.multibody->mechanism();
  for (const Segment& segment : mechanism.segments()) {
    reach += segment.X_PS.position.norm() + segment.centre_S.norm();
    if (segment.motion != Motion::prismatic) continue;
    const description::JointAxis& axis = mechanism.dofs()[static_cast<std::size_t>(segment.first_dof)].axis;
    const double way = std::max(std::abs(axis.lower), std::abs(axis.upper));
    reach += std::isfinite(way) ? way : 1.0;
  }
  double furthest_part = 0.0;
  for (const Part& part : member.parts) furthest_part = std::max(furthest_part, part.X_SC.position.norm());
  return reach + furthest_part;
}

}  // namespace

bool Member::is_valid() const {
  const BodyMotion& motion = multibody->motion();
  const double* const velocities = motion.velocities();
  return std::all_of(velocities, velocities + motion.mechanism().dof_count(),
                     [](double v) { return std::isfinite(v); }) &&
         std::ranges::all_of(motion.segment_poses(), [](const Pose& X_WS) {
           return X_WS.position.allFinite() && X_WS.orientation.coeffs().allFinite() && is_unit(X_WS.orientation);
         });
}

Assembly::Assembly(const description::World& world)
    : step(std::chrono::duration<double>(world.step).count()),
      gravity(world.gravity),
      settings(world.physics),
      surfaces(world),
      collision(scene, [this](std::uint32_t solid, std::uint32_t other) { return may_touch(solid, other); }),
      media(world) {}

void Assembly::reserve(std::size_t solids) {
  scene.reserve(solids);
  collision.reserve(solids);
  anchors.part_of_solid.reserve(solids);
}

void Assembly::add_solid(BodyId body, const ModelParts& parts, std::size_t index, const Pose& X_WC,
                         Anchors::Part part) {
  const bool moves = part.member != Anchors::nobody;
  scene.add(parts.kinds[index], body, moves, X_WC);
  collision.add(parts.shapes[index], moves);
  anchors.part_of_solid.push_back(part);
}

void Assembly::add_static(BodyId body, const description::Model& model, const Pose& X_WM, const ModelParts& parts) {
  std::size_t index = 0;
  for (const description::Link& link : model.links)
    for (const description::Collision& part : link.collisions)
      add_solid(body, parts, index++, X_WM * link.X_ML * part.X_LC, {});
}

std::uint32_t Assembly::add_member(std::unique_ptr<Multibody> multibody, const ModelParts& parts) {
  const auto index = static_cast<std::uint32_t>(members.size());
  const Multibody& body = *multibody;
  std::shared_ptr<const FluidModel>& fluid = fluid_models[&body.mechanism()];
  if (!fluid) fluid = std::make_shared<const FluidModel>(body.mechanism(), media);
  Member& member = members.emplace_back();
  member.body = body.body();
  member.multibody = std::move(multibody);
  has_belts = has_belts || member.multibody->has_belts();
  if (!fluid->is_empty()) member.fluid = std::make_unique<FluidBody>(fluid);
  anchors.index_of_member.push_back(-1);
  ++revision;
  const description::Model& model = body.mechanism().model();
  const std::vector<description::Link>& links = model.links;
  if (body.mechanism().has_kinematic_root()) {
    const Segment& root = body.mechanism().segments()[0];
    member.weightless.push_back({0, 0, root.mass, root.centre_S});
  }
  std::size_t next = 0;
  for (std::size_t link = 0; link < links.size(); ++link) {
    const Mechanism::LinkPlace& place = body.mechanism().link(link);
    const description::Inertial& inertial = links[link].inertial;
    if (!links[link].feels_gravity)
      member.weightless.push_back({link, place.segment, inertial.mass, place.X_SL * inertial.X_LI.position});
    for (const description::Collision& described : links[link].collisions) {
      const std::size_t collision_of_model = next++;
      if (!place.collides) continue;
      const Pose X_SC = place.X_SL * described.X_LC;
      const auto solid = static_cast<std::uint32_t>(scene.size());
      member.parts.push_back({solid, place.segment, X_SC});
      add_solid(body.body(), parts, collision_of_model, body.motion().segment_pose(place.segment) * X_SC,
                {index, place.segment});
      member.furthest_unseen = std::min(member.furthest_unseen, collision.furthest_unseen(solid));
    }
  }
  member.reach = reach_of(member);
  return index;
}

void Assembly::renew_static(BodyId body, const description::Model& model, const Pose& X_WM, std::uint32_t first_solid) {
  std::uint32_t next = first_solid;
  for (const description::Link& link : model.links)
    for (const description::Collision& part : link.collisions) scene.renew(next++, body, X_WM * link.X_ML * part.X_LC);
}

void Assembly::renew_member(std::uint32_t index, std::unique_ptr<Multibody> multibody) {
  Member& member = members[index];
  member.body = multibody->body();
  member.multibody = std::move(multibody);
  if (member.fluid) member.fluid = std::make_unique<FluidBody>(fluid_models.at(&member.multibody->mechanism()));
  member.record.reset();
  member.is_fast = false;
  member.is_active = member.is_finite = member.is_inside = true;
  member.still_steps = 0;
  ++revision;
  for (const Part& part : member.parts)
    scene.renew(part.solid, member.body, member.multibody->motion().segment_pose(part.segment) * part.X_SC);
}

void Assembly::take_out(std::uint32_t member) {
  ++revision;
  members[member].is_active = false;
  if (members[member].record) members[member].record->forget();
  connections.release_of(member);
  for (const Part& part : members[member].parts) {
    scene.remove(part.solid);
    collision.remove(part.solid);
  }
}

void Assembly::put_back(std::uint32_t index) {
  Member& member = members[index];
  if (!member.is_finite || !member.is_inside) {
    member.multibody->motion().stop();
    if (member.fluid) member.fluid->stop();
  }
  member.is_active = member.is_finite = member.is_inside = true;
  member.still_steps = 0;
  ++revision;
  place_solids_of(member);
  for (const Part& part : member.parts) scene.put_back(part.solid);
}

void Assembly::place(std::uint32_t index, const Pose& X_WM) {
  const Member& member = members[index];
  connections.release_of(index);
  member.multibody->motion().place(X_WM);
  if (member.fluid) member.fluid->stop();
  if (member.record) member.record->forget();
  for (const Part& part : member.parts) collision.remove(part.solid);
  place_solids_of(member);
  scene.update();
}

void Assembly::place_solids_of(const Member& member) {
  for (const Part& part : member.parts)
    scene.set_pose(part.solid, member.multibody->motion().segment_pose(part.segment) * part.X_SC);
}

void Assembly::set_asleep(std::uint32_t index, bool asleep) {
  members[index].is_asleep = asleep;
  ++revision;
  for (const Part& part : members[index].parts) collision.set_asleep(part.solid, asleep);
}

// Solids of one body collide only if the model says so, and never across a joint, where they overlap by design.
bool Assembly::may_touch(std::uint32_t solid, std::uint32_t other) const {
  if (!anchors.moves(solid)) return false;
  const Mechanism& mechanism = members[anchors.member(solid)].multibody->mechanism();
  if (!mechanism.model().self_collide) return false;
  const auto above = [&](int segment) {
    // Skip the massless middle of a universal joint.
    const auto& segments = mechanism.segments();
    int parent = segments[static_cast<std::size_t>(segment)].parent;
    while (parent >= 0 && segments[static_cast<std::size_t>(parent)].mass == 0.0)
      parent = segments[static_cast<std::size_t>(parent)].parent;
    return parent;
  };
  const int one = anchors.part_of_solid[solid].segment;
  const int two = anchors.part_of_solid[other].segment;
  const LoopRows& loops = members[anchors.member(solid)].multibody->loops();
  return one != two && above(one) != two && above(two) != one && !loops.connect(one, two);
}

double Assembly::look_ahead(Member& member) {
  const BodyMotion& motion = member.multibody->motion();
  const bool may_be_fast = step * motion.greatest_speed(member.reach) > member.furthest_unseen;
  if (!may_be_fast && !member.is_fast) return 0.0;
  member.is_fast = false;
  double furthest = 0.0;
  for (const Part& part : member.parts) {
    const Eigen::Vector3d centre_W = motion.segment_pose(part.segment) * part.X_SC.position;
    Eigen::Vector3d way_W = step * motion.segment_twist(part.segment, centre_W).linear_W;
    const double length = way_W.norm();
    if (length > collision.furthest_unseen(part.solid)) {
      way_W *= std::min(1.0, collision.furthest_followed(part.solid) / length);
      furthest = std::max(furthest, way_W.norm());
      member.is_fast = true;
    } else {
      way_W.setZero();
    }
    collision.set_way(part.solid, way_W);
  }
  return furthest;
}

// One query of the scene serves all solids of a body.
void Assembly::look_around(const Member& member, double furthest, std::vector<std::uint32_t>& near,
                           std::vector<std::uint32_t>& candidates) {
  Multibody& multibody = *member.multibody;
  if (member.parts.empty() && multibody.treels().empty()) return;
  geometry::Bounds around{Eigen::Vector3d::Constant(infinity), Eigen::Vector3d::Constant(-infinity)};
  for (const Part& part : member.parts) around.include(collision.region_of(part.solid));
  if (member.is_fast) around = around.grown_by(furthest);  // others may move towards it
  const Pose& X_WS = multibody.motion().segment_pose(0);
  for (const TrackRows& treel : multibody.treels()) around.include(treel.ground_region(X_WS));
  near.clear();
  scene.for_each_overlap(around, [&](std::uint32_t solid) { near.push_back(solid); });
  std::sort(near.begin(), near.end());

  for (const Part& part : member.parts) collision.detect(part.solid, near);
  for (TrackRows& treel : multibody.treels()) {
    const geometry::Bounds region = treel.ground_region(X_WS);
    candidates.clear();
    for (const std::uint32_t solid : near)
      if (scene.solid(solid).body != member.body && scene.reaches_into(solid, region)) candidates.push_back(solid);
    treel.find_ground(scene, surfaces, X_WS, candidates);
    treel.find_belts([&](const Ground& ground) { return surface_of(ground.solid).velocity_at(ground.normal_W); });
  }
}

void Assembly::set_up(std::uint32_t member, IslandBodies& bodies) {
  Equations& equations = bodies[anchors.index_of_member[member]];
  equations.set_up(members[member].multibody->motion(), gravity, step, bodies.count() > 1 || is_held(member));
  members[member].multibody->apply_efforts(equations, step);
  pushes.for_each_of(member, [&](const Pushes::Push& push) {
    equations.push(push.segment, push.point_W, step * push.wrench.force_W, step * push.wrench.torque_W);
  });
  for (const WeightlessLink& link : members[member].weightless) {
    const Eigen::Vector3d centre_W = members[member].multibody->motion().segment_pose(link.segment) * link.centre_S;
    equations.push(link.segment, centre_W, -step * link.mass * gravity, Eigen::Vector3d::Zero());
  }
  if (FluidBody* const fluid = members[member].fluid.get()) fluid->apply(equations, media, step);
}

void Assembly::add_own_rows(std::uint32_t member, Problem& problem) {
  members[member].multibody->add_rows(problem, anchors.index_of_member[member], anchors, step);
}

void Assembly::add_connection_rows(Connection& connection, Problem& problem) {
  if (connection.b().member != Anchors::nobody && anchors.index_of_member[connection.b().member] < 0) return;
  const Connection::Ends X_WS{pose_of(connection.a()), pose_of(connection.b())};
  const Connection::Ends ahead{pose_ahead_of(connection.a()), pose_ahead_of(connection.b())};
  connection.add_rows(problem, anchors, X_WS, ahead, step);
}

void Assembly::add_contact_rows(SolidPair& pair, Problem& problem, FrictionStart start) const {
  if (anchors.moves(pair.b) && anchors.of(pair.b).body < 0) return;
  if (is_immovable(pair.a) && (!anchors.moves(pair.b) || is_immovable(pair.b))) return;
  const geometry::Solid& a = scene.solid(pair.a);
  const geometry::Solid& b = scene.solid(pair.b);
  const SurfacePair both = surfaces.of(a.surface(), b.surface());
  const RunningSurfaces running{surface_of(pair.a), surface_of(pair.b)};
  switch (both.directed) {
    case SurfacePair::Directed::neither:
      pair.contact.friction_direction_W = running.a.is_belt() ? running.a.axis_W : running.b.axis_W;
      break;
    case SurfacePair::Directed::by_first: pair.contact.friction_direction_W = friction_direction_of(pair.a); break;
    case SurfacePair::Directed::by_second: pair.contact.friction_direction_W = friction_direction_of(pair.b); break;
  }
  physics::add_contact_rows(problem, anchors.of(pair.a), anchors.of(pair.b), pair.contact, both, running, step, start);
}

Eigen::Vector3d Assembly::friction_direction_of(std::uint32_t solid) const {
  const description::Surface& surface = scene.solid(solid).surface();
  if (!surface.friction_link || !anchors.moves(solid))
    return scene.solid(solid).X_WC.orientation * surface.friction_direction;
  const Multibody& multibody = *members[anchors.member(solid)].multibody;
  const Mechanism::LinkPlace& place = multibody.mechanism().link(*surface.friction_link);
  return (multibody.motion().segment_pose(place.segment) * place.X_SL).orientation * surface.friction_direction;
}

bool Assembly::is_immovable(std::uint32_t solid) const {
  const Anchor anchor = anchors.of(solid);
  return anchor.segment == 0 && members[anchors.member(solid)].multibody->mechanism().has_kinematic_root();
}

RunningSurface Assembly::surface_of(std::uint32_t solid) const {
  if (!anchors.moves(solid)) return {};
  return members[anchors.member(solid)].multibody->surface_of(scene.solid(solid).link());
}

bool Assembly::check(std::uint32_t member, const IslandBodies& bodies) {
  const Equations& equations = bodies[anchors.index_of_member[member]];
  return members[member].is_finite = is_sensible(equations.velocity(), equations.size());
}

void Assembly::expect_sound(const Member& member) const {
  const Mechanism& mechanism = member.multibody->mechanism();
  if (!member.is_finite || !member.is_inside ||
      !is_sensible(member.multibody->motion().velocities(), mechanism.dof_count()))
    throw SnapshotError("snapshot: invalid velocities of a body");
  for (const Pose& X_WS : member.multibody->motion().segment_poses()) expect_placed(X_WS);
}

bool Assembly::is_in_flight(std::uint32_t index) {
  const Mechanism& mechanism = members[index].multibody->mechanism();
  if (!mechanism.has_free_root() || mechanism.is_free_body() || mechanism.has_kinematic_root()) return false;
  if (!mechanism.added_masses().empty()) return false;  // the fluid takes momentum
  return !is_held(index);
}

bool Assembly::is_held(std::uint32_t index) {
  const Multibody& multibody = *members[index].multibody;
  bool is_held = multibody.loops().reach_the_world();
  for (const TrackRows& treel : multibody.treels()) treel.for_each_ground([&](std::uint32_t) { is_held = true; });
  connections.for_each_of(index, [&](const Connection&) { is_held = true; });
  for_each_pair(index, [&](const SolidPair&) { is_held = true; });
  return is_held;
}

// A body that was just hit may be much faster than predicted at the beginning of the step, when its contacts were
// found. It stops at the first obstacle and touches that in the next step.
void Assembly::keep_from_passing_through(Member& member) const {
  BodyMotion& motion = member.multibody->motion();
  if (!motion.mechanism().has_free_root() || motion.mechanism().has_kinematic_root()) return;
  if (!(step * motion.greatest_speed(member.reach) > member.furthest_unseen)) return;
  Eigen::Vector3d back_W = Eigen::Vector3d::Zero();
  for (const Part& part : member.parts) {
    const Eigen::Vector3d way_W =
        motion.segment_pose(part.segment) * part.X_SC.position - scene.solid(part.solid).X_WC.position;
    const Eigen::Vector3d rest_W = (1.0 - collision.free_share(part.solid, way_W)) * way_W;
    if (rest_W.squaredNorm() > back_W.squaredNorm()) back_W = rest_W;
  }
  if (!back_W.isZero(0.0)) motion.move(-back_W);
}

void Assembly::integrate(std::uint32_t index, const Problem& problem) {
  Member& member = members[index];
  Multibody& multibody = *member.multibody;
  for (TrackRows& treel : multibody.treels()) treel.read_rows(problem, step);
  if (member.record) member.record->begin(multibody.motion());
  const Equations& equations = problem.equations(anchors.index_of_member[index]);
  if (problem.body_count() == 1 && is_in_flight(index))
    multibody.fly(equations.velocity(), equations.pushed().linear, equations.pushed().angular, gravity, step);
  else
    multibody.integrate(equations.velocity(), step);
  keep_from_passing_through(member);
  if (member.record)
    member.record->finish(multibody.motion(), equations.velocity(), !equations.is_symmetric(), gravity, step);
  if (member.fluid) member.fluid->finish_step();
  const Eigen::Vector3d& position_W = multibody.motion().segment_pose(0).position;
  member.is_inside = position_W.z() >= settings.lowest && position_W.cwiseAbs().maxCoeff() < furthest_from_origin;
  place_solids_of(member);
}

}  // namespace cohort::physics
