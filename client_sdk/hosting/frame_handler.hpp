#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "client_sdk/hosting/controller_state.hpp"
#include "idl/wire/messages.hpp"

namespace cohort {

/// A controller failed: which robot's, where, and its message.
class ControllerFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A controller cannot save its state: which robot's, and why. It goes on as it was.
class SaveFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thrown to leave the run as if the process had died: no failure, and no answer.
struct LeaveRun {};

/// What a client does with its robots, whatever carries the frames. One thread at a time.
class FrameHandler {
 public:
  virtual ~FrameHandler() = default;

  /// Begins a lease, or begins it again after a reset. `descriptions` holds at least those that `admit` names. Throws
  /// ControllerFailure or LeaveRun.
  virtual void start(const wire::Admit& admit, std::span<const wire::RobotDescription> descriptions) = 0;

  /// Returns the values of the answer, robot after robot as in `frame.robots`, valid until the next call. Throws as
  /// `start` does.
  virtual std::span<const double> answer(const wire::Observation& frame) = 0;

  /// Returns what is remembered of each robot, in the order of their ids. Throws SaveFailure or LeaveRun.
  virtual std::vector<RobotState> save() const = 0;

  /// Goes on from `states`, right after `start`; they may be of other robots too. Returns a sentence for each kind of
  /// controller whose state cannot be used here. Throws as `start` does.
  virtual std::vector<std::string> load(std::span<const RobotState> states) = 0;
};

}  // namespace cohort
