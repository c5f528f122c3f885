// SPDX-License-Identifier: Apache-2.0
#include "server/physics/islands/multibody_world.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "server/core/tick_stage.hpp"
#include "server/physics/islands/island_solver.hpp"

namespace cohort::physics {
namespace {

// Each thread has one solver for all worlds, so that many small worlds share memory that stays in the cache.
IslandSolver& solver_of_this_thread() {
  static thread_local IslandSolver solver;
  return solver;
}

template <class Output>
Multibody& driver_of(const Member& member, const Output& /*driven*/) {
  return *member.multibody;
}
FluidBody& driver_of(const Member& member, const DeviceOutputs::Propeller& /*driven*/) { return *member.fluid; }

}  // namespace

MultibodyWorld::MultibodyWorld(const description::World& description, WorkerPool& workers, const MultibodyWorld* like,
                               std::span<const Pose> X_WM)
    : description_(description),
      workers_(workers),
      mechanisms_(description.models.size()),
      parts_(description.models.size()),
      assembly_(description),
      large_island_solver_(workers),
      sleep_(assembly_),
      memory_(workers.threads()) {
  if (like != nullptr) {
    mechanisms_ = like->mechanisms_;
    parts_ = like->parts_;
    kinds_ = like->kinds_;
    assembly_.reserve(like->assembly_.scene.size());
    assembly_.fluid_models = like->assembly_.fluid_models;
  }
  bodies_.reserve(description.instances.size());
  for (const description::Instance& instance : description.instances)
    create_body(instance.model, X_WM.empty() ? instance.X_WM : X_WM[bodies_.size()]);
  assembly_.scene.build();
  for (std::size_t body = 0; body < bodies_.size(); ++body)
    if (!description.instances[body].is_present) remove_body(BodyId{body});
}

BodyId MultibodyWorld::add_body(std::size_t model, const Pose& X_WM, std::optional<std::uint32_t> saved_slot) {
  const BodyId body = create_body(model, X_WM, saved_slot);
  assembly_.scene.build();
  is_lowest_known_ = false;
  if (!saved_slot && is_static(body)) sleep_.wake_all();
  return body;
}

BodyId MultibodyWorld::create_body(std::size_t model_index, const Pose& X_WM, std::optional<std::uint32_t> saved_slot) {
  const BodyId body{bodies_.size()};
  const description::Model& model = description_.models[model_index];
  if (model_index >= parts_.size()) {  // the model was added later
    mechanisms_.resize(model_index + 1);
    parts_.resize(model_index + 1);
  }
  std::unique_ptr<Multibody> multibody = model.is_static ? nullptr : make_multibody(model_index, X_WM, body);
  PlacedBody placed;
  placed.model = static_cast<std::uint32_t>(model_index);
  placed.X_WM = X_WM;
  const bool is_slot_used = slots_.take(placed, saved_slot);
  if (multibody && is_slot_used) {
    assembly_.renew_member(placed.member, std::move(multibody));
  } else if (multibody) {
    placed.member = assembly_.add_member(std::move(multibody), parts_of(model_index));
  } else if (is_slot_used) {
    assembly_.renew_static(body, model, X_WM, placed.first_solid);
  } else {
    placed.first_solid = static_cast<std::uint32_t>(assembly_.scene.size());
    assembly_.add_static(body, model, X_WM, parts_of(model_index));
    placed.end_of_solids = static_cast<std::uint32_t>(assembly_.scene.size());
  }
  bodies_.push_back(placed);
  return body;
}

const ModelParts& MultibodyWorld::parts_of(std::size_t model) {
  std::shared_ptr<const ModelParts>& known = parts_[model];
  if (known) return *known;
  ModelParts parts{kinds_.of_model(model, description_.models[model]), {}};
  for (const geometry::SolidKindPtr& kind : parts.kinds)
    parts.shapes.push_back(std::make_shared<BulletShape>(kind->shape));
  known = std::make_shared<const ModelParts>(std::move(parts));
  return *known;
}

std::unique_ptr<Multibody> MultibodyWorld::make_multibody(std::size_t model_index, const Pose& X_WM, BodyId body) {
  const description::Model& model = description_.models[model_index];
  std::shared_ptr<const Mechanism>& known = mechanisms_[model_index];
  try {
    std::shared_ptr<const Mechanism> made =
        known ? nullptr : std::make_shared<const Mechanism>(model, description_.physics.fidelity);
    auto multibody = std::make_unique<Multibody>(made ? *made : *known, description_.physics.dynamics, X_WM, body);
    if (made) known = std::move(made);
    return multibody;
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("model '" + model.name + "': " + error.what());
  }
}

Activity MultibodyWorld::activity(BodyId body) const {
  if (is_static(body)) return bodies_[body.value].is_out ? Activity::out : Activity::awake;
  const Member& member = assembly_.members[bodies_[body.value].member];
  if (!member.is_active) return Activity::out;
  return member.is_asleep ? Activity::asleep : Activity::awake;
}

Pose MultibodyWorld::link_pose(BodyId body, LinkId link) const {
  if (!is_static(body)) return multibody(body).motion().link_pose(link.value);
  return bodies_[body.value].X_WM * description_.models[bodies_[body.value].model].links[link.value].X_ML;
}

Twist MultibodyWorld::link_twist(BodyId body, LinkId link) const {
  if (!is_static(body) && is_active(body)) return multibody(body).motion().link_twist(link.value);
  return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
}

JointState MultibodyWorld::joint_state(BodyId body, JointId joint) const {
  if (is_static(body)) return {};
  const Multibody& its = multibody(body);
  return {its.motion().joint_position(joint.value), its.motion().joint_velocity(joint.value),
          its.joint_effort(joint.value)};
}

OutputState MultibodyWorld::device_state(BodyId body, DeviceId device, std::size_t output) const {
  if (is_static(body)) return {};
  const Member& member = assembly_.members[bodies_[body.value].member];
  return std::visit([&](const auto& driven) { return driver_of(member, driven).state(driven); },
                    member.multibody->mechanism().outputs().at(device, output));
}

void MultibodyWorld::set_device_target(BodyId body, DeviceId device, std::size_t output, double velocity) {
  const Member& member = assembly_.members[bodies_[body.value].member];
  const bool is_new =
      std::visit([&](const auto& driven) { return driver_of(member, driven).set_target(driven, velocity); },
                 member.multibody->mechanism().outputs().at(device, output));
  if (is_new) wake(body);
}

Wrench MultibodyWorld::joint_wrench(BodyId body, JointId joint) const {
  if (const ForceRecord* record = record_of(body)) return record->joint_wrench(joint.value);
  return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
}

Wrench MultibodyWorld::joint_wrench_on_parent(BodyId body, JointId joint) const {
  if (const ForceRecord* record = record_of(body)) return record->joint_wrench_on_parent(joint.value);
  return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
}

Eigen::Vector3d MultibodyWorld::link_acceleration(BodyId body, LinkId link, const Eigen::Vector3d& p_LP) const {
  if (const ForceRecord* record = record_of(body))
    return record->motion().acceleration(link.value, p_LP, assembly_.step);
  return Eigen::Vector3d::Zero();
}

Wrench MultibodyWorld::wrench(ConnectionId connection, ConnectionEnd end) const {
  const Connection* const found = assembly_.connections.find(connection.value);
  if (found == nullptr) return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  const Pose X_WSa = assembly_.pose_of(found->a());
  const Pose X_WSb = assembly_.pose_of(found->b());
  return end == ConnectionEnd::a ? found->wrench_on_a(X_WSa, X_WSb, assembly_.step)
                                 : found->wrench_on_b(X_WSa, X_WSb, assembly_.step);
}

void MultibodyWorld::set_joint_state(BodyId body, JointId joint, std::span<const double> coordinates,
                                     std::span<const double> velocities) {
  wake(body);
  multibody(body).motion().set_joint_state(joint.value, coordinates, velocities);
  assembly_.place_solids_of(assembly_.members[bodies_[body.value].member]);
  assembly_.scene.update();
}

void MultibodyWorld::step() {
  if (!is_lowest_known_) find_lowest();
  find_awake();
  quarantined_.clear();
  convergence_.of_last_step.clear();
  const bool all_is_as_it_was = awake_.empty() && reported_at_ == assembly_.revision;
  if (!all_is_as_it_was) {
    StageMarks stages;
    stages.enter("collision detection");
    detect();
    find_islands();
    stages.enter("contact and joint forces");
    solve_islands();
    report_contacts();
    assembly_.connections.settle([&](const Connection::End& end) { return assembly_.pose_of(end); }, assembly_.step);
    assembly_.record_outside();
    assembly_.load_belts();
  }
  assembly_.connections.break_overloaded(assembly_.step);
  assembly_.pushes.clear();
  if (all_is_as_it_was) return;
  quarantine();
  assert(std::ranges::all_of(awake_, [&](std::uint32_t index) {
    return !assembly_.members[index].is_active || assembly_.members[index].is_valid();
  }));
  assembly_.scene.update();
  sleep_.fall_asleep(islands_);
}

void MultibodyWorld::find_awake() {
  if (awake_at_ == assembly_.revision) return;
  awake_at_ = assembly_.revision;
  awake_.clear();
  for (std::uint32_t member = 0; member < assembly_.members.size(); ++member)
    if (assembly_.members[member].is_awake()) awake_.push_back(member);
}

void MultibodyWorld::detect() {
  std::vector<Member>& members = assembly_.members;
  workers_.for_each_chunk(awake_.size(), WorkerPool::fine, [&](std::size_t begin, std::size_t end, unsigned worker) {
    double& furthest = memory_[worker].furthest;
    for (std::size_t i = begin; i < end; ++i) furthest = std::max(furthest, assembly_.look_ahead(members[awake_[i]]));
  });
  double furthest = 0.0;
  for (Memory& memory : memory_) furthest = std::max(furthest, std::exchange(memory.furthest, 0.0));
  workers_.for_each_chunk(awake_.size(), WorkerPool::fine, [&](std::size_t begin, std::size_t end, unsigned worker) {
    Memory& memory = memory_[worker];
    for (std::size_t i = begin; i < end; ++i)
      assembly_.look_around(members[awake_[i]], furthest, memory.near, memory.candidates);
  });
}

void MultibodyWorld::find_islands() {
  // NOLINTNEXTLINE(modernize-loop-convert): they become more, as what is touched wakes.
  for (std::size_t i = 0; i < awake_.size(); ++i)
    assembly_.for_each_coupled(awake_[i], [&](std::uint32_t other) {
      if (assembly_.members[other].is_asleep) wake_group_of(other);
    });
  find_awake();
  const auto count = static_cast<std::uint32_t>(awake_.size());
  place_among_awake_.resize(assembly_.members.size());
  for (std::uint32_t place = 0; place < count; ++place) place_among_awake_[awake_[place]] = place;
  islands_.reset(count);
  for (std::uint32_t place = 0; place < count; ++place)
    assembly_.for_each_coupled(awake_[place],
                               [&](std::uint32_t other) { islands_.link(place, place_among_awake_[other]); });
  islands_.finish();
  islands_.rename(awake_);
}

// The pairs that a sleeper has with the bodies that touched it are already found in this step, except its own.
void MultibodyWorld::wake_group_of(std::uint32_t sleeper) {
  constexpr double slow = 0.0;
  for (const std::uint32_t member : sleep_.group_of(sleeper)) {
    assembly_.look_around(assembly_.members[member], slow, memory_[0].near, memory_[0].candidates);
    awake_.push_back(member);
  }
  sleep_.wake(sleeper);
}

// Small islands come first, each solved by one worker, then the large ones, each solved by all workers. A large island
// that is nearly at rest is solved more precisely by one of them, so that it comes to rest.
void MultibodyWorld::solve_islands() {
  const auto is_large = [&](std::uint32_t island) {
    const std::size_t bodies = islands_.members(island).size();
    return bodies >= LargeIslandSolver::least_bodies && !is_solved_directly(assembly_.settings, bodies);
  };
  outcomes_.assign(islands_.count(), std::nullopt);
  workers_.for_each_chunk(islands_.count(), WorkerPool::fine, [&](std::size_t begin, std::size_t end, unsigned) {
    IslandSolver& solver = solver_of_this_thread();
    for (auto island = static_cast<std::uint32_t>(begin); island < end; ++island)
      if (!is_large(island)) outcomes_[island] = solver.solve(assembly_, islands_.members(island));
  });
  for (std::uint32_t island = 0; island < islands_.count(); ++island) {
    if (!is_large(island)) continue;
    outcomes_[island] = solver_of_this_thread().solve_if_calm(assembly_, islands_.members(island));
    if (!outcomes_[island]) large_island_solver_.solve(assembly_, islands_.members(island));
  }
  count_outcomes();
  if (!assembly_.settings.sleeping) return;
  workers_.for_each_chunk(islands_.count(), WorkerPool::fine, [&](std::size_t begin, std::size_t end, unsigned) {
    for (auto island = static_cast<std::uint32_t>(begin); island < end; ++island)
      for (const std::uint32_t member : islands_.members(island)) sleep_.count(member);
  });
}

void MultibodyWorld::count_outcomes() {
  for (std::uint32_t island = 0; island < islands_.count(); ++island) {
    const std::optional<Convergence::Outcome>& outcome = outcomes_[island];
    if (!outcome) continue;
    ++convergence_.solved;
    convergence_.minima += outcome->minima;
    convergence_.steps += outcome->steps;
    convergence_.factorisations += outcome->factorisations;
    convergence_.most_minima = std::max(convergence_.most_minima, outcome->minima);
    if (outcome->error <= Convergence::bound) continue;
    ++convergence_.unconverged;
    convergence_.worst = std::max(convergence_.worst, outcome->error);
    const std::uint32_t first = islands_.members(island).front();
    convergence_.of_last_step.push_back({assembly_.members[first].multibody->body(), outcome->error});
  }
}

void MultibodyWorld::quarantine() {
  for (const std::uint32_t index : awake_) {
    const Member& member = assembly_.members[index];
    if (member.is_finite && member.is_inside) continue;
    using Reason = Quarantine::Reason;
    quarantined_.push_back({member.body, member.is_finite ? Reason::left_world : Reason::not_finite});
    assembly_.take_out(index);
  }
}

ConnectionId MultibodyWorld::connect(const BodyLink& a, const Pose& X_LP, const BodyLink& b,
                                     const ConnectionLimits& limits) {
  const BodyMotion& body_a = multibody(a.body).motion();
  const Mechanism::LinkPlace& place_a = body_a.mechanism().link(a.link.value);
  const Connection::End end_a{bodies_[a.body.value].member, place_a.segment, a.link.value, place_a.X_SL * X_LP,
                              a.body.value};
  const Pose X_WP = body_a.segment_pose(place_a.segment) * end_a.X_SP;
  Connection::End end_b{Anchors::nobody, 0, 0, X_WP, b.body.value};
  if (!is_static(b.body)) {
    const BodyMotion& body_b = multibody(b.body).motion();
    const int segment = body_b.mechanism().link(b.link.value).segment;
    end_b = {bodies_[b.body.value].member, segment, b.link.value, body_b.segment_pose(segment).inverse() * X_WP,
             b.body.value};
  }
  wake(a.body);
  if (!is_static(b.body)) wake(b.body);
  return ConnectionId{assembly_.connections.add(end_a, end_b, limits)};
}

void MultibodyWorld::disconnect(ConnectionId connection) {
  sleep_.wake_ends(connection.value);
  assembly_.connections.release(connection.value);
}

void MultibodyWorld::set_give(ConnectionId connection, const ConnectionGive& give) {
  sleep_.wake_ends(connection.value);
  assembly_.connections.set_give(connection.value, give);
}

PlacedBody& MultibodyWorld::wake(BodyId body) {
  sleep_.wake(bodies_[body.value].member);
  return bodies_[body.value];
}

// Contacts of sleeping bodies come first: they remain until a body wakes or falls asleep.
void MultibodyWorld::report_contacts() {
  if (reported_at_ != assembly_.revision) {
    reported_at_ = assembly_.revision;
    contacts_.clear();
    for (std::uint32_t member = 0; member < assembly_.members.size(); ++member)
      if (assembly_.members[member].is_asleep) report_contacts_of(member);
    contacts_asleep_ = contacts_.size();
  }
  contacts_.resize(contacts_asleep_);
  for (const std::uint32_t member : awake_) report_contacts_of(member);
}

void MultibodyWorld::report_contacts_of(std::uint32_t member) {
  const geometry::Scene& scene = assembly_.scene;
  assembly_.for_each_pair(member, [&](const SolidPair& pair) {
    for (const ContactPoint& point : pair.contact) {
      if (point.gap > 0.0 && point.impulse[0] == 0.0) continue;  // near, but not touching
      contacts_.push_back({scene.solid(pair.a).body, scene.solid(pair.b).body, point.position_W, point.normal_W,
                           point.gap, point.impulse[0], pair.a, pair.b});
    }
  });
}

}  // namespace cohort::physics
