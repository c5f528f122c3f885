// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/avr/kilobot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <regex>
#include <string>
#include <vector>

#include "tests/support/process.hpp"
#include "tools/bridges/avr/simavr.hpp"

namespace cohort::avr::kilobot {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using test::ScratchFolder;
using test::write_file;

const std::string program = COHORT_BUILD_DIR "/bin/cohort-avr-bridge";
const std::string shipped = COHORT_SOURCE_DIR "/worlds/experiments/kilobot.yaml";

std::string firmware(const std::string& name) { return COHORT_AVR_FIRMWARE "/" + name; }

constexpr double bit = 269.0 / 8e6;  // [s]

// A Kilobot without board and server: its core, its infrared, and what it said.
struct Kilobot {
  Kilobot(Air& air, std::uint32_t number, const std::string& image, double clock = 1.0) {
    Robot::Options options{read_image(firmware(image)), chip()};
    Start start;
    start.robot = number;
    prepare(options, start);
    options.chip.frequency = static_cast<std::uint32_t>(8e6 * clock);
    core = std::make_unique<Core>(options.image, options.chip);
    infrared = std::make_unique<Transceiver>(air, number, *core);
    core->connect_serial(0, [this](std::uint8_t byte) { said += static_cast<char>(byte); });
    Output& pin = core->outputs().watch({'B', 0});
    pin.edge = [this, pass_on = pin.edge](std::uint64_t cycle, bool high) {
      if (high) sent.push_back(static_cast<double>(cycle) / core->chip().frequency);
      pass_on(cycle, high);
    };
    avr_irq_register_notify(
        avr_io_getirq(core->handle(), static_cast<std::uint32_t>(AVR_IOCTL_ACOMP_GETIRQ), ACOMP_IRQ_OUT),
        [](avr_irq_t*, std::uint32_t high, void* self) {
          auto* its = static_cast<Kilobot*>(self);
          const double now = static_cast<double>(its->core->cycle()) / its->core->chip().frequency;
          if (high != 0)
            its->received.push_back(now);
          else if (!its->received.empty())
            its->longest = std::max(its->longest, now - its->received.back());
        },
        this);
  }
  std::unique_ptr<Core> core;
  std::unique_ptr<Transceiver> infrared;
  std::string said;
  std::vector<double> sent, received;  // when pulses began [s]
  double longest = 0.0;                // longest received pulse [s]
};

void run(Air& air, const std::vector<Kilobot*>& robots, nanoseconds end, nanoseconds begin = nanoseconds{0}) {
  for (nanoseconds time = begin; time < end;) {
    time = std::min(time + air.window(), end);
    for (Kilobot* robot : robots) robot->core->run_until(cycles_in(time, robot->core->chip().frequency));
    air.exchange();
  }
}

int lines_in(const std::string& text, const std::string& expression) {
  const std::regex line(expression);
  return static_cast<int>(std::distance(std::sregex_iterator(text.begin(), text.end(), line), {}));
}

class KilobotFirmware : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(firmware("kilobot.elf")))
      GTEST_SKIP() << "there is no avr-gcc: tools/dev/install-packages tools/dev/packages-avr.txt";
  }
  Air air_;
};

TEST_F(KilobotFirmware, AMessageArrivesPulseByPulseOneBitLater) {
  Kilobot sender(air_, 513, "kilobot_sends.elf"), receiver(air_, 7, "kilobot.elf");
  receiver.infrared->hear({{513, 0.05}});
  run(air_, {&sender, &receiver}, milliseconds{900});
  EXPECT_GE(lines_in(receiver.said, "heard 513 high"), 3) << receiver.said;
  EXPECT_EQ(receiver.said.find("garbled"), std::string::npos);
  ASSERT_EQ(sender.sent.size(), receiver.received.size());
  ASSERT_GT(sender.sent.size(), 100U);
  for (std::size_t i = 0; i < sender.sent.size(); ++i)
    EXPECT_NEAR(receiver.received[i] - sender.sent[i], bit, 8.0 / 8e6) << i;  // the end of an instruction
  // Within a message, pulses are whole bits apart.
  const double bits = (receiver.received[40] - receiver.received[0]) / bit;
  EXPECT_NEAR(bits, std::round(bits), 0.1);
}

