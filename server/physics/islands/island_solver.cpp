#include "server/physics/islands/island_solver.hpp"

#include <algorithm>
#include <cmath>

#include "server/physics/solvers/direct_solver.hpp"
#include "server/physics/solvers/iterative_solver.hpp"

namespace cohort::physics {

namespace {

// A pass that changes velocities by less than this share of what gravity adds in a step has settled them.
constexpr double settled_share = 1e-4;
constexpr double settled_without_gravity = 1e-5;  // [m/s or rad/s]
// Up to this multiple of the usual number of passes settles an island without connections.
constexpr std::uint32_t passes_of_unsettled = 5;
// A wall of 100 bricks at rest takes two or three steps of Newton's method, but over 16 when it begins to stand.
constexpr std::uint32_t steps_for_heap = 30;
// Damping of a calm heap [1/s]: what still rocks there has stopped after a few tenths of a second.
constexpr double damping_of_calm = 10.0;
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

std::optional<Convergence::Outcome> IslandSolver::solve(Assembly& assembly, std::span<const std::uint32_t> members) {
  take(assembly, members);
  outcome_.reset();
  while (!sound_.empty() && !try_to_solve(assembly)) {
    leave_out_broken(sound_, assembly);
    outcome_.reset();
  }
  return outcome_;
}

std::optional<Convergence::Outcome> IslandSolver::solve_calm_heap(Assembly& assembly,
                                                                  std::span<const std::uint32_t> members) {
  if (assembly.settings.solver != description::Solver::convex || !is_calm_heap(members, assembly)) return std::nullopt;
  take(assembly, members);
  if (!set_up(assembly) || method_ != Method::convex) return std::nullopt;
  outcome_ = convex_.solve(problem_, steps_for_heap);
  return outcome_ && finish(assembly) ? outcome_ : std::nullopt;
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
  has_connections_ = false;
  for (const std::uint32_t member : sound_)
    assembly.connections.for_each_of(member, [&](Connection& connection) {
      assembly.add_connection_rows(connection, problem_);
      has_connections_ = true;
    });
  method_ = find_method(assembly);
  const FrictionStart start = method_ == Method::convex ? FrictionStart::last : FrictionStart::shared;
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

IslandSolver::Method IslandSolver::find_method(const Assembly& assembly) const {
  const bool is_symmetric = std::ranges::all_of(
      sound_, [&](std::uint32_t member) { return bodies_[assembly.anchors.index_of_member[member]].is_symmetric(); });
  if (!is_symmetric) return Method::many_passes;
  if (is_solved_directly(assembly.settings, sound_.size())) return Method::direct;
  return assembly.settings.solver == description::Solver::convex ? Method::convex : Method::passes;
}

void IslandSolver::solve_rows(const Assembly& assembly) {
  if (problem_.row_count() == 0 || (method_ == Method::direct && solve_directly(problem_))) return;
  if (method_ == Method::convex || method_ == Method::direct) {
    outcome_ = convex_.solve(problem_);
    if (outcome_) return;
  }
  const std::uint32_t passes = assembly.settings.iterations * (method_ == Method::many_passes ? passes_where_fast : 1);
  const std::uint32_t most = sound_.size() == 1 || has_connections_ ? passes : passes_of_unsettled * passes;
  solve_iteratively(problem_, {passes, most, settled_change(assembly)}, has_connections_ ? start_of_connected : 1.0);
}

}  // namespace cohort::physics
