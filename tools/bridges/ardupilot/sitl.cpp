// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ardupilot/sitl.hpp"

#include <cmath>
#include <stdexcept>

namespace cohort::ardupilot {
namespace {

constexpr bridges::Patience at_once{bridges::Silence::hold, std::chrono::milliseconds(0)};
constexpr bridges::Patience a_moment{bridges::Silence::hold, std::chrono::milliseconds(100)};

void send(bridges::Conversation& sitl, const std::string& line) {
  sitl.send({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()});
}

}  // namespace

void Sitl::start(const DrivenRobot& robot) {
  // SITL takes steps from 0.1 s on for jumps of the time.
  if (robot.start.seconds_per_step() >= 0.1)
    throw std::runtime_error(
        "ArduPilot needs frames shorter than 0.1 s: reduce the step size or the period of this team");
  steps_in_a_second_ = 1.0 / robot.start.seconds_per_step();
  sensors_.start(robot.start);
  outputs_.start(robot.start, given_, autopilots::Numbering::ardupilot);
}

bool Sitl::exchange(bridges::Conversation& sitl, const Observation& observation) {
  if (owes_an_answer_) answer(sitl, observation);
  const auto packet = next_packet(sitl);
  if (!packet) {
    if (!is_silent_) sitl.tell("is silent: the run continues without it until it sends again");
    is_silent_ = true;
    return false;
  }
  heed(sitl, *packet);
  return true;
}

// The same packet again, after its answer, is answered again without a step, unless SITL has the first answer. In that
// case its next packet is about to come, and SITL would take a second answer for that of the next packet.
std::optional<ServoPacket> Sitl::next_packet(bridges::Conversation& sitl) {
  // Time stands still until SITL has driven the robot for the first time. One that was silent has had its time.
  const bridges::Patience patience = is_silent_ ? at_once : driven_ ? patience_ : bridges::Patience{};
  bool asks_again = false;
  for (;;) {
    const auto datagram = sitl.receive(servo_packet_size, asks_again ? a_moment : patience);
    if (!datagram && !asks_again) return std::nullopt;
    if (datagram) {
      const ServoPacket packet = decode(*datagram);
      if (!is_answered(packet)) return packet;
    } else {
      send(sitl, last_answer_);
    }
    asks_again = datagram.has_value();
  }
}

void Sitl::answer(bridges::Conversation& sitl, const Observation& observation) {
  last_answer_ = answer_line(observation.time(), sensors_.sense(observation));
  send(sitl, last_answer_);
  owes_an_answer_ = false;
}

bool Sitl::is_answered(const ServoPacket& packet) const {
  return driven_ && !owes_an_answer_ && !last_answer_.empty() && packet.frame_count == frame_count_;
}

void Sitl::heed(bridges::Conversation& sitl, const ServoPacket& packet) {
  const std::string count = std::to_string(packet.frame_count);
  if (!driven_ && std::abs(packet.frame_rate - steps_in_a_second_) > 0.5)
    sitl.tell("requests " + std::to_string(packet.frame_rate) + " steps per second (SIM_RATE_HZ), but the run has " +
              std::to_string(std::lround(steps_in_a_second_)));
  if (driven_ && packet.frame_count < frame_count_)
    sitl.tell("has restarted: frame " + count + " follows frame " + std::to_string(frame_count_));
  if (driven_ && packet.frame_count > frame_count_ + 1)
    sitl.tell("has lost frames: frame " + count + " follows frame " + std::to_string(frame_count_));
  driven_ = true;
  is_silent_ = false;
  owes_an_answer_ = true;
  frame_count_ = packet.frame_count;
  shares_ = packet.shares;
}

}  // namespace cohort::ardupilot
