// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "server/physics/islands/assembly.hpp"
#include "server/physics/solvers/convex_solver.hpp"
#include "server/physics/solvers/impacts.hpp"
#include "server/physics/solvers/iterative_solver.hpp"

namespace cohort::physics {

/// Moves the bodies of one island by one step. Each worker has one and reuses its memory for further islands.
class IslandSolver {
 public:
  /// Solves the island. A body whose state breaks keeps its pose, and the rest of the island is solved without it.
  /// Returns the outcome if the convex solver has solved rows.
  std::optional<Convergence::Outcome> solve(Assembly& assembly, std::span<const std::uint32_t> members);

  /// Solves a large island that is nearly at rest as one problem. Returns nothing, without moving any body, if the
  /// bodies are not calm (`are_calm`) or the world has another solver. It does the same if the solution would cost too
  /// much, or if a velocity is invalid.
  std::optional<Convergence::Outcome> solve_if_calm(Assembly& assembly, std::span<const std::uint32_t> members);

 private:
  enum class Method : std::uint8_t { convex, passes, many_passes, direct };

  void take(const Assembly& assembly, std::span<const std::uint32_t> members);
  bool try_to_solve(Assembly& assembly);
  bool all_are_finite(Assembly& assembly);
  bool set_up(Assembly& assembly);
  bool finish(Assembly& assembly);
  Method find_method(const Assembly& assembly) const;
  void solve_rows(Assembly& assembly);

  IslandBodies bodies_;
  Problem problem_{bodies_};
  ConvexSolver convex_;
  Impacts impacts_;
  std::vector<std::uint32_t> sound_;  // members
  Method method_ = Method::passes;
  std::optional<Convergence::Outcome> outcome_;  // empty: not by the convex solver
};

/// Returns how an island of these bodies is solved by passes.
Passes passes_of(std::span<const std::uint32_t> members, Assembly& assembly);

/// Returns whether an island of this many bodies is solved by Dantzig's algorithm.
bool is_solved_directly(const description::PhysicsSettings& settings, std::size_t bodies);

/// Returns whether the members have no connections and move, on average, so slowly that they will soon be at rest.
bool are_calm(std::span<const std::uint32_t> members, Assembly& assembly);

/// Assigns to each member its index in `bodies`.
void number_bodies(std::span<const std::uint32_t> members, Assembly& assembly, IslandBodies& bodies);
/// Removes members whose state broke from `members`.
void leave_out_broken(std::vector<std::uint32_t>& members, Assembly& assembly);
/// Keeps the impulses to warm-start the next step.
void keep_impulses(const Problem& problem);

}  // namespace cohort::physics
