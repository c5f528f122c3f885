// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <csignal>
#include <memory>
#include <regex>

#include "tests/bridges/bridged_run.hpp"
#include "tests/bridges/epuck2_program.hpp"
#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

// A server and a bridge, for programs of a test to connect to.
BridgedRun::Options with_bridge(const std::string& experiment, const std::string& seconds, const std::string& robots,
                                const std::vector<std::string>& more = {}) {
  return {.experiment = experiment,
          .bridge = "cohort-epuck2-bridge",
          .robots = robots,
          .seconds = seconds,
          .more = more,
          .who = "program"};
}

// Commands as a program gives them that knows nothing of a simulation, until the robots hang up. How many exchanges
// that were, and how far the wheels of the first robot turned [steps].
struct Drive {
  int exchanges = 0;
  int steps = 0;
};
Drive drive(std::vector<EpuckProgram>& programs, int at_most = 1'000'000) {
  Drive made;
  std::vector<std::array<int, 2>> speeds(programs.size());
  int steps_before = 0;
  for (; made.exchanges < at_most; ++made.exchanges) {
    for (std::size_t i = 0; i < programs.size(); ++i)
      programs[i].send(EpuckProgram::command(speeds[i][0], speeds[i][1]));
    for (std::size_t i = 0; i < programs.size(); ++i) {
      if (programs[i].receive(1) != Bytes{0x02}) return made;
      const Bytes sensors = programs[i].receive(104);
      speeds[i] = avoid_obstacles(sensors);
      if (i == 0) {
        const int steps = signed_16(sensors, 79) + signed_16(sensors, 81);
        made.steps += std::abs(static_cast<std::int16_t>(steps - steps_before));
        steps_before = steps;
      }
    }
  }
  return made;
}

// One robot at the origin, asked every 50 ms. A wall is 20 cm before its distance sensor, another one 2 cm to the right
// of its proximity sensor 2.
class Epuck2Bridge : public ::testing::Test {
 protected:
  Epuck2Bridge() {
    write_file(folder_ / "world.yaml",
               "world:\n  name: room\n  model:\n"
               "    - {name: ground, static: true, link: {collision: {geometry: {plane: {}}}}}\n"
               "    - {name: ahead, static: true, pose: [0.2405, 0, 0.05, 0, 0, 0],\n"
               "       link: {collision: {geometry: {box: {size: [0.01, 0.6, 0.1]}}}}}\n"
               "    - {name: aside, static: true, pose: [0, -0.058, 0.05, 0, 0, 0],\n"
               "       link: {collision: {geometry: {box: {size: [0.3, 0.01, 0.1]}}}}}\n"
               "  include: {uri: model://epuck2, name: epuck}\n");
    write_file(folder_ / "experiment.yaml",
               "world: world.yaml\nduration: 1\nseed: 1\nphysics: {fidelity: articulated}\n"
               "teams:\n  - {name: alone, robots: epuck, controller: constant, period: 5}\n");
  }
  std::unique_ptr<BridgedRun> simulate(const std::string& seconds, const std::vector<std::string>& more = {}) const {
    return std::make_unique<BridgedRun>(with_bridge((folder_ / "experiment.yaml").string(), seconds, "epuck", more));
  }
  /// The robot turns on the spot, commanded by one program to the end.
  static void turn(EpuckProgram& program, int exchanges) {
    for (int i = 0; i < exchanges; ++i) {
      program.send(EpuckProgram::command(-150, 150));
      program.receive_sensors();
    }
  }
  static void turn_to_the_end(EpuckProgram& program) {
    for (;;) {
      program.send(EpuckProgram::command(-150, 150));
      if (program.receive(1).empty()) return;
      program.receive(104);
    }
  }
  std::string hash_of_undisturbed_turn() const {
    const auto simulated = simulate("1");
    EpuckProgram program(simulated->port("epuck"));
    turn_to_the_end(program);
    return simulated->summary()["state_hash"];
  }

