// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace cohort::physics {

/// A solver of linear complementarity problems with bounds (Dantzig's algorithm). It finds x between `lower` and
/// `upper`. A row of A x - b is zero if its x is between the limits, not negative at the lower limit, and not positive
/// at the upper one. Source: Baraff, "Fast contact force computation for nonpenetrating rigid bodies", SIGGRAPH 1994.
/// Rows are driven one after the other until they satisfy their conditions, while earlier rows stay satisfied. The
/// Cholesky factors of the free rows are updated as rows join and leave. The cost grows with the third power of the
/// number of rows.
///
/// Reuses its memory. Nothing is shared between objects.
class LinearComplementarity {
 public:
  /// Solves into `x`. `matrix`: symmetric and positive definite, by rows. Limits may be infinite; lower <= 0 <= upper.
  /// Returns false if it finds no solution because the matrix is not positive definite.
  bool solve(std::span<const double> matrix, std::span<const double> b, std::span<const double> lower,
             std::span<const double> upper, std::span<double> x);

 private:
  enum class Place : unsigned char { later, between, lower, upper };

  /// The first row that reaches or leaves a limit while x of the driven row changes.
  struct Change {
    double way = 0.0;  ///< change of x of the driven row until then
    std::size_t row = 0;
    Place becomes = Place::between;
  };

  bool drive(std::size_t row);
  bool may_stay(std::size_t row);
  Change first_change(std::size_t row, double sense) const;
  bool make(const Change& change);
  void find_directions(std::size_t row, double sense);
  bool insert(std::size_t row);
  void remove(std::size_t position);
  double at(std::size_t row, std::size_t column) const { return matrix_[row * size_ + column]; }
  double& factor(std::size_t row, std::size_t column) { return factors_[row * size_ + column]; }

  std::size_t size_ = 0;
  std::span<const double> matrix_;
  std::span<const double> lower_;
  std::span<const double> upper_;
  std::span<double> x_;
  std::vector<double> excess_;            // A x - b, by row
  std::vector<Place> places_;             // by row
  std::vector<std::size_t> between_;      // free rows, in the order of the factors
  std::vector<double> factors_;           // the lower triangle, by position in between_
  std::vector<double> change_of_x_;       // by position in between_, per unit change of the driven row
  std::vector<double> change_of_excess_;  // by row
  std::size_t moves_left_ = 0;
};

}  // namespace cohort::physics
