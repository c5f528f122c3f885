#include "server/physics/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "server/physics/active_set_solver.hpp"
#include "server/physics/direct_solver.hpp"
#include "server/physics/iterative_solver.hpp"

namespace cohort::physics {
namespace {

constexpr std::size_t bodies_a_chunk = 16;
constexpr std::size_t islands_a_chunk = 8;

// A pass of the solver that changes no velocity by more ends it [m/s or rad/s].
constexpr double tolerance = 1e-9;

// Further from the origin a body has left the world [m].
constexpr double furthest = 1e6;

// False for velocities from which the next step would leave the numbers [m/s or rad/s].
bool is_sensible(const double* velocities, int count) {
  constexpr double senseless = 1e6;
  double sum = 0.0;
  for (int i = 0; i < count; ++i) sum += std::abs(velocities[i]);
  return sum < senseless;
}

}  // namespace

Stepper::Stepper(const description::World& description, WorkerPool& workers)
    : description_(description),
      workers_(workers),
      step_(std::chrono::duration<double>(description.step).count()),
      surfaces_(description),
      mechanisms_(description.models.size()),
      shapes_(description.models.size()),
      collision_(scene_, [this](std::uint32_t solid, std::uint32_t other) { return may_touch(solid, other); }),
      memory_(workers.threads()) {
  bodies_.reserve(description.instances.size());
  for (const description::Instance& instance : description.instances) create_body(instance.model, instance.X_WM);
  scene_.build();
  find_lowest();
  for (std::uint32_t body = 0; body < bodies_.size(); ++body)
    if (!description.instances[body].is_present) remove_body(body);
}

std::uint32_t Stepper::add_body(std::size_t model, const Pose& X_WM) {
  const std::uint32_t body = create_body(model, X_WM);
  scene_.build();
  return body;
}

std::uint32_t Stepper::create_body(std::size_t model_index, const Pose& X_WM) {
  const auto body = static_cast<std::uint32_t>(bodies_.size());
  const description::Model& model = description_.models[model_index];
  std::unique_ptr<Mechanism>& mechanism = mechanisms_[model_index];
  if (shapes_[model_index].empty())
    for (const description::Link& link : model.links)
      for (const description::Collision& collision : link.collisions)
        shapes_[model_index].push_back(std::make_shared<BulletShape>(collision.shape));
  if (model.is_static) {
    bodies_.push_back({model_index, X_WM, Anchors::nobody, nullptr, false, false, {}});
    add_static_solids(body);
  } else {
    try {
      if (!mechanism) mechanism = std::make_unique<Mechanism>(model, description_.physics.fidelity);
      bodies_.push_back(
          {model_index, X_WM, Anchors::nobody, std::make_unique<Multibody>(*mechanism, X_WM, body), false, false, {}});
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("model '" + model.name + "': " + error.what());
    }
    add_moving_solids(body);
  }
  return body;
}

void Stepper::add_solid(std::uint32_t body, const description::Collision& collision, const Pose& X_WC,
                        Anchors::Part part, std::shared_ptr<const BulletShape> shape) {
  scene_.add({collision.shape, collision.surface, body, part.member != Anchors::nobody, X_WC});
  collision_.add(std::move(shape));
  anchors_.part_of_solid.push_back(part);
}

void Stepper::add_static_solids(std::uint32_t body) {
  const std::size_t model = bodies_[body].model;
  std::size_t index = 0;
  for (const description::Link& link : description_.models[model].links)
    for (const description::Collision& collision : link.collisions) {
      bodies_[body].solids.push_back(static_cast<std::uint32_t>(scene_.size()));
      add_solid(body, collision, bodies_[body].X_WM * link.X_ML * collision.X_LC, {}, shapes_[model][index++]);
    }
}

void Stepper::add_moving_solids(std::uint32_t body) {
  const std::size_t model = bodies_[body].model;
  const Multibody& multibody = *bodies_[body].multibody;
  const auto member = static_cast<std::uint32_t>(members_.size());
  bodies_[body].member = member;
  members_.emplace_back().body = body;
  anchors_.index_of_member.push_back(-1);
  std::size_t index = 0;
  for (std::size_t link = 0; link < description_.models[model].links.size(); ++link) {
    const Mechanism::LinkPlace& place = multibody.mechanism().link(link);
    for (const description::Collision& collision : description_.models[model].links[link].collisions) {
      const std::shared_ptr<const BulletShape>& shape = shapes_[model][index++];
      if (!place.collides) continue;
      const Pose X_SC = place.X_SL * collision.X_LC;
      members_.back().parts.push_back({static_cast<std::uint32_t>(scene_.size()), place.segment, X_SC});
      add_solid(body, collision, multibody.segment_pose(place.segment) * X_SC, {member, place.segment}, shape);
    }
  }
}

// Well below everything that was there at first, unless the world says where.
void Stepper::find_lowest() {
  constexpr double below_all = 10.0;  // [m]
  lowest_ = description_.physics.lowest;
  if (std::isfinite(lowest_)) return;
  lowest_ = std::numeric_limits<double>::infinity();
  for (std::uint32_t solid = 0; solid < scene_.size(); ++solid) {
    const double low = scene_.bounds(solid).lower.z();
    lowest_ = std::min(lowest_, std::isfinite(low) ? low : scene_.solid(solid).X_WC.position.z());
  }
  for (const Member& member : members_) lowest_ = std::min(lowest_, of(member).segment_pose(0).position.z());
  lowest_ -= below_all;
}

bool Stepper::is_active(std::uint32_t body) const {
  return bodies_[body].member == Anchors::nobody ? !bodies_[body].is_out : members_[bodies_[body].member].is_active;
}

void Stepper::take_out(Member& member) {
  member.is_active = false;
  release_connections_of(bodies_[member.body].member);
  for (const Part& part : member.parts) {
    scene_.remove(part.solid);
    collision_.remove(part.solid);
  }
}

Pose Stepper::link_pose(std::uint32_t body, std::size_t link) const {
  if (const Multibody* multibody = bodies_[body].multibody.get()) return multibody->link_pose(link);
  return bodies_[body].X_WM * description_.models[bodies_[body].model].links[link].X_ML;
}

Twist Stepper::link_twist(std::uint32_t body, std::size_t link) const {
  if (const Multibody* multibody = bodies_[body].multibody.get(); multibody != nullptr && is_active(body))
    return multibody->link_twist(link);
  return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
}

void Stepper::set_joint_state(std::uint32_t body, std::size_t joint, std::span<const double> coordinates,
                              std::span<const double> velocities) {
  bodies_[body].multibody->set_joint_state(joint, coordinates, velocities);
  place_solids_of(members_[bodies_[body].member]);
  scene_.update();
}

// Solids of one body: only if the model says so, and not beside a joint, where they overlap by design.
bool Stepper::may_touch(std::uint32_t solid, std::uint32_t other) const {
  const Multibody* multibody = bodies_[scene_.solid(solid).body].multibody.get();
  if (multibody == nullptr || !multibody->mechanism().model().self_collide) return false;
  const auto above = [&](int segment) {
    // Over the massless middle of a universal joint.
    const auto& segments = multibody->mechanism().segments();
    int parent = segments[static_cast<std::size_t>(segment)].parent;
    while (parent >= 0 && segments[static_cast<std::size_t>(parent)].mass == 0.0)
      parent = segments[static_cast<std::size_t>(parent)].parent;
    return parent;
  };
  const int one = anchors_.part_of_solid[solid].segment;
  const int two = anchors_.part_of_solid[other].segment;
  return one != two && above(one) != two && above(two) != one;
}

void Stepper::step() {
  detect();
  find_islands();
  workers_.for_each_chunk(islands_.count(), islands_a_chunk, [&](std::size_t begin, std::size_t end, unsigned worker) {
    for (std::size_t i = begin; i < end; ++i)
      solve_island(islands_.members(static_cast<std::uint32_t>(i)), memory_[worker]);
  });
  report_contacts();
  break_connections();
  quarantine();
  pushes_.clear();
  scene_.update();
}

void Stepper::quarantine() {
  quarantined_.clear();
  for (Member& member : members_) {
    if (!member.is_active || (member.is_finite && member.is_inside)) continue;
    using Reason = Quarantine::Reason;
    quarantined_.push_back({member.body, member.is_finite ? Reason::left_world : Reason::not_finite});
    take_out(member);
  }
}

void Stepper::detect() {
  workers_.for_each_chunk(members_.size(), bodies_a_chunk, [&](std::size_t begin, std::size_t end, unsigned worker) {
    for (std::size_t i = begin; i < end; ++i)
      if (members_[i].is_active) look_around(members_[i], memory_[worker]);
  });
}

// What a body touches and stands on: one look around the scene for all of it.
void Stepper::look_around(const Member& member, Memory& memory) {
  Multibody& multibody = of(member);
  if (member.parts.empty() && multibody.treels().empty()) return;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  geometry::Bounds around{Eigen::Vector3d::Constant(infinity), Eigen::Vector3d::Constant(-infinity)};
  for (const Part& part : member.parts) around.include(scene_.bounds(part.solid).grown_by(Collision::margin));
  const Pose& X_WS = multibody.segment_pose(0);
  for (const TreelDrive& treel : multibody.treels()) around.include(treel.ground_region(X_WS));
  std::vector<std::uint32_t>& near = memory.near;
  near.clear();
  scene_.for_each_overlap(around, [&](std::uint32_t solid) { near.push_back(solid); });
  std::sort(near.begin(), near.end());

  for (const Part& part : member.parts) collision_.detect(part.solid, near);
  for (TreelDrive& treel : multibody.treels()) {
    const geometry::Bounds region = treel.ground_region(X_WS);
    memory.candidates.clear();
    for (const std::uint32_t solid : near)
      if (scene_.solid(solid).body != member.body && scene_.reaches_into(solid, region))
        memory.candidates.push_back(solid);
    treel.find_ground(scene_, X_WS, memory.candidates);
  }
}

void Stepper::find_islands() {
  const auto count = static_cast<std::uint32_t>(members_.size());
  islands_.reset(count);
  for (std::uint32_t member = 0; member < count; ++member) {
    if (!members_[member].is_active) continue;
    for (const Part& part : members_[member].parts)
      for (const SolidPair& pair : collision_.pairs_of(part.solid))
        if (pair.contact.count > 0 && anchors_.moves(pair.b)) islands_.link(member, anchors_.member(pair.b));
    for (const std::uint32_t index : members_[member].connections) {
      const Connection& connection = connections_[index];
      if (connection.holds() && connection.b().member != Anchors::nobody) islands_.link(member, connection.b().member);
    }
    for (const TreelDrive& treel : of(members_[member]).treels())
      treel.for_each_ground([&](std::uint32_t solid) {
        if (anchors_.moves(solid)) islands_.link(member, anchors_.member(solid));
      });
  }
  islands_.finish();
}

// Whose state breaks is left out, and the rest of the island is solved without it.
void Stepper::solve_island(std::span<const std::uint32_t> members, Memory& memory) {
  std::vector<std::uint32_t>& sound = memory.members;
  sound.assign(members.begin(), members.end());
  std::erase_if(sound, [&](std::uint32_t member) { return !members_[member].is_active; });
  while (!sound.empty() && !try_island(sound, memory.problem)) {
    for (const std::uint32_t member : sound)
      if (!members_[member].is_finite) anchors_.index_of_member[member] = -1;
    std::erase_if(sound, [&](std::uint32_t member) { return !members_[member].is_finite; });
  }
}

// False, and no body moved, if one of them has no sensible velocities: then its member says so.
bool Stepper::try_island(const std::vector<std::uint32_t>& members, Problem& problem) {
  const auto all_are_finite = [&] {
    bool all = true;
    for (const std::uint32_t member : members) {
      const Equations& equations = problem.equations(anchors_.index_of_member[member]);
      members_[member].is_finite = is_sensible(equations.velocity(), equations.size());
      all = all && members_[member].is_finite;
    }
    return all;
  };
  problem.clear();
  for (const std::uint32_t member : members)
    anchors_.index_of_member[member] = problem.add_body(of(members_[member]), description_.gravity, step_);
  if (!pushes_.empty())
    for (const std::uint32_t member : members) add_pushes_of(member, problem);
  if (!all_are_finite()) return false;

  for (const std::uint32_t member : members)
    of(members_[member]).add_rows(problem, anchors_.index_of_member[member], anchors_, step_);
  for (const std::uint32_t member : members) add_connection_rows_of(members_[member], problem);
  for (const std::uint32_t member : members) add_contact_rows_of(members_[member], problem);
  solve(problem);
  if (!all_are_finite()) return false;

  for (const Row& row : problem.rows())
    if (row.kept != nullptr) *row.kept = row.impulse;
  for (const std::uint32_t member : members) {
    Multibody& multibody = of(members_[member]);
    for (TreelDrive& treel : multibody.treels()) treel.read_rows(problem, step_);
    multibody.integrate(problem.equations(anchors_.index_of_member[member]).velocity(), step_);
    const Eigen::Vector3d& position_W = multibody.segment_pose(0).position;
    members_[member].is_inside = position_W.z() >= lowest_ && position_W.cwiseAbs().maxCoeff() < furthest;
    place_solids_of(members_[member]);
  }
  return true;
}

void Stepper::place_solids_of(const Member& member) {
  const Multibody& multibody = of(member);
  for (const Part& part : member.parts) scene_.set_pose(part.solid, multibody.segment_pose(part.segment) * part.X_SC);
}

void Stepper::solve(Problem& problem) const {
  const description::PhysicsSettings& settings = description_.physics;
  const bool directly = settings.solver == description::Solver::direct ||
                        (settings.solver == description::Solver::hybrid &&
                         problem.body_count() <= static_cast<int>(settings.direct_bodies));
  if (directly ? solve_directly(problem) : solve_by_active_set(problem)) return;
  solve_iteratively(problem, settings.iterations, tolerance);
}

void Stepper::add_contact_rows_of(const Member& member, Problem& problem) {
  for (const Part& part : member.parts) {
    for (SolidPair& pair : collision_.pairs_of(part.solid)) {
      if (pair.contact.count == 0 || (anchors_.moves(pair.b) && anchors_.of(pair.b).body < 0)) continue;
      const SurfacePair surfaces = surfaces_.of(scene_.solid(pair.a).surface, scene_.solid(pair.b).surface);
      add_contact_rows(problem, anchors_.of(pair.a), anchors_.of(pair.b), pair.contact, surfaces, step_);
    }
  }
}

void Stepper::add_connection_rows_of(const Member& member, Problem& problem) {
  for (const std::uint32_t index : member.connections) {
    Connection& connection = connections_[index];
    const bool to_world = connection.b().member == Anchors::nobody;
    if (!connection.holds() || (!to_world && anchors_.index_of_member[connection.b().member] < 0)) continue;
    const Pose X_WSb = to_world ? Pose{} : of(members_[connection.b().member]).segment_pose(connection.b().segment);
    connection.add_rows(problem, anchors_, of(member).segment_pose(connection.a().segment), X_WSb, step_);
  }
}

std::uint32_t Stepper::connect(std::uint32_t body_a, std::size_t link_a, const Pose& X_LP, std::uint32_t body_b,
                               std::size_t link_b, const ConnectionLimits& limits) {
  const Multibody& a = *bodies_[body_a].multibody;
  const Mechanism::LinkPlace& place_a = a.mechanism().link(link_a);
  const Connection::End end_a{bodies_[body_a].member, place_a.segment, place_a.X_SL * X_LP};
  const Pose X_WP = a.segment_pose(place_a.segment) * end_a.X_SP;
  Connection::End end_b{Anchors::nobody, 0, X_WP};
  if (const Multibody* b = bodies_[body_b].multibody.get()) {
    const int segment = b->mechanism().link(link_b).segment;
    end_b = {bodies_[body_b].member, segment, b->segment_pose(segment).inverse() * X_WP};
  }
  const auto index = static_cast<std::uint32_t>(connections_.size());
  connections_.emplace_back(end_a, end_b, limits);
  members_[end_a.member].connections.push_back(index);
  return index;
}

void Stepper::break_connections() {
  broken_.clear();
  for (std::uint32_t index = 0; index < connections_.size(); ++index) {
    if (!connections_[index].holds() || !connections_[index].is_overloaded(step_)) continue;
    connections_[index].release();
    broken_.push_back(index);
  }
}

void Stepper::report_contacts() {
  contacts_.clear();
  for (const Member& member : members_) {
    for (const Part& part : member.parts) {
      for (const SolidPair& pair : collision_.pairs_of(part.solid)) {
        for (const ContactPoint& point : pair.contact) {
          if (point.gap > 0.0 && point.impulse[0] == 0.0) continue;  // near, but it did not touch
          contacts_.push_back({scene_.solid(pair.a).body, scene_.solid(pair.b).body, point.position_W, point.normal_W,
                               point.gap, point.impulse[0]});
        }
      }
    }
  }
}

}  // namespace cohort::physics
