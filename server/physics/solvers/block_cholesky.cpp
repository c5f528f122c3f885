// SPDX-License-Identifier: Apache-2.0
#include "server/physics/solvers/block_cholesky.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>

#include "server/physics/mechanism/lanes.hpp"

namespace cohort::physics {
namespace {

std::ptrdiff_t padded(int size) { return (std::max(size, 1) + lanes - 1) / lanes * lanes; }

// As `dot` for vectors of any length.
double dot_of(const double* a, const double* b, std::ptrdiff_t length) {
  const std::ptrdiff_t whole = length / lanes * lanes;
  double sum = whole > 0 ? dot(a, b, whole) : 0.0;
  for (std::ptrdiff_t i = whole; i < length; ++i) sum += a[i] * b[i];
  return sum;
}

// Solves x L' = x in place for a row x; `factor` is L.
void solve_row(const double* factor, std::ptrdiff_t stride, const double* inverse, double* x, int size) {
  for (int j = 0; j < size; ++j) x[j] = (x[j] - dot_of(x, factor + j * stride, j)) * inverse[j];
}

}  // namespace

void BlockCholesky::reset(const std::vector<int>& sizes) {
  sizes_ = sizes;
  const std::size_t count = sizes.size();
  strides_.resize(count);
  offsets_.resize(count + 1);
  offsets_[0] = 0;
  for (std::size_t body = 0; body < count; ++body) {
    strides_[body] = padded(sizes[body]);
    offsets_[body + 1] = offsets_[body] + static_cast<std::size_t>(strides_[body]);
  }
  if (neighbours_.size() < count) neighbours_.resize(count);
  if (below_.size() < count) below_.resize(count);
  for (std::size_t body = 0; body < count; ++body) neighbours_[body].clear();
}

void BlockCholesky::couple(int a, int b) {
  assert(a != b);
  const auto insert = [&](int body, int other) {
    std::vector<int>& around = neighbours_[at(body)];
    const auto place = std::lower_bound(around.begin(), around.end(), other);
    if (place == around.end() || *place != other) around.insert(place, other);
  };
  insert(a, b);
  insert(b, a);
}

bool BlockCholesky::order(double most_work) {
  const int count = static_cast<int>(sizes_.size());
  order_.clear();
  rank_.assign(at(count), -1);
  double work = 0.0;
  while (order_.size() < at(count)) {
    int next = -1;
    for (int body = 0; body < count; ++body)
      if (rank_[at(body)] < 0 && (next < 0 || neighbours_[at(body)].size() < neighbours_[at(next)].size())) next = body;
    rank_[at(next)] = static_cast<int>(order_.size());
    order_.push_back(next);
    const std::vector<int>& around = neighbours_[at(next)];
    double rows = 0.0;
    for (const int body : around) {
      rows += sizes_[at(body)];
      std::vector<int>& theirs = neighbours_[at(body)];
      merged_.clear();
      std::set_union(theirs.begin(), theirs.end(), around.begin(), around.end(), std::back_inserter(merged_));
      std::erase_if(merged_, [&](int other) { return other == body || other == next; });
      theirs = merged_;
    }
    const double size = sizes_[at(next)];
    work += size * (size * size / 6.0 + 0.5 * size * rows + 0.5 * rows * rows);
    if (work > most_work) return false;
  }

  diagonal_.resize(at(count));
  std::size_t length = 0;
  for (const int body : order_) {
    diagonal_[at(body)] = length;
    length += at(sizes_[at(body)] * strides_[at(body)]);
    std::vector<Below>& column = below_[at(body)];
    column.clear();
    for (const int other : neighbours_[at(body)]) column.push_back({other, 0});
    std::ranges::sort(column, {}, [&](const Below& entry) { return rank_[at(entry.body)]; });
    for (Below& entry : column) {
      entry.begin = length;
      length += at(sizes_[at(entry.body)] * strides_[at(body)]);
    }
  }
  values_.assign(length, 0.0);
  inverse_.assign(offsets_.back(), 0.0);
  return true;
}

void BlockCholesky::clear() { std::ranges::fill(values_, 0.0); }

const BlockCholesky::Below& BlockCholesky::below(int column, int row) const {
  const auto found = std::ranges::lower_bound(below_[at(column)], rank_[at(row)], {},
                                              [&](const Below& entry) { return rank_[at(entry.body)]; });
  assert(found != below_[at(column)].end() && found->body == row);
  return *found;
}

BlockCholesky::Block BlockCholesky::block(int a, int b) const {
  if (a == b) return {diagonal_[at(a)], a, a};
  const bool is_a_later = rank_[at(a)] > rank_[at(b)];
  const int row = is_a_later ? a : b;
  const int column = is_a_later ? b : a;
  return {below(column, row).begin, row, column};
}

// Column after column: the factors of a column are final when the products of all columns before have been subtracted.
void BlockCholesky::factorise() {
  for (const int body : order_) {
    const int size = sizes_[at(body)];
    const std::ptrdiff_t stride = strides_[at(body)];
    double* const own = values_.data() + diagonal_[at(body)];
    double* const inverse = inverse_.data() + offsets_[at(body)];
    for (int i = 0; i < size; ++i) {
      double* const row = own + i * stride;
      solve_row(own, stride, inverse, row, i);
      const double diagonal = std::sqrt(row[i] - dot_of(row, row, i));
      row[i] = diagonal;
      inverse[i] = 1.0 / diagonal;
      std::fill(row + i + 1, row + stride, 0.0);
    }
    for (const Below& entry : below_[at(body)])
      for (int i = 0; i < sizes_[at(entry.body)]; ++i)
        solve_row(own, stride, inverse, values_.data() + entry.begin + i * stride, size);
    subtract_products(body);
  }
}

// Subtracts the products of the rows of a column from the blocks of later columns.
void BlockCholesky::subtract_products(int column) {
  const std::ptrdiff_t inner = strides_[at(column)];
  const std::vector<Below>& rows = below_[at(column)];
  for (std::size_t j = 0; j < rows.size(); ++j) {
    const int later = rows[j].body;
    const std::ptrdiff_t stride = strides_[at(later)];
    const double* const of_column = values_.data() + rows[j].begin;
    auto entry = below_[at(later)].begin();
    for (std::size_t i = j; i < rows.size(); ++i) {
      if (i > j)
        while (entry->body != rows[i].body) ++entry;
      assert(i == j || entry < below_[at(later)].end());
      double* const into = values_.data() + (i == j ? diagonal_[at(later)] : entry->begin);
      const double* const of_row = values_.data() + rows[i].begin;
      for (int r = 0; r < sizes_[at(rows[i].body)]; ++r)
        for (int c = 0; c < (i == j ? r + 1 : sizes_[at(later)]); ++c)
          into[r * stride + c] -= dot(of_row + r * inner, of_column + c * inner, inner);
    }
  }
}

void BlockCholesky::solve(double* x) const {
  for (const int body : order_) {
    const std::ptrdiff_t stride = strides_[at(body)];
    double* const own = x + offsets_[at(body)];
    solve_row(values_.data() + diagonal_[at(body)], stride, inverse_.data() + offsets_[at(body)], own,
              sizes_[at(body)]);
    for (const Below& entry : below_[at(body)]) {
      double* const other = x + offsets_[at(entry.body)];
      for (int r = 0; r < sizes_[at(entry.body)]; ++r)
        other[r] -= dot(values_.data() + entry.begin + r * stride, own, stride);
    }
  }
  for (std::size_t rank = order_.size(); rank-- > 0;) {
    const int body = order_[rank];
    const std::ptrdiff_t stride = strides_[at(body)];
    double* const own = x + offsets_[at(body)];
    for (const Below& entry : below_[at(body)]) {
      const double* const other = x + offsets_[at(entry.body)];
      for (int r = 0; r < sizes_[at(entry.body)]; ++r)
        add_scaled(-other[r], values_.data() + entry.begin + r * stride, own, stride);
    }
    const double* const factor = values_.data() + diagonal_[at(body)];
    const double* const inverse = inverse_.data() + offsets_[at(body)];
    for (int j = sizes_[at(body)] - 1; j >= 0; --j) {
      own[j] *= inverse[j];
      for (int q = 0; q < j; ++q) own[q] -= factor[j * stride + q] * own[j];
    }
  }
}

}  // namespace cohort::physics
