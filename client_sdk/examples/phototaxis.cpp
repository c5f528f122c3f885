// Phototaxis after Braitenberg (thesis, section 5.2.2), for the s-bot: each track slows down for what is near on the
// other side, so the robot turns away from obstacles, and for the light on its own side, so it turns towards lamps.
// Near a lamp the light stops both tracks.
//
// It keeps nothing from one step to the next.

#include <algorithm>
#include <cohort/sbot.hpp>

namespace {

constexpr double full_speed = 0.2;     // of a track [m/s]
constexpr double turning_speed = 0.1;  // of a track when turning on the spot [m/s]
constexpr double too_near = 0.5;       // of an obstacle
constexpr double arrived = 0.75;       // of the brightest light sensor: some 0.7 m from a lamp of intensity 1
constexpr double darkness = 0.03;      // what the noise of a sensor may give without any light

class Phototaxis final : public cohort::Controller {
 public:
  void start(const cohort::Start& start) override { robot_ = cohort::Sbot(start); }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    const cohort::Sbot::Sides near = robot_.obstacles(observation);
    // Light sensor 0 looks ahead, 4 behind.
    double brightest = 0.0;
    for (const cohort::ObservationChannel sensor : robot_.light) brightest = std::max(brightest, observation[sensor]);
    double light_left = 0.0;
    double light_right = 0.0;
    for (std::size_t i = 1; i < 4; ++i) {
      light_left += observation[robot_.light[i]];
      light_right += observation[robot_.light[8 - i]];
    }
    robot_.align_turret(observation, command);
    if (brightest > arrived) return;  // the tracks stand still

    if (std::max(near.left, near.right) > too_near) {
      // On the spot, and always the same way: one that chose the freer side would swing to and fro in a corner.
      robot_.turn(command, 0.0, turning_speed);
      return;
    }
    // What matters is which side is brighter, near a lamp and far away.
    const double contrast = brightest > darkness ? (light_left - light_right) / (light_left + light_right) : 0.0;
    robot_.drive(command, full_speed * (1.0 - near.right - std::max(0.0, contrast)),
                 full_speed * (1.0 - near.left - std::max(0.0, -contrast)));
  }

  void save(cohort::StateWriter&) const override {}

 private:
  cohort::Sbot robot_;
};

}  // namespace

COHORT_CONTROLLER(Phototaxis)
