// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace cohort::physics {

/// A system of linear equations with a general square matrix. Solved by Gaussian elimination with partial pivoting; the
/// order of the sums depends only on the size.
class LinearSystem {
 public:
  /// Sets the size and all entries to zero.
  void reset(int size);
  double& operator()(int row, int column);

  /// Factorises the matrix. Call it after the last entry was set and before `solve`.
  void factorise();
  /// Solves matrix * y = x in place. The result is not finite if the matrix is singular.
  void solve(double* x) const;

 private:
  int size_ = 0;
  std::vector<double> entries_;  // by row: the matrix, then its factors L (below the diagonal) and U
  std::vector<int> pivots_;
};

}  // namespace cohort::physics
