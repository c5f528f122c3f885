// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <memory>
#include <thread>

#include "tests/bridges/bridged_run.hpp"
#include "tests/bridges/px4_program.hpp"
#include "tools/bridges/mavlink/payload.hpp"

namespace cohort::test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using mavlink::HilActuatorControls;

Bytes frame_of(const HilActuatorControls& controls) {
  return mavlink::frame_of({0, 1, 1, HilActuatorControls::id, mavlink::payload_of(controls)},
                           HilActuatorControls::crc_extra);
}

BridgedRun::Options with_px4(const std::string& experiment, const std::string& seconds,
                             std::vector<std::string> more = {}) {
  return {experiment, "cohort-px4-bridge", "0", seconds, "1", std::move(more)};
}

// `late`: so many HIL_SENSOR arrive at each between its first controls and the HIL_SENSOR that they answer.
std::array<Flown, 2> fly_two(const std::string& seconds, const std::string& threads, int boot,
                             std::array<int, 2> late) {
  auto options = with_px4("px4", seconds);
  options.robots = "0,1";
  options.threads = threads;
  BridgedRun run(options);
  std::array<Flown, 2> flown;
  const std::array<std::uint16_t, 2> ports{run.port("0"), run.port("1")};
  std::vector<std::thread> pilots;
  for (std::size_t i = 0; i < 2; ++i)
    pilots.emplace_back([&, i] {
      Px4Program px4(ports[i], boot, i == 1);
      px4.sensors_before_first_answer = late[i];
      flown[i].steps = px4.fly(hover_at_two_metres);
      flown[i].seen = px4.seen;
    });
  for (std::thread& pilot : pilots) pilot.join();
  const auto summary = run.summary();
  EXPECT_EQ(summary["late"], 0);
  for (Flown& each : flown) each.hash = summary["state_hash"];
  return flown;
}

TEST(Px4Bridge, TwoCoptersTakeOffAndHoverWithTheSameBitsHoweverLongTheyBootAndWithTwoThreads) {
  const auto first = fly_two("8", "1", 3, {0, 0});
  for (const Flown& flown : first) {
    EXPECT_NEAR(flown.seen.position[0], &flown == first.data() ? 0.5 : -2.5, 0.1);
    EXPECT_NEAR(flown.seen.position[1], -0.5, 0.1);
    EXPECT_NEAR(flown.seen.position[2], -2.0, 0.1);
    EXPECT_NEAR(yaw_of(flown.seen), 0.0, 0.1);
  }
  EXPECT_EQ(fly_two("8", "1", 40, {2, 0})[0].hash, first[0].hash);
  EXPECT_EQ(fly_two("8", "2", 10, {1, 7})[0].hash, first[0].hash);
}

Flown drive_by_px4(const std::string& experiment, const std::string& seconds, Pilot pilot) {
  BridgedRun run(with_px4(experiment, seconds));
  Px4Program px4(run.port());
  px4.steers_by_two_sides = true;
  Flown flown;
  flown.steps = px4.fly(pilot);
  flown.seen = px4.seen;
  flown.hash = run.summary()["state_hash"];
  return flown;
}

TEST(Px4Bridge, ARoverDrivesToItsWaypoint) {
  const Flown flown = drive_by_px4("autopilot_rover", "12", drive_to_the_north);
  EXPECT_NEAR(flown.seen.position[0], 1.0, 0.1);
  EXPECT_NEAR(flown.seen.position[1], 0.5, 0.1);
}

TEST(Px4Bridge, ABoatCrossesTheWaterToItsWaypoint) {
  const Flown flown = drive_by_px4("autopilot_boat", "20", cross_the_water);
  EXPECT_NEAR(flown.seen.position[0], 8.0, 0.5);
  EXPECT_NEAR(flown.seen.position[1], 6.0, 0.5);
}

class Px4Rover : public ::testing::Test {
 protected:
  static std::string undisturbed() {
    static const std::string hash = drive_by_px4("autopilot_rover", "2", drive_to_the_north).hash;
    return hash;
  }
  static void finish(BridgedRun& run, Px4Program& px4) {
    px4.fly(drive_to_the_north);
    EXPECT_EQ(run.summary()["state_hash"], undisturbed());
  }
};