TEST_F(KilobotFirmware, ClocksThatDifferByTwoPerCentUnderstandEachOther) {
  Kilobot sender(air_, 1, "kilobot_sends.elf", 1.01), receiver(air_, 2, "kilobot.elf", 0.99);
  receiver.infrared->hear({{1, 0.05}});
  run(air_, {&sender, &receiver}, milliseconds{900});
  EXPECT_GE(lines_in(receiver.said, "heard 1 high"), 3) << receiver.said;
  EXPECT_EQ(receiver.said.find("garbled"), std::string::npos);
}

TEST_F(KilobotFirmware, RobotsOutOfRangeReceiveNothing) {
  Kilobot sender(air_, 1, "kilobot_sends.elf"), receiver(air_, 2, "kilobot.elf");
  receiver.infrared->hear({{3, 0.05}});
  run(air_, {&sender, &receiver}, milliseconds{900});
  EXPECT_GT(sender.sent.size(), 100U);
  EXPECT_TRUE(receiver.received.empty());
}

TEST_F(KilobotFirmware, BothGainsSayHowFarTheSenderIs) {
  std::vector<int> lows, highs;
  for (const int millimetres : {33, 40, 50, 60, 70, 80, 90, 97}) {
    Air air;
    Kilobot sender(air, 1, "kilobot_sends.elf"), receiver(air, 2, "kilobot.elf");
    receiver.infrared->hear({{1, millimetres / 1000.0}});
    run(air, {&sender, &receiver}, milliseconds{300});
    std::smatch match;
    ASSERT_TRUE(std::regex_search(receiver.said, match, std::regex("high (\\d+) low (\\d+) mm (\\d+)"))) << millimetres;
    const Gains gains = gains_at(millimetres / 1000.0);
    EXPECT_NEAR(std::stoi(match[1]), gains.high, 1);
    EXPECT_NEAR(std::stoi(match[2]), gains.low, 1);
    EXPECT_NEAR(std::stoi(match[3]), millimetres, 1);
    highs.push_back(gains.high);
    lows.push_back(gains.low);
  }
  EXPECT_EQ(lows.front(), 900);
  EXPECT_EQ(highs.front(), 1023);  // too strong for the high gain
  for (std::size_t i = 1; i < lows.size(); ++i) EXPECT_LT(lows[i], lows[i - 1]);
  EXPECT_LT(highs.back(), 900);
}

// The two begin at the same time, so neither hears the other while it listens.
TEST_F(KilobotFirmware, TwoThatSendAtTheSameTimeGarbleEachOther) {
  Kilobot one(air_, 1, "kilobot_sends.elf"), other(air_, 2, "kilobot_sends.elf"), receiver(air_, 3, "kilobot.elf");
  one.infrared->hear({{2, 0.06}});
  other.infrared->hear({{1, 0.06}});
  receiver.infrared->hear({{1, 0.04}, {2, 0.04}});
  run(air_, {&one, &other, &receiver}, milliseconds{900});
  EXPECT_EQ(lines_in(receiver.said, "heard"), 0) << receiver.said;
  EXPECT_GE(lines_in(receiver.said, "garbled"), 3) << receiver.said;
}

TEST_F(KilobotFirmware, PulsesThatOverlapAreOneThatIsLonger) {
  std::vector<double> longest;
  for (const bool hears_both : {false, true}) {
    Air air;
    Kilobot one(air, 1, "kilobot_sends.elf"), other(air, 2, "kilobot_sends.elf"), receiver(air, 3, "kilobot.elf");
    receiver.infrared->hear({{1, 0.05}});
    if (hears_both) receiver.infrared->hear({{1, 0.05}, {2, 0.05}});
    other.infrared->switch_on(nanoseconds{750});  // six cycles
    run(air, {&one, &other, &receiver}, milliseconds{400});
    ASSERT_GT(receiver.received.size(), 10U);
    longest.push_back(receiver.longest * 8e6);
  }
  EXPECT_NEAR(longest[1] - longest[0], 6.0, 3.0);
}

