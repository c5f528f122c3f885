// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "tests/bridges/pilots.hpp"
#include "tools/bridges/mavlink/hil_messages.hpp"

namespace cohort::test {

/// PX4 as its simulator sees it: it connects, asks for HIL_STATE_QUATERNION, boots on the time of HIL_SENSOR, and then
/// answers each HIL_SENSOR with controls of the same time.
///
/// Its pilot's time counts from the last HIL_SENSOR before the simulation's first step, not from the first one that it
/// answers. How many HIL_SENSOR lie between the two depends on wall time: the bridge goes on sending them until it has
/// received the first controls.
class Px4Program {
 public:
  /// `boot`: so many HIL_SENSOR are not answered, nor those before the first HIL_STATE_QUATERNION. `counts_from_first`:
  /// gives times since the first one, as older PX4.
  explicit Px4Program(std::uint16_t port, int boot = 10, bool counts_from_first = false);
  Px4Program(const Px4Program&) = delete;
  Px4Program& operator=(const Px4Program&) = delete;
  ~Px4Program();

  /// Receives to the next HIL_SENSOR and answers it; false if the bridge has hung up.
  bool step(Pilot pilot);
  int fly(Pilot pilot, int at_most = 1'000'000);
  /// Ends its side of the connection and waits for the end of the other.
  void leave();
  void send_bytes(const std::vector<std::uint8_t>& bytes) const;

  Seen seen;
  mavlink::HilSensor sensor;
  mavlink::HilGps gps;
  std::size_t of_state = 0, of_gps = 0, of_heartbeat = 0;  // messages that came
  bool steers_by_two_sides = false;
  /// Sends its first controls only after so many more HIL_SENSOR have arrived, like a program on a busy machine.
  int sensors_before_first_answer = 0;

 private:
  bool receive();
  int waiting_sensors() const;
  void take(const std::vector<std::uint8_t>& bytes);
  template <class Message>
  void send(const Message& message);

  int socket_;
  int boot_;
  bool counts_from_first_;
  std::uint64_t first_ = 0;          // time of the first HIL_SENSOR [us]
  std::uint64_t at_rest_until_ = 0;  // time of the last one before the simulation's first step [us]
  bool has_moved_ = false;           // the simulation, since the first HIL_SENSOR
  bool has_sensor_ = false;
  bool has_answered_ = false;
  std::uint8_t sequence_ = 0;
  std::vector<std::uint8_t> received_;
};

}  // namespace cohort::test
