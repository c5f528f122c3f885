// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <string>
#include <vector>

#include "tests/bridges/bridged_run.hpp"
#include "tests/bridges/serial_board.hpp"
#include "tests/support/process.hpp"
#include "tools/bridges/mavlink/hil_messages.hpp"
#include "tools/bridges/mavlink/payload.hpp"

namespace cohort::test {
namespace {

using Bytes = SerialBoard::Bytes;

// PX4 on a board: sends controls at its own pace, with times of its own clock, once it has sensed.
class Px4Board {
 public:
  Bytes operator()(const Bytes& received) {
    received_.insert(received_.end(), received.begin(), received.end());
    while (const std::size_t size = mavlink::size_at(received_)) {
      if (size > received_.size()) break;
      const auto end = received_.begin() + static_cast<std::ptrdiff_t>(size);
      const mavlink::Piece piece = mavlink::piece_of(Bytes(received_.begin(), end));
      received_.erase(received_.begin(), end);
      if (!piece.packet || !piece.is_known) continue;
      if (mavlink::message_in<mavlink::HilSensor>(*piece.packet)) ++sensors;
      if (mavlink::message_in<mavlink::HilGps>(*piece.packet)) ++fixes;
    }
    if (says_nonsense) return Bytes(100, 'x');
    if (is_silent || sensors == 0) return {};
    mavlink::HilActuatorControls controls;
    controls.time_usec = clock_ += 3000;
    controls.flags = 1;
    controls.mode = 129;
    controls.controls[0] = controls.controls[1] = 0.5F;
    ++sent;
    return mavlink::frame_of({sequence_++, 1, 1, controls.id, mavlink::payload_of(controls)}, controls.crc_extra);
  }

  std::atomic<int> sensors{0}, fixes{0}, sent{0};
  std::atomic<bool> is_silent{false}, says_nonsense{false};

 private:
  Bytes received_;
  std::uint64_t clock_ = 987'654'321;  // it has run for a while
  std::uint8_t sequence_ = 0;
};

// Two rovers: PX4 on a board drives one, a controller in lockstep the other.
class HardwareInTheLoop : public ::testing::Test {
 protected:
  HardwareInTheLoop() { write_experiment("mode: free, on_late: zero, deadline: 0.3"); }

  void write_experiment(const std::string& mode) const {
    write_file(folder_ / "world.yaml",
               "world:\n  name: yard\n  model:\n"
               "    - {name: ground, static: true, link: {collision: {geometry: {plane: {}}}}}\n"
               "  include:\n    - {uri: model://rover, name: real}\n"
               "    - {uri: model://rover, name: simulated, pose: [0, 3, 0, 0, 0, 0]}\n");
    write_file(folder_ / "experiment.yaml",
               "world: world.yaml\nduration: 600\nstep: 0.004\nseed: 1\nphysics: {fidelity: articulated}\nteams:\n"
               "  - {name: board, robots: real, controller: constant, " +
                   mode +
                   "}\n"
                   "  - name: others\n    robots: simulated\n    controller: constant\n"
                   "    parameters: {left_wheel/0/velocity: 4, right_wheel/0/velocity: 5}\n");
  }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::vector<std::string> serve() const {
    return {cohort_program(), "serve",     file("experiment.yaml"), "--domain", domain_.text(), "--record",
            file("run.mcap"), "--summary", file("summary.json")};
  }
  std::vector<std::string> host() const {
    return {cohort_program(), "host", "constant", "--robots", "simulated", "--domain", domain_.text()};
  }
  std::vector<std::string> bridge(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> command = {COHORT_BUILD_DIR "/bin/cohort-px4-bridge",
                                        "--robots",
                                        "real",
                                        "--serial",
                                        file("ttyBOARD") + ":921600",
                                        "--domain",
                                        domain_.text()};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }
  nlohmann::json end(Process& server, Process& bridge);