TEST_F(KilobotFirmware, ALaterSenderDetectsATransmissionAndWaits) {
  Kilobot one(air_, 1, "kilobot_sends.elf"), other(air_, 2, "kilobot_sends.elf"), receiver(air_, 3, "kilobot.elf");
  one.infrared->hear({{2, 0.06}});
  other.infrared->hear({{1, 0.06}});
  receiver.infrared->hear({{1, 0.04}, {2, 0.04}});
  // By 2 ms, half a message: it is within the message of the first one.
  other.infrared->switch_on(milliseconds{2});
  for (nanoseconds time{0}; time < milliseconds{900}; time += air_.window()) {
    for (Kilobot* robot : {&one, &other, &receiver}) {
      const nanoseconds since = robot == &other ? std::max(time - milliseconds{2}, nanoseconds{0}) : time;
      robot->core->run_until(cycles_in(since, 8'000'000));
    }
    air_.exchange();
  }
  EXPECT_GE(lines_in(receiver.said, "heard 1"), 3) << receiver.said;
  EXPECT_EQ(lines_in(receiver.said, "garbled"), 0) << receiver.said;
}

// A board without a server.
struct Lone {
  Lone() {
    const auto channel = [](const char* name, std::uint32_t offset, std::uint32_t size) {
      return ChannelInfo{name, "1", offset, size, -1e9, 1e9, 0.0};
    };
    start.command_channels = {channel("legs/left/velocity", 0, 1), channel("legs/right/velocity", 1, 1),
                              channel("led/0/color", 2, 3), channel("infrared/0/sending", 5, 1),
                              channel("infrared/0/message", 6, 1)};
    start.observation_channels = {channel("light/0/reading", 0, 1), channel("infrared/0/count", 1, 1),
                                  channel("infrared/0/range", 2, 1), channel("infrared/0/message", 3, 1)};
    start.robot = 300;
    start.seed = 5;
  }
  // Runs it for two seconds, and returns its command at the end.
  std::vector<double> run(const std::string& image, bool overhead) {
    Robot::Options options{read_image(firmware(image)), chip()};
    prepare(options, start);
    Core core(options.image, options.chip);
    core.connect_serial(0, [this](std::uint8_t byte) { said += static_cast<char>(byte); });
    const auto board = make_board(air, overhead);
    board->start(start, core);
    board->switch_on(options.power_on);
    std::vector<double> values(7);
    for (int frame = 1; frame <= 100; ++frame) {
      core.outputs().begin_window();
      const std::array<double, 4> observed{0.5, 1.0, 0.05, std::nan("")};
      board->sense(Observation(0, {}, observed), 0, 0);
      core.run_until(cycles_in(milliseconds{20} * frame, options.chip.frequency));
      values.assign(7, 0.0);
      Command command(values);
      board->act(command);
    }
    return values;
  }
  Air air;
  Start start;
  std::string said;
};

TEST_F(KilobotFirmware, MotorsAndColorsAreThoseOfItsPins) {
  // One motor, at the calibrated power, moves the right side; green is dim, blue less so.
  EXPECT_EQ(Lone().run("kilobot.elf", true), (std::vector<double>{0.0, 0.01, 0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0, 300.0}));
  EXPECT_EQ(Lone().run("kilobot_sends.elf", true), (std::vector<double>{0.01, 0.01, 1.0, 0.0, 0.0, 1.0, 300.0}));
}

TEST_F(KilobotFirmware, StandsUntilTheOverheadControllerTellsItToRun) {
  Lone told, not_told;
  EXPECT_EQ(not_told.run("kilobot.elf", false)[1], 0.0);
  EXPECT_EQ(lines_in(not_told.said, "run"), 0);
  told.run("kilobot.elf", true);
  EXPECT_EQ(lines_in(told.said, "run"), 3) << told.said;
}

TEST_F(KilobotFirmware, HasItsNumberAndSensesBatteryAndLight) {
  Lone lone;
  lone.run("kilobot.elf", false);
  std::smatch match;
  ASSERT_TRUE(std::regex_search(lone.said, match, std::regex("number 300 battery (\\d+) light (\\d+)"))) << lone.said;
  EXPECT_NEAR(std::stoi(match[1]), 699, 3);  // 2.05 V of 3 V
  EXPECT_NEAR(std::stoi(match[2]), 511, 1);
}

