// SPDX-License-Identifier: Apache-2.0
#include "server/physics/islands/island_solver.hpp"

#include <algorithm>
#include <cmath>

#include "server/physics/solvers/direct_solver.hpp"
#include "server/physics/solvers/iterative_solver.hpp"

namespace cohort::physics {

namespace {

// A pass that changes velocities by less than this share of what gravity adds in a step has settled them.
constexpr double settled_share = 1e-4;
// Up to this multiple of the usual number of passes settles an island without connections.
constexpr std::uint32_t passes_of_unsettled = 5;
// This multiple is made for fast-spinning bodies: their equations are not symmetric, as the other solvers require.
constexpr std::uint32_t passes_where_fast = 10;
// A wall of 100 bricks at rest takes two or three steps of Newton's method, but over 16 when it begins to stand.
constexpr std::uint32_t most_steps_if_calm = 30;

// Returns whether any of them has a connection, such as a grip.
bool has_connections(std::span<const std::uint32_t> members, Assembly& assembly) {
  return std::ranges::any_of(members, [&](std::uint32_t member) {
    bool any = false;
    assembly.connections.for_each_of(member, [&](const Connection&) { any = true; });
    return any;
  });
}

}  // namespace

Passes passes_of(std::span<const std::uint32_t> members, Assembly& assembly) {
  const double settled = settled_share * assembly.step * assembly.gravity.norm();
  const bool is_connected = has_connections(members, assembly);
  return {.least = assembly.settings.iterations,
          .most_times = members.size() == 1 || is_connected ? 1 : passes_of_unsettled,
          .settled = std::max(settled, negligible_change),
          .share_of_last = is_connected ? start_of_connected : 1.0};
}

bool are_calm(std::span<const std::uint32_t> members, Assembly& assembly) {
  const double fall = assembly.step * assembly.gravity.norm();
  double sum = 0.0;
  for (const std::uint32_t member : members) {
    const BodyMotion& motion = assembly.members[member].multibody->motion();
    sum += motion.segment_twist(0, motion.segment_pose(0).position).linear_W.squaredNorm();
  }
  return sum < fall * fall * static_cast<double>(members.size()) && !has_connections(members, assembly);
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

std::optional<Convergence::Outcome> IslandSolver::solve_if_calm(Assembly& assembly,
                                                                std::span<const std::uint32_t> members) {
  if (assembly.settings.solver != description::Solver::convex || !are_calm(members, assembly)) return std::nullopt;
  take(assembly, members);
  if (!set_up(assembly) || method_ != Method::convex) return std::nullopt;
  outcome_ = convex_.solve(problem_, most_steps_if_calm);
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
  for (const std::uint32_t member : sound_)
    assembly.connections.for_each_of(
        member, [&](Connection& connection) { assembly.add_connection_rows(connection, problem_); });
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

void IslandSolver::solve_rows(Assembly& assembly) {
  if (problem_.row_count() == 0 || (method_ == Method::direct && solve_directly(problem_))) return;
  if (method_ == Method::convex || method_ == Method::direct) {
    outcome_ = convex_.solve(problem_);
    if (outcome_) return;
  }
  Passes passes = passes_of(sound_, assembly);
  if (method_ == Method::many_passes) passes.least *= passes_where_fast;
  SequentialImpulses impulses(problem_);
  impulses.start(passes.share_of_last);
  make_passes(passes, [&](bool forwards) { return impulses.pass(forwards); });
}

}  // namespace cohort::physics
