// SPDX-License-Identifier: Apache-2.0
#include "server/physics/solvers/block_cholesky.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "server/core/random.hpp"

namespace cohort::test {
namespace {

using physics::BlockCholesky;

// Bodies of different sizes with couplings: a chain, a star, a ring or random pairs.
struct System {
  std::vector<int> sizes;
  std::vector<std::pair<int, int>> couplings;
};
std::vector<System> systems() {
  const RandomStream random(5, "block_cholesky", "systems");
  std::vector<System> systems;
  for (std::uint64_t number = 0; number < 40; ++number) {
    std::uint32_t drawn = 0;
    const auto below = [&](int end) { return static_cast<int>(random.uniform(number, drawn++) * end); };
    System system;
    const int bodies = 1 + below(12);
    for (int body = 0; body < bodies; ++body) system.sizes.push_back(1 + below(13));
    for (int body = 1; body < bodies; ++body) {
      if (number % 4 == 0) system.couplings.emplace_back(body - 1, body);
      if (number % 4 == 1) system.couplings.emplace_back(body, 0);
      if (number % 4 == 2) system.couplings.emplace_back(body, (body + 1) % bodies);
      if (number % 4 == 3) system.couplings.emplace_back(body, below(body));
    }
    std::erase_if(system.couplings, [](const auto& pair) { return pair.first == pair.second; });
    systems.push_back(system);
  }
  return systems;
}

// Writes a value to both triangles of the dense matrix, and to the blocks.
struct Both {
  BlockCholesky blocks;
  Eigen::MatrixXd dense;
  std::vector<int> first;  // row of the dense matrix, by body

  std::ptrdiff_t stride(int size) const { return (size + 3) / 4 * 4; }
  void add(int a, int row, int b, int column, double value, const std::vector<int>& sizes) {
    const BlockCholesky::Block block = blocks.block(a, b);
    const bool is_turned = block.row != a;
    const int size = sizes[static_cast<std::size_t>(block.column)];
    blocks.values(block)[(is_turned ? column : row) * stride(size) + (is_turned ? row : column)] += value;
    const int i = first[static_cast<std::size_t>(a)] + row;
    const int j = first[static_cast<std::size_t>(b)] + column;
    dense(i, j) += value;
    if (a != b) dense(j, i) += value;
  }
};

TEST(BlockCholesky, SolvesAsADenseFactorisationDoes) {
  constexpr double any_work = 1e12;
  BlockCholesky reused;
  for (const System& system : systems()) {
    const RandomStream random(6, "block_cholesky", "values");
    std::uint32_t drawn = 0;
    const auto draw = [&] { return 2.0 * random.uniform(system.sizes.size(), drawn++) - 1.0; };
    Both both;
    both.blocks = reused;  // with memory from the system before
    int count = 0;
    for (const int size : system.sizes) {
      both.first.push_back(count);
      count += size;
    }
    both.dense.setZero(count, count);
    both.blocks.reset(system.sizes);
    for (const auto& [a, b] : system.couplings) both.blocks.couple(a, b);
    ASSERT_TRUE(both.blocks.order(any_work));
    const auto size_of = [&](int body) { return system.sizes[static_cast<std::size_t>(body)]; };
    for (int body = 0; body < static_cast<int>(system.sizes.size()); ++body)
      for (int i = 0; i < size_of(body); ++i)
        for (int j = 0; j < size_of(body); ++j)
          both.add(body, i, body, j, i == j ? 50.0 : 0.1 * (i + j), system.sizes);  // diagonally dominant
    for (const auto& [a, b] : system.couplings)
      for (int i = 0; i < size_of(a); ++i)
        for (int j = 0; j < size_of(b); ++j) both.add(a, i, b, j, 0.3 * draw(), system.sizes);

    Eigen::VectorXd wanted(count);
    std::vector<double> x(both.blocks.length(), 0.0);
    for (std::size_t body = 0; body < system.sizes.size(); ++body)
      for (int i = 0; i < system.sizes[body]; ++i)
        wanted[both.first[body] + i] = x[both.blocks.offset(static_cast<int>(body)) + static_cast<std::size_t>(i)] =
            draw();
    const Eigen::VectorXd expected = both.dense.llt().solve(wanted);
    both.blocks.factorise();
    both.blocks.solve(x.data());
    for (std::size_t body = 0; body < system.sizes.size(); ++body)
      for (int i = 0; i < system.sizes[body]; ++i)
        EXPECT_NEAR(x[both.blocks.offset(static_cast<int>(body)) + static_cast<std::size_t>(i)],
                    expected[both.first[body] + i], 1e-12);
    reused = both.blocks;
  }
}

TEST(BlockCholesky, RefusesWhatCostsTooMuch) {
  BlockCholesky blocks;
  blocks.reset({6, 6, 6});
  blocks.couple(0, 1);
  blocks.couple(1, 2);
  EXPECT_TRUE(blocks.order(1e4));
  blocks.reset({6, 6, 6});
  blocks.couple(0, 1);
  blocks.couple(1, 2);
  EXPECT_FALSE(blocks.order(100.0));
}

}  // namespace
}  // namespace cohort::test
