// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "client_sdk/hosting/controller_state.hpp"
#include "idl/wire/messages.hpp"

namespace cohort {

/// Failure of a controller, with its robot, the function and the message.
class ControllerFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Failure of a controller to save its state, with its robot and the reason. The controller continues.
class SaveFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thrown to leave the run without a failure or an answer, as if the process had died.
struct LeaveRun {};

/// Thrown to leave a frame unanswered and continue with newer ones.
struct NoAnswer {};

/// The interface of a client that drives robots, independent of how frames arrive. For one thread at a time.
class FrameHandler {
 public:
  virtual ~FrameHandler() = default;

  /// Starts a lease, or restarts it after a reset. `descriptions` contains at least those that `admit` names. Throws
  /// ControllerFailure or LeaveRun.
  virtual void start(const wire::Admit& admit, std::span<const wire::RobotDescription> descriptions) = 0;

  /// Returns the values of the answer, robot by robot as in `frame.robots`, valid until the next call. Throws as
  /// `start` does, and NoAnswer.
  virtual std::span<const double> answer(const wire::Observation& frame) = 0;

  /// Returns the state of each robot, in the order of their ids. Throws SaveFailure or LeaveRun.
  virtual std::vector<RobotState> save() const = 0;

  /// Continues from `states`, which may include other robots; called right after `start`. Returns a warning for each
  /// kind of controller whose state cannot be used here. Throws as `start` does.
  virtual std::vector<std::string> load(std::span<const RobotState> states) = 0;
};

}  // namespace cohort
