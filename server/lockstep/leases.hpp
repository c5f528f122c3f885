#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/lockstep/barrier.hpp"

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
    bool alive = true;                  ///< says liveliness
    Time heard_until{0};                ///< what liveliness calls dead and yet answers counts as alive until then
    /// The last answer: when it came, to which frame, and which of the copies that were sent of it.
    Time answered_at{0};
    std::uint64_t answered_tick = 0;
    std::uint32_t answered_copy = 0;
    std::uint64_t answer_count = 0;
    struct Answered {
      std::uint64_t tick;
      Time at;
    };
    std::vector<Answered> news{};  ///< answers since `drain_news`; at most 64
  };

  /// Robots have come: there are so many now.
  void note_robots(std::uint32_t robot_count) { holder_.resize(robot_count); }

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
  Decisions decide(Time now, MayGrant&& may_grant) {
    Decisions decisions;
    std::erase_if(claims_,
                  [&](const Claim& claim) { return decide_one(claim, now, may_grant(claim.robots), decisions); });
    return decisions;
  }

  /// Null if the client has no lease.
  const Lease* lease(std::uint64_t client) const;
  const std::map<std::uint64_t, Lease>& all() const { return leases_; }
  std::optional<std::uint64_t> holder(std::uint32_t robot) const { return holder_[robot]; }
  std::uint64_t next_epoch() const { return next_epoch_; }
  bool has_claims() const { return !claims_.empty(); }

  /// The client, which has a lease, answered a frame. If liveliness called it dead, it lives for a second more: one
  /// that was stopped and goes on may die for good before liveliness has called it alive again, and then says nothing
  /// more.
  void note_answer(std::uint64_t client, Time now = Time{0}, std::uint64_t tick = 0, std::uint32_t copy = 0);
  /// Calls `note` with each answer of the client since this was last called, if it has a lease.
  template <class Note>
  void drain_news(std::uint64_t client, Note&& note) {
    const auto found = leases_.find(client);
    if (found == leases_.end()) return;
    for (const Lease::Answered& answered : found->second.news) note(answered);
    found->second.news.clear();
  }
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
  static bool is_dead(const Lease& lease, Time now) { return !lease.alive && now >= lease.heard_until; }
  bool decide_one(const Claim& claim, Time now, bool may_grant, Decisions& decisions);
  std::uint64_t answers_of_holder(std::uint32_t robot) const;

  std::vector<std::optional<std::uint64_t>> holder_;  // by robot
  std::map<std::uint64_t, Lease> leases_;             // by client
  std::map<std::uint64_t, std::uint64_t> answers_;    // by client
  std::vector<Claim> claims_;
  std::uint64_t next_epoch_;
};

}  // namespace cohort::lockstep
