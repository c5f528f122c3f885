#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace cohort::physics {

/// Groups of things that touch, packed into batches for the solver. What is in a batch depends on the links alone:
/// islands in the order of their least member, filled up to `batch_size` members.
class Islands {
 public:
  /// Joins linked members of [0, count). Then `batch_of` and `batch_count` hold.
  void build(std::uint32_t count, std::span<const std::pair<std::uint32_t, std::uint32_t>> links,
             std::uint32_t batch_size);

  std::uint32_t batch_of(std::uint32_t member) const { return batch_[root_[member]]; }
  std::uint32_t batch_count() const { return batch_count_; }

 private:
  std::uint32_t find(std::uint32_t member);

  std::vector<std::uint32_t> root_;  // least member of its island
  std::vector<std::uint32_t> size_;
  std::vector<std::uint32_t> batch_;
  std::uint32_t batch_count_ = 0;
};

}  // namespace cohort::physics
