#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace cohort::lockstep {

/// Who drives which robots. One client has one lease for all its robots, with an epoch that is never used again; a
/// client that loses one robot loses its lease. Pure logic, like the barrier. Not thread-safe.
///
/// A claim on free robots is granted. A claim on a robot that somebody holds waits: it is granted once every holder is
/// known to be dead, and refused once a holder shows that it lives by answering. So a controller that was killed can be
/// started again before its death is noticed, and nobody takes robots from a controller that works.
class Leases {
 public:
  explicit Leases(std::uint32_t robot_count, std::uint64_t first_epoch = 1)
      : holder_(robot_count), next_epoch_(first_epoch) {}

  struct Lease {
    std::uint64_t epoch = 0;
    std::vector<std::uint32_t> robots;  ///< ascending
    bool alive = true;
  };

  /// `robots`: ascending, at least one. A client's new claim stands in for its earlier one that still waits.
  void claim(std::uint64_t client, std::vector<std::uint32_t> robots);

  struct Granted {
    std::uint64_t client;
    std::vector<std::uint64_t> superseded;  ///< clients whose lease ended by it
    bool again;                             ///< the client held just these robots before
  };
  struct Refused {
    std::uint64_t client;
    std::uint32_t robot;  ///< one that is held
    std::uint64_t holder;
  };
  struct Decisions {
    std::vector<Granted> granted;
    std::vector<Refused> refused;
  };
  /// Decides the claims that can be decided now and `may_grant(robots)` allows, in the order they came.
  template <class MayGrant>
  Decisions decide(MayGrant&& may_grant) {
    Decisions decisions;
    std::erase_if(claims_, [&](const Claim& claim) { return decide_one(claim, may_grant(claim.robots), decisions); });
    return decisions;
  }

  /// Null if the client has no lease.
  const Lease* lease(std::uint64_t client) const;
  const std::map<std::uint64_t, Lease>& all() const { return leases_; }
  std::optional<std::uint64_t> holder(std::uint32_t robot) const { return holder_[robot]; }
  std::uint64_t next_epoch() const { return next_epoch_; }
  bool has_claims() const { return !claims_.empty(); }

  /// The client, which has a lease, answered a frame: it lives, whatever liveliness said last.
  void note_answer(std::uint64_t client);
  /// What liveliness says.
  void set_alive(std::uint64_t client, bool alive);
  /// The client left for good: its robots are free, its claim is gone.
  void release(std::uint64_t client);

 private:
  struct Claim {
    std::uint64_t client;
    std::vector<std::uint32_t> robots;
    std::vector<std::uint64_t> answers_before;  // of each robot's holder, when the claim came
  };
  void end_lease(std::uint64_t client);
  bool decide_one(const Claim& claim, bool may_grant, Decisions& decisions);
  std::uint64_t answers_of_holder(std::uint32_t robot) const;

  std::vector<std::optional<std::uint64_t>> holder_;  // by robot
  std::map<std::uint64_t, Lease> leases_;             // by client
  std::map<std::uint64_t, std::uint64_t> answers_;    // by client
  std::vector<Claim> claims_;
  std::uint64_t next_epoch_;
};

}  // namespace cohort::lockstep
