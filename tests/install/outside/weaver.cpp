// SPDX-License-Identifier: Apache-2.0

// Drives in waves, away from near obstacles: sums of products and functions of the C library, whose last bits may
// differ from one CPU to another.

#include <cmath>
#include <cohort/controller.hpp>
#include <vector>

namespace {

class Weaver final : public cohort::Controller {
 public:
  void start(const cohort::Start& start) override {
    proximity_ = start.observations("proximity/*/reading");
    left_ = start.command("treel/left/velocity");
    right_ = start.command("treel/right/velocity");
    phase_ = 0.7 * static_cast<double>(start.robot);
  }
  void step(const cohort::Observation& observation, cohort::Command& command) override {
    const double t = std::chrono::duration<double>(observation.time()).count();
    double left = 0.0;
    double right = 0.0;
    for (std::size_t i = 0; i < proximity_.size(); ++i) {
      const double bearing = 2.1 * static_cast<double>(i) + phase_;
      left += observation[proximity_[i]] * std::sin(bearing);
      right += observation[proximity_[i]] * std::cos(bearing);
    }
    const double heading = std::atan2(left, 1.0 + right * right);
    const double wave = 0.05 * std::sin(3.7 * t + phase_) + 0.01 * std::log(1.0 + t) + 0.02 * heading;
    command.set(left_, 0.1 * std::exp(-0.3 * t) + wave);
    command.set(right_, 0.1 * std::cos(0.9 * t) - wave);
  }

 private:
  std::vector<cohort::ObservationChannel> proximity_;
  cohort::CommandChannel left_;
  cohort::CommandChannel right_;
  double phase_ = 0.0;
};

}  // namespace

COHORT_CONTROLLER(Weaver)