 private:
  ScratchFolder folder_;
};

TEST_F(Epuck2Bridge, AProgramForTheRobotAvoidsObstaclesAndTwoRunsGiveTheSameBits) {
  std::vector<std::string> hashes;
  for (int run = 0; run < 2; ++run) {
    BridgedRun simulated(with_bridge("epuck2", "30", "0..3"));
    std::vector<EpuckProgram> programs;
    for (const char* robot : {"0", "1", "2", "3"}) programs.emplace_back(simulated.port(robot));
    const Drive made = drive(programs);
    const auto summary = simulated.summary();
    EXPECT_EQ(made.exchanges, 599);  // the answer to the last command is the run's end
    EXPECT_GT(made.steps, 1000);
    EXPECT_EQ(summary["touches"]["obstacles"], 0);
    EXPECT_EQ(summary["touches"]["robots"], 0);
    EXPECT_EQ(summary["late"], 0);
    hashes.push_back(summary["state_hash"]);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST_F(Epuck2Bridge, TheSensorsPacketSaysWhatTheDescriptionSays) {
  const auto simulated = simulate("1");
  EpuckProgram program(simulated->port("epuck"));
  program.send(EpuckProgram::command(0, 0));
  const Bytes at_rest = program.receive_sensors();
  EXPECT_NEAR(signed_16(at_rest, 0), 0, 8);
  EXPECT_NEAR(signed_16(at_rest, 2), 0, 8);
  EXPECT_NEAR(signed_16(at_rest, 4), 768, 8);
  EXPECT_NEAR(real_32(at_rest, 6), 768.0, 8.0);
  EXPECT_EQ(real_32(at_rest, 10), 0.0F);
  EXPECT_NEAR(real_32(at_rest, 14), 0.0, 1.0);
  // The field of SDF: x to the east, where the robot looks.
  EXPECT_NEAR(real_32(at_rest, 24), -22.9, 0.5);
  EXPECT_NEAR(real_32(at_rest, 28), 5.6, 0.5);
  EXPECT_NEAR(real_32(at_rest, 32), -42.4, 0.5);
  EXPECT_EQ(at_rest[36], 25);
  EXPECT_NEAR(proximity(at_rest)[2], 613, 5);  // 4526 exp(-0.9994 * 2)
  EXPECT_EQ(proximity(at_rest)[5], 0);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(unsigned_16(at_rest, 53 + 2 * i), 4000);
  EXPECT_EQ(unsigned_16(at_rest, 69), 200);
  EXPECT_EQ(signed_16(at_rest, 79), 0);
  EXPECT_EQ(unsigned_16(at_rest, 83), 3440);
  EXPECT_EQ(at_rest[89], 15);
  EXPECT_NEAR(unsigned_16(at_rest, 92), 625, 40);

  Bytes turning;
  for (int i = 0; i < 10; ++i) {
    program.send(EpuckProgram::command(-200, 200));
    turning = program.receive_sensors();
  }
  EXPECT_NEAR(signed_16(turning, 79), -100, 2);  // 0.5 s
  EXPECT_NEAR(signed_16(turning, 81), 100, 2);
  // 400 steps/s * pi 41 mm / 1000 steps / 53 mm = 0.972 rad/s = 55.7 degrees/s, 131 counts each.
  EXPECT_NEAR(signed_16(turning, 22), 7297, 100);

  // Bit 2 of the settings: the counters are set, and the speed stays.
  Bytes set = EpuckProgram::command(1000, -1000);
  set[2] = 0x04;
  program.send(set);
  const Bytes counted = program.receive_sensors();
  EXPECT_NEAR(signed_16(counted, 79), 1000 - 10, 2);
  EXPECT_NEAR(signed_16(counted, 81), -1000 + 10, 2);
}

TEST_F(Epuck2Bridge, AnswersWithWhatTheRequestAsksFor) {
  const auto simulated = simulate("1");
  EpuckProgram program(simulated->port("epuck"));
  program.send(EpuckProgram::command(0, 0, EpuckProgram::nothing));
  EXPECT_EQ(program.receive(1), Bytes{0x03});
  program.send(EpuckProgram::command(0, 0, EpuckProgram::image));
  EXPECT_EQ(program.receive(1), Bytes{0x01});
  EXPECT_EQ(program.receive(38400), Bytes(38400, 0));
  program.send(EpuckProgram::command(0, 0, EpuckProgram::image | EpuckProgram::sensors));
  EXPECT_EQ(program.receive(1), Bytes{0x01});
  EXPECT_EQ(program.receive(38400).size(), 38400U);
  EXPECT_NEAR(proximity(program.receive_sensors())[2], 613, 5);
}

TEST_F(Epuck2Bridge, AnswersWithOneOfTwoPacketsWhereAProgramReadsOneAtATime) {
  const auto simulated = simulate("1", {"--packets", "in-turn"});
  EpuckProgram program(simulated->port("epuck"));
  for (int i = 0; i < 4; ++i) {
    program.send(EpuckProgram::command(0, 0, EpuckProgram::image | EpuckProgram::sensors));
    const bool is_image = i % 2 == 0;
    EXPECT_EQ(program.receive(1), is_image ? Bytes{0x01} : Bytes{0x02});
    EXPECT_EQ(program.receive(is_image ? 38400 : 104).size(), is_image ? 38400U : 104U);
  }
  program.send(EpuckProgram::command(0, 0));
  program.receive_sensors();
}

TEST_F(Epuck2Bridge, APacketThatIsNoneEndsItsConnectionByNameAndLeavesTheRunItsBits) {
  const std::string expected = hash_of_undisturbed_turn();
  const auto simulated = simulate("1");
  const std::uint16_t port = simulated->port("epuck");
  {
    EpuckProgram program(port);
    turn(program, 5);
  }
  Bytes unknown_request = EpuckProgram::command(100, 100);
  unknown_request[1] = 0x40;
  Bytes cut = EpuckProgram::command(100, 100);
  cut.resize(7);
  const Bytes long_text(10'000, 'A');
  for (const auto& [sent, reason] : {std::pair(Bytes{'G', 'E', 'T'}, "a command begins with 0x80, not with 0x47"),
                                     {long_text, "a command begins with 0x80, not with 0x41"},
                                     {unknown_request, "request 0x40: expected image (1), sensors (2) or both (3)"}}) {
    EpuckProgram program(port);
    program.send(sent);
    EXPECT_TRUE(program.is_cut_off());
    EXPECT_TRUE(simulated->bridge().wait_for_output(reason)) << simulated->bridge().output();
  }
  { EpuckProgram(port).send(cut); }
  EXPECT_TRUE(simulated->bridge().wait_for_output("after 7 of 21 bytes")) << simulated->bridge().output();
  EpuckProgram program(port);
  turn_to_the_end(program);
  EXPECT_EQ(simulated->summary()["state_hash"], expected);
}

TEST_F(Epuck2Bridge, ACommandThatComesInPiecesIsOne) {
  const std::string expected = hash_of_undisturbed_turn();
  const auto simulated = simulate("1");
  EpuckProgram program(simulated->port("epuck"));
  for (int i = 0; i < 19; ++i) {
    for (const std::uint8_t byte : EpuckProgram::command(-150, 150)) program.send({byte});
    program.receive_sensors();
  }
  program.send(EpuckProgram::command(-150, 150));
  EXPECT_TRUE(program.is_cut_off());
  EXPECT_EQ(simulated->summary()["state_hash"], expected);
}

TEST_F(Epuck2Bridge, TimeStandsStillUntilAProgramHasConnectedAgain) {
  const std::string expected = hash_of_undisturbed_turn();
  const auto simulated = simulate("1");
  const std::uint16_t port = simulated->port("epuck");
  for (int program_number = 0; program_number < 3; ++program_number) {
    EpuckProgram program(port);
    turn(program, 5);
  }
  EpuckProgram program(port);
  turn_to_the_end(program);
  EXPECT_EQ(simulated->summary()["state_hash"], expected);
}

TEST_F(Epuck2Bridge, OrTheRobotStandsAndTheRunGoesOnToItsEnd) {
  std::vector<std::string> hashes;
  for (int run = 0; run < 2; ++run) {
    const auto simulated = simulate("5", {"--without-program", "stand"});
    {
      EpuckProgram program(simulated->port("epuck"));
      turn(program, 5);
    }
    const auto summary = simulated->summary();
    EXPECT_EQ(summary["ticks"], 500);
    hashes.push_back(summary["state_hash"]);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST_F(Epuck2Bridge, LeavesWhenTheServerDoesWhileAProgramIsSilent) {
  const auto simulated = simulate("1");
  EpuckProgram program(simulated->port("epuck"));
  turn(program, 3);
  simulated->server().signal(SIGINT);
  EXPECT_TRUE(program.is_cut_off());
  EXPECT_EQ(simulated->bridge().wait_for_exit(), 0) << simulated->bridge().output();
}

TEST_F(Epuck2Bridge, LeavesWhenItsServerIsKilledWhileAProgramIsSilent) {
  const auto simulated = simulate("1");
  EpuckProgram program(simulated->port("epuck"));
  turn(program, 3);
  simulated->server().signal(SIGKILL);
  EXPECT_TRUE(program.is_cut_off());
  EXPECT_EQ(simulated->bridge().wait_for_exit(), 1) << simulated->bridge().output();
  EXPECT_NE(simulated->bridge().output().find("is gone"), std::string::npos) << simulated->bridge().output();
}

TEST_F(Epuck2Bridge, EndsWhenItIsToldToWhileItWaits) {
  const auto simulated = simulate("1");
  simulated->port("epuck");
  simulated->bridge().signal(SIGTERM);
  EXPECT_EQ(simulated->bridge().wait_for_exit(), 130) << simulated->bridge().output();
}

TEST(Epuck2BridgeOptions, AreRefusedWithWhatToDo) {
  const std::string program = COHORT_BUILD_DIR "/bin/cohort-epuck2-bridge";
  for (const auto& [arguments, text] : {std::pair(std::vector<std::string>{"--robots", "all"}, "single robots"),
                                        {{"--robots", "epucks/*"}, "single robots"},
                                        {{"--robots", "0..x"}, "'x': expected the id of a robot"},
                                        {{"--robots", ","}, "'--robots' is empty"},
                                        {{"--robots", "0..3", "--listen", "127.0.0.1,127.0.0.2"}, "one for each robot"},
                                        {{"--listen", "nowhere"}, "is not an IPv4 address"},
                                        {{"--listen", "192.0.2.1", "--port", "0"}, "cannot listen on 192.0.2.1:0"},
                                        {{"--robots", "0..3", "--port", "65534"}, "the last robot exceeds 65535"},
                                        {{"--without-program", "dance"}, "--without-program"}}) {
    std::vector<std::string> command{program};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const Ended ended = run_to_end(command);
    EXPECT_EQ(ended.exit_code, 2) << ended.err;
    EXPECT_NE(ended.err.find(text), std::string::npos) << ended.err;
  }
}

// As real robots are reached: each at its own address, all at the same port.
TEST_F(Epuck2Bridge, RobotsMayHaveAddressesOfTheirOwn) {
  BridgedRun simulated(with_bridge("epuck2", "1", "0..1", {"--listen", "127.0.0.1,127.0.0.2"}));
  EpuckProgram first(simulated.port("0"), "127.0.0.1");
  EpuckProgram second(simulated.port("1"), "127.0.0.2");
  EXPECT_NE(simulated.bridge().output().find("127.0.0.2"), std::string::npos);
}

}  // namespace
}  // namespace cohort::test
