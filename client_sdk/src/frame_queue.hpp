#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "idl/wire/messages.hpp"

namespace cohort {

/// The frames of one client between arrival and answer (docs/protocol.md, "Frames and answers"): answers each one of a
/// lease once, in tick order, and keeps the latest answers for frames that the server sends again. Of a lease whose
/// robots are all free, only the newest. Pure logic, no thread of its own, no clock; allocates nothing once the frames
/// have their size.
class FrameQueue {
 public:
  /// A lease begins: forgets the answers, and drops the frames of other leases but those of later ones.
  void begin(const wire::Admit& admit);

  /// A frame came. One that was answered is due for a repeat; one that waits or is being answered is not taken twice;
  /// one of an earlier lease is dropped. Frames may come before their lease begins.
  void arrive(const wire::Observation& frame);

  /// The frame to answer next, or null. It is under way until `finish`; until then `begin` must not be called.
  const wire::Observation* next();
  /// Of the lease, all frames before it are answered, under way, or not to come.
  std::uint64_t next_tick() const { return next_tick_; }
  /// Takes the values that answer the frame under way, and gives the command to send. Valid until `begin` or until
  /// as many later answers as are kept.
  wire::Command finish(std::span<const double> values);
  /// An answer that the server asked for again, if there is one. Valid as what `finish` gives.
  std::optional<wire::Command> next_repeat();

 private:
  struct Frame {
    wire::Observation head;  // its spans are those of the vectors below
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

  void drop_older();
  bool in_order(const Frame& frame) const;
  std::uint64_t next_due(std::uint64_t tick) const;
  const Answer* find_answer(std::uint64_t tick) const;
  wire::Command command_of(const Answer& answer) const;

  std::optional<std::uint64_t> epoch_;  // of the lease: higher with each, whatever the run and the server
  std::uint32_t run_ = 0;
  std::uint64_t client_ = 0;
  std::uint64_t next_tick_ = 0;  // all before it are answered or under way
  std::uint64_t longest_delay_ = 0;
  bool newest_only_ = false;  // nobody waits for answers: older frames are not worth one
  std::vector<Schedule> schedules_;
  std::size_t answers_kept_ = 0;

  std::vector<Frame> waiting_;  // by lease, then tick
  std::vector<Frame> spare_;
  Frame under_way_;
  std::vector<Answer> answers_;  // a ring once it is full
  std::size_t oldest_answer_ = 0;
  struct Repeat {
    std::uint64_t tick;
    std::uint32_t resent;
  };
  std::vector<Repeat> repeats_;
};

}  // namespace cohort
