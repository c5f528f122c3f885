// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "server/core/worker_pool.hpp"
#include "server/physics/islands/assembly.hpp"
#include "server/physics/islands/island_parts.hpp"

namespace cohort::physics {

/// Moves the bodies of one large island by one step, with all workers at once.
///
/// The island is cut into parts. Rows within a part belong to that part. Rows between parts are sorted by the set of
/// parts that they couple, one seam for each set; seams that share a part get different colours. A pass of the solver
/// goes over all parts at once, then over all seams of the first colour at once, and so on. Every second pass runs in
/// reverse order. Two workers therefore never change the same body. The result depends neither on the number of workers
/// nor on their speed: it is that of sequential impulses with another order of the rows.
class LargeIslandSolver {
 public:
  /// Islands of at least this size use this solver with any number of workers, because the order of the rows affects
  /// the result.
  static constexpr std::size_t least_bodies = 96;

  explicit LargeIslandSolver(WorkerPool& workers) : workers_(workers) {}

  /// Solves the island. A body whose state breaks keeps its pose, and the rest of the island is solved without it.
  void solve(Assembly& assembly, std::span<const std::uint32_t> members);

 private:
  /// The rows of a part or a seam.
  struct Share {
    explicit Share(IslandBodies& bodies) : problem(bodies) {}

    Problem problem;
    double change = 0.0;  // in the last pass
  };
  /// Two parts, the lower one first; `several` if more than two are coupled.
  using Parts = std::pair<std::uint32_t, std::uint32_t>;
  static constexpr std::uint32_t no_part = 0xffffffffu;
  static constexpr Parts several{no_part, no_part};

  /// A source of rows in a seam: the own rows of a member whose tracks stand on another part, a connection or a pair.
  struct Crossing {
    Parts parts;
    std::uint32_t member = 0;  // its own rows, if both pointers are null
    Connection* connection = nullptr;
    SolidPair* pair = nullptr;
  };
  struct Seam {
    std::size_t begin = 0;  // range of its crossings
    std::size_t end = 0;
    unsigned colour = 0;
  };

  bool try_to_solve(Assembly& assembly);
  void cut(Assembly& assembly);
  std::optional<Parts> parts_across(const Assembly& assembly, std::uint32_t part, std::uint32_t other) const;
  void add_rows_of_part(Assembly& assembly, std::uint32_t part);
  void find_seams();
  void colour_seams();
  void add_rows_of_seam(Assembly& assembly, const Seam& seam, Problem& problem);
  bool all_are_finite(Assembly& assembly);
  /// Returns the greatest change of a row's velocity.
  double run_pass(bool forwards, bool with_friction);
  void settle(double settled);
  /// Damps bodies that are slower than the velocity that gravity adds in one step, if all are single rigid bodies
  /// without drives, outside of fluids. A body that is held at two points would otherwise swing about them for ever,
  /// and friction that has not quite settled would let others rock.
  void damp(const Assembly& assembly);
  template <class Work>
  void for_each_share(std::size_t phase, Work&& work);

  WorkerPool& workers_;
  IslandBodies bodies_;
  std::vector<std::uint32_t> sound_;  // members
  FrictionStart friction_start_ = FrictionStart::shared;
  IslandParts parts_;
  std::vector<std::vector<Crossing>> crossings_of_part_;
  std::vector<Crossing> crossings_;
  std::vector<Seam> seams_;                 // by colour
  std::deque<Share> shares_;                // parts, then seams
  std::vector<std::size_t> phases_;         // start of each phase in shares_, and the end
  std::vector<const Problem*> problem_of_;  // by body: the problem with its own rows
};

}  // namespace cohort::physics
