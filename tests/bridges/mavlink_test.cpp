// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tools/bridges/mavlink/hil_messages.hpp"
#include "tools/bridges/mavlink/payload.hpp"

namespace cohort::mavlink {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes heartbeat_frame() {
  Heartbeat heartbeat;
  heartbeat.type = 6;
  heartbeat.autopilot = 8;
  return frame_of({7, 255, 190, Heartbeat::id, payload_of(heartbeat)}, Heartbeat::crc_extra);
}

TEST(MavlinkFrames, HaveTheChecksumOfMcrf4xx) {
  const std::string text = "123456789";
  EXPECT_EQ(checksum(Bytes(text.begin(), text.end())), 0x6f91);
}

TEST(MavlinkFrames, HaveTheSizesOfMavlinksDefinitions) {
  EXPECT_EQ(payload_of(Heartbeat{}).size(), 9U);
  EXPECT_EQ(payload_of(CommandLong{}).size(), 33U);
  EXPECT_EQ(payload_of(HilActuatorControls{}).size(), 81U);
  EXPECT_EQ(payload_of(HilSensor{}).size(), 65U);
  EXPECT_EQ(payload_of(HilGps{}).size(), 39U);
  EXPECT_EQ(payload_of(HilStateQuaternion{}).size(), 64U);
}

TEST(MavlinkFrames, LoseTheZerosAtTheirEndAndGetThemBack) {
  HilSensor sensor;
  sensor.time_usec = 4000;
  sensor.acceleration[0] = 1.5F;
  const Bytes frame = frame_of({1, 1, 1, HilSensor::id, payload_of(sensor)}, HilSensor::crc_extra);
  EXPECT_EQ(frame.size(), 10U + 12U + 2U);
  ASSERT_EQ(size_at(frame), frame.size());
  const Piece piece = piece_of(frame);
  ASSERT_TRUE(piece.packet);
  const auto again = message_in<HilSensor>(*piece.packet);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->time_usec, 4000U);
  EXPECT_EQ(again->acceleration[0], 1.5F);
  EXPECT_EQ(again->fields_updated, 0U);
  const Bytes nothing = frame_of({1, 1, 1, CommandLong::id, payload_of(CommandLong{})}, CommandLong::crc_extra);
  EXPECT_EQ(nothing.size(), 10U + 1U + 2U) << "one byte stays";
}

TEST(MavlinkFrames, AreFoundBehindAndInsideOfBytesThatAreNone) {
  const Bytes frame = heartbeat_frame();
  for (const Bytes& before : {Bytes{1, 2, 3}, Bytes{0xfd, 9, 0, 0, 1}, Bytes{0xfd, 2, 0xff}, Bytes{0xfe, 9}}) {
    Bytes stream = before;
    stream.insert(stream.end(), frame.begin(), frame.end());
    // A frame that seems longer than what there is may still be one: the next one shows that it is not.
    stream.insert(stream.end(), frame.begin(), frame.end());
    std::size_t found = 0;
    std::span<const std::uint8_t> rest = stream;
    while (const std::size_t size = size_at(rest)) {
      if (size > rest.size()) break;
      if (piece_of(rest.first(size)).packet) ++found;
      rest = rest.subspan(size);
    }
    EXPECT_EQ(found, 2U);
  }
}

TEST(MavlinkFrames, OneWithAnyBitWrongIsNone) {
  const Bytes frame = heartbeat_frame();
  for (std::size_t bit = 0; bit < 8 * frame.size(); ++bit) {
    Bytes wrong = frame;
    wrong[bit / 8] ^= 1 << bit % 8;
    const Piece piece = piece_of(wrong);
    EXPECT_FALSE(piece.packet && piece.is_known) << "bit " << bit;
  }
}

TEST(MavlinkFrames, OneOfAnUnknownMessageIsSkippedWhole) {
  const Bytes frame = frame_of({1, 1, 1, 4711, {1, 2, 0xfd, 4}}, 99);
  EXPECT_EQ(size_at(frame), frame.size());
  const Piece piece = piece_of(frame);
  ASSERT_TRUE(piece.packet);
  EXPECT_FALSE(piece.is_known);
}

}  // namespace
}  // namespace cohort::mavlink
