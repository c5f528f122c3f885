// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <thread>

#include "tests/bridges/bridged_run.hpp"
#include "tests/bridges/sitl_program.hpp"

namespace cohort::test {
namespace {

// The other quadcopter of the experiment has no controller, so its team would wait forever.
BridgedRun::Options alone(const std::string& experiment, const std::string& seconds) {
  return {experiment, "cohort-ardupilot-bridge", "0", seconds};
}

// Two quadcopters, each flown by a SITL of its own.
std::array<Flown, 2> fly_two(const std::string& seconds, const std::string& threads) {
  auto options = alone("ardupilot", seconds);
  options.robots = "0,1";
  options.threads = threads;
  BridgedRun run(options);
  std::array<Flown, 2> flown;
  const std::array<std::uint16_t, 2> ports{run.port("0"), run.port("1")};
  std::vector<std::thread> pilots;
  for (std::size_t i = 0; i < 2; ++i)
    pilots.emplace_back([&, i] {
      SitlProgram sitl(ports[i]);
      sitl.run_ends_at = std::stod(seconds);
      flown[i].steps = sitl.fly(hover_at_two_metres);
      flown[i].seen = sitl.seen;
    });
  for (std::thread& pilot : pilots) pilot.join();
  const auto summary = run.summary();
  EXPECT_EQ(summary["late"], 0);
  for (Flown& each : flown) each.hash = summary["state_hash"];
  return flown;
}

TEST(ArdupilotBridge, TwoCoptersTakeOffAndHoverWithTheSameBitsInTwoRunsAndWithTwoThreads) {
  const auto first = fly_two("8", "1");
  for (const Flown& flown : first) {
    EXPECT_EQ(flown.steps, 3199);  // the answer to the last packet is the run's end
    EXPECT_NEAR(flown.seen.position[0], &flown == first.data() ? 0.5 : -2.5, 0.05);
    EXPECT_NEAR(flown.seen.position[1], -0.5, 0.05);
    EXPECT_NEAR(flown.seen.position[2], -2.0, 0.05);
    EXPECT_NEAR(yaw_of(flown.seen), 0.0, 0.05);
  }
  EXPECT_EQ(fly_two("8", "1")[0].hash, first[0].hash);
  EXPECT_EQ(fly_two("8", "2")[0].hash, first[0].hash);
}

Flown drive_by_sitl(const std::string& experiment, const std::string& seconds, Pilot pilot) {
  BridgedRun run(alone(experiment, seconds));
  SitlProgram sitl(run.port());
  sitl.run_ends_at = std::stod(seconds);
  Flown flown;
  flown.steps = sitl.fly(pilot);
  flown.seen = sitl.seen;
  flown.hash = run.summary()["state_hash"];
  return flown;
}

TEST(ArdupilotBridge, ARoverDrivesToItsWaypoint) {
  const Flown flown = drive_by_sitl("autopilot_rover", "12", drive_to_the_north);
  EXPECT_NEAR(flown.seen.position[0], 1.0, 0.1);
  EXPECT_NEAR(flown.seen.position[1], 0.5, 0.1);
  EXPECT_EQ(drive_by_sitl("autopilot_rover", "12", drive_to_the_north).hash, flown.hash);
}

TEST(ArdupilotBridge, ABoatCrossesTheWaterToItsWaypoint) {
  const Flown flown = drive_by_sitl("autopilot_boat", "20", cross_the_water);
  EXPECT_NEAR(flown.seen.position[0], 8.0, 0.5);
  EXPECT_NEAR(flown.seen.position[1], 6.0, 0.5);
  EXPECT_NEAR(flown.seen.position[2], 0.05, 0.02) << "the keel under the water";
  EXPECT_EQ(drive_by_sitl("autopilot_boat", "20", cross_the_water).hash, flown.hash);
}

TEST(ArdupilotBridge, AnswersInTheFramesOfArduPilot) {
  BridgedRun run(alone("autopilot_rover", "2"));
  SitlProgram sitl(run.port());
  sitl.run_ends_at = 2;
  ASSERT_TRUE(sitl.step(drive_to_the_north));
  EXPECT_EQ(sitl.seen.time, 0.004);
  EXPECT_NEAR(yaw_of(sitl.seen), std::acos(0.0), 0.01) << "it looks east";
  const auto answer = nlohmann::json::parse(sitl.last_answer);
  EXPECT_NEAR(answer["imu"]["accel_body"][2], -9.81, 1.0);
  sitl.has_32 = true;
  sitl.fly([](const Seen&) { return Outputs{1.0, 0.5, 0.5}; }, 200);
  EXPECT_GT(sitl.seen.turn_rate[2], 0.5) << "clockwise: its left wheel turns alone";
  EXPECT_GT(yaw_of(sitl.seen), std::acos(0.0) + 0.2);
  EXPECT_LT(sitl.seen.position[0], -0.01) << "it turns to the south";
  sitl.fly(drive_to_the_north);
  run.summary();
}

// A run of a rover whose first packets are given, for what disturbs it in between.
class ArdupilotRover : public ::testing::Test {
 protected:
  static std::string undisturbed() {
    static const std::string hash = drive_by_sitl("autopilot_rover", "2", drive_to_the_north).hash;
    return hash;
  }
};

TEST_F(ArdupilotRover, APacketThatIsSentAgainGetsTheSameAnswerWithoutAStep) {
  const std::string expected = undisturbed();
  BridgedRun run(alone("autopilot_rover", "2"));
  SitlProgram sitl(run.port());
  sitl.run_ends_at = 2;
  sitl.fly(drive_to_the_north, 20);
  const std::string answer = sitl.last_answer;
  const auto again = SitlProgram::packet(sitl.frame_count - 1, drive_to_the_north(sitl.seen));
  for (int i = 0; i < 3; ++i) {
    sitl.send(again);
    EXPECT_EQ(sitl.receive(5000), answer);
  }
  sitl.fly(drive_to_the_north);
  EXPECT_EQ(run.summary()["state_hash"], expected);
}

TEST_F(ArdupilotRover, APacketThatIsSentAgainBeforeItsAnswerGetsOneAnswer) {
  const std::string expected = undisturbed();
  BridgedRun run(alone("autopilot_rover", "2"));
  SitlProgram sitl(run.port());
  sitl.run_ends_at = 2;
  sitl.fly(drive_to_the_north, 20);
  run.server().signal(SIGSTOP);
  const auto packet = SitlProgram::packet(sitl.frame_count, drive_to_the_north(sitl.seen));
  sitl.send(packet);
  sitl.send(packet);
  EXPECT_EQ(sitl.receive(300), std::nullopt);
  run.server().signal(SIGCONT);
  sitl.fly(drive_to_the_north);
  EXPECT_EQ(run.summary()["state_hash"], expected);
}

TEST_F(ArdupilotRover, DatagramsThatAreNoPacketsAreNamedAndChangeNothing) {
  const std::string expected = undisturbed();
  BridgedRun run(alone("autopilot_rover", "2"));
  SitlProgram sitl(run.port());
  sitl.run_ends_at = 2;
  sitl.fly(drive_to_the_north, 20);
  auto half = SitlProgram::packet(21, {});
  half.resize(20);
  auto more = SitlProgram::packet(21, {});
  more.resize(200);
  const SitlProgram stranger(run.port());
  for (const auto& [datagram, reason] :
       {std::pair(std::vector<std::uint8_t>{'G', 'E', 'T'}, "a servo packet has 40 or 72 bytes, not 3"),
        {std::vector<std::uint8_t>(2000, 'A'), "begins with 18458 or 29569, not with 16705"},
        {half, "of 16 channels has 40 bytes, not 20"},
        {more, "of 16 channels has 40 bytes, not 200"}}) {
    stranger.send(datagram);
    EXPECT_TRUE(run.says(reason)) << run.bridge().output();
  }
  sitl.fly(drive_to_the_north);
  EXPECT_EQ(run.summary()["state_hash"], expected);
}

TEST_F(ArdupilotRover, ARestartedSitlContinuesTheRunWithTheSameBitsTwice) {
  std::vector<std::string> hashes;
  for (int i = 0; i < 2; ++i) {
    BridgedRun run(alone("autopilot_rover", "2"));
    const std::uint16_t port = run.port();
    {
      SitlProgram sitl(port);
      sitl.fly(drive_to_the_north, 200);
    }
    SitlProgram sitl(port);
    sitl.run_ends_at = 2;
    ASSERT_TRUE(sitl.step(drive_to_the_north));
    EXPECT_NEAR(sitl.seen.time, 201 * 0.004, 1e-9) << "time goes on";
    sitl.fly(drive_to_the_north);
    EXPECT_TRUE(run.says("has restarted: frame 0 follows frame 199")) << run.bridge().output();
    hashes.push_back(run.summary()["state_hash"]);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST_F(ArdupilotRover, TheLaterOfTwoSitlsDrivesTheRobot) {
  BridgedRun run(alone("autopilot_rover", "2"));
  SitlProgram earlier(run.port());
  earlier.fly(drive_to_the_north, 200);
  SitlProgram later(run.port());
  later.run_ends_at = 2;
  ASSERT_TRUE(later.step(drive_to_the_north));
  earlier.send(SitlProgram::packet(200, {}));
  later.fly(drive_to_the_north, 100);
  EXPECT_EQ(earlier.receive(0), std::nullopt);
  EXPECT_EQ(later.seen.time, 301 * 0.004);
  later.fly(drive_to_the_north);
  EXPECT_EQ(run.summary()["ticks"], 500);
}

TEST_F(ArdupilotRover, StandsWhileItsSitlIsSilentAndTheRunGoesOnIfSoAsked) {
  auto options = alone("autopilot_rover", "2");
  options.more = {"--without-firmware", "stand", "--patience", "0.1"};
  BridgedRun run(options);
  SitlProgram sitl(run.port());
  sitl.run_ends_at = 2;
  sitl.fly(drive_to_the_north, 20);
  EXPECT_TRUE(run.says("is silent: the run continues without it")) << run.bridge().output();
  EXPECT_EQ(run.summary()["ticks"], 500);
}

TEST_F(ArdupilotRover, TheBridgeLeavesWithTheServerWhileItsSitlIsSilent) {
  BridgedRun run(alone("autopilot_rover", "2"));
  SitlProgram sitl(run.port());
  sitl.run_ends_at = 2;
  sitl.fly(drive_to_the_north, 20);
  run.server().signal(SIGINT);
  EXPECT_EQ(run.bridge().wait_for_exit(), 0) << run.bridge().output();
}

TEST(ArdupilotBridgeOptions, AreRefusedWithWhatToDo) {
  expect_refusals("cohort-ardupilot-bridge",
                  {{{"--output", "1=left"}, "expected NUMBER=CHANNEL:LOW..HIGH"},
                   {{"--output", "33=left/0/velocity:0..1"}, "the output number must be from 1 to 32"},
                   {{"--output", "1=left/0/velocity:0..x"}, "not finite numbers"},
                   {{"--patience", "0"}, "--patience"},
                   {{"--robots", "0..9", "--port", "65500"}, "the last robot exceeds 65535"},
                   {{"--without-firmware", "dance"}, "--without-firmware"}});
}

TEST(ArdupilotBridgeOptions, AnUnknownChannelEndsTheBridgeByName) {
  auto options = alone("autopilot_rover", "2");
  options.more = {"--output", "1=propeller/0/velocity:0..1"};
  BridgedRun run(options);
  EXPECT_TRUE(run.says("propeller/0/velocity")) << run.bridge().output();
  EXPECT_EQ(run.bridge().wait_for_exit(), 1);
}

}  // namespace
}  // namespace cohort::test
