#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace cohort::physics {

/// Groups of things that touch, directly or through others. What an island is depends on the links alone, not on their
/// order.
class Islands {
 public:
  /// Begins anew, with every member of [0, count) on its own.
  void reset(std::uint32_t count);
  void link(std::uint32_t a, std::uint32_t b);
  /// After the last link: sorts the members.
  void finish();
  /// Then: what each of [0, count) is called from now on, ascending.
  void rename(std::span<const std::uint32_t> names) {
    for (std::uint32_t& member : members_) member = names[member];
  }

  /// Islands are in the order of their least members.
  std::uint32_t count() const { return static_cast<std::uint32_t>(begin_.size()) - 1; }
  /// Ascending.
  std::span<const std::uint32_t> members(std::uint32_t island) const {
    return {members_.data() + begin_[island], members_.data() + begin_[island + 1]};
  }

 private:
  std::uint32_t find(std::uint32_t member);

  std::vector<std::uint32_t> root_;    // a lower member of the same island, or itself
  std::vector<std::uint32_t> island_;  // by root
  std::vector<std::uint32_t> begin_{0};
  std::vector<std::uint32_t> members_;
};

}  // namespace cohort::physics
