#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "server/physics/islands/assembly.hpp"
#include "server/physics/islands/islands.hpp"

namespace cohort::physics {

/// Which bodies sleep: those that have been still for a while, with all that they touch and hang together with. Steps
/// leave them as they are, and the forces between them, until something that is awake touches one of them or one is
/// changed from outside; then all wake that fell asleep together. Who sleeps is part of the state. It is decided island
/// by island, so it depends on nothing that an island is not coupled to. One thread alone, but for `count`.
class Sleep {
 public:
  /// The assembly must outlive this.
  explicit Sleep(Assembly& assembly);

  /// After a step of the member: whether it was still, and for how long. Different members from different threads.
  void count(std::uint32_t index);
  /// After a step and all that came of it: the islands sleep that have been still for long enough.
  void fall_asleep(const Islands& islands);
  /// All that fell asleep with the member, which sleeps.
  std::vector<std::uint32_t> group_of(std::uint32_t index) const;
  /// They are awake; a member that is has not been still until now.
  void wake(std::uint32_t index);
  /// What a connection holds, if it is there.
  void wake_ends(std::uint32_t number);
  /// Of a world that was restored. Throws SnapshotError if the groups are none.
  void check_groups() const;
  /// After a change of what stands still.
  void wake_all();

 private:
  bool may_sleep(std::uint32_t index) const;
  void put_to_sleep(std::span<const std::uint32_t> members);

  Assembly& assembly_;
  std::uint32_t enough_;  // steps
};

}  // namespace cohort::physics