TEST_F(KilobotFirmware, EachHasAClockAndAPowerOnOfItsOwn) {
  Robot::Options first, second, again;
  Start start;
  start.seed = 1;
  prepare(first, start);
  prepare(again, start);
  start.seed = 2;
  prepare(second, start);
  EXPECT_EQ(first.chip.frequency, again.chip.frequency);
  EXPECT_EQ(first.power_on, again.power_on);
  EXPECT_NE(first.chip.frequency, second.chip.frequency);
  EXPECT_NE(first.power_on, second.power_on);
  for (const auto* options : {&first, &second}) {
    EXPECT_NEAR(options->chip.frequency, 8e6, 8e4);
    EXPECT_LE(options->power_on, milliseconds{500});
  }
}

// A server and a bridge that drives all of its robots.
class KilobotBridge : public KilobotFirmware {
 protected:
  struct Ran {
    nlohmann::json summary;
    std::string output;
  };
  Ran run(const std::string& experiment, const std::vector<std::string>& images, const std::string& duration,
          const std::string& threads = "2") {
    const test::ReservedDomain domain;
    std::string list;
    for (const std::string& image : images) list += (list.empty() ? "" : ",") + firmware(image);
    test::Process server({test::cohort_program(), "serve", experiment, "--domain", domain.text(), "--duration",
                          duration, "--threads", threads, "--summary", (folder_ / "summary.json").string()});
    test::Process bridge({program, "--board", "kilobot", "--robots", "all", "--domain", domain.text(), "--image", list,
                          "--threads", threads});
    EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
    EXPECT_EQ(bridge.wait_for_exit(), 0) << bridge.output();
    return {test::read_json(folder_ / "summary.json"), bridge.output()};
  }
  // Two robots, 60 mm apart.
  std::string pair() {
    write_file(folder_ / "world.yaml",
               "world:\n  name: table\n  model:\n"
               "    - {name: ground, static: true, link: {collision: {geometry: {plane: {}}}}}\n"
               "  include:\n"
               "    - {uri: model://kilobot, name: a}\n"
               "    - {uri: model://kilobot, name: b, pose: [0, 0.06, 0, 0, 0, 0]}\n");
    write_file(folder_ / "pair.yaml",
               "world: world.yaml\nduration: 3\nseed: 1\nphysics: {fidelity: planar}\n"
               "teams:\n  - {name: pair, robots: all, controller: constant, period: 2}\n");
    return (folder_ / "pair.yaml").string();
  }
  const ScratchFolder folder_;
};

TEST_F(KilobotBridge, NeighboursHearEachOtherWithTheSameBitsForAnyNumberOfThreads) {
  std::vector<std::string> hashes, outputs;
  for (const char* threads : {"1", "2", "2"}) {
    const Ran ran = run(shipped, {"kilobot_sends.elf"}, "2", threads);
    hashes.push_back(ran.summary["state_hash"]);
    outputs.push_back(std::regex_replace(ran.output, std::regex("process \\d+"), ""));
    EXPECT_EQ(ran.summary["late"], 0);
    // Robot 12 is in the middle: those at its sides are 6 cm away, those across 8.5 cm.
    for (const char* heard : {"heard 7 ", "heard 11 ", "heard 13 ", "heard 17 ", "heard 6 ", "heard 18 "})
      EXPECT_GT(lines_in(ran.output, std::string("robot swarm/kilobot_12: [^\n]*") + heard), 0) << heard;
    EXPECT_EQ(lines_in(ran.output, "robot swarm/kilobot_12: [^\n]*heard (2|10|14|22) "), 0);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[1], hashes[2]);
  EXPECT_EQ(outputs[0], outputs[1]);
  EXPECT_EQ(outputs[1], outputs[2]);
}

TEST_F(KilobotBridge, TheDistanceOfANeighbourIsThatOfTheSimulation) {
  // Before they are told to run.
  const Ran ran = run(pair(), {"kilobot_sends.elf", "kilobot.elf"}, "1");
  EXPECT_GE(lines_in(ran.output, "robot b: [^\n]*heard 0 high \\d+ low \\d+ mm (59|60|61)\n"), 1) << ran.output;
}

