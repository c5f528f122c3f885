// SPDX-License-Identifier: Apache-2.0

// A chain of s-bots crosses a gap that is too wide for one (thesis, figure 1.2b). Each drives ahead until it detects
// the edge of the ground, or an s-bot in front of it, which it grips. A robot on its way calls. When all calls have
// stopped, the robots of the chain drive ahead together.
//
// Snapshots contain its state. A copy that takes over in the middle of a run starts by driving ahead.

#include <cohort/sbot.hpp>

namespace {

constexpr double approach_speed = 0.06;  // speed of a track [m/s]
constexpr double crossing_speed = 0.08;  // speed of a track [m/s]
constexpr double steering = 0.05;        // gain towards the robot ahead [m/s]
constexpr double tone = 1000.0;          // [Hz]
constexpr double call = 0.05;            // intensity of a call at 1 m [1]
constexpr double silence = 0.005;        // microphone reading if all callers are far away, or there are none
constexpr double no_ground = 0.2;        // reading of a ground sensor over a gap; it reads 0.65 on flat ground

class Chain final : public cohort::Controller {
 public:
  void start(const cohort::Start& start) override {
    robot_ = cohort::Sbot(start);
    wait_ = std::chrono::milliseconds(static_cast<int>(1000.0 * start.parameters.real("wait", 3.0)));
    state_ = State::approaching;
    silent_since_ = std::chrono::nanoseconds(0);
  }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    if (robot_.hears(observation, silence)) silent_since_ = observation.time();
    if (state_ == State::approaching && robot_.can_grip(observation)) state_ = State::gripping;
    if (state_ == State::approaching && observation[robot_.ground[0]] < no_ground) state_ = State::waiting;
    if (state_ == State::gripping && robot_.grips(observation)) state_ = State::waiting;
    if (state_ == State::waiting && observation.time() - silent_since_ > wait_) state_ = State::crossing;

    const bool is_on_its_way = state_ == State::approaching || state_ == State::gripping;
    if (is_on_its_way) robot_.call(command, tone, call);
    if (state_ != State::approaching) robot_.close_gripper(command);
    using enum cohort::Sbot::Color;
    robot_.shine(command, is_on_its_way ? blue : state_ == State::waiting ? red : green);
    if (state_ == State::approaching) {
      // The robot ahead is on the side with the greater readings.
      const double left = observation[robot_.proximity[0]] + observation[robot_.proximity[1]];
      const double right = observation[robot_.proximity[14]] + observation[robot_.proximity[13]];
      robot_.turn(command, approach_speed, steering * (left - right));
      robot_.align_turret(observation, command);
    } else if (state_ == State::crossing) {
      robot_.drive(command, crossing_speed, crossing_speed);
    }
  }

  void save(cohort::StateWriter& state) const override { state.write(state_, silent_since_); }
  void load(cohort::StateReader& state) override {
    state.read_up_to(state_, State::crossing);
    state.read(silent_since_);
  }

 private:
  enum class State { approaching, gripping, waiting, crossing };

  cohort::Sbot robot_;
  std::chrono::nanoseconds wait_{0};  // time from the last call to the crossing
  State state_ = State::approaching;
  std::chrono::nanoseconds silent_since_{0};
};

}  // namespace

COHORT_CONTROLLER(Chain)
