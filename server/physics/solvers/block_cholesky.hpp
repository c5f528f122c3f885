// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace cohort::physics {

/// A symmetric positive definite matrix of blocks, one row and column of blocks per body, and its Cholesky factors. The
/// bodies are eliminated in the order of minimum degree. The cost grows linearly with their number if they form a chain
/// or a tree. Source: George and Liu, "Computer solution of large sparse positive definite systems", 1981, chapter 5.
///
/// A block has the size of its bodies' degrees of freedom; its rows are padded with zeros to a multiple of `lanes`.
/// Vectors hold the entries of one body after the other, with the same padding. Reuses its memory.
class BlockCholesky {
 public:
  /// Starts a matrix. `sizes`: degrees of freedom by body.
  void reset(const std::vector<int>& sizes);
  /// Adds the off-diagonal block that couples two different bodies.
  void couple(int a, int b);
  /// Finds the order of elimination and sets all blocks to zero. Call it after the last `couple`. Returns false if a
  /// factorisation would take more than `most_work` multiplications.
  bool order(double most_work);

  /// Start of a body's entries in a vector.
  std::size_t offset(int body) const { return offsets_[static_cast<std::size_t>(body)]; }
  std::size_t length() const { return offsets_.back(); }  ///< length of a vector

  /// The off-diagonal block of two coupled bodies, or the lower triangle of the diagonal block of one body. Its rows
  /// belong to the body `row`, its columns to `column`.
  struct Block {
    std::size_t begin = 0;
    int row = 0;     ///< body
    int column = 0;  ///< body
  };
  Block block(int a, int b) const;
  double* values(const Block& block) { return values_.data() + block.begin; }
  void clear();

  /// Replaces the blocks by the factors.
  void factorise();
  /// Solves matrix * y = x in place.
  void solve(double* x) const;

 private:
  struct Below {
    int body = 0;
    std::size_t begin = 0;
  };
  const Below& below(int column, int row) const;
  void subtract_products(int column);

  std::vector<int> sizes_;  // degrees of freedom, by body
  std::vector<std::ptrdiff_t> strides_;
  std::vector<std::size_t> offsets_;
  std::vector<std::vector<int>> neighbours_;  // not yet eliminated, ascending
  std::vector<std::vector<Below>> below_;     // by column: later bodies that it is coupled to, by rank
  std::vector<std::size_t> diagonal_;         // by body: start of its block
  std::vector<int> order_;                    // bodies by rank
  std::vector<int> rank_;                     // by body
  std::vector<int> merged_;                   // scratch
  std::vector<double> values_;
  std::vector<double> inverse_;  // reciprocals of the diagonal of the factors; a vector
};

}  // namespace cohort::physics
