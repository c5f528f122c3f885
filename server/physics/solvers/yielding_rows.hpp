#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "server/physics/multibody/rows.hpp"
#include "server/physics/solvers/newton_on_rows.hpp"

namespace cohort::physics {

/// A row of YieldingRows.
struct YieldingRow : SmoothRow {
  bool is_free = false;  ///< the impulse is within its limits
  double compliance = 0.0;
  double forgotten = 0.0;         ///< share of the impulse that is missing in the next guess
  std::array<double, 2> guess{};  ///< guess of the impulse
};

/// The rows of a problem as functions of the velocities: each yields a little, so that its impulse is a first guess
/// plus (target - velocity) / compliance, within its limits. The limits of friction stay constant until they are
/// updated.
///
/// Reuses its memory.
class YieldingRows {
 public:
  using Term = YieldingRow;

  /// Takes the rows of `problem`, which must outlive this, and guesses the impulses of the last step.
  void gather(Problem& problem);
  /// Guesses the loads of new contacts: those that would stop the bodies. `along`: returns the velocity along a row.
  template <class Along>
  void guess_loads(Along&& along);

  const Row& row(const YieldingRow& term, std::size_t i = 0) const { return problem_->rows()[term.row + i]; }
  std::vector<YieldingRow>& terms() { return terms_; }
  const std::vector<YieldingRow>& terms() const { return terms_; }
  const std::vector<double>& impulses() const { return impulses_; }  ///< by row of the problem

  /// Returns whether the impulses satisfy all rows at their present velocities.
  bool are_settled(double negligible) const;
  /// Computes the impulse at a share of the change of the velocity, and its derivative.
  void evaluate(YieldingRow& term, double share) const;

  /// Keeps the impulses and takes them as the next guess. Returns the greatest velocity by which a row has yielded to a
  /// change of its impulse.
  double update_guesses();
  /// Computes the limits of friction from the impulses. Returns the greatest change of a limit that is reached, as the
  /// velocity change of a free body.
  double update_limits();

  /// Writes impulses and limits to the rows of the problem.
  void apply() const;

 private:
  bool is_settled(const YieldingRow& term, double negligible) const;
  void soften(YieldingRow& term, double response, double least) const;
  double response_of_heavier(const Row& row, double response) const;

  Problem* problem_ = nullptr;
  std::vector<YieldingRow> terms_;
  std::vector<double> impulses_;
};

template <class Along>
void YieldingRows::guess_loads(Along&& along) {
  for (YieldingRow& term : terms_) {
    const Row& of = row(term);
    if (of.has_fixed_limits() || term.upper > 0.0) continue;
    double load = 0.0;
    for (int j = of.load_begin; j < of.load_end; ++j) {
      const Row& other = problem_->rows()[static_cast<std::size_t>(j)];
      load += std::max(0.0, (other.target - along(other)) * other.inverse);
    }
    term.upper = std::min(of.cap, of.friction * load);
    term.lower = -term.upper;
  }
}

}  // namespace cohort::physics
