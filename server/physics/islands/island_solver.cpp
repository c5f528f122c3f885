#include "server/physics/islands/island_solver.hpp"

#include <algorithm>

#include "server/physics/solvers/active_set_solver.hpp"
#include "server/physics/solvers/direct_solver.hpp"
#include "server/physics/solvers/iterative_solver.hpp"

namespace cohort::physics {

namespace {

// If light links hold heavy bodies, sequential impulses leave errors of millimetres. Islands of up to this many bodies
// are solved exactly instead; more bodies would take too long.
constexpr std::size_t most_solved_as_group = 6;
// Islands of 2 to this many bodies without connections are solved until they settle, by at most this many times the
// usual number of passes. Their friction therefore starts from that of the last step. In larger heaps the passes cannot
// follow, and the friction that a heap needed one step ago would rock it.
constexpr std::size_t most_followed = 16;
constexpr std::uint32_t passes_of_followed = 5;
// A pass that changes velocities by less than this share of what gravity adds in a step has settled them.
constexpr double settled_share = 1e-4;
constexpr double settled_without_gravity = 1e-5;  // [m/s or rad/s]
// Fast-spinning bodies need more passes: their equations are not symmetric, as the direct and the group solver require.
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

  problem_.clear();
  for (const std::uint32_t member : sound_) assembly.add_own_rows(member, problem_);
  bool has_connections = false;
  bool has_light_connections = false;
  for (const std::uint32_t member : sound_)
    assembly.connections.for_each_of(member, [&](Connection& connection) {
      assembly.add_connection_rows(connection, problem_);
      has_connections = true;
      has_light_connections =
          has_light_connections || assembly.is_light(connection.a()) || assembly.is_light(connection.b());
    });
  const bool is_followed = !has_connections && sound_.size() > 1 && sound_.size() <= most_followed;
  for (const std::uint32_t member : sound_)
    assembly.for_each_pair(member, [&](SolidPair& pair) { assembly.add_contact_rows(pair, problem_, is_followed); });

  impacts_.solve(problem_);
  const bool directly = is_solved_directly(assembly.settings, sound_.size());
  const bool is_symmetric = std::ranges::all_of(
      sound_, [&](std::uint32_t member) { return bodies_[assembly.anchors.index_of_member[member]].is_symmetric(); });
  bool is_solved = false;
  if (directly && is_symmetric) {
    is_solved = solve_directly(problem_);
  } else if (is_symmetric && has_light_connections && sound_.size() <= most_solved_as_group) {
    is_solved = group_solver_.solve(problem_) || solve_directly(problem_);
  } else {
    is_solved = solve_by_active_set(problem_) || (is_symmetric && is_mechanism() && group_solver_.solve(problem_));
  }
  if (!is_solved) {
    const double share_of_last = has_connections ? start_of_connected : 1.0;
    const std::uint32_t passes = assembly.settings.iterations * (is_symmetric ? 1 : passes_where_fast);
    const double settled = settled_change(assembly);
    const double change = solve_iteratively(
        problem_, is_followed ? Passes{passes, passes_of_followed * passes, settled} : Passes{passes, passes, 0.0},
        share_of_last);
    if (!has_connections && is_unsettled_heap(change, sound_, assembly))
      settle(assembly.settings.iterations, is_symmetric, settled);
  }
  if (!all_are_finite()) return false;

  impacts_.add_impulses(problem_);
  keep_impulses(problem_);
  for (const std::uint32_t member : sound_) assembly.integrate(member, problem_);
  return true;
}

// Returns whether the island is a single body without friction in a disc: joints, motors and loops, for example of a
// parallel robot.
bool IslandSolver::is_mechanism() const {
  const auto is_cone = [](const Row& row) { return row.limits == Row::Limits::cone; };
  return sound_.size() == 1 && std::ranges::none_of(problem_.rows(), is_cone);
}

// Solves all rows at once if that is not too expensive, otherwise by more passes.
void IslandSolver::settle(std::uint32_t iterations, bool is_symmetric, double settled) {
  SequentialImpulses impulses(problem_);
  impulses.take_back();
  if (is_symmetric && group_solver_.solve(problem_)) return;
  impulses.put_in();
  for (std::uint32_t i = 0; i < passes_of_heaps * iterations; ++i)
    if (impulses.pass(i % 2 == 0) <= settled) return;
}

}  // namespace cohort::physics
