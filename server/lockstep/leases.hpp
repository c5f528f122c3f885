// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/lockstep/barrier.hpp"

namespace cohort::lockstep {

/// The leases of clients on robots. One client has one lease for all its robots, with a unique epoch; a client that
/// loses one robot loses its lease. Pure logic, like the barrier. Not thread-safe.
///
/// A claim on free robots is granted. A claim on a robot with a holder waits: it is granted once all holders are known
/// to be dead, and refused once a holder answers. So a killed controller can be restarted before its death is noticed,
/// and a working controller never loses its robots.
class Leases {
 public:
  explicit Leases(std::uint32_t robot_count, std::uint64_t first_epoch = 1)
      : holder_(robot_count), next_epoch_(first_epoch) {}

  struct Lease {
    std::uint64_t epoch = 0;
    std::vector<std::uint32_t> robots;  ///< ascending
    bool alive = true;                  ///< according to DDS liveliness
    Time heard_until{0};                ///< until then it counts as alive, as it has answered
    /// The last answer: its time, its frame, and the copy of the frame that it answers.
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

  /// Notes added robots; `robot_count` is the new number.
  void note_robots(std::uint32_t robot_count) { holder_.resize(robot_count); }

  /// Adds a claim on `robots`: ascending, at least one. It replaces an earlier claim of the client that still waits.
  void claim(std::uint64_t client, std::vector<std::uint32_t> robots);

  /// Gives a lease other robots, ascending and at least one, which no other client holds, and a new epoch.
  void change(std::uint64_t client, std::vector<std::uint32_t> robots);

  struct Granted {
    std::uint64_t client;
    std::vector<std::uint64_t> superseded;  ///< clients that lose their lease because of it
    bool again;                             ///< the client held exactly these robots before
  };
  struct Refused {
    std::uint64_t client;
    std::uint32_t robot;  ///< a robot with a holder
    std::uint64_t holder;
  };
  struct Decisions {
    std::vector<Granted> granted;
    std::vector<Refused> refused;
  };
  /// Decides the claims that can be decided now and that `may_grant(robots)` allows, in order of arrival.
  template <class MayGrant>
  Decisions decide(Time now, MayGrant&& may_grant) {
    Decisions decisions;
    std::erase_if(claims_,
                  [&](const Claim& claim) { return decide_one(claim, now, may_grant(claim.robots), decisions); });
    return decisions;
  }

  /// Returns null if the client has no lease.
  const Lease* lease(std::uint64_t client) const;
  const std::map<std::uint64_t, Lease>& all() const { return leases_; }
  std::optional<std::uint64_t> holder(std::uint32_t robot) const { return holder_[robot]; }
  std::uint64_t next_epoch() const { return next_epoch_; }
  bool has_claims() const { return !claims_.empty(); }

  /// Notes an answer of the client, which has a lease. A client that DDS liveliness reported dead then counts as alive
  /// for one more second. A process that was stopped and continues may die for good before it is reported alive again,
  /// and no further report would follow.
  void note_answer(std::uint64_t client, Time now = Time{0}, std::uint64_t tick = 0, std::uint32_t copy = 0);
  /// Calls `note` with each answer of the client since the last call, if it has a lease.
  template <class Note>
  void drain_news(std::uint64_t client, Note&& note) {
    const auto found = leases_.find(client);
    if (found == leases_.end()) return;
    for (const Lease::Answered& answered : found->second.news) note(answered);
    found->second.news.clear();
  }
  /// Notes a report of DDS liveliness.
  void set_alive(std::uint64_t client, bool alive);
  /// Removes a client that has left for good: its robots are free, and its claim is dropped.
  void release(std::uint64_t client);

 private:
  struct Claim {
    std::uint64_t client;
    std::vector<std::uint32_t> robots;
    std::vector<std::uint64_t> answers_before;  // answers of each robot's holder at the time of the claim
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
