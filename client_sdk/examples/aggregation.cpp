// SPDX-License-Identifier: Apache-2.0

// Aggregation by sound, for the s-bot: every robot calls, drives towards louder sound, and stays where it is loud. A
// robot in a small group leaves from time to time, so that small groups merge into large ones. Cockroaches and robot
// swarms aggregate by this rule (Garnier et al., "Aggregation behaviour as a source of collective decision in a group
// of cockroach-like robots", ECAL 2005).
//
// Snapshots contain its state. A copy that takes over in the middle of a run starts by walking.

#include <algorithm>
#include <cmath>
#include <cohort/sbot.hpp>
#include <random>

namespace {

constexpr double full_speed = 0.2;     // speed of a track [m/s]
constexpr double turning_speed = 0.1;  // speed of a track when turning on the spot [m/s]
constexpr double too_near = 0.8;       // reading of an obstacle at 4 cm
constexpr double tone = 1000.0;        // frequency of all calls [Hz]
constexpr double quiet = 1e-4;         // lower levels are silence [1]
constexpr double in_company = 0.5;     // number of neighbours that count as company

class Aggregation final : public cohort::Controller {
 public:
  void start(const cohort::Start& start) override {
    robot_ = cohort::Sbot(start);
    call_ = start.parameters.real("call", 0.01);
    crowd_ = start.parameters.real("crowd", 0.5);
    leaving_ = start.parameters.real("leaving", 0.5);
    step_ = start.seconds_per_step();
    random_.seed(start.seed);
    state_ = State::walking;
    until_ = std::chrono::nanoseconds(0);
  }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    robot_.align_turret(observation, command);
    robot_.call(command, tone, call_);

    const cohort::Sbot::Sound sound = robot_.listen(observation);
    const double neighbours =
        sound.level / (call_ / (touching * touching));  // number of touching neighbours with this sound level
    if (observation.time() >= until_) decide(neighbours, observation.time());
    const bool stays = state_ == State::staying;
    robot_.shine(command, stays ? cohort::Sbot::Color::red : cohort::Sbot::Color::blue);
    if (stays) return;
    walk(observation, sound, command);
  }

  void save(cohort::StateWriter& state) const override { state.write(random_, state_, until_, turn_); }
  void load(cohort::StateReader& state) override {
    state.read(random_);
    state.read_up_to(state_, State::leaving);
    state.read(until_, turn_);
  }

 private:
  enum class State { walking, staying, leaving };
  static constexpr double touching = 0.12;  // distance between the centres of two adjacent s-bots [m]

  // Decides whether to stay near neighbours; the fewer there are, the sooner the robot leaves again.
  void decide(double neighbours, std::chrono::nanoseconds time) {
    using std::chrono::milliseconds;
    const bool is_in_company = neighbours > in_company;
    switch (state_) {
      case State::leaving: state_ = State::walking; break;
      case State::walking:
        if (is_in_company) state_ = State::staying;
        break;
      case State::staying: {
        const double rate = leaving_ * std::exp(-neighbours / crowd_);
        if (!is_in_company) {
          state_ = State::walking;
        } else if (uniform() < rate * step_) {
          state_ = State::leaving;
          until_ = time + milliseconds(5000 + static_cast<int>(10000.0 * uniform()));
          turn_ = uniform() < 0.5 ? -1.0 : 1.0;
        }
        break;
      }
    }
  }

  void walk(const cohort::Observation& observation, const cohort::Sbot::Sound& sound, cohort::Command& command) {
    const cohort::Sbot::Sides near = robot_.obstacles(observation);
    if (std::max(near.left, near.right) > too_near) {
      const double turn = state_ == State::leaving ? turn_ : 1.0;
      robot_.turn(command, 0.0, turn * turning_speed);
      return;
    }
    // The differences between the microphones are the gradient of the sound.
    double ahead = 1.0;
    double aside = 0.0;
    if (sound.level > quiet && state_ == State::walking) {
      const double size = std::sqrt(sound.ahead * sound.ahead + sound.left * sound.left);
      ahead = size > 0.0 ? sound.ahead / size : 1.0;
      aside = size > 0.0 ? sound.left / size : 0.0;
    }
    const double turn = ahead < 0.0 ? (aside < 0.0 ? -1.0 : 1.0) : aside;
    robot_.drive(command, full_speed * std::clamp(1.0 - near.right - turn, -0.5, 1.0),
                 full_speed * std::clamp(1.0 - near.left + turn, -0.5, 1.0));
  }

  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

  cohort::Sbot robot_;
  double call_ = 0.0;     // intensity of a call
  double crowd_ = 0.0;    // so many more neighbours make the stay e times longer
  double leaving_ = 0.0;  // leaving rate of a robot without neighbours [1/s]
  double step_ = 0.0;     // [s]

  std::mt19937_64 random_;
  State state_ = State::walking;
  std::chrono::nanoseconds until_{0};  // end of a walk that ignores neighbours
  double turn_ = 1.0;
};

}  // namespace

COHORT_CONTROLLER(Aggregation)
