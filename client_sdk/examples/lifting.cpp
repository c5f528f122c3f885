// SPDX-License-Identifier: Apache-2.0

// One s-bot lifts another (thesis, section 1.1) while a third holds it from behind, because alone it would tip over.
// Each robot with this controller drives ahead until it can grip the one in front of it. A robot on its way calls. When
// all calls have stopped, the robots with the parameter `angle` raise their arm to it, hold, lower it, and release.
//
// Snapshots contain its state. A copy that takes over in the middle of a run starts by driving ahead.

#include <algorithm>
#include <cohort/sbot.hpp>

namespace {

constexpr double approach_speed = 0.04;  // speed of a track [m/s]
constexpr double steering = 0.04;        // gain towards the robot ahead [m/s]
constexpr double tone = 1000.0;          // [Hz]
constexpr double call = 0.05;            // intensity of a call at 1 m [1]
constexpr double silence = 0.005;        // microphone reading if all callers are far away, or there are none
constexpr double calm = 2.0;             // time from the last call to the lift [s]
constexpr double lifting_speed = 0.1;    // velocity of the arm [rad/s]
constexpr double level = 0.01;           // angle of the lowered arm [rad]

class Lifting final : public cohort::Controller {
 public:
  void start(const cohort::Start& start) override {
    robot_ = cohort::Sbot(start);
    elevation_ = start.command("elevation/0/position");
    angle_ = start.parameters.real("angle", 0.0);
    hold_ = start.parameters.real("hold", 6.0);
    step_ = start.seconds_per_step();
    state_ = State::approaching;
    calm_for_ = 0.0;
    held_for_ = 0.0;
    raised_ = 0.0;
  }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    calm_for_ = robot_.hears(observation, silence) ? 0.0 : calm_for_ + step_;
    advance(observation);
    command.set(elevation_, raised_);
    if (state_ == State::approaching || state_ == State::gripping) robot_.call(command, tone, call);
    if (state_ == State::approaching) {
      // The robot ahead is on the side with the greater reading.
      const double aside = observation[robot_.proximity.front()] - observation[robot_.proximity.back()];
      robot_.turn(command, approach_speed, steering * aside);
      robot_.align_turret(observation, command);
    } else if (state_ != State::done) {
      robot_.close_gripper(command);
    }
  }

  void save(cohort::StateWriter& state) const override { state.write(state_, calm_for_, held_for_, raised_); }
  void load(cohort::StateReader& state) override {
    state.read_up_to(state_, State::done);
    state.read(calm_for_, held_for_, raised_);
  }

 private:
  enum class State { approaching, gripping, waiting, lifting, lowering, done };

  void advance(const cohort::Observation& observation) {
    const double by = lifting_speed * step_;
    switch (state_) {
      case State::approaching:
        if (robot_.can_grip(observation)) state_ = State::gripping;
        break;
      case State::gripping:
        if (robot_.grips(observation)) state_ = State::waiting;
        break;
      case State::waiting:
        if (calm_for_ > calm) state_ = State::lifting;
        break;
      case State::lifting:
        raised_ = std::min(angle_, raised_ + by);
        if (raised_ == angle_) held_for_ += step_;
        if (held_for_ > hold_) state_ = State::lowering;
        break;
      case State::lowering:
        raised_ = std::max(0.0, raised_ - by);
        if (raised_ < level && angle_ > 0.0) state_ = State::done;
        break;
      case State::done: break;
    }
  }
  cohort::Sbot robot_;
  cohort::CommandChannel elevation_;
  double angle_ = 0.0;  // target angle [rad]
  double hold_ = 0.0;   // duration [s]
  double step_ = 0.0;   // time from one answer to the next [s]
  State state_ = State::approaching;
  double calm_for_ = 0.0;  // [s]
  double held_for_ = 0.0;  // [s]
  double raised_ = 0.0;    // [rad]
};

}  // namespace

COHORT_CONTROLLER(Lifting)
