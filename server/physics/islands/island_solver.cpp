#include "server/physics/islands/island_solver.hpp"

#include <algorithm>

#include "server/physics/solvers/active_set_solver.hpp"
#include "server/physics/solvers/direct_solver.hpp"
#include "server/physics/solvers/iterative_solver.hpp"

namespace cohort::physics {

namespace {

// A pass that changes velocities by less than this share of what gravity adds in a step has settled them.
constexpr double settled_share = 1e-4;
constexpr double settled_without_gravity = 1e-5;  // [m/s or rad/s]
// Newton's method is this much more precise, at nearly the same cost.
constexpr double share_for_newton = 1e-2;
// Where Newton's method finds no solution, up to this multiple of the usual number of passes settles an island.
constexpr std::uint32_t passes_of_unsettled = 5;
// Fast-spinning bodies need more passes: their equations are not symmetric, as the other solvers require.
constexpr std::uint32_t passes_where_fast = 10;

// Returns whether only other moving bodies support it.
bool is_carried(std::uint32_t member, const Assembly& assembly) {
  const Multibody& multibody = *assembly.members[member].multibody;
  bool stands = !multibody.mechanism().has_free_root();
  for (const TrackRows& treel : multibody.treels())
    treel.for_each_ground([&](std::uint32_t solid) { stands = stands || !assembly.anchors.moves(solid); });
  assembly.for_each_pair(member, [&](const SolidPair& pair) { stands = stands || !assembly.anchors.moves(pair.b); });
  return !stands;
}

}  // namespace

double settled_change(const Assembly& assembly) {
  const double fall = assembly.step * assembly.gravity.norm();
  return fall > 0.0 ? settled_share * fall : settled_without_gravity;
}

bool is_unsettled_heap(double change, std::span<const std::uint32_t> members, const Assembly& assembly) {
  return change > settled_change(assembly) && members.size() > 1 &&
         std::ranges::any_of(members, [&](std::uint32_t member) { return is_carried(member, assembly); });
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

void IslandSolver::solve(Assembly& assembly, std::span<const std::uint32_t> members) {
  sound_.clear();
  for (const std::uint32_t member : members)
    if (assembly.members[member].is_awake()) sound_.push_back(member);
  while (!sound_.empty() && !try_to_solve(assembly)) leave_out_broken(sound_, assembly);
}

// Returns false, without moving any body, if one of them has invalid velocities.
bool IslandSolver::try_to_solve(Assembly& assembly) {
  const auto all_are_finite = [&] {
    bool all = true;
    for (const std::uint32_t member : sound_) all = assembly.check(member, bodies_) && all;
    return all;
  };
  number_bodies(sound_, assembly, bodies_);
  for (const std::uint32_t member : sound_) assembly.set_up(member, bodies_);
  if (!all_are_finite()) return false;

  const bool directly = is_solved_directly(assembly.settings, sound_.size());
  const bool is_symmetric = std::ranges::all_of(
      sound_, [&](std::uint32_t member) { return bodies_[assembly.anchors.index_of_member[member]].is_symmetric(); });
  problem_.clear();
  for (const std::uint32_t member : sound_) assembly.add_own_rows(member, problem_);
  bool has_connections = false;
  for (const std::uint32_t member : sound_)
    assembly.connections.for_each_of(member, [&](Connection& connection) {
      assembly.add_connection_rows(connection, problem_);
      has_connections = true;
    });
  const bool is_alone = sound_.size() == 1;
  const FrictionStart start = is_symmetric && !directly && !is_alone ? FrictionStart::last : FrictionStart::shared;
  for (const std::uint32_t member : sound_)
    assembly.for_each_pair(member, [&](SolidPair& pair) { assembly.add_contact_rows(pair, problem_, start); });

  impacts_.solve(problem_);
  const double settled = settled_change(assembly);
  bool is_solved = false;
  if (directly && is_symmetric) {
    is_solved = solve_directly(problem_);
  } else {
    is_solved = solve_by_active_set(problem_) ||
                (is_symmetric && (!is_alone || !has_cones()) && newton_.solve(problem_, share_for_newton * settled));
  }
  if (!is_solved) {
    const std::uint32_t passes = assembly.settings.iterations * (is_symmetric ? 1 : passes_where_fast);
    solve_iteratively(problem_,
                      is_alone ? Passes{passes, passes, 0.0} : Passes{passes, passes_of_unsettled * passes, settled},
                      has_connections ? start_of_connected : 1.0);
  }
  if (!all_are_finite()) return false;

  impacts_.add_impulses(problem_);
  keep_impulses(problem_);
  for (const std::uint32_t member : sound_) assembly.integrate(member, problem_);
  return true;
}

bool IslandSolver::has_cones() const {
  return std::ranges::any_of(problem_.rows(), [](const Row& row) { return row.limits == Row::Limits::cone; });
}

}  // namespace cohort::physics
