#include "server/physics/islands/island_solver.hpp"

#include <algorithm>
#include <cmath>

#include "server/physics/solvers/active_set_solver.hpp"
#include "server/physics/solvers/direct_solver.hpp"
#include "server/physics/solvers/iterative_solver.hpp"

namespace cohort::physics {

namespace {

// A pass that changes velocities by less than this share of what gravity adds in a step has settled them.
constexpr double settled_share = 1e-4;
constexpr double settled_without_gravity = 1e-5;  // [m/s or rad/s]
// Islands of up to this many bodies with connections at light links, such as an arm that lifts a robot, are solved by
// Newton's method. More bodies would take too long, and connected bodies of similar mass do not need it.
constexpr std::size_t most_lightly_connected = 6;
// Newton's method solves islands more precisely than passes, by this factor of the settled change.
constexpr double precise_share = 1e-2;
// A single body with disc-shaped friction is solved by passes. If the last pass still changes velocities by this
// multiple of the settled change, as in a robot with many legs, Newton's method finds one minimum instead.
constexpr double far_from_settled = 1e4;
// Where Newton's method finds no solution, up to this multiple of the usual number of passes settles an island.
constexpr std::uint32_t passes_of_unsettled = 5;
// Damping of a calm heap [1/s]: what still rocks there has stopped after a few tenths of a second.
constexpr double damping_of_calm = 10.0;
// A single rigid body is nearly at rest below this share of what gravity adds in a step.
constexpr double slow_share = 0.1;
// Fast-spinning bodies need more passes: their equations are not symmetric, as the other solvers require.
constexpr std::uint32_t passes_where_fast = 10;

// Returns whether only other moving bodies support it, as a can between fingers.
bool is_held_by_others(std::uint32_t member, const Assembly& assembly) {
  const Multibody& multibody = *assembly.members[member].multibody;
  bool stands = !multibody.mechanism().has_free_root();
  for (const TrackRows& treel : multibody.treels())
    treel.for_each_ground([&](std::uint32_t solid) { stands = stands || !assembly.anchors.moves(solid); });
  assembly.for_each_pair(member, [&](const SolidPair& pair) { stands = stands || !assembly.anchors.moves(pair.b); });
  return !stands;
}

// Returns whether it stands on another moving body, or that one on it.
bool is_stacked(std::uint32_t member, const Assembly& assembly) {
  constexpr double steepest = 0.5;  // cosine of the angle between gravity and the normal
  const double least = steepest * assembly.gravity.norm();
  bool is_stacked = false;
  assembly.for_each_pair(member, [&](const SolidPair& pair) {
    if (!assembly.anchors.moves(pair.b)) return;
    for (const ContactPoint& point : pair.contact)
      is_stacked = is_stacked || std::abs(point.normal_W.dot(assembly.gravity)) > least;
  });
  return is_stacked;
}

}  // namespace

double settled_change(const Assembly& assembly) {
  const double fall = assembly.step * assembly.gravity.norm();
  return fall > 0.0 ? settled_share * fall : settled_without_gravity;
}

bool has_carried(std::span<const std::uint32_t> members, const Assembly& assembly) {
  return std::ranges::any_of(members, [&](std::uint32_t member) {
    return is_held_by_others(member, assembly) || is_stacked(member, assembly);
  });
}

bool is_calm_heap(std::span<const std::uint32_t> members, Assembly& assembly) {
  const double fall = assembly.step * assembly.gravity.norm();
  double sum = 0.0;
  bool has_connections = false;
  for (const std::uint32_t member : members) {
    const BodyMotion& motion = assembly.members[member].multibody->motion();
    sum += motion.segment_twist(0, motion.segment_pose(0).position).linear_W.squaredNorm();
    assembly.connections.for_each_of(member, [&](const Connection&) { has_connections = true; });
  }
  return sum < fall * fall * static_cast<double>(members.size()) && !has_connections && has_carried(members, assembly);
}

void damp_calm_heap(std::span<const std::uint32_t> members, const Assembly& assembly, IslandBodies& bodies) {
  const auto is_left_alone = [&](std::uint32_t index) {
    const Member& member = assembly.members[index];
    return member.multibody->is_inert() && !member.fluid;
  };
  if (!std::ranges::all_of(members, is_left_alone)) return;
  const double fall = assembly.step * assembly.gravity.norm();
  const double kept = 1.0 / (1.0 + damping_of_calm * assembly.step);
  for (const std::uint32_t member : members) {
    const std::span velocity(bodies[assembly.anchors.index_of_member[member]].velocity(), 6);  // angular, linear
    const bool is_slow = std::ranges::all_of(velocity.last(3), [&](double v) { return std::abs(v) < fall; });
    if (!is_slow) continue;
    for (double& v : velocity) v *= kept;
  }
}

bool is_solved_directly(const description::PhysicsSettings& settings, std::size_t bodies) {
  return settings.solver == description::Solver::direct ||
         (settings.solver == description::Solver::hybrid && bodies <= settings.direct_bodies);
}

void number_bodies(std::span<const std::uint32_t> members, Assembly& assembly, IslandBodies& bodies) {
  bodies.reset(members.size());
  for (std::size_t i = 0; i < members.size(); ++i) assembly.anchors.index_of_member[members[i]] = static_cast<int>(i);
}

void leave_out_broken(std::vector<std::uint32_t>& members, Assembly& assembly) {
  std::erase_if(members, [&](std::uint32_t member) {
    if (assembly.members[member].is_finite) return false;
    assembly.anchors.index_of_member[member] = -1;
    return true;
  });
}

void keep_impulses(const Problem& problem) {
  for (const Row& row : problem.rows())
    if (row.kept != nullptr) *row.kept = row.impulse;
}

void IslandSolver::take(const Assembly& assembly, std::span<const std::uint32_t> members) {
  sound_.clear();
  for (const std::uint32_t member : members)
    if (assembly.members[member].is_awake()) sound_.push_back(member);
}

std::optional<double> IslandSolver::solve(Assembly& assembly, std::span<const std::uint32_t> members) {
  take(assembly, members);
  error_.reset();
  while (!sound_.empty() && !try_to_solve(assembly)) {
    leave_out_broken(sound_, assembly);
    error_.reset();
  }
  return error_;
}

bool IslandSolver::solve_by_newton(Assembly& assembly, std::span<const std::uint32_t> members) {
  take(assembly, members);
  if (!set_up(assembly) || find_iterative_method(assembly) != Method::newton ||
      !newton_.solve(problem_, precise_share * settled_change(assembly)))
    return false;
  damp_calm_heap(sound_, assembly, bodies_);
  return finish(assembly);
}

bool IslandSolver::try_to_solve(Assembly& assembly) {
  if (!set_up(assembly)) return false;
  solve_rows(assembly);
  return finish(assembly);
}

bool IslandSolver::all_are_finite(Assembly& assembly) {
  bool all = true;
  for (const std::uint32_t member : sound_) all = assembly.check(member, bodies_) && all;
  return all;
}

// Returns false if a body has invalid velocities without any impulse.
bool IslandSolver::set_up(Assembly& assembly) {
  number_bodies(sound_, assembly, bodies_);
  for (const std::uint32_t member : sound_) assembly.set_up(member, bodies_);
  if (!all_are_finite(assembly)) return false;

  problem_.clear();
  for (const std::uint32_t member : sound_) assembly.add_own_rows(member, problem_);
  has_light_connections_ = false;
  has_connections_ = false;
  for (const std::uint32_t member : sound_)
    assembly.connections.for_each_of(member, [&](Connection& connection) {
      assembly.add_connection_rows(connection, problem_);
      has_connections_ = true;
      has_light_connections_ =
          has_light_connections_ || assembly.is_light(connection.a()) || assembly.is_light(connection.b());
    });
  method_ = find_method(assembly);
  const FrictionStart start = find_start(assembly);
  for (const std::uint32_t member : sound_)
    assembly.for_each_pair(member, [&](SolidPair& pair) { assembly.add_contact_rows(pair, problem_, start); });
  impacts_.solve(problem_, assembly.step * assembly.gravity.norm());
  return true;
}

// Returns false, without moving any body, if one of them has invalid velocities.
bool IslandSolver::finish(Assembly& assembly) {
  if (!all_are_finite(assembly)) return false;
  impacts_.add_impulses(problem_);
  keep_impulses(problem_);
  for (const std::uint32_t member : sound_) assembly.integrate(member, problem_);
  return true;
}

FrictionStart IslandSolver::find_start(const Assembly& assembly) const {
  if (method_ == Method::convex) return FrictionStart::last;
  if (sound_.size() > 1) return method_ == Method::newton ? FrictionStart::last : FrictionStart::shared;
  const Multibody& body = *assembly.members[sound_.front()].multibody;
  if (!body.mechanism().is_free_body()) return FrictionStart::shared;
  // Friction that is shared by load would let a body creep that leans on something.
  const Eigen::Map<const Eigen::Vector3d> velocity(body.motion().velocities() + 3);
  return velocity.norm() < slow_share * assembly.step * assembly.gravity.norm() ? FrictionStart::last
                                                                                : FrictionStart::shared;
}

IslandSolver::Method IslandSolver::find_method(const Assembly& assembly) const {
  const bool is_symmetric = std::ranges::all_of(
      sound_, [&](std::uint32_t member) { return bodies_[assembly.anchors.index_of_member[member]].is_symmetric(); });
  if (!is_symmetric) return Method::many_passes;
  if (is_solved_directly(assembly.settings, sound_.size())) return Method::direct;
  if (assembly.settings.solver == description::Solver::convex) return Method::convex;
  return find_iterative_method(assembly);
}

// For the iterative solver, and for islands that are too large for the convex one.
IslandSolver::Method IslandSolver::find_iterative_method(const Assembly& assembly) const {
  if (has_connections_)
    return has_light_connections_ && sound_.size() <= most_lightly_connected ? Method::newton : Method::passes;
  return sound_.size() == 1 || has_carried(sound_, assembly) ? Method::newton : Method::passes;
}

void IslandSolver::solve_rows(const Assembly& assembly) {
  const double settled = settled_change(assembly);
  const bool is_alone = sound_.size() == 1;
  if (method_ == Method::direct && solve_directly(problem_)) return;
  if (method_ == Method::convex) {
    if (problem_.row_count() == 0) return;
    error_ = convex_.solve(problem_);
    if (error_) return;
    method_ = find_iterative_method(assembly);
  }
  if (method_ != Method::direct && solve_by_active_set(problem_)) return;
  if (method_ == Method::newton && !(is_alone && has_cones()) && newton_.solve(problem_, precise_share * settled))
    return;

  const std::uint32_t passes = assembly.settings.iterations * (method_ == Method::many_passes ? passes_where_fast : 1);
  const std::uint32_t most = is_alone || has_connections_ ? passes : passes_of_unsettled * passes;
  Equations& body = bodies_[0];
  without_impulses_.assign(body.velocity(), body.velocity() + body.stride());
  const double change =
      solve_iteratively(problem_, {passes, most, settled}, has_connections_ ? start_of_connected : 1.0);
  if (!is_alone || method_ != Method::newton || change <= far_from_settled * settled) return;
  std::swap_ranges(without_impulses_.begin(), without_impulses_.end(), body.velocity());
  if (!newton_.solve(problem_, settled, 1))
    std::copy(without_impulses_.begin(), without_impulses_.end(), body.velocity());
}

bool IslandSolver::has_cones() const {
  return std::ranges::any_of(problem_.rows(), [](const Row& row) { return row.limits == Row::Limits::cone; });
}

}  // namespace cohort::physics
