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

/// A point on whatever clock the caller uses; only differences count.
using Time = std::chrono::nanoseconds;

/// Decides, tick by tick, whose answers the world waits for and what it does without them. Pure logic: it reads no
/// clock, knows no network and never blocks. Not thread-safe.
///
/// At tick k a robot's answer to frame k - delay is needed, if that frame was due; up to delay + 1 frames are under
/// way. A robot that is free is asked too, but nothing is needed of it: the newest answer that has come acts.
class Barrier {
 public:
  /// The robot with the next id, which is asked from `tick` on; that is not opened yet. `command_size`: float64 values.
  void add(const description::Policy& policy, std::size_t command_size, std::uint64_t tick);

  /// Whether the robot is in the world, from the tick on that is opened next: one that is not is not asked. At first
  /// all are. Frames under way stay as they are.
  void set_present(std::uint32_t robot, bool present) { robots_[robot].present = present; }

  /// Whether somebody drives the robot, from the tick on that is opened next; taken away, from now on: then it is no
  /// longer awaited, and has its neutral values. At first all are driven.
  void set_driven(std::uint32_t robot, bool driven);

  /// Starts tick `tick` at time `now`; the first call has tick 0, or that of the boundary at which what was restored
  /// was saved, each further one the next tick. The tick before must be complete.
  void open(std::uint64_t tick, Time now);

  std::uint64_t tick() const { return tick_; }
  /// Whether nothing was opened yet.
  bool is_fresh() const { return is_fresh_; }
  /// Whether the robot is asked at this tick: one that is detached, not driven or not in the world is not.
  bool is_due(std::uint32_t robot, std::uint64_t tick) const;

  enum class Verdict {
    accepted,
    repeated,  ///< that frame is answered already
    stale,     ///< that frame can no longer act
    early,     ///< no such frame has been sent
  };
  /// Whether an answer to the frame of `frame_tick` would be accepted.
  Verdict judge(std::uint32_t robot, std::uint64_t frame_tick) const;
  /// Takes an answer that `judge` accepts. `now` counts for those that are free.
  void answer(std::uint32_t robot, std::uint64_t frame_tick, std::span<const double> values, Time now = Time{0});
  /// An answer that cannot act: a miss at once. Under `wait` nothing else can come of it, so the run has to stop.
  void refuse(std::uint32_t robot, std::uint64_t frame_tick, Time now = Time{0});

  bool complete() const { return awaited_count_ == 0; }
  bool is_awaited(std::uint32_t robot) const { return robots_[robot].awaited; }
  /// For good, by a policy.
  bool is_detached(std::uint32_t robot) const { return robots_[robot].detached; }
  /// Ascending.
  std::vector<std::uint32_t> awaited() const;
  Time opened_at() const { return opened_at_; }

  /// Frames sent to the robot and not answered, oldest first: what whoever takes it over has to be given.
  std::vector<std::uint64_t> unanswered(std::uint32_t robot) const;

  struct Miss {
    std::uint32_t robot;
    std::uint64_t frame_tick;
    description::OnLate consequence;
    Time waited;
    bool refused = false;  ///< an answer came in time, and cannot act
  };
  /// When `expire` has something to do next while the tick is not complete; never if nobody who is awaited has a
  /// deadline.
  std::optional<Time> next_deadline() const;
  /// Gives up on those whose deadline has passed. Each is a miss, and no longer awaited. One that is free misses once
  /// for each silence.
  std::vector<Miss> expire(Time now);
  /// The misses of answers that were refused since this was last called; of a free robot, one for each silence.
  std::vector<Miss> take_refused() { return std::exchange(refused_, {}); }

  struct Outcome {
    enum class Kind {
      keep,     ///< nothing was due, or the last command holds
      command,  ///< `values` act from this tick on
      neutral,  ///< the neutral values act from this tick on
    };
    Kind kind = Kind::keep;
    std::span<const double> values;  ///< valid until the next `open`
  };
  /// What the tick gives the robot. Once the tick is complete.
  Outcome outcome(std::uint32_t robot) const;

  /// Calls `visit(robot, values)` for the answers that have come, acted or will act.
  template <class Visit>
  void for_each_answer(Visit&& visit) const {
    for (std::uint32_t id = 0; id < robots_.size(); ++id)
      for (const Answer& answer : robots_[id].answers)
        if (answer.state == Answer::State::given || (robots_[id].answered && &answer == robots_[id].answers.data()))
          visit(id, std::span<const double>(answer.values));
  }

  /// At a boundary: answers that have come and do not act yet, and who is asked no more. Not times.
  void save(SnapshotWriter& writer) const;
  /// Of a barrier of the same policies and sizes, before the first `open`. Throws SnapshotError.
  void restore(SnapshotReader& reader);

 private:
  struct Answer {
    enum class State { none, given, missed, refused } state = State::none;
    bool asked = false;  // whether the frame goes out
    std::vector<double> values;
  };
  struct Robot {
    description::Policy policy;
    std::vector<Answer> answers;   // by frame tick, modulo delay + 1
    std::uint64_t first_tick = 0;  // it was not there before
    bool present = true;
    bool driven = true;
    bool awaited = false;
    bool detached = false;
    // Of a free one.
    std::optional<std::uint64_t> answered{};  // the frame whose answer acts, in the first of `answers`
    Time heard_at{0};                         // of the last answer, or the opening before the first
    bool silent = false;                      // for too long
  };
  static Answer& answer_of(Robot& robot, std::uint64_t frame_tick) {
    return robot.answers[place_of(robot, frame_tick)];
  }
  static const Answer& answer_of(const Robot& robot, std::uint64_t frame_tick) {
    return robot.answers[place_of(robot, frame_tick)];
  }
  // Divisions by a number that is mostly 1 would be the better part of a tick's cost here.
  static std::size_t place_of(const Robot& robot, std::uint64_t frame_tick) {
    return robot.policy.delay == 0 ? 0 : frame_tick % robot.answers.size();
  }
  /// The frame whose answer acts at this tick, if there is one.
  std::optional<std::uint64_t> acting_frame(const Robot& robot) const;
  void settle(Robot& robot);
  bool is_too_late(const Robot& robot, Time now) const;
  static bool is_too_silent(const Robot& robot, Time now);
  static bool is_free(const Robot& robot) { return robot.policy.mode == description::Mode::free; }
  /// By the robot's policy alone, once it is there.
  static bool is_asked(const Robot& robot, std::uint64_t tick) {
    if (tick < robot.policy.phase || tick < robot.first_tick) return false;
    return robot.policy.period == 1 || (tick - robot.policy.phase) % robot.policy.period == 0;
  }

  std::vector<Robot> robots_;
  std::vector<Miss> refused_;  // and not taken yet
  std::uint64_t tick_ = 0;
  Time opened_at_{0};
  std::size_t awaited_count_ = 0;
  bool is_fresh_ = true;  // nothing was opened yet
};

}  // namespace cohort::lockstep
