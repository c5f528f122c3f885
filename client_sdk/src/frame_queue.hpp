// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "idl/wire/messages.hpp"

namespace cohort {

/// The frames of one client between arrival and answer (docs/protocol.md, "Frames and answers"). Answers each frame of
/// a lease once, in tick order, and keeps the latest answers for frames that the server sends again. If all robots of a
/// lease are free, it answers only the newest frame. Pure logic without threads or clocks; allocates no memory once its
/// buffers have grown to the size of the frames.
class FrameQueue {
 public:
  /// Starts a lease: discards the answers, and the frames of earlier leases.
  void begin(const wire::Admit& admit);

  /// Continues a lease that now has more robots and a new epoch: keeps the answers.
  void extend(const wire::Admit& admit);

  /// Adds a frame. A frame that was answered is scheduled for a repeat. A frame that waits or is being answered is
  /// ignored, and one of an earlier lease is dropped. Frames may arrive before their lease starts.
  void arrive(const wire::Observation& frame);

  /// Returns the next frame to answer, or null. It is being answered until `finish`; do not call `begin` before.
  const wire::Observation* next();
  /// Returns the tick before which all frames of the lease are answered, being answered, or not expected.
  std::uint64_t next_tick() const { return next_tick_; }
  /// Finishes the current frame with the values of its answer, and returns the command to send. Valid until `begin`, or
  /// until more answers follow than are kept.
  wire::Command finish(std::span<const double> values);
  /// Finishes the current frame without an answer.
  void leave_unanswered() { spare_.push_back(std::move(under_way_)); }
  /// Returns an answer that the server requested again, if there is one. Valid like the result of `finish`.
  std::optional<wire::Command> next_repeat();

 private:
  struct Frame {
    wire::Observation head;  // its spans refer to the vectors below
    std::vector<std::uint32_t> robots;
    std::vector<double> values;
    int came_again = 0;
  };
  struct Answer {
    std::uint64_t tick = 0;
    std::uint32_t resent = 0;
    std::vector<std::uint32_t> robots;
    std::vector<double> values;
  };
  struct Schedule {
    std::uint64_t period;
    std::uint64_t phase;
    bool operator==(const Schedule&) const = default;
  };

  void take_schedules(const wire::Admit& admit);
  void drop_waiting_before();
  void drop_older();
  bool in_order(const Frame& frame) const;
  std::uint64_t next_due(std::uint64_t tick) const;
  const Answer* find_answer(std::uint64_t tick) const;
  wire::Command command_of(const Answer& answer) const;

  std::optional<std::uint64_t> epoch_;  // increases with each lease, across runs and servers
  std::uint32_t run_ = 0;
  std::uint64_t client_ = 0;
  std::uint64_t next_tick_ = 0;  // all frames before it are answered or being answered
  std::uint64_t longest_delay_ = 0;
  bool newest_only_ = false;  // the run does not wait for answers: older frames are useless
  std::vector<Schedule> schedules_;
  std::size_t answers_kept_ = 0;

  std::vector<Frame> waiting_;  // sorted by lease, then tick
  std::vector<Frame> spare_;
  Frame under_way_;
  std::vector<Answer> answers_;  // a ring buffer once it is full
  std::size_t oldest_answer_ = 0;
  struct Repeat {
    std::uint64_t tick;
    std::uint32_t resent;
  };
  std::vector<Repeat> repeats_;
};

}  // namespace cohort
