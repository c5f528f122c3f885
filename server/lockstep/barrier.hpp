// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "server/core/snapshot.hpp"
#include "server/description/experiment.hpp"

namespace cohort::lockstep {

/// A time of the caller's clock; only differences matter.
using Time = std::chrono::nanoseconds;

/// Decides, tick by tick, which robots' answers the world waits for, and what happens without them. Pure logic: it
/// reads no clock, uses no network and never blocks. Not thread-safe.
///
/// At tick k a robot's answer to frame k - delay is required, if that frame was due; up to delay + 1 frames are
/// pending. A robot in free mode also receives frames, but its answers are not required: its newest answer acts.
class Barrier {
 public:
  /// Adds the robot with the next id, which receives frames from `tick` on; that tick is not opened yet.
  /// `command_size`: number of float64 values.
  void add(const description::Policy& policy, std::size_t command_size, std::uint64_t tick);

  /// Sets whether the robot is in the world, from the next opened tick on. A robot that is absent receives no frames.
  /// Initially, all robots are present. Pending frames stay as they are.
  void set_present(std::uint32_t robot, bool present) { robots_[robot].present = present; }

  /// Sets whether a client drives the robot, from the next opened tick on. If the robot loses its client, this takes
  /// effect at once: the barrier no longer waits for the robot, whose values are neutral. Initially, all robots are
  /// driven.
  void set_driven(std::uint32_t robot, bool driven);

  /// Opens tick `tick` at time `now`. The first call has tick 0, or the tick of the restored boundary; each further
  /// call has the next tick. The previous tick must be complete.
  void open(std::uint64_t tick, Time now);

  std::uint64_t tick() const { return tick_; }
  /// Returns true if no tick was opened yet.
  bool is_fresh() const { return is_fresh_; }
  /// Returns true if the robot receives a frame at this tick: not if it is detached, not driven or not in the world.
  bool is_due(std::uint32_t robot, std::uint64_t tick) const;

  enum class Asked { no, yes, unknown };
  /// Returns whether the frame of this tick contained the robot. The result is unknown if the barrier no longer keeps
  /// that frame, or if the frame was sent to a previous client.
  Asked was_asked(std::uint32_t robot, std::uint64_t frame_tick) const;

  enum class Verdict {
    accepted,
    repeated,  ///< the frame is already answered
    stale,     ///< too late to have an effect
    early,     ///< no such frame has been sent
  };
  /// Returns the verdict on an answer to the frame of `frame_tick`.
  Verdict judge(std::uint32_t robot, std::uint64_t frame_tick) const;
  /// Takes an answer that `judge` accepts. `now` matters only for robots in free mode.
  void answer(std::uint32_t robot, std::uint64_t frame_tick, std::span<const double> values, Time now = Time{0});
  /// Handles an invalid answer, which counts as a miss immediately. Under the policy `wait` the run must then stop.
  void refuse(std::uint32_t robot, std::uint64_t frame_tick, Time now = Time{0});

  bool complete() const { return awaited_count_ == 0; }
  bool is_awaited(std::uint32_t robot) const { return robots_[robot].awaited; }
  /// Returns true if a policy has detached the robot for good.
  bool is_detached(std::uint32_t robot) const { return robots_[robot].detached; }
  /// Returns the robots that the tick waits for, ascending.
  std::vector<std::uint32_t> awaited() const;
  Time opened_at() const { return opened_at_; }

  /// Returns the unanswered frames of the robot, oldest first. A client that takes over the robot must receive them.
  std::vector<std::uint64_t> unanswered(std::uint32_t robot) const;

  struct Miss {
    std::uint32_t robot;
    std::uint64_t frame_tick;
    description::OnLate consequence;
    Time waited;
    bool refused = false;  ///< an answer arrived in time, but was invalid
  };
  /// Returns when `expire` is next due while the tick is not complete; nothing if no awaited robot has a deadline.
  std::optional<Time> next_deadline() const;
  /// Stops waiting for robots whose deadline has passed, and returns a miss for each. A robot in free mode has one miss
  /// for each period of silence.
  std::vector<Miss> expire(Time now);
  /// Returns the misses caused by refused answers since the last call; for a robot in free mode, one for each period of
  /// silence.
  std::vector<Miss> take_refused() { return std::exchange(refused_, {}); }

