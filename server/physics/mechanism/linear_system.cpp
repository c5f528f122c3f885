// SPDX-License-Identifier: Apache-2.0
#include "server/physics/mechanism/linear_system.hpp"

#include <cmath>
#include <utility>

#include "server/physics/mechanism/lanes.hpp"

namespace cohort::physics {

void LinearSystem::reset(int size) {
  size_ = size;
  entries_.assign(at(std::ptrdiff_t{size} * size), 0.0);
  pivots_.assign(at(size), 0);
}

double& LinearSystem::operator()(int row, int column) { return entries_[at(std::ptrdiff_t{row} * size_ + column)]; }

void LinearSystem::factorise() {
  LinearSystem& matrix = *this;
  for (int k = 0; k < size_; ++k) {
    int pivot = k;
    for (int row = k + 1; row < size_; ++row)
      if (std::abs(matrix(row, k)) > std::abs(matrix(pivot, k))) pivot = row;
    pivots_[at(k)] = pivot;
    if (pivot != k)
      for (int column = 0; column < size_; ++column) std::swap(matrix(k, column), matrix(pivot, column));
    for (int row = k + 1; row < size_; ++row) {
      const double factor = matrix(row, k) / matrix(k, k);
      matrix(row, k) = factor;
      for (int column = k + 1; column < size_; ++column) matrix(row, column) -= factor * matrix(k, column);
    }
  }
}

void LinearSystem::solve(double* x) const {
  for (int k = 0; k < size_; ++k) std::swap(x[k], x[pivots_[at(k)]]);
  for (int row = 0; row < size_; ++row)
    for (int column = 0; column < row; ++column)
      x[row] -= entries_[at(std::ptrdiff_t{row} * size_ + column)] * x[column];
  for (int row = size_ - 1; row >= 0; --row) {
    for (int column = row + 1; column < size_; ++column)
      x[row] -= entries_[at(std::ptrdiff_t{row} * size_ + column)] * x[column];
    x[row] /= entries_[at(std::ptrdiff_t{row} * (size_ + 1))];
  }
}

}  // namespace cohort::physics
