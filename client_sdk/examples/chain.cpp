// A chain of s-bots over a gap that is too wide for one (thesis, figure 1.2b). Each drives ahead until it sees the edge
// of the ground, or another s-bot before it, which it grips. Who is on its way calls; when nobody is heard any more,
// all that are in the chain drive ahead together.
//
// It remembers what it is doing; one that takes over in the middle of a run begins by driving ahead.

#include <cohort/controller.hpp>
#include <stdexcept>
#include <vector>

#include "sbot_senses.hpp"

namespace {

constexpr double approach_speed = 0.06;  // of a track [m/s]
constexpr double crossing_speed = 0.08;  // of a track [m/s]
constexpr double steering = 0.05;        // towards the one ahead [m/s]
constexpr double alignment_gain = 5.0;   // of the turret [1/s]
constexpr double tone = 1000.0;          // [Hz]
constexpr double call = 0.05;            // what arrives of it at 1 m [1]
constexpr double silence = 0.005;        // of a microphone: all that call are far away, or nobody does
constexpr double no_ground = 0.2;        // of a ground sensor; on flat ground it reads 0.65

class Chain final : public cohort::Controller {
 public:
  void start(const cohort::Start& start) override {
    proximity_ = start.observations("proximity/*/reading");
    ground_ = start.observations("ground/*/reading");
    microphones_ = start.observations("microphones/*/intensity");
    if (proximity_.size() != 15 || ground_.size() != 4)
      throw std::runtime_error("this controller wants the 15 proximity sensors and the 4 ground sensors of an s-bot");
    grippable_ = start.observation("gripper/0/grippable");
    gripping_ = start.observation("gripper/0/gripping");
    turret_position_ = start.observation("turret/0/position");
    opening_ = start.command("gripper/0/opening");
    turret_velocity_ = start.command("turret/0/velocity");
    left_track_ = start.command("treel/left/velocity");
    right_track_ = start.command("treel/right/velocity");
    frequency_ = start.command("left_speaker/0/frequency");
    loudness_ = start.command("left_speaker/0/intensity");
    colors_ = start.commands("leds/*/color");
    wait_ = std::chrono::milliseconds(static_cast<int>(1000.0 * start.parameters.real("wait", 3.0)));
    state_ = State::approaching;
    silent_since_ = std::chrono::nanoseconds(0);
  }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    if (sbot::hears(observation, microphones_, silence)) silent_since_ = observation.time();
    if (state_ == State::approaching && observation[grippable_] > 0.5) state_ = State::gripping;
    if (state_ == State::approaching && observation[ground_[0]] < no_ground) state_ = State::waiting;
    if (state_ == State::gripping && observation[gripping_] > 0.5) state_ = State::waiting;
    if (state_ == State::waiting && observation.time() - silent_since_ > wait_) state_ = State::crossing;

    const bool is_on_its_way = state_ == State::approaching || state_ == State::gripping;
    if (is_on_its_way) {
      command.set(frequency_, tone);
      command.set(loudness_, call);
    }
    if (state_ != State::approaching) command.set(opening_, 0.0);
    const std::size_t color = is_on_its_way ? 2 : state_ == State::waiting ? 0 : 1;  // blue, red, green
    for (const cohort::CommandChannel led : colors_) command.set(led, 1.0, color);
    if (state_ == State::approaching) {
      // The one ahead is on the side where more is seen of it.
      const double left = observation[proximity_[0]] + observation[proximity_[1]];
      const double right = observation[proximity_[14]] + observation[proximity_[13]];
      command.set(left_track_, approach_speed - steering * (left - right));
      command.set(right_track_, approach_speed + steering * (left - right));
      command.set(turret_velocity_, -alignment_gain * observation[turret_position_]);
    } else if (state_ == State::crossing) {
      command.set(left_track_, crossing_speed);
      command.set(right_track_, crossing_speed);
    }
  }

 private:
  enum class State { approaching, gripping, waiting, crossing };

  std::vector<cohort::ObservationChannel> proximity_;
  std::vector<cohort::ObservationChannel> ground_;
  std::vector<cohort::ObservationChannel> microphones_;
  cohort::ObservationChannel grippable_;
  cohort::ObservationChannel gripping_;
  cohort::ObservationChannel turret_position_;
  cohort::CommandChannel opening_;
  cohort::CommandChannel turret_velocity_;
  cohort::CommandChannel left_track_;
  cohort::CommandChannel right_track_;
  cohort::CommandChannel frequency_;
  cohort::CommandChannel loudness_;
  std::vector<cohort::CommandChannel> colors_;
  std::chrono::nanoseconds wait_{0};  // from the last call to the crossing
  State state_ = State::approaching;
  std::chrono::nanoseconds silent_since_{0};
};

}  // namespace

COHORT_CONTROLLER(Chain)
