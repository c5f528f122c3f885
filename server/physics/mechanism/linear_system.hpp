#pragma once

#include <vector>

namespace cohort::physics {

/// A square matrix, of no particular form, and what it times a vector is solved for: Gauss's elimination with the
/// greatest pivot of each column, in sums whose order depends on the size alone.
class LinearSystem {
 public:
  /// All entries become zero.
  void reset(int size);
  double& operator()(int row, int column);

  /// Before the next one, and after the last entry was set.
  void factorise();
  /// In place: the solution of the matrix times it = `x`. Not finite where the matrix cannot be inverted.
  void solve(double* x) const;

 private:
  int size_ = 0;
  std::vector<double> entries_;  // row by row; then the factors, upper and below the diagonal lower
  std::vector<int> pivots_;
};

}  // namespace cohort::physics
