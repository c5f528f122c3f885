// Aggregation by sound, for the s-bot: every robot calls, goes where it hears more, and stays where it hears much. Who
// is in a small group leaves it now and then, so that small groups dissolve into large ones: the rule by which
// cockroaches and swarms of robots aggregate (Garnier et al., "Aggregation behaviour as a source of collective decision
// in a group of cockroach-like robots", ECAL 2005).
//
// It remembers what it is doing; one that takes over in the middle of a run begins by walking.

#include <algorithm>
#include <array>
#include <cmath>
#include <cohort/controller.hpp>
#include <random>
#include <stdexcept>
#include <vector>

namespace {

constexpr std::array weights{1.0, 0.8, 0.6, 0.3};  // of the proximity sensors ahead, from the middle to the side

constexpr double full_speed = 0.2;      // of a track [m/s]
constexpr double turning_speed = 0.1;   // of a track when turning on the spot [m/s]
constexpr double too_near = 0.8;        // of an obstacle: 4 cm
constexpr double alignment_gain = 5.0;  // of the turret [1/s]
constexpr double tone = 1000.0;         // that all call with [Hz]
constexpr double quiet = 1e-4;          // less than this is no sound at all [1]
constexpr double in_company = 0.5;      // neighbours that count as company

class Aggregation final : public cohort::Controller {
 public:
  void start(const cohort::Start& start) override {
    proximity_ = start.observations("proximity/*/reading");
    microphones_ = start.observations("microphones/*/intensity");
    if (proximity_.size() != 15 || microphones_.size() != 4)
      throw std::runtime_error("this controller wants the 15 proximity sensors and the 4 microphones of an s-bot");
    turret_position_ = start.observation("turret/0/position");
    turret_velocity_ = start.command("turret/0/velocity");
    left_track_ = start.command("treel/left/velocity");
    right_track_ = start.command("treel/right/velocity");
    frequency_ = start.command("left_speaker/0/frequency");
    loudness_ = start.command("left_speaker/0/intensity");
    color_ = start.commands("leds/*/color");
    call_ = start.parameters.real("call", 0.01);
    crowd_ = start.parameters.real("crowd", 0.5);
    leaving_ = start.parameters.real("leaving", 0.5);
    step_ = std::chrono::duration<double>(start.step).count() * start.period;
    random_.seed(start.seed);
    state_ = State::walking;
    until_ = std::chrono::nanoseconds(0);
  }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    command.set(turret_velocity_, -alignment_gain * observation[turret_position_]);
    command.set(frequency_, tone);
    command.set(loudness_, call_);

    // What arrives at each microphone, from its saturated reading; in multiples of a call from a neighbour that
    // touches.
    std::array<double, 4> heard{};
    for (std::size_t i = 0; i < heard.size(); ++i)
      heard[i] = -std::log(2.0 / (1.0 + std::min(observation[microphones_[i]], 0.999999)) - 1.0);
    const double sum = (heard[0] + heard[1] + heard[2] + heard[3]) / 4.0;
    const double neighbours = sum / (call_ / (touching * touching));

    if (observation.time() >= until_) decide(neighbours, observation.time());
    const bool stays = state_ == State::staying;
    for (const cohort::CommandChannel led : color_) command.set(led, 1.0, stays ? 0 : 2);  // red or blue
    if (stays) return;
    walk(observation, command, heard, sum);
  }

 private:
  enum class State { walking, staying, leaving };
  static constexpr double touching = 0.12;  // between the middles of two s-bots side by side [m]

  // Whoever hears neighbours stays; the fewer they are, the sooner it leaves again.
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

  void walk(const cohort::Observation& observation, cohort::Command& command, const std::array<double, 4>& heard,
            double sum) {
    double near_left = 0.0;
    double near_right = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      near_left = std::max(near_left, weights[i] * observation[proximity_[i]]);
      near_right = std::max(near_right, weights[i] * observation[proximity_[proximity_.size() - 1 - i]]);
    }
    if (std::max(near_left, near_right) > too_near) {
      const double turn = state_ == State::leaving ? turn_ : 1.0;
      command.set(left_track_, -turn * turning_speed);
      command.set(right_track_, turn * turning_speed);
      return;
    }
    // Microphones 0 and 3 are in front, 0 and 1 on the left. Their differences are the gradient of the sound.
    double ahead = 1.0;
    double aside = 0.0;
    if (sum > quiet && state_ == State::walking) {
      ahead = heard[0] + heard[3] - heard[1] - heard[2];
      aside = heard[0] + heard[1] - heard[2] - heard[3];
      const double size = std::sqrt(ahead * ahead + aside * aside);
      ahead = size > 0.0 ? ahead / size : 1.0;
      aside = size > 0.0 ? aside / size : 0.0;
    }
    const double turn = ahead < 0.0 ? (aside < 0.0 ? -1.0 : 1.0) : aside;
    command.set(left_track_, full_speed * std::clamp(1.0 - near_right - turn, -0.5, 1.0));
    command.set(right_track_, full_speed * std::clamp(1.0 - near_left + turn, -0.5, 1.0));
  }

  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

  std::vector<cohort::ObservationChannel> proximity_;
  std::vector<cohort::ObservationChannel> microphones_;
  cohort::ObservationChannel turret_position_;
  cohort::CommandChannel turret_velocity_;
  cohort::CommandChannel left_track_;
  cohort::CommandChannel right_track_;
  cohort::CommandChannel frequency_;
  cohort::CommandChannel loudness_;
  std::vector<cohort::CommandChannel> color_;
  double call_ = 0.0;     // intensity of a call
  double crowd_ = 0.0;    // so many more neighbours make a robot stay e times as long
  double leaving_ = 0.0;  // how often a robot would leave that has none [1/s]
  double step_ = 0.0;     // [s]

  std::mt19937_64 random_;
  State state_ = State::walking;
  std::chrono::nanoseconds until_{0};  // it leaves, without looking back
  double turn_ = 1.0;
};

}  // namespace

COHORT_CONTROLLER(Aggregation)
