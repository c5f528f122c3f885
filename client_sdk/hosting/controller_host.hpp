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

/// How to make controllers of one kind.
struct ControllerKind {
  std::string name;  ///< shown to people
  std::function<OwnedController()> create;
  bool has_state = true;  ///< they have `save` and `load`: of plugins of older interfaces, none have
  /// Makes one object that drives all robots of a process, in place of `create`; empty: each robot has a controller.
  std::function<std::unique_ptr<FrameHandler>()> create_for_all{};
};
ControllerKind kind_of(const Plugin& plugin);
/// Returns what drives the robots of a process by controllers of this kind.
std::unique_ptr<FrameHandler> make_handler(const ControllerKind& kind);

/// What a controller of `robot`, one of `admit`'s, is started with. Throws ControllerFailure if `admit` or
/// `descriptions` lack what it refers to.
Start start_of(const wire::Admit& admit, const wire::AdmittedRobot& robot,
               std::span<const wire::RobotDescription> descriptions);

/// The controllers of some robots in this process: turns frames into answers. Knows nothing of the network, so a
/// process of its own and a run in the server's process do the very same. One thread at a time.
class ControllerHost final : public FrameHandler {
 public:
  explicit ControllerHost(ControllerKind kind);
  explicit ControllerHost(const Plugin& plugin) : ControllerHost(kind_of(plugin)) {}
  ~ControllerHost() override;

  /// Creates a controller for each admitted robot (keeping those that it has if the reason is reset or restored) and
  /// calls `start`. `descriptions` holds at least those that `admit` names. Throws ControllerFailure, or LeaveRun if a
  /// controller did.
  void start(const wire::Admit& admit, std::span<const wire::RobotDescription> descriptions) override;

  /// The answer's values, robot after robot as in `frame.robots`. Valid until the next call. Throws as `start` does,
  /// also if the frame does not fit the descriptions.
  std::span<const double> answer(const wire::Observation& frame) override;

  /// What the controllers of all robots remember now, in the order of their ids. Throws SaveFailure, also if one
  /// writes more than `largest_state`, or LeaveRun if a controller did.
  std::vector<RobotState> save() const override;
  /// Right after `start`: lets the controllers go on from `states`, which may be of other robots too. Throws as `start`
  /// does, also if a controller leaves some of its state unread. A sentence for each kind of controllers whose state is
  /// of no use to these.
  std::vector<std::string> load(std::span<const RobotState> states) override;

 private:
  struct Robot;
  Robot* find(std::uint32_t id);
  void drop_controllers();

  ControllerKind kind_;
  std::vector<Robot> robots_;  // ascending ids
  std::size_t next_ = 0;       // where `find` looks first
  std::vector<double> values_;
};

}  // namespace cohort
