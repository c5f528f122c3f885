// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <regex>

#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

const std::string program = COHORT_BUILD_DIR "/bin/cohort-avr-bridge";
const std::string shipped = COHORT_SOURCE_DIR "/worlds/experiments/arduino.yaml";
const std::string shipped_pins = COHORT_SOURCE_DIR "/worlds/robots/two_wheeler/pins.yaml";

std::string firmware(const std::string& name) { return COHORT_AVR_FIRMWARE "/" + name; }

// One robot, 1 m from a wall.
class AvrBridge : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(firmware("avoid.elf")))
      GTEST_SKIP() << "there is no avr-gcc: tools/dev/install-packages tools/dev/packages-avr.txt";
    write_file(folder_ / "world.yaml",
               "world:\n  name: room\n  model:\n"
               "    - {name: ground, static: true, link: {collision: {geometry: {plane: {}}}}}\n"
               "    - {name: wall, static: true, pose: [1, 0, 0.1, 0, 0, 0],\n"
               "       link: {collision: {geometry: {box: {size: [0.02, 4, 0.2]}}}}}\n"
               "  include: {uri: model://two_wheeler, name: robot}\n");
    write_file(alone_,
               "world: world.yaml\nduration: 3\nseed: 1\nphysics: {fidelity: articulated}\n"
               "teams:\n  - {name: alone, robots: robot, controller: constant, period: 2}\n");
  }

  // A server and a bridge that drives all of its robots.
  struct Run {
    Run(const std::filesystem::path& folder, const std::string& experiment, std::vector<std::string> of_server,
        std::vector<std::string> of_bridge)
        : summary(folder / "summary.json") {
      of_server.insert(of_server.begin(), {cohort_program(), "serve", experiment, "--domain", domain.text(),
                                           "--summary", summary.string()});
      server = std::make_unique<Process>(of_server);
      of_bridge.insert(of_bridge.begin(), {program, "--robots", "all", "--domain", domain.text()});
      bridge = std::make_unique<Process>(of_bridge);
    }
    nlohmann::json end() const {
      EXPECT_EQ(server->wait_for_exit(), 0) << server->output();
      EXPECT_EQ(bridge->wait_for_exit(), 0) << bridge->output();
      return read_json(summary);
    }
    Ended control(std::vector<std::string> arguments) const {
      arguments.insert(arguments.begin(), {cohort_program(), "ctl", "--domain", domain.text()});
      return run_to_end(arguments);
    }
    ReservedDomain domain;
    std::filesystem::path summary;
    std::unique_ptr<Process> server, bridge;
  };
  std::unique_ptr<Run> run(const std::string& experiment, const std::string& image,
                           const std::vector<std::string>& of_server = {}, std::vector<std::string> of_bridge = {}) {
    of_bridge.insert(of_bridge.end(), {"--image", firmware(image), "--pins", shipped_pins});
    return std::make_unique<Run>(folder_.path(), experiment, of_server, of_bridge);
  }

  const ScratchFolder folder_;
  const std::string alone_ = (folder_ / "experiment.yaml").string();
};

TEST_F(AvrBridge, AProgramInCAvoidsObstaclesWithTheSameBitsForAnyNumberOfThreads) {
  std::vector<std::string> hashes;
  for (const char* threads : {"1", "2", "2"}) {
    const auto made = run(shipped, "avoid.elf", {"--duration", "20", "--threads", threads}, {"--threads", threads});
    const auto summary = made->end();
    hashes.push_back(summary["state_hash"]);
    EXPECT_EQ(summary["touches"]["obstacles"], 0);
    EXPECT_EQ(summary["touches"]["robots"], 0);
    EXPECT_EQ(summary["late"], 0);
    // The firmware counts the edges of its encoder: each of the four robots has gone far.
    const std::string output = made->bridge->output();
    for (const char* robot : {"robot_0", "robot_1", "robot_2", "robot_3"}) {
      const std::regex line(std::string("robot ") + robot + ": 19\\.\\d+ s: step 950 edges (\\d+) adc");
      std::smatch match;
      ASSERT_TRUE(std::regex_search(output, match, line)) << output;
      EXPECT_GT(std::stoi(match[1]), 400);
    }
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[1], hashes[2]);
}

