// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cohort/controller.hpp>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "cohort.h"
#include "tests/conformance/plugin.hpp"
#include "tests/conformance/states.hpp"

namespace cohort::conformance {

namespace message = ::cohort::v1;

/// The controllers of the robots of an admitted client.
class Robots {
 public:
  explicit Robots(const std::string& plugin) : plugin_(plugin) {}

  /// Creates new controllers, except for a reset or restored world (docs/protocol.md, "Leases"). Throws exceptions of
  /// controllers, and std::runtime_error if `descriptions` lacks one.
  void start(const message::Admit& admit, const std::map<std::uint32_t, message::RobotDescription>& descriptions);

  /// Returns the state of the controllers, by robot.
  std::vector<RobotState> save() const;
  /// Restores the state; throws std::runtime_error if it is that of other controllers.
  void load(const std::vector<RobotState>& states);

  /// Returns the answer to a frame. Throws exceptions of controllers, and std::runtime_error if the frame does not
  /// match the descriptions.
  message::Command answer(const message::Observation& frame);

 private:
  struct Robot {
    OwnedController controller;
    std::size_t observation_size;
    std::vector<double> neutral;
  };
  PluginFile plugin_;
  std::map<std::uint32_t, Robot> robots_;
};

}  // namespace cohort::conformance
