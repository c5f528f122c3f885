// SPDX-License-Identifier: Apache-2.0

// Drives an s-bot with commands that depend on all frames so far. A frame that is answered twice, left out or out of
// order changes the run, and so does another seed or parameter.

#include <cmath>
#include <cohort/controller.hpp>
#include <cstdint>
#include <vector>

namespace {

class Remembering final : public cohort::Controller {
 public:
  void start(const cohort::Start& start) override {
    constexpr std::uint64_t seeds = 1000;
    proximity_ = start.observations("proximity/*/reading");
    left_track_ = start.command("treel/left/velocity");
    right_track_ = start.command("treel/right/velocity");
    speed_ = start.parameters.real("speed");
    memory_ = static_cast<double>(start.seed % seeds) / static_cast<double>(seeds);
  }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    double seen = 0.0;
    for (const auto channel : proximity_) seen += observation[channel];
    // Below 1, and different after any difference in the past.
    memory_ = std::fmod(1.7 * memory_ + 0.1 * static_cast<double>(observation.tick()) + seen, 1.0);
    command.set(left_track_, speed_ * memory_);
    command.set(right_track_, speed_ * (1.0 - memory_));
  }

  void save(cohort::StateWriter& state) const override { state.write(memory_); }
  void load(cohort::StateReader& state) override { state.read(memory_); }

 private:
  std::vector<cohort::ObservationChannel> proximity_;
  cohort::CommandChannel left_track_;
  cohort::CommandChannel right_track_;
  double speed_ = 0.0;
  double memory_ = 0.0;
};

}  // namespace

COHORT_CONTROLLER(Remembering)