TEST_F(Px4Rover, IsToldWhatItsSensorsMeasureInTheUnitsOfPx4) {
  BridgedRun run(with_px4("autopilot_rover", "2"));
  Px4Program px4(run.port());
  px4.steers_by_two_sides = true;
  px4.fly([](const Seen&) { return Outputs{0.5, 0.5, 0.5}; }, 250);
  EXPECT_NEAR(px4.sensor.acceleration[2], -9.81, 0.3);
  EXPECT_NEAR(px4.sensor.absolute_pressure, 956.0, 0.2) << "of the standard atmosphere at 488 m";
  EXPECT_NEAR(px4.sensor.pressure_altitude, 1e-3 * px4.gps.altitude, 2.0);
  // SDF's field is 5.6 uT to the east and 22.9 uT to the north, and the robot looks east.
  EXPECT_NEAR(px4.sensor.magnetic_field[0], 0.056, 0.02);
  EXPECT_NEAR(px4.sensor.magnetic_field[1], -0.229, 0.02);
  EXPECT_NEAR(px4.sensor.magnetic_field[2], 0.424, 0.02);
  EXPECT_EQ(px4.sensor.fields_updated, 0x1bffU);
  EXPECT_NEAR(px4.gps.latitude, 473977420, 20);
  EXPECT_NEAR(px4.gps.altitude, 488000, 20);
  EXPECT_EQ(px4.gps.fix_type, 3);
  EXPECT_NEAR(yaw_of(px4.seen), std::acos(0.0), 0.01);
  EXPECT_NEAR(static_cast<double>(px4.of_gps), 11.0, 1.0) << "ten in a second";
  EXPECT_GT(px4.of_state, 240U);
  px4.fly(drive_to_the_north);
  run.summary();
}

TEST_F(Px4Rover, BytesThatAreNoMessageAreSkippedCountedAndNamed) {
  BridgedRun run(with_px4("autopilot_rover", "2"));
  Px4Program px4(run.port());
  px4.steers_by_two_sides = true;
  px4.fly(drive_to_the_north, 20);
  HilActuatorControls controls;
  controls.time_usec = px4.sensor.time_usec;
  controls.controls.fill(1.0F);
  Bytes wrong = frame_of(controls);
  wrong.back() ^= 1;
  px4.send_bytes(wrong);
  px4.fly(drive_to_the_north, 5);
  EXPECT_TRUE(run.says("not a valid MAVLink 2 message, 1 time, last 92 bytes: skipped")) << run.bridge().output();
  px4.send_bytes(Bytes(1000, 'A'));
  px4.send_bytes({0xfd, 0xff});  // as if a long message began
  finish(run, px4);
}

TEST_F(Px4Rover, ControlsOfAnotherTimeAreNotTaken) {
  BridgedRun run(with_px4("autopilot_rover", "2"));
  Px4Program px4(run.port());
  px4.steers_by_two_sides = true;
  for (int i = 0; i < 20; ++i) {
    HilActuatorControls controls;
    controls.time_usec = px4.sensor.time_usec > 4000 ? px4.sensor.time_usec - 4000 : 5'000'000;
    controls.controls.fill(-1.0F);
    if (i > 0) px4.send_bytes(frame_of(controls));
    px4.step(drive_to_the_north);
  }
  finish(run, px4);
}

