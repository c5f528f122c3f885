// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "server/physics/islands/assembly.hpp"
#include "server/physics/islands/islands.hpp"

namespace cohort::physics {

/// Decides which bodies sleep: islands of which all bodies have been still for a while. Steps leave sleeping bodies and
/// the forces between them unchanged, until an awake body touches one of them or one is changed from outside. All
/// bodies that fell asleep together then wake. Sleep is part of the state. It is decided island by island, so it
/// depends only on bodies that are coupled. One thread only, except for `count`.
class Sleep {
 public:
  /// The assembly must outlive this.
  explicit Sleep(Assembly& assembly);

  /// Counts how long the member has been still; call it after each step of the member. Threads may call it for
  /// different members.
  void count(std::uint32_t index);
  /// Puts islands to sleep that have been still for long enough; call it after a step and all its consequences.
  void fall_asleep(const Islands& islands);
  /// Returns the members that fell asleep together with this sleeping one.
  std::vector<std::uint32_t> group_of(std::uint32_t index) const;
  /// Wakes a member and all that fell asleep together with it. For a member that is already awake, restarts the count
  /// of still steps.
  void wake(std::uint32_t index);
  /// Wakes the bodies at both ends of a connection, if it exists.
  void wake_ends(std::uint32_t number);
  /// Validates the groups of a restored world; throws SnapshotError if they are invalid.
  void check_groups() const;
  /// Wakes all bodies; call it after a change of static bodies.
  void wake_all();

 private:
  bool may_sleep(std::uint32_t index) const;
  void put_to_sleep(std::span<const std::uint32_t> members);

  Assembly& assembly_;
  std::uint32_t enough_;  // steps
};

}  // namespace cohort::physics