  ScratchFolder folder_;
  ReservedDomain domain_;
};

std::size_t count_in(const std::string& output, const std::string& text) {
  std::size_t count = 0;
  for (auto at = output.find(text); at != std::string::npos; at = output.find(text, at + 1)) ++count;
  return count;
}

// The run goes at the pace of the wall clock for as long as a test needs, and then ends in order.
nlohmann::json HardwareInTheLoop::end(Process& server, Process& bridge) {
  server.signal(SIGINT);
  EXPECT_EQ(server.wait_for_exit(), 130) << server.output();
  EXPECT_TRUE(bridge.wait_for_exit()) << bridge.output();
  return read_json(file("summary.json"));
}

TEST_F(HardwareInTheLoop, ABoardThatIsUnpluggedStopsItsRobotAndDrivesAgainAndTheRunReplaysWithoutItToTheSameHash) {
  Px4Board px4;
  SerialBoard board(file("ttyBOARD"), std::ref(px4));
  Process server(serve(), {{"COHORT_LOG", "info"}});
  Process others(host());
  Process bridge(this->bridge());
  ASSERT_TRUE(bridge.wait_for_output("the firmware drives")) << bridge.output();
  board.unplug();
  ASSERT_TRUE(bridge.wait_for_output("is unplugged")) << bridge.output();
  ASSERT_TRUE(server.wait_for_output("missed: real did not answer in time")) << server.output();
  const int sensors_before = px4.sensors;
  board.plug_in();
  ASSERT_TRUE(eventually([&] { return count_in(bridge.output(), "the firmware drives") == 2; })) << bridge.output();
  EXPECT_TRUE(eventually([&] { return px4.sensors > sensors_before && px4.fixes >= 2; })) << "it senses again";

  const auto summary = end(server, bridge);
  ASSERT_GE(summary["misses"].size(), 1U);
  EXPECT_EQ(summary["misses"][0]["robot"], "real");
  EXPECT_EQ(summary["misses"][0]["on_late"], "zero");
  EXPECT_GT(summary["lateness_us"]["max"], 0.0);
  EXPECT_LE(summary["late_ticks"], summary["ticks"]);
  EXPECT_NE(server.output().find("longer than a step in "), std::string::npos) << server.output();

  const int boundaries = summary["ticks"].get<int>() + 1;
  for (const char* threads : {"1", "2"}) {
    const Ended replay = run_to_end({cohort_program(), "replay", file("run.mcap"), "--verify", "--threads", threads});
    EXPECT_EQ(replay.exit_code, 0) << replay.err;
    EXPECT_NE(replay.out.find("identical, " + std::to_string(boundaries) + " ticks"), std::string::npos) << replay.out;
  }
}

TEST_F(HardwareInTheLoop, ABoardThatSaysNonsenseOrNothingIsNamedAndItsTeamsPolicyDecides) {
  Px4Board px4;
  const SerialBoard board(file("ttyBOARD"), std::ref(px4));
  Process server(serve(), {{"COHORT_LOG", "info"}});
  Process others(host());
  Process bridge(this->bridge({"--patience", "0.5"}));
  ASSERT_TRUE(bridge.wait_for_output("the firmware drives")) << bridge.output();
  px4.says_nonsense = true;
  EXPECT_TRUE(bridge.wait_for_output("not a valid MAVLink 2 message")) << bridge.output();
  EXPECT_TRUE(server.wait_for_output("missed: real did not answer in time")) << server.output();
  EXPECT_TRUE(bridge.wait_for_output("has stopped sending controls")) << bridge.output();
  px4.says_nonsense = false;
  ASSERT_TRUE(eventually([&] { return count_in(bridge.output(), "the firmware drives") == 2; })) << bridge.output();
  px4.is_silent = true;
  EXPECT_TRUE(eventually([&] { return count_in(bridge.output(), "has stopped sending controls") == 2; }))
      << bridge.output();
  EXPECT_TRUE(others.running());
  end(server, bridge);
}

TEST_F(HardwareInTheLoop, ARobotThatStandsWithoutItsBoardMissesNothing) {
  write_experiment("mode: free, on_late: zero, deadline: 100");
  Px4Board px4;
  const SerialBoard board(file("ttyBOARD"), std::ref(px4));
  Process server(serve(), {{"COHORT_LOG", "info"}});
  Process others(host());
  Process bridge(this->bridge({"--without-firmware", "stand", "--patience", "0.5"}));
  ASSERT_TRUE(bridge.wait_for_output("the firmware drives")) << bridge.output();
  px4.is_silent = true;
  ASSERT_TRUE(bridge.wait_for_output("has stopped sending controls")) << bridge.output();
  px4.is_silent = false;
  ASSERT_TRUE(eventually([&] { return count_in(bridge.output(), "the firmware drives") == 2; })) << bridge.output();
  EXPECT_EQ(end(server, bridge)["late"], 0);
}

// A program for an e-puck2 that does not look at a clock, at a line in place of WiFi.
TEST_F(HardwareInTheLoop, ABoardWithTheCommandsOfTheEpuck2DrivesItAtItsOwnPace) {
  write_file(folder_ / "world.yaml",
             "world:\n  name: table\n  model:\n"
             "    - {name: ground, static: true, link: {collision: {geometry: {plane: {}}}}}\n"
             "  include: {uri: model://epuck2, name: real}\n");
  write_file(folder_ / "experiment.yaml",
             "world: world.yaml\nduration: 600\nseed: 1\nphysics: {fidelity: articulated}\nteams:\n"
             "  - {name: board, robots: real, controller: constant, mode: free, on_late: zero, deadline: 1}\n");
  std::atomic<int> answers = 0;
  Bytes received;
  bool waits = false;
  const SerialBoard board(file("ttyBOARD"), [&](const Bytes& bytes) -> Bytes {
    received.insert(received.end(), bytes.begin(), bytes.end());
    constexpr std::size_t answer_size = 105;
    if (waits && received.size() < answer_size) return {};
    if (waits) ++answers;
    received.clear();
    waits = true;
    Bytes command(21, 0);
    command[0] = 0x80;
    command[1] = 2;
    command[3] = command[5] = 200;
    return command;
  });
  Process server(serve());
  Process bridge({COHORT_BUILD_DIR "/bin/cohort-epuck2-bridge", "--serial", file("ttyBOARD") + ":115200", "--domain",
                  domain_.text()});
  ASSERT_TRUE(bridge.wait_for_output("has connected")) << bridge.output();
  EXPECT_TRUE(eventually([&] { return answers > 20; })) << bridge.output() << server.output();
  end(server, bridge);
  const Ended replay = run_to_end({cohort_program(), "replay", file("run.mcap"), "--verify"});
  EXPECT_EQ(replay.exit_code, 0) << replay.err;
}

TEST_F(HardwareInTheLoop, IsRefusedForATeamInLockstepWithWhatToDo) {
  write_experiment("mode: lockstep");
  Px4Board px4;
  const SerialBoard board(file("ttyBOARD"), std::ref(px4));
  Process server(serve());
  Process bridge(this->bridge());
  EXPECT_EQ(bridge.wait_for_exit(), 1);
  EXPECT_NE(bridge.output().find("set 'mode: free' for the team"), std::string::npos) << bridge.output();
}

TEST_F(HardwareInTheLoop, MistakesInTheDevicesAreNamed) {
  expect_refusals("cohort-px4-bridge",
                  {{{"--serial", "/no/such/tty:9600"}, "cannot open /no/such/tty"},
                   {{"--serial", "/dev/null"}, "expected a link tcp:ADDRESS:PORT"},
                   {{"--serial", "/dev/null:9600", "--robots", "0,1"}, "--serial expects one device for each robot"},
                   {{"--serial", "/dev/null:9600", "--port", "4560"}, "--port"}});
}

}  // namespace
}  // namespace cohort::test
