// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "client_sdk/hosting/frame_handler.hpp"
#include "client_sdk/include/cohort/client.hpp"
#include "client_sdk/src/hand_over.hpp"

namespace cohort {

/// Drives robots by handing all events to a program's loop.
class LoopHost final : public FrameHandler {
 public:
  /// `name` is that of the program, and identifies its saved states.
  LoopHost(std::string name, HandOver& hand_over) : name_(std::move(name)), hand_over_(hand_over) {}

  const std::string& name() const { return name_; }

  void start(const wire::Admit& admit, std::span<const wire::RobotDescription> descriptions) override;
  std::span<const double> answer(const wire::Observation& frame) override;
  std::vector<RobotState> save() const override;
  std::vector<std::string> load(std::span<const RobotState> states) override;

 private:
  struct Layout {
    std::size_t observation_size = 0;
    std::vector<double> neutral;
  };
  // Returns the index of a robot. Throws ControllerFailure if this client does not drive it.
  std::size_t place_of(std::uint32_t robot, std::uint64_t tick) const;

  const std::string name_;
  HandOver& hand_over_;
  std::vector<DrivenRobot> robots_;  // in ascending order of ids
  std::vector<Layout> layouts_;      // one per robot
  std::vector<FrameRobot> frame_;    // reused
  std::vector<double> values_;
};

}  // namespace cohort
