// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

#include "client_sdk/include/cohort/controller.hpp"
#include "idl/wire/messages.hpp"

namespace cohort::test {

/// A controller that commands its number of steps, the tick, twice its reading, and the reason of its start. Throws if
/// it reads -1.
class CountingController final : public Controller {
 public:
  void start(const Start& start) override {
    reading_ = start.observation("sensor/0/reading");
    steps_channel_ = start.command("count/0/steps");
    tick_channel_ = start.command("count/0/tick");
    doubled_channel_ = start.command("count/0/doubled");
    reason_channel_ = start.command("count/0/reason");
    reason_ = start.reason;
  }

  void step(const Observation& observation, Command& command) override {
    if (observation[reading_] == -1.0) throw std::runtime_error("it hurts");
    command.set(steps_channel_, ++steps_);
    command.set(tick_channel_, static_cast<double>(observation.tick()));
    command.set(doubled_channel_, 2.0 * observation[reading_]);
    command.set(reason_channel_, static_cast<double>(reason_));
  }

  static Plugin plugin() {
    return {Plugin::current_abi, "counting", []() -> Controller* { return new CountingController; },
            [](Controller* controller) { delete controller; }};
  }

  static wire::RobotDescription description(std::uint32_t id = 0) {
    constexpr double most = 1e9;
    return {id,
            "counter",
            {{"sensor/0/reading", "1", 1, -1.0, 1.0, 0.0}},
            {{"count/0/steps", "1", 1, 0.0, most, 0.0},
             {"count/0/tick", "1", 1, 0.0, most, 0.0},
             {"count/0/doubled", "1", 1, -most, most, 0.0},
             {"count/0/reason", "1", 1, 0.0, 3.0, 0.0},
             {"count/0/unused", "1", 2, -1.0, 1.0, 0.25}}};
  }

 private:
  ObservationChannel reading_;
  CommandChannel steps_channel_;
  CommandChannel tick_channel_;
  CommandChannel doubled_channel_;
  CommandChannel reason_channel_;
  StartReason reason_ = StartReason::first;
  int steps_ = 0;
};

}  // namespace cohort::test
