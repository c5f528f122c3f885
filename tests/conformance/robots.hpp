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

/// The controllers of an admitted client's robots.
class Robots {
 public:
  explicit Robots(const std::string& plugin) : plugin_(plugin) {}

  /// As docs/protocol.md has it under "Leases": new controllers, but for a reset or restored world. Throws what a
  /// controller throws, and std::runtime_error if `descriptions` lacks one.
  void start(const message::Admit& admit, const std::map<std::uint32_t, message::RobotDescription>& descriptions);

  /// What the controllers remember, by robot.
  std::vector<RobotState> save() const;
  /// Throws std::runtime_error where it is the state of other controllers.
  void load(const std::vector<RobotState>& states);

  /// Throws what a controller throws, and std::runtime_error if the frame is not as the descriptions say.
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
