#include "server/physics/islands.hpp"

#include <numeric>

namespace cohort::physics {

std::uint32_t Islands::find(std::uint32_t member) {
  while (root_[member] != member) {
    root_[member] = root_[root_[member]];
    member = root_[member];
  }
  return member;
}

void Islands::build(std::uint32_t count, std::span<const std::pair<std::uint32_t, std::uint32_t>> links,
                    std::uint32_t batch_size) {
  root_.resize(count);
  std::iota(root_.begin(), root_.end(), 0u);
  for (const auto& [a, b] : links) {
    const std::uint32_t root_a = find(a);
    const std::uint32_t root_b = find(b);
    root_[std::max(root_a, root_b)] = std::min(root_a, root_b);
  }
  size_.assign(count, 0);
  for (std::uint32_t member = 0; member < count; ++member) {
    root_[member] = find(member);
    ++size_[root_[member]];
  }

  batch_.resize(count);
  batch_count_ = 0;
  std::uint32_t filled = 0;
  for (std::uint32_t member = 0; member < count; ++member) {
    if (root_[member] != member) continue;
    if (batch_count_ == 0 || filled + size_[member] > batch_size) {
      ++batch_count_;
      filled = 0;
    }
    filled += size_[member];
    batch_[member] = batch_count_ - 1;
  }
}

}  // namespace cohort::physics
