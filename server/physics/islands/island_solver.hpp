#pragma once

#include <span>
#include <vector>

#include "server/physics/islands/assembly.hpp"
#include "server/physics/solvers/group_solver.hpp"

namespace cohort::physics {

/// Moves the bodies of one island by one step. Keeps its memory from island to island: one for each worker.
class IslandSolver {
 public:
  /// A body whose state breaks is left where it is, and the rest of the island solved without it.
  void solve(Assembly& assembly, std::span<const std::uint32_t> members);

 private:
  bool try_to_solve(Assembly& assembly);
  void settle(std::uint32_t iterations, bool is_symmetric);

  IslandBodies bodies_;
  Problem problem_{bodies_};
  GroupSolver group_solver_;
  std::vector<std::uint32_t> sound_;  // members
};

/// Whether passes, the last of which changed a row's velocity by `change`, ended too early for bodies of which some are
/// carried by others, as in a stack or between fingers: what is on top of them would wander off.
bool is_unsettled_heap(double change, std::span<const std::uint32_t> members, const Assembly& assembly);
/// Then so many times more passes are made, as long as they change anything.
inline constexpr std::uint32_t passes_of_heaps = 4;

/// Whether an island of so many bodies is solved by Dantzig's algorithm.
bool is_solved_directly(const description::PhysicsSettings& settings, std::size_t bodies);

/// Gives each its index in `bodies`.
void number_bodies(std::span<const std::uint32_t> members, Assembly& assembly, IslandBodies& bodies);
/// Takes those whose state broke out of `members`.
void leave_out_broken(std::vector<std::uint32_t>& members, Assembly& assembly);
/// Keeps the impulses for the next step's start.
void keep_impulses(const Problem& problem);

}  // namespace cohort::physics
