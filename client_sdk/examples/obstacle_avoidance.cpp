// SPDX-License-Identifier: Apache-2.0

// Obstacle avoidance after Braitenberg (thesis, section 5.2.1), for the s-bot. Each track slows down for obstacles on
// the opposite side, so the robot turns away from them.
//
// It has no state, so a copy that takes over in the middle of a run continues without a difference.

#include <algorithm>
#include <array>
#include <cohort/controller.hpp>
#include <vector>

namespace {

// Weights of the four front sensors on each side, at 12, 36, 60 and 84 degrees from straight ahead. Obstacles beside
// the robot have lower weights.
constexpr std::array weights{1.0, 0.8, 0.6, 0.3};

constexpr double full_speed = 0.2;      // speed of a track [m/s]
constexpr double turning_speed = 0.1;   // speed of a track when turning on the spot [m/s]
constexpr double too_near = 0.5;        // halfway between the edge of the sensors' range and contact
constexpr double alignment_gain = 5.0;  // gain of the turret [1/s]

class ObstacleAvoidance final : public cohort::StatelessController {
 public:
  void start(const cohort::Start& start) override {
    proximity_ = start.observations("proximity/*/reading", 15);
    turret_position_ = start.observation("turret/0/position");
    turret_velocity_ = start.command("turret/0/velocity");
    left_track_ = start.command("treel/left/velocity");
    right_track_ = start.command("treel/right/velocity");
  }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    // Sensors are numbered counter-clockwise from the gripper: the first ones face left, the last ones face right.
    double left = 0.0;
    double right = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      left = std::max(left, weights[i] * observation[proximity_[i]]);
      right = std::max(right, weights[i] * observation[proximity_[proximity_.size() - 1 - i]]);
    }

    if (std::max(left, right) > too_near) {
      // Turn on the spot, always in the same direction. A robot that chose the freer side would oscillate in a corner.
      command.set(left_track_, -turning_speed);
      command.set(right_track_, turning_speed);
    } else {
      command.set(left_track_, full_speed * (1.0 - right));
      command.set(right_track_, full_speed * (1.0 - left));
    }
    // The sensors are on the turret: keep it aligned with the tracks.
    command.set(turret_velocity_, -alignment_gain * observation[turret_position_]);
  }

 private:
  std::vector<cohort::ObservationChannel> proximity_;
  cohort::ObservationChannel turret_position_;
  cohort::CommandChannel turret_velocity_;
  cohort::CommandChannel left_track_;
  cohort::CommandChannel right_track_;
};

}  // namespace

COHORT_CONTROLLER(ObstacleAvoidance)
