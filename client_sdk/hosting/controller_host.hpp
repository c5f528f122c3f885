// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "client_sdk/hosting/controller_state.hpp"
#include "client_sdk/hosting/frame_handler.hpp"
#include "client_sdk/include/cohort/controller.hpp"
#include "idl/wire/messages.hpp"

namespace cohort {

using OwnedController = std::unique_ptr<Controller, void (*)(Controller*)>;

/// A factory of controllers of one kind.
struct ControllerKind {
  std::string name;  ///< name in messages
  std::function<OwnedController()> create;
  bool has_state = true;  ///< controllers have `save` and `load`; false for plugins of older interfaces
  /// Creates one object that drives all robots of a process, instead of `create`. Empty: each robot has a controller.
  std::function<std::unique_ptr<FrameHandler>()> create_for_all{};
};
ControllerKind kind_of(const Plugin& plugin);
/// Creates the handler that drives the robots of a process with controllers of this kind.
std::unique_ptr<FrameHandler> make_handler(const ControllerKind& kind);

/// Returns the Start for the controller of `robot`, one of the robots in `admit`. Throws ControllerFailure if
/// `descriptions` lacks the description of this robot, or `admit` its team.
Start start_of(const wire::Admit& admit, const wire::AdmittedRobot& robot,
               std::span<const wire::RobotDescription> descriptions);

/// The controllers of robots in this process, which compute the answer to each frame. Independent of the network:
/// client processes and in-process runs use the same code. For one thread at a time.
class ControllerHost final : public FrameHandler {
 public:
  explicit ControllerHost(ControllerKind kind);
  explicit ControllerHost(const Plugin& plugin) : ControllerHost(kind_of(plugin)) {}
  ~ControllerHost() override;

  /// Creates a controller for each admitted robot and calls `start`. Keeps existing controllers if the reason is reset
  /// or restored. `descriptions` contains at least those that `admit` names. Throws ControllerFailure, or LeaveRun if a
  /// controller did.
  void start(const wire::Admit& admit, std::span<const wire::RobotDescription> descriptions) override;

  /// Returns the values of the answer, robot by robot as in `frame.robots`, valid until the next call. Throws as
  /// `start` does, also if the frame does not match the descriptions.
  std::span<const double> answer(const wire::Observation& frame) override;

  /// Returns the current state of all controllers, in the order of their ids. Throws SaveFailure, also if a state is
  /// larger than `largest_state`, or LeaveRun if a controller did.
  std::vector<RobotState> save() const override;
  /// Restores the controllers from `states`, which may include other robots; called right after `start`. Returns a
  /// warning for each kind of controller whose state cannot be used here. Throws as `start` does, also if a controller
  /// does not read all of its state.
  std::vector<std::string> load(std::span<const RobotState> states) override;

 private:
  struct Robot;
  Robot* find(std::uint32_t id);
  void drop_controllers();

  ControllerKind kind_;
  std::vector<Robot> robots_;  // in ascending order of ids
  std::size_t next_ = 0;       // where `find` starts
  std::vector<double> values_;
};

}  // namespace cohort
