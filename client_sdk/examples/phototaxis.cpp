// SPDX-License-Identifier: Apache-2.0

// Phototaxis after Braitenberg (thesis, section 5.2.2), for the s-bot. Each track slows down for obstacles on the
// opposite side, so the robot turns away from them. It slows down for light on its own side, so the robot turns towards
// lamps. Near a lamp, the light stops both tracks.
//
// It has no state.

#include <algorithm>
#include <cohort/sbot.hpp>

namespace {

constexpr double full_speed = 0.2;     // speed of a track [m/s]
constexpr double turning_speed = 0.1;  // speed of a track when turning on the spot [m/s]
constexpr double too_near = 0.5;       // proximity reading of an obstacle
constexpr double arrived = 0.75;       // reading of the brightest light sensor, about 0.7 m from a lamp of intensity 1
constexpr double darkness = 0.03;      // greatest noise of a light sensor in darkness

class Phototaxis final : public cohort::StatelessController {
 public:
  void start(const cohort::Start& start) override { robot_ = cohort::Sbot(start); }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    const cohort::Sbot::Sides near = robot_.obstacles(observation);
    // Light sensor 0 faces ahead, sensor 4 behind.
    double brightest = 0.0;
    for (const cohort::ObservationChannel sensor : robot_.light) brightest = std::max(brightest, observation[sensor]);
    double light_left = 0.0;
    double light_right = 0.0;
    for (std::size_t i = 1; i < 4; ++i) {
      light_left += observation[robot_.light[i]];
      light_right += observation[robot_.light[8 - i]];
    }
    robot_.align_turret(observation, command);
    if (brightest > arrived) return;  // the tracks stop

    if (std::max(near.left, near.right) > too_near) {
      // Turn on the spot, always in the same direction. A robot that chose the freer side would oscillate in a corner.
      robot_.turn(command, 0.0, turning_speed);
      return;
    }
    // The contrast between the sides does not depend on the distance to the lamp.
    const double contrast = brightest > darkness ? (light_left - light_right) / (light_left + light_right) : 0.0;
    robot_.drive(command, full_speed * (1.0 - near.right - std::max(0.0, contrast)),
                 full_speed * (1.0 - near.left - std::max(0.0, -contrast)));
  }

 private:
  cohort::Sbot robot_;
};

}  // namespace

COHORT_CONTROLLER(Phototaxis)