TEST_F(Px4Rover, APx4ThatConnectsAgainGoesOnFromWhereTheRunIsWithTheSameBitsTwice) {
  std::vector<std::string> hashes;
  for (const int boot : {5, 30}) {
    BridgedRun run(with_px4("autopilot_rover", "2"));
    const std::uint16_t port = run.port();
    {
      Px4Program px4(port);
      px4.steers_by_two_sides = true;
      px4.fly(drive_to_the_north, 200);
    }
    Px4Program px4(port, boot);
    px4.steers_by_two_sides = true;
    px4.fly(drive_to_the_north);
    hashes.push_back(run.summary()["state_hash"]);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST_F(Px4Rover, AnotherPx4ThatHasWaitedDrivesOnceTheFirstHasLeft) {
  BridgedRun run(with_px4("autopilot_rover", "2"));
  const std::uint16_t port = run.port();
  auto first = std::make_unique<Px4Program>(port);
  first->steers_by_two_sides = true;
  first->fly(drive_to_the_north, 200);
  Px4Program second(port);
  second.steers_by_two_sides = true;
  first.reset();
  second.fly(drive_to_the_north);
  EXPECT_EQ(run.summary()["ticks"], 500);
}

TEST_F(Px4Rover, HalfAMessageIsNamedWhenItsPx4Leaves) {
  BridgedRun run(with_px4("autopilot_rover", "2"));
  const std::uint16_t port = run.port();
  {
    Px4Program px4(port);
    px4.fly([](const Seen&) { return Outputs{0.5, 0.5, 0.5}; }, 20);
    px4.send_bytes({0xfd, 60, 0, 0, 1, 1, 1});
    px4.leave();
  }
  EXPECT_TRUE(run.says("inside a message, after 7 of 72 bytes")) << run.bridge().output();
  Px4Program px4(port);
  px4.fly(drive_to_the_north);
  run.summary();
}

TEST_F(Px4Rover, APx4ThatIsConnectedAndDoesNotAnswerIsNamedAndTheRunGoesOn) {
  BridgedRun run(with_px4("autopilot_rover", "0.4", {"--patience", "0.02"}));
  Px4Program px4(run.port());
  px4.fly(drive_to_the_north, 20);
  EXPECT_TRUE(run.says("has not answered HIL_SENSOR in time, 16 times")) << run.bridge().output();
  EXPECT_EQ(run.summary()["ticks"], 100);
}

TEST_F(Px4Rover, OrItStandsWhenItsPx4HasLeftAndTheRunGoesOnToItsEnd) {
  BridgedRun run(with_px4("autopilot_rover", "2", {"--without-firmware", "stand"}));
  {
    Px4Program px4(run.port());
    px4.steers_by_two_sides = true;
    px4.fly(drive_to_the_north, 20);
  }
  EXPECT_EQ(run.summary()["ticks"], 500);
}

TEST_F(Px4Rover, ASecondPx4WaitsUntilTheFirstHasLeft) {
  BridgedRun run(with_px4("autopilot_rover", "2"));
  const std::uint16_t port = run.port();
  Px4Program px4(port);
  px4.steers_by_two_sides = true;
  px4.fly(drive_to_the_north, 20);
  const Px4Program second(port);
  finish(run, px4);
}

TEST_F(Px4Rover, TheBridgeLeavesWithTheServerWhileItsPx4IsSilent) {
  BridgedRun run(with_px4("autopilot_rover", "2", {"--patience", "600"}));
  Px4Program px4(run.port());
  px4.fly(drive_to_the_north, 20);
  run.server().signal(SIGINT);
  EXPECT_EQ(run.bridge().wait_for_exit(), 0) << run.bridge().output();
}

#ifdef COHORT_BRIDGES_PYTHON
// A peer that has nothing in common with the bridge: pymavlink's definitions, made from MAVLink's.
TEST(Px4Wire, PymavlinkDecodesAllMessagesAndItsControlsDriveTheRover) {
  std::vector<std::string> hashes;
  for (int i = 0; i < 2; ++i) {
    BridgedRun run(with_px4("autopilot_rover", "2"));
    const Ended peer =
        run_to_end({COHORT_BRIDGES_PYTHON, COHORT_SOURCE_DIR "/tests/bridges/px4_peer.py", std::to_string(run.port())});
    ASSERT_EQ(peer.exit_code, 0) << peer.err;
    const auto seen = nlohmann::json::parse(peer.out);
    EXPECT_EQ(seen["lost"], 0) << "bad messages";
    EXPECT_GE(seen["counts"]["HIL_SENSOR"], 509);
    EXPECT_GE(seen["counts"]["HIL_GPS"], 20);
    EXPECT_GE(seen["counts"]["HIL_STATE_QUATERNION"], 498);
    EXPECT_GE(seen["counts"]["HEARTBEAT"], 2);
    EXPECT_EQ(seen["counts"].size(), 4U) << seen["counts"];
    const auto& sensor = seen["last"]["HIL_SENSOR"];
    EXPECT_NEAR(sensor["zacc"], -9.81, 2.0);
    EXPECT_NEAR(sensor["abs_pressure"], 956.0, 0.2);
    EXPECT_NEAR(sensor["ymag"], -0.229, 0.02);
    EXPECT_EQ(sensor["fields_updated"], 0x1bff);
    EXPECT_NEAR(sensor["temperature"], 25.0, 1e-6);
    const auto& gps = seen["last"]["HIL_GPS"];
    EXPECT_NEAR(gps["lat"], 473977420, 20);
    EXPECT_GT(gps["lon"], 85455940 + 40) << "it has driven 0.5 m to the east";
    EXPECT_NEAR(gps["ve"], 28, 3);
    EXPECT_NEAR(gps["cog"], 9000, 300);
    const auto& state = seen["last"]["HIL_STATE_QUATERNION"];
    EXPECT_NEAR(state["attitude_quaternion"][0], std::sqrt(0.5), 0.01);
    EXPECT_NEAR(state["attitude_quaternion"][3], std::sqrt(0.5), 0.01);
    EXPECT_NEAR(state["vy"], 28, 3);
    EXPECT_NEAR(state["zacc"], -1000, 200);
    EXPECT_EQ(run.bridge().output().find("skipped"), std::string::npos) << run.bridge().output();
    hashes.push_back(run.summary()["state_hash"]);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}
#else
TEST(Px4Wire, PymavlinkDecodesAllMessagesAndItsControlsDriveTheRover) {
  GTEST_SKIP() << "no environment of tools/dev/python-environment --bridges (COHORT_BRIDGES_PYTHON)";
}
#endif

TEST(Px4BridgeOptions, AreRefusedWithWhatToDo) {
  expect_refusals("cohort-px4-bridge", {{{"--home", "1,2"}, "--home"},
                                        {{"--home", "90,2,3"}, "latitude from -89 to 89"},
                                        {{"--home", "a,2,3"}, "--home"},
                                        {{"--robots", "0..9", "--port", "65530"}, "the last robot exceeds 65535"}});
}

}  // namespace
}  // namespace cohort::test
