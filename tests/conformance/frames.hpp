// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "cohort.h"

namespace cohort::conformance {

namespace message = ::cohort::v1;

/// The frames of one lease, in the order in which docs/protocol.md requires answers ("Order when frames are lost"), and
/// the latest answers ("Sending again"). Has no input or output.
class Frames {
 public:
  explicit Frames(const message::Admit& admit);

  enum class Kind { of_the_lease, of_an_earlier_one, of_a_later_one };
  Kind kind_of(const message::Observation& frame) const;

  /// Adds a received frame of the lease. Returns its answer if it has been answered.
  const message::Command* arrive(message::Observation frame);
  /// Returns the frame to answer now, if any.
  std::optional<message::Observation> next();
  /// Keeps the answer to the last frame that `next` returned.
  void keep(const message::Command& answer);

 private:
  struct Waiting {
    message::Observation frame;
    int came_again = 0;
  };
  bool is_due(std::uint64_t tick) const;
  bool misses_an_earlier_one(std::uint64_t tick) const;

  std::uint64_t epoch_;
  std::uint64_t next_tick_;  // ticks before it are answered or skipped
  std::uint64_t highest_ = 0;
  std::uint64_t longest_delay_ = 0;
  std::vector<message::AdmittedRobot> robots_;
  std::map<std::uint64_t, Waiting> waiting_;
  std::deque<message::Command> answers_;
};

}  // namespace cohort::conformance
