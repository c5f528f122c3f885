// SPDX-License-Identifier: Apache-2.0
#include "server/physics/solvers/linear_complementarity.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "server/core/infinity.hpp"

namespace cohort::physics {

bool LinearComplementarity::solve(std::span<const double> matrix, std::span<const double> b,
                                  std::span<const double> lower, std::span<const double> upper, std::span<double> x) {
  size_ = b.size();
  assert(matrix.size() == size_ * size_ && lower.size() == size_ && upper.size() == size_ && x.size() == size_);
  assert(std::ranges::equal(lower, upper, std::ranges::less_equal()));
  matrix_ = matrix;
  lower_ = lower;
  upper_ = upper;
  x_ = x;
  std::ranges::fill(x_, 0.0);
  excess_.resize(size_);
  std::ranges::transform(b, excess_.begin(), [](double wanted) { return -wanted; });
  places_.assign(size_, Place::later);
  between_.clear();
  factors_.resize(size_ * size_);
  change_of_x_.resize(size_);
  change_of_excess_.resize(size_);
  moves_left_ = 20 * size_ + 100;
  // Rows without limits first: they never have to move again.
  for (const bool limited : {false, true})
    for (std::size_t row = 0; row < size_; ++row)
      if ((std::isfinite(lower_[row]) || std::isfinite(upper_[row])) == limited && !drive(row)) return false;
  return true;
}

// Moves x of `row`, and of all free rows with it, from zero until the row satisfies its condition.
bool LinearComplementarity::drive(std::size_t row) {
  while (!may_stay(row)) {
    const double sense = excess_[row] < 0.0 ? 1.0 : -1.0;
    find_directions(row, sense);
    if (!(sense * change_of_excess_[row] > 0.0) || moves_left_-- == 0) return false;
    const Change change = first_change(row, sense);
    x_[row] += sense * change.way;
    for (std::size_t i = 0; i < between_.size(); ++i) x_[between_[i]] += change.way * change_of_x_[i];
    for (std::size_t other = 0; other < size_; ++other) excess_[other] += change.way * change_of_excess_[other];
    if (!make(change)) return false;
    if (change.row == row) return true;
  }
  return true;
}

// A row at a limit, with an excess that keeps it there, stays at this limit.
bool LinearComplementarity::may_stay(std::size_t row) {
  const bool at_lower = excess_[row] >= 0.0 && x_[row] <= lower_[row];
  const bool at_upper = excess_[row] <= 0.0 && x_[row] >= upper_[row];
  if (at_lower || at_upper) places_[row] = at_lower ? Place::lower : Place::upper;
  return at_lower || at_upper;
}

LinearComplementarity::Change LinearComplementarity::first_change(std::size_t row, double sense) const {
  Change first{-excess_[row] / change_of_excess_[row], row, Place::between};
  const auto reaches = [&](double way, std::size_t its_row, Place place) {
    if (way < first.way) first = {std::max(0.0, way), its_row, place};
  };
  if (sense > 0.0)
    reaches(upper_[row] - x_[row], row, Place::upper);
  else
    reaches(x_[row] - lower_[row], row, Place::lower);
  for (std::size_t i = 0; i < between_.size(); ++i) {
    const std::size_t other = between_[i];
    if (change_of_x_[i] > 0.0) reaches((upper_[other] - x_[other]) / change_of_x_[i], other, Place::upper);
    if (change_of_x_[i] < 0.0) reaches((lower_[other] - x_[other]) / change_of_x_[i], other, Place::lower);
  }
  for (std::size_t other = 0; other < size_; ++other) {
    if (lower_[other] == upper_[other]) continue;
    const double change = change_of_excess_[other];
    if ((places_[other] == Place::lower && change < 0.0) || (places_[other] == Place::upper && change > 0.0))
      reaches(-excess_[other] / change, other, Place::between);
  }
  return first;
}

bool LinearComplementarity::make(const Change& change) {
  const std::size_t row = change.row;
  if (change.becomes == Place::between) {
    excess_[row] = 0.0;
    return insert(row);
  }
  x_[row] = change.becomes == Place::upper ? upper_[row] : lower_[row];
  if (places_[row] == Place::between)
    remove(static_cast<std::size_t>(std::ranges::find(between_, row) - between_.begin()));
  places_[row] = change.becomes;
  return true;
}

// Computes how x of the free rows, and the excess of all others, change with x of `row`.
void LinearComplementarity::find_directions(std::size_t row, double sense) {
  const std::size_t count = between_.size();
  for (std::size_t i = 0; i < count; ++i) {
    double sum = -sense * at(between_[i], row);
    for (std::size_t k = 0; k < i; ++k) sum -= factor(i, k) * change_of_x_[k];
    change_of_x_[i] = sum / factor(i, i);
  }
  for (std::size_t i = count; i-- > 0;) {
    change_of_x_[i] /= factor(i, i);
    for (std::size_t k = 0; k < i; ++k) change_of_x_[k] -= factor(i, k) * change_of_x_[i];
  }
  for (std::size_t other = 0; other < size_; ++other) change_of_excess_[other] = sense * at(row, other);
  for (std::size_t i = 0; i < count; ++i) {
    const double change = change_of_x_[i];
    const double* const gains = matrix_.data() + between_[i] * size_;
    for (std::size_t other = 0; other < size_; ++other) change_of_excess_[other] += change * gains[other];
  }
  for (const std::size_t other : between_) change_of_excess_[other] = 0.0;
}

bool LinearComplementarity::insert(std::size_t row) {
  const std::size_t count = between_.size();
  double rest = at(row, row);
  for (std::size_t i = 0; i < count; ++i) {
    double sum = at(row, between_[i]);
    for (std::size_t k = 0; k < i; ++k) sum -= factor(i, k) * factor(count, k);
    factor(count, i) = sum / factor(i, i);
    rest -= factor(count, i) * factor(count, i);
  }
  if (!(rest > 0.0)) return false;
  factor(count, count) = std::sqrt(rest);
  between_.push_back(row);
  places_[row] = Place::between;
  return true;
}

// The rows below move up; Givens rotations of pairs of columns restore the triangle (Golub and Van Loan, "Matrix
// computations", 1996, section 12.5.3).
void LinearComplementarity::remove(std::size_t position) {
  between_.erase(between_.begin() + static_cast<std::ptrdiff_t>(position));
  const std::size_t count = between_.size();
  for (std::size_t i = position; i < count; ++i) std::copy_n(&factor(i + 1, 0), i + 2, &factor(i, 0));
  for (std::size_t k = position; k < count; ++k) {
    const double length = std::sqrt(factor(k, k) * factor(k, k) + factor(k, k + 1) * factor(k, k + 1));
    const double cosine = factor(k, k) / length;
    const double sine = factor(k, k + 1) / length;
    for (std::size_t i = k; i < count; ++i) {
      const double left = factor(i, k);
      const double right = factor(i, k + 1);
      factor(i, k) = cosine * left + sine * right;
      factor(i, k + 1) = cosine * right - sine * left;
    }
  }
}

}  // namespace cohort::physics