  struct Outcome {
    enum class Kind {
      keep,     ///< nothing was due, or the last command stays
      command,  ///< `values` act from this tick on
      neutral,  ///< the neutral values act from this tick on
    };
    Kind kind = Kind::keep;
    std::span<const double> values;  ///< valid until the next `open`
  };
  /// Returns the tick's outcome for the robot. The tick must be complete.
  Outcome outcome(std::uint32_t robot) const;

  /// Calls `visit(robot, values)` for the stored answers: new, acting or future.
  template <class Visit>
  void for_each_answer(Visit&& visit) const {
    for (std::uint32_t id = 0; id < robots_.size(); ++id)
      for (const Answer& answer : robots_[id].answers)
        if (answer.state == Answer::State::given || (robots_[id].answered && &answer == robots_[id].answers.data()))
          visit(id, std::span<const double>(answer.values));
  }

  /// Saves, at a boundary, the answers that have not taken effect yet, and the detached robots. Times are not saved.
  void save(SnapshotWriter& writer) const;
  /// Restores a barrier with the same policies and sizes, before the first `open`. Throws SnapshotError.
  void restore(SnapshotReader& reader);

 private:
  struct Answer {
    enum class State { none, given, missed, refused } state = State::none;
    bool asked = false;  // the frame is sent
    std::vector<double> values;
  };
  struct Robot {
    description::Policy policy;
    std::vector<Answer> answers;     // by frame tick, modulo delay + 1
    std::uint64_t first_tick = 0;    // the robot's first tick
    std::uint64_t driven_since = 0;  // first tick of its present driver
    bool present = true;
    bool driven = true;
    bool awaited = false;
    bool detached = false;
    // State of a robot in free mode.
    std::optional<std::uint64_t> answered{};  // frame of the acting answer, stored first in `answers`
    Time heard_at{0};                         // time of the last answer, or of the opening before the first
    bool silent = false;                      // for longer than its deadline
  };
  static Answer& answer_of(Robot& robot, std::uint64_t frame_tick) {
    return robot.answers[place_of(robot, frame_tick)];
  }
  static const Answer& answer_of(const Robot& robot, std::uint64_t frame_tick) {
    return robot.answers[place_of(robot, frame_tick)];
  }
  // Avoids a division by a number that is mostly 1, which would dominate the cost of a tick here.
  static std::size_t place_of(const Robot& robot, std::uint64_t frame_tick) {
    return robot.policy.delay == 0 ? 0 : frame_tick % robot.answers.size();
  }
  /// Returns the frame whose answer acts at this tick, if there is one.
  std::optional<std::uint64_t> acting_frame(const Robot& robot) const;
  void settle(Robot& robot);
  bool is_too_late(const Robot& robot, Time now) const;
  static bool is_too_silent(const Robot& robot, Time now);
  static bool is_free(const Robot& robot) { return robot.policy.mode == description::Mode::free; }
  /// Returns true if the barrier keeps the robot's frame of this tick.
  bool is_under_way(const Robot& robot, std::uint64_t tick) const {
    return tick <= tick_ && tick + robot.policy.delay >= tick_;
  }
  /// Considers only the robot's policy and its first tick.
  static bool is_asked(const Robot& robot, std::uint64_t tick) {
    if (tick < robot.policy.phase || tick < robot.first_tick) return false;
    return robot.policy.period == 1 || (tick - robot.policy.phase) % robot.policy.period == 0;
  }

  std::vector<Robot> robots_;
  std::vector<Miss> refused_;  // not taken yet
  std::uint64_t tick_ = 0;
  Time opened_at_{0};
  std::size_t awaited_count_ = 0;
  bool is_fresh_ = true;  // no tick was opened yet
};

}  // namespace cohort::lockstep