TEST_F(AvrBridge, ASketchForAnArduinoAvoidsObstaclesWithTheSameBits) {
  if (!std::filesystem::exists(firmware("sketch.elf")))
    GTEST_SKIP() << "there is no core for Arduino: tools/dev/install-packages tools/dev/packages-avr.txt";
  std::vector<std::string> hashes;
  for (int i = 0; i < 2; ++i) {
    const auto made = run(shipped, "sketch.elf", {"--duration", "10"});
    const auto summary = made->end();
    hashes.push_back(summary["state_hash"]);
    EXPECT_EQ(summary["touches"]["obstacles"], 0);
    EXPECT_TRUE(std::regex_search(made->bridge->output(), std::regex("robot robot_3: 9\\.\\d+ s: edges \\d\\d+ ahead")))
        << made->bridge->output();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

// A wall is 1 m ahead of the robot's axle, 7 cm behind its sensor.
TEST_F(AvrBridge, AnUltrasonicSensorSaysHowFarAWallIs) {
  if (!std::filesystem::exists(firmware("sketch.elf")))
    GTEST_SKIP() << "there is no core for Arduino: tools/dev/install-packages tools/dev/packages-avr.txt";
  const auto made = run(alone_, "sketch.elf", {"--duration", "1.5"});
  made->end();
  std::smatch match;
  const std::string output = made->bridge->output();
  ASSERT_TRUE(std::regex_search(output, match, std::regex("edges (\\d+) ahead (\\d+)"))) << output;
  // By 80 edges of one turn of 204 mm, of which the interrupt sees those of one pin.
  const double gone = std::stod(match[1]) / 40.0 * 204.2;
  EXPECT_GT(gone, 50.0);
  EXPECT_NEAR(std::stod(match[2]), 990.0 - 72.0 - gone, 60.0);
}

TEST_F(AvrBridge, AResetStartsMicrocontrollersFromPowerOn) {
  const std::string undisturbed = run(alone_, "avoid.elf")->end()["state_hash"];
  const auto made = run(alone_, "avoid.elf", {"--paused"});
  EXPECT_EQ(made->control({"step", "120"}).exit_code, 0);
  EXPECT_EQ(made->control({"reset"}).exit_code, 0);
  EXPECT_EQ(made->control({"resume"}).exit_code, 0);
  EXPECT_EQ(made->end()["state_hash"], undisturbed);
  const std::string output = made->bridge->output();
  const auto first = output.find("ready");
  EXPECT_NE(output.find("ready", first + 1), std::string::npos) << output;
}

TEST_F(AvrBridge, FaultsOfACoreAreReportedByName) {
  for (const auto& [image, text] :
       {std::pair("fault_1.elf", "robot robot: tick 50: the microcontroller has crashed: invalid instruction"),
        {"fault_2.elf", "has crashed: it writes to an invalid address"},
        {"fault_3.elf", "has crashed: it executed beyond the end"},
        {"fault_4.elf", "tick 62: the microcontroller was reset by its watchdog"},
        {"fault_5.elf", "the microcontroller sleeps with interrupts disabled"}}) {
    const auto made = run(alone_, image, {"--duration", "1.5"});
    made->end();
    EXPECT_NE(made->bridge->output().find(text), std::string::npos) << made->bridge->output();
  }
}

TEST_F(AvrBridge, ASecondBridgeOfTheSameRobotsIsRefusedAndChangesNoBit) {
  const std::string undisturbed = run(alone_, "avoid.elf")->end()["state_hash"];
  const auto made = run(alone_, "avoid.elf", {"--paused"});
  ASSERT_EQ(made->control({"step", "20"}).exit_code, 0);
  Process second({program, "--robots", "all", "--domain", made->domain.text(), "--image", firmware("avoid.elf"),
                  "--pins", shipped_pins});
  for (int i = 0; i < 100 && second.running(); ++i) EXPECT_EQ(made->control({"step", "1"}).exit_code, 0);
  EXPECT_EQ(made->control({"resume"}).exit_code, 0);
  EXPECT_EQ(made->end()["state_hash"], undisturbed);
  EXPECT_EQ(second.wait_for_exit(), 2);
  EXPECT_NE(second.output().find("is driven by cohort-avr-bridge"), std::string::npos) << second.output();
}

TEST_F(AvrBridge, AnImageForEachRobotOrOneForAll) {
  const std::string two = firmware("avoid.elf") + "," + firmware("fault_5.elf");
  const Run made(folder_.path(), shipped, {"--duration", "1"}, {"--image", two, "--pins", shipped_pins});
  EXPECT_EQ(made.bridge->wait_for_exit(), 1);
  EXPECT_NE(made.bridge->output().find("there are 2 images for 4 robots"), std::string::npos) << made.bridge->output();
}

TEST_F(AvrBridge, ASerialInterfaceIsAPseudoTerminal) {
  const auto made = run(alone_, "avoid.elf", {"--paused"}, {"--serial", "pty"});
  ASSERT_TRUE(made->bridge->wait_for_output("robot robot: its serial interface is at /dev/pts/"));
  std::smatch match;
  const std::string output = made->bridge->output();
  ASSERT_TRUE(std::regex_search(output, match, std::regex("/dev/pts/\\d+")));
  EXPECT_EQ(made->control({"step", "20"}).exit_code, 0);
  std::ifstream serial(match.str());
  std::string line;
  std::getline(serial, line);
  EXPECT_EQ(line, "ready");
  EXPECT_EQ(made->control({"resume"}).exit_code, 0);
  made->end();
}

TEST_F(AvrBridge, MistakesInOptionsAndFilesEndItBeforeItAttaches) {
  write_file(folder_ / "garbage", "garbage");
  write_file(folder_ / "pins.yaml", "wires:\n  - {motor: left_wheel/0/velocity, enable: PD5}\n");
  const std::string avoid = firmware("avoid.elf"), garbage = (folder_ / "garbage").string();
  using Arguments = std::vector<std::string>;
  for (const auto& [arguments, text] :
       {std::pair(Arguments{"--image", garbage, "--pins", shipped_pins}, "neither an ELF file nor Intel HEX"),
        {{"--image", garbage + "-not", "--pins", shipped_pins}, "no such file"},
        {{"--image", firmware("mega.elf"), "--pins", shipped_pins}, "the image is for an atmega2560"},
        {{"--image", firmware("avoid.hex"), "--benchmark", "1"}, "--mcu is required"},
        {{"--image", avoid, "--benchmark", "1"}, "--frequency is required"},
        {{"--image", avoid, "--pins", shipped_pins, "--mcu", "z80"}, "not for an z80"},
        {{"--image", avoid}, "--pins is required"},
        {{"--pins", shipped_pins}, "--image is required"},
        {{"--image", avoid, "--pins", (folder_ / "pins.yaml").string(), "--frequency", "1"}, "pins.yaml:2: 'scale'"},
        {{"--image", avoid, "--pins", shipped_pins, "--serial", "usb"}, "'usb': expected one of log|none|pty"},
        {{"--image", avoid, "--pins", shipped_pins, "--robots", ","}, "'--robots' is empty"}}) {
    Arguments command{program};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const Ended ended = run_to_end(command);
    EXPECT_EQ(ended.exit_code, 2) << ended.err;
    EXPECT_NE(ended.err.find(text), std::string::npos) << ended.err;
  }
}

TEST_F(AvrBridge, PrintsTextsOfFilesWithoutControlSequencesAndShortens) {
  const std::string avoid = firmware("avoid.elf");
  const std::string pins = (folder_ / "pins.yaml").string();
  for (const std::string& text : {std::string("mcu: \"\\e]0;title\\a\\x9b31m\""), "mcu: " + std::string(900'000, 'x'),
                                  std::string("wires: [{led: leds/0/color, pin: \"\\e]0;title\\a\"}]")}) {
    write_file(pins, text + "\n");
    const Ended bridge = run_to_end({program, "--robots", "0", "--image", avoid, "--pins", pins});
    EXPECT_EQ(bridge.exit_code, 2);
    EXPECT_LT(bridge.err.size(), 20'000u);
    for (const char control : {'\x1b', '\a', '\x9b'})
      EXPECT_EQ(bridge.err.find(control), std::string::npos) << bridge.err;
  }
}

TEST_F(AvrBridge, SaysHowFastItIs) {
  const Ended ended =
      run_to_end({program, "--image", firmware("avoid.elf"), "--frequency", "16000000", "--benchmark", "0.5"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_NE(ended.out.find("avoid.elf on an atmega328p at 16 MHz"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("simulated MHz"), std::string::npos) << ended.out;
}

}  // namespace
}  // namespace cohort::test
