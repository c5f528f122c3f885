// Phototaxis after Braitenberg (thesis, section 5.2.2), for the s-bot: each track slows down for what is near on the
// other side, so the robot turns away from obstacles, and for the light on its own side, so it turns towards lamps.
// Near a lamp the light stops both tracks.
//
// It keeps nothing from one step to the next.

#include <algorithm>
#include <array>
#include <cohort/controller.hpp>
#include <stdexcept>
#include <vector>

namespace {

// Of the four proximity sensors on each side that look ahead, at 12, 36, 60 and 84 degrees from straight ahead.
constexpr std::array weights{1.0, 0.8, 0.6, 0.3};

constexpr double full_speed = 0.2;      // of a track [m/s]
constexpr double turning_speed = 0.1;   // of a track when turning on the spot [m/s]
constexpr double too_near = 0.5;        // of an obstacle
constexpr double arrived = 0.75;        // of the brightest light sensor: some 0.7 m from a lamp of intensity 1
constexpr double darkness = 0.03;       // what the noise of a sensor may give without any light
constexpr double alignment_gain = 5.0;  // of the turret [1/s]

class Phototaxis final : public cohort::Controller {
 public:
  void start(const cohort::Start& start) override {
    proximity_ = start.observations("proximity/*/reading");
    light_ = start.observations("light/*/reading");
    if (proximity_.size() != 15 || light_.size() != 8)
      throw std::runtime_error("this controller wants the 15 proximity sensors and the 8 light sensors of an s-bot");
    turret_position_ = start.observation("turret/0/position");
    turret_velocity_ = start.command("turret/0/velocity");
    left_track_ = start.command("treel/left/velocity");
    right_track_ = start.command("treel/right/velocity");
  }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    // Sensors are numbered counter-clockwise from the gripper: the first ones look to the left, the last to the right.
    double near_left = 0.0;
    double near_right = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      near_left = std::max(near_left, weights[i] * observation[proximity_[i]]);
      near_right = std::max(near_right, weights[i] * observation[proximity_[proximity_.size() - 1 - i]]);
    }
    // Light sensor 0 looks ahead, 4 behind.
    double brightest = 0.0;
    for (const cohort::ObservationChannel sensor : light_) brightest = std::max(brightest, observation[sensor]);
    double light_left = 0.0;
    double light_right = 0.0;
    for (std::size_t i = 1; i < 4; ++i) {
      light_left += observation[light_[i]];
      light_right += observation[light_[8 - i]];
    }
    command.set(turret_velocity_, -alignment_gain * observation[turret_position_]);
    if (brightest > arrived) return;  // the tracks stand still

    if (std::max(near_left, near_right) > too_near) {
      // On the spot, and always the same way: one that chose the freer side would swing to and fro in a corner.
      command.set(left_track_, -turning_speed);
      command.set(right_track_, turning_speed);
      return;
    }
    // What matters is which side is brighter, near a lamp and far away.
    const double contrast = brightest > darkness ? (light_left - light_right) / (light_left + light_right) : 0.0;
    command.set(left_track_, full_speed * (1.0 - near_right - std::max(0.0, contrast)));
    command.set(right_track_, full_speed * (1.0 - near_left - std::max(0.0, -contrast)));
  }

 private:
  std::vector<cohort::ObservationChannel> proximity_;
  std::vector<cohort::ObservationChannel> light_;
  cohort::ObservationChannel turret_position_;
  cohort::CommandChannel turret_velocity_;
  cohort::CommandChannel left_track_;
  cohort::CommandChannel right_track_;
};

}  // namespace

COHORT_CONTROLLER(Phototaxis)