TEST_F(KilobotBridge, AResetStartsAllFromPowerOn) {
  const std::string experiment = pair();
  const std::string undisturbed = run(experiment, {"kilobot_sends.elf"}, "3").summary["state_hash"];
  const test::ReservedDomain domain;
  test::Process server({test::cohort_program(), "serve", experiment, "--domain", domain.text(), "--paused", "--summary",
                        (folder_ / "summary.json").string()});
  test::Process bridge({program, "--board", "kilobot", "--robots", "all", "--domain", domain.text(), "--image",
                        firmware("kilobot_sends.elf")});
  using Arguments = std::vector<std::string>;
  for (Arguments order : {Arguments{"step", "155"}, {"reset"}, {"resume"}}) {
    order.insert(order.begin(), {test::cohort_program(), "ctl", "--domain", domain.text()});
    EXPECT_EQ(test::run_to_end(order).exit_code, 0);
  }
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_EQ(bridge.wait_for_exit(), 0) << bridge.output();
  EXPECT_EQ(test::read_json(folder_ / "summary.json")["state_hash"], undisturbed);
  EXPECT_EQ(lines_in(bridge.output(), "robot a: [^\n]*number 0 "), 2) << bridge.output();
}

TEST_F(KilobotBridge, ACoreThatCrashesIsNamedAndTheOtherOneGoesOn) {
  const Ran ran = run(pair(), {"kilobot_sends.elf", "fault_1.elf"}, "2");
  EXPECT_EQ(lines_in(ran.output, "robot b: tick \\d+: the microcontroller has crashed: invalid instruction"), 1)
      << ran.output;
  EXPECT_EQ(lines_in(ran.output, "robot a: [^\n]*run\n"), 3) << ran.output;
}

TEST_F(KilobotBridge, MistakesInOptionsEndIt) {
  using Arguments = std::vector<std::string>;
  const std::string image = firmware("kilobot.elf");
  for (const auto& [arguments, text] :
       {std::pair(Arguments{"--pins", "pins.yaml"}, "--pins cannot be used with --board kilobot"),
        {{"--mcu", "atmega328p"}, "--mcu cannot be used with --board kilobot"},
        {{"--frequency", "1000000"}, "--frequency cannot be used with --board kilobot"},
        {{"--overhead", "always"}, "'always': expected one of none|run"}}) {
    Arguments command{program, "--board", "kilobot", "--image", image};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const test::Ended ended = test::run_to_end(command);
    EXPECT_EQ(ended.exit_code, 2) << ended.err;
    EXPECT_NE(ended.err.find(text), std::string::npos) << ended.err;
  }
  const test::Ended other = test::run_to_end({program, "--board", "kilobot", "--image", firmware("mega.elf")});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("the image is for an atmega2560, not for an atmega328p"), std::string::npos) << other.err;
}

TEST_F(KilobotBridge, ARobotOfAnotherModelIsRefused) {
  const test::ReservedDomain domain;
  test::Process server({test::cohort_program(), "serve", COHORT_SOURCE_DIR "/worlds/experiments/arduino.yaml",
                        "--domain", domain.text(), "--duration", "1"});
  test::Process bridge({program, "--board", "kilobot", "--robots", "all", "--domain", domain.text(), "--image",
                        firmware("kilobot.elf")});
  EXPECT_EQ(bridge.wait_for_exit(), 1);
  EXPECT_NE(bridge.output().find("robot robot_0: "), std::string::npos) << bridge.output();
  EXPECT_NE(bridge.output().find("legs/left/velocity"), std::string::npos) << bridge.output();
}

TEST_F(KilobotBridge, SaysHowManyRunInRealTime) {
  const test::Ended ended =
      test::run_to_end({program, "--board", "kilobot", "--image", firmware("kilobot.elf"), "--benchmark", "0.3"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_NE(ended.out.find("kilobot.elf on 8 Kilobots: simulated 0.3 s"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("Kilobots run in real time"), std::string::npos) << ended.out;
}

}  // namespace
}  // namespace cohort::avr::kilobot
