// One s-bot lifts another (thesis, section 1.1), held from behind by a third: alone it would tip over. Each that has
// this controller drives ahead until it can grip the one before it. Who is on its way calls; when nobody is heard any
// more, those that are told an angle raise their arm to it, hold, lower it, and let go.
//
// It remembers what it is doing; one that takes over in the middle of a run begins by driving ahead.

#include <algorithm>
#include <cohort/controller.hpp>
#include <stdexcept>
#include <vector>

#include "sbot_senses.hpp"

namespace {

constexpr double approach_speed = 0.04;  // of a track [m/s]
constexpr double steering = 0.04;        // towards the one ahead [m/s]
constexpr double alignment_gain = 5.0;   // of the turret [1/s]
constexpr double tone = 1000.0;          // [Hz]
constexpr double call = 0.05;            // what arrives of it at 1 m [1]
constexpr double silence = 0.005;        // of a microphone: all that call are far away, or nobody does
constexpr double calm = 2.0;             // from the last call to the lifting [s]
constexpr double lifting_speed = 0.1;    // of the arm [rad/s]
constexpr double level = 0.01;           // of the arm, when it is down again [rad]

class Lifting final : public cohort::Controller {
 public:
  void start(const cohort::Start& start) override {
    proximity_ = start.observations("proximity/*/reading");
    microphones_ = start.observations("microphones/*/intensity");
    if (proximity_.size() != 15) throw std::runtime_error("this controller wants the 15 proximity sensors of an s-bot");
    grippable_ = start.observation("gripper/0/grippable");
    gripping_ = start.observation("gripper/0/gripping");
    turret_position_ = start.observation("turret/0/position");
    opening_ = start.command("gripper/0/opening");
    elevation_ = start.command("elevation/0/position");
    turret_velocity_ = start.command("turret/0/velocity");
    left_track_ = start.command("treel/left/velocity");
    right_track_ = start.command("treel/right/velocity");
    frequency_ = start.command("left_speaker/0/frequency");
    loudness_ = start.command("left_speaker/0/intensity");
    angle_ = start.parameters.real("angle", 0.0);
    hold_ = start.parameters.real("hold", 6.0);
    step_ = std::chrono::duration<double>(start.step).count() * start.period;
    state_ = State::approaching;
    calm_for_ = 0.0;
    held_for_ = 0.0;
    raised_ = 0.0;
  }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    calm_for_ = sbot::hears(observation, microphones_, silence) ? 0.0 : calm_for_ + step_;
    advance(observation);
    command.set(elevation_, raised_);
    if (state_ == State::approaching || state_ == State::gripping) {
      command.set(frequency_, tone);
      command.set(loudness_, call);
    }
    if (state_ == State::approaching) {
      // The one ahead is on the side where more is seen of it.
      const double aside = observation[proximity_.front()] - observation[proximity_.back()];
      command.set(left_track_, approach_speed - steering * aside);
      command.set(right_track_, approach_speed + steering * aside);
      command.set(turret_velocity_, -alignment_gain * observation[turret_position_]);
    } else if (state_ != State::done) {
      command.set(opening_, 0.0);
    }
  }

 private:
  enum class State { approaching, gripping, waiting, lifting, lowering, done };

  void advance(const cohort::Observation& observation) {
    const double by = lifting_speed * step_;
    switch (state_) {
      case State::approaching:
        if (observation[grippable_] > 0.5) state_ = State::gripping;
        break;
      case State::gripping:
        if (observation[gripping_] > 0.5) state_ = State::waiting;
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
  std::vector<cohort::ObservationChannel> proximity_;
  std::vector<cohort::ObservationChannel> microphones_;
  cohort::ObservationChannel grippable_;
  cohort::ObservationChannel gripping_;
  cohort::ObservationChannel turret_position_;
  cohort::CommandChannel opening_;
  cohort::CommandChannel elevation_;
  cohort::CommandChannel turret_velocity_;
  cohort::CommandChannel left_track_;
  cohort::CommandChannel right_track_;
  cohort::CommandChannel frequency_;
  cohort::CommandChannel loudness_;
  double angle_ = 0.0;  // to lift to [rad]
  double hold_ = 0.0;   // how long [s]
  double step_ = 0.0;   // from one answer to the next [s]
  State state_ = State::approaching;
  double calm_for_ = 0.0;  // [s]
  double held_for_ = 0.0;  // [s]
  double raised_ = 0.0;    // [rad]
};

}  // namespace

COHORT_CONTROLLER(Lifting)
