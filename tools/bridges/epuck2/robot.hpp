#pragma once

#include <array>
#include <cohort/controller.hpp>
#include <cstdint>

#include "tools/bridges/epuck2/packets.hpp"
#include "tools/bridges/epuck2/port.hpp"

namespace cohort::epuck2 {

/// What becomes of a robot whose program has left.
enum class WithoutProgram {
  wait,   ///< time stands still until another one has connected and sent a command
  stand,  ///< it stops, and the run goes on; another one that connects drives on from there
};

/// What answers a command that asks for image and sensors.
enum class Packets {
  both,     ///< the image, then the sensors, as the robot sends them
  in_turn,  ///< one of them, by turns, for programs that read a single packet after each command
};

/// An e-puck2 whose commands come from a program at a port, each of them answered at the next step. Waits in `step`.
class Robot final : public Controller {
 public:
  Robot(Port& port, WithoutProgram without_program, Packets packets)
      : port_(port), without_program_(without_program), packets_(packets) {}

  /// The robot has the channels of worlds/robots/epuck2.
  void start(const Start& start) override;
  void step(const Observation& observation, cohort::Command& command) override;

 private:
  Sensors sense(const Observation& observation) const;
  void answer(const Observation& observation);
  void heed(const Command& received, const Observation& observation);
  void act(cohort::Command& command) const;
  std::array<std::int64_t, 2> steps_made(const Observation& observation) const;

  Port& port_;
  WithoutProgram without_program_;
  Packets packets_;
  bool sent_image_ = false;      // with the last answer
  bool driven_ = false;          // by a program, at some time
  bool owes_an_answer_ = false;  // to `last_`
  Command last_;
  std::array<int, 2> speed_{};  // [steps/s]
  std::array<std::int64_t, 2> counters_begin_at_{};

  std::array<ObservationChannel, 2> wheel_position_;
  std::array<ObservationChannel, 8> proximity_;
  std::array<ObservationChannel, 3> ground_;
  ObservationChannel angular_velocity_;
  ObservationChannel acceleration_;
  ObservationChannel magnetic_field_;
  ObservationChannel distance_;
  std::array<CommandChannel, 2> wheel_velocity_;
  std::array<CommandChannel, 8> leds_;
  CommandChannel body_led_;
  CommandChannel front_led_;
};

}  // namespace cohort::epuck2
