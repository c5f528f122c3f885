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
/// The island is cut into parts. Rows within a part are the part's; rows between parts are sorted by the parts that
/// they couple, one seam for each such set, and seams that share a part get different colours. A pass of the solver
/// goes over all parts at once, then over all seams of the first colour at once, and so on; every second pass goes the
/// other way round. So no two workers ever change the same body, and the result depends on neither their number nor
/// their speed: it is that of sequential impulses in another order of the rows.
class LargeIslandSolver {
 public:
  /// Larger islands are for this solver, whatever the number of workers: the order of the rows is part of the result.
  static constexpr std::size_t least_bodies = 96;

  explicit LargeIslandSolver(WorkerPool& workers) : workers_(workers) {}

  /// A body whose state breaks is left where it is, and the rest of the island solved without it.
  void solve(Assembly& assembly, std::span<const std::uint32_t> members);

 private:
  /// Of a part or a seam.
  struct Share {
    explicit Share(IslandBodies& bodies) : problem(bodies) {}

    Problem problem;
    double change = 0.0;  // by the last pass
  };
  /// Two parts, the lower one first. What couples more than two is `several`.
  using Parts = std::pair<std::uint32_t, std::uint32_t>;
  static constexpr std::uint32_t no_part = 0xffffffffu;
  static constexpr Parts several{no_part, no_part};

  /// What adds its rows to a seam: the own rows of a member whose tracks stand on another part, a connection or a pair.
  struct Crossing {
    Parts parts;
    std::uint32_t member = 0;  // with its own rows, if it is neither of these:
    Connection* connection = nullptr;
    SolidPair* pair = nullptr;
  };
  struct Seam {
    std::size_t begin = 0;  // of its crossings
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
  /// Returns the greatest change of a row's velocity by the last of them.
  double run_passes(std::uint32_t most);
  template <class Work>
  void for_each_share(std::size_t phase, Work&& work);

  WorkerPool& workers_;
  IslandBodies bodies_;
  std::vector<std::uint32_t> sound_;  // members
  IslandParts parts_;
  std::vector<std::vector<Crossing>> crossings_of_part_;
  std::vector<Crossing> crossings_;
  std::vector<Seam> seams_;                 // by colour
  std::deque<Share> shares_;                // of the parts, then of the seams
  std::vector<std::size_t> phases_;         // where the shares of each phase begin, and the end
  std::vector<const Problem*> problem_of_;  // by body: the one with its own rows
};

}  // namespace cohort::physics
