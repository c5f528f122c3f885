// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/avr/core.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/files.hpp"
#include "tools/bridges/avr/avr_robot.hpp"
#include "tools/bridges/avr/board.hpp"
#include "tools/bridges/avr/image.hpp"
#include "tools/bridges/avr/pins.hpp"
#include "tools/bridges/avr/simavr.hpp"

namespace cohort::avr {
namespace {

using test::ScratchFolder;
using test::write_file;

constexpr std::uint64_t millisecond = 16'000;  // [cycles]
const Chip uno{"atmega328p", 16'000'000, 5.0};

std::string firmware(const std::string& name) { return COHORT_AVR_FIRMWARE "/" + name; }

std::string error_of(const std::function<void()>& function) {
  try {
    function();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

class AvrCore : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(firmware("signals.elf")))
      GTEST_SKIP() << "there is no avr-gcc: tools/dev/install-packages tools/dev/packages-avr.txt";
  }
};

// A core with what it sent.
struct Talking {
  explicit Talking(const std::string& file) : core(read_image(firmware(file)), uno) {
    core.connect_serial(0, [this](std::uint8_t byte) { received += static_cast<char>(byte); });
  }
  // Asks one question, and returns the answer.
  int ask(char question) {
    received.clear();
    const auto byte = static_cast<std::uint8_t>(question);
    EXPECT_EQ(core.send_serial(0, {&byte, 1}), 1U);
    core.run_until(core.cycle() + 5 * millisecond);
    return received.empty() ? -1 : static_cast<unsigned char>(received[0]);
  }
  Core core;
  std::string received;
};

TEST_F(AvrCore, MeasuresDutiesAsTheDataSheetHasThem) {
  Talking signals("signals.elf");
  std::map<std::string, Output*> pins;
  for (const char* name : {"PD6", "PD5", "PB1", "PB2", "PB3", "PD2", "PD7"})
    pins[name] = &signals.core.outputs().watch(pin_of(name, ""));
  signals.core.run_until(10 * millisecond);
  signals.core.outputs().begin_window();
  const std::uint64_t begin = signals.core.cycle();
  signals.core.run_until(begin + 40 * millisecond);
  const std::uint64_t now = signals.core.cycle();
  EXPECT_NEAR(pins["PD6"]->duty(now), 64.0 / 256.0, 1e-12);
  EXPECT_NEAR(pins["PD5"]->duty(now), 1.0 - 64.0 / 256.0, 1e-12);
  EXPECT_NEAR(pins["PB1"]->duty(now), 256.0 / 1023.0, 1e-12);
  EXPECT_NEAR(pins["PB2"]->duty(now), 1.0, 1e-12);
  EXPECT_NEAR(pins["PB3"]->duty(now), 0.5, 1e-3);
  EXPECT_NEAR(pins["PD2"]->duty(now), 0.25, 1e-3);
  EXPECT_EQ(pins["PD7"]->duty(now), 0.0);
  // 8 MHz of a timer at 2 * 1023 counts, and pulses of 1 ms each 4 ms.
  EXPECT_NEAR(*pins["PB1"]->period(begin), 8.0 * 2046.0, 1e-9);
  EXPECT_NEAR(*pins["PD2"]->pulse(begin), 1.0 * millisecond, 50.0);
  EXPECT_NEAR(*pins["PD2"]->period(begin), 4.0 * millisecond, 50.0);
  EXPECT_FALSE(pins["PD7"]->pulse(0).has_value());
}

TEST_F(AvrCore, APinThatATimerHasLeftIsAsItsPortSays) {
  Talking signals("signals.elf");
  Output& left = signals.core.outputs().watch({'D', 6});
  Output& written = signals.core.outputs().watch({'D', 7});
  signals.core.run_until(10 * millisecond);
  signals.ask('s');
  signals.core.outputs().begin_window();
  signals.core.run_until(signals.core.cycle() + millisecond);
  EXPECT_EQ(left.duty(signals.core.cycle()), 0.0);
  EXPECT_EQ(written.duty(signals.core.cycle()), 1.0);
}

TEST_F(AvrCore, ReadsVoltagesAndLevelsThatAreSetFromOutside) {
  Talking signals("signals.elf");
  signals.core.run_until(10 * millisecond);
  EXPECT_EQ(signals.received, "!");
  signals.core.set_voltage(3, 2.5);
  EXPECT_NEAR(signals.ask('a'), 127, 1);
  signals.core.set_voltage(3, 99.0);  // within the supply
  EXPECT_EQ(signals.ask('a'), 255);
  signals.core.set_voltage(3, std::nan(""));
  EXPECT_EQ(signals.ask('a'), 0);
  signals.core.set_input({'B', 0}, false);
  EXPECT_EQ(signals.ask('p'), 0);
  signals.core.set_input({'B', 0}, true);
  EXPECT_EQ(signals.ask('p'), 1);
  // The pull-up of the pin does not win when another pin of its port is written.
  signals.core.set_input({'B', 0}, false);
  EXPECT_EQ(signals.ask('w'), 0);
  EXPECT_EQ(signals.ask('p'), 0);
}

TEST_F(AvrCore, TheSameCyclesRunHoweverTheyAreCutIntoFrames) {
  const auto edges_of = [](std::uint64_t frame) {
    Core core(read_image(firmware("edges.elf")), uno);
    std::vector<std::pair<std::uint64_t, bool>> edges;
    for (const int bit : {0, 1, 2, 4, 5})
      core.outputs().watch({'B', bit}).edge = [&edges](std::uint64_t cycle, bool high) {
        edges.emplace_back(cycle, high);
      };
    for (std::uint64_t end = 0; end < 200 * millisecond;) core.run_until(end += frame);
    return edges;
  };
  const auto whole = edges_of(200 * millisecond);
  EXPECT_GT(whole.size(), 1000U);
  EXPECT_EQ(edges_of(20 * millisecond), whole);
  EXPECT_EQ(edges_of(1000), whole);
  EXPECT_EQ(edges_of(1), whole);
}

TEST_F(AvrCore, ATimeHasAsManyCyclesAsItsPartsWithoutDrift) {
  using std::chrono::nanoseconds;
  EXPECT_EQ(cycles_in(nanoseconds(20'000'000), 16'000'000), 320'000U);
  // A third of a millisecond at an odd frequency, for a hundred days.
  const nanoseconds long_time(8'640'000'000'000'000);
  EXPECT_EQ(cycles_in(long_time, 7'372'800), 63'700'992'000'000U);
  EXPECT_EQ(cycles_in(nanoseconds(333'333), 7'372'800), 2457U);
}

TEST_F(AvrCore, ACoreThatDoesWhatNoChipCanStopsByName) {
  for (const auto& [fault, text] : {std::pair("fault_1.elf", "invalid instruction 0x0001"),
                                    {"fault_2.elf", "it writes to an invalid address"},
                                    {"fault_3.elf", "beyond the end of its flash memory"}}) {
    Core core(read_image(firmware(fault)), uno);
    core.run_until(490 * millisecond);
    EXPECT_FALSE(core.fault().has_value());
    core.run_until(600 * millisecond);
    ASSERT_TRUE(core.fault().has_value()) << fault;
    EXPECT_NE(core.fault()->find(text), std::string::npos) << *core.fault();
    EXPECT_EQ(core.cycle(), 600 * millisecond);
  }
}

TEST_F(AvrCore, AWatchdogResetsItAlsoFromASleepWithoutEnd) {
  for (const auto& [fault, notes] :
       {std::pair("fault_4.elf", std::vector<std::string>{"was reset by its watchdog"}),
        {"fault_5.elf", {"sleeps with interrupts disabled"}},
        {"fault_6.elf", {"sleeps with interrupts disabled", "was reset by its watchdog"}}}) {
    Core core(read_image(firmware(fault)), uno);
    Output& motor = core.outputs().watch({'D', 5});
    core.run_until(1000 * millisecond);
    EXPECT_FALSE(core.fault().has_value());
    const std::vector<std::string> noted = core.take_notes();
    ASSERT_EQ(noted.size(), notes.size()) << fault;
    for (std::size_t i = 0; i < notes.size(); ++i) EXPECT_TRUE(noted[i].starts_with(notes[i])) << noted[i];
    // It runs again after the reset, and drives its pins again.
    EXPECT_EQ(motor.waveform().duty, 1.0);
  }
}

TEST_F(AvrCore, AWatchdogResetsItAgainAndAgainAfterTheSameTime) {
  Core core(read_image(firmware("watchdog.elf")), uno);
  core.set_input({'D', 2}, false);  // the pin of an interrupt by level
  std::vector<std::uint64_t> starts;
  core.outputs().watch({'B', 0}).edge = [&](std::uint64_t cycle, bool high) {
    if (high) starts.push_back(cycle);
  };
  for (int frame = 1; frame <= 100; ++frame) {
    core.run_until(static_cast<std::uint64_t>(frame) * 10 * millisecond);
    // Nothing to do until then: simavr is slow if a timer ends in each cycle.
    ASSERT_NE(core.handle()->cycle_timers.timer, nullptr);
    EXPECT_GT(core.handle()->cycle_timers.timer->when, core.cycle() + 1) << "after " << starts.size() << " starts";
  }
  ASSERT_EQ(starts.size(), 8U);
  for (std::size_t i = 1; i < starts.size(); ++i)
    EXPECT_NEAR(static_cast<double>(starts[i] - starts[i - 1]), 128.0 * millisecond, 100.0)
        << "16,384 periods of 128 kHz";
}

TEST_F(AvrCore, ImagesThatAreNoneAreRefusedWithWhatWasExpected) {
  const ScratchFolder folder;
  const auto refused = [&folder](const std::string& content) {
    write_file(folder / "image", content);
    return error_of([&] { Core(read_image(folder / "image"), uno); });
  };
  EXPECT_NE(error_of([&] { read_image(folder / "none"); }).find("no such file"), std::string::npos);
  EXPECT_NE(refused("").find("neither an ELF file nor Intel HEX"), std::string::npos);
  EXPECT_NE(refused("Hello").find("neither an ELF file nor Intel HEX"), std::string::npos);
  EXPECT_NE(refused(":00000001FF\n").find("contains no program"), std::string::npos);
  EXPECT_NE(refused(":0100000000FF\n").find("image: the end-of-file record is missing"), std::string::npos);
  EXPECT_NE(refused(":0100000000FF\n:0100000000FE\n").find("image:2: wrong checksum"), std::string::npos);
  EXPECT_NE(refused(":01000000GG00\n").find("image:1: expected a hexadecimal digit"), std::string::npos);
  EXPECT_NE(refused(":02000000FF\n").find("image:1: the record has 5 bytes"), std::string::npos);
  EXPECT_NE(refused(":020000021000EC\n:0100000000FF\n:00000001FF\n").find("the program ends at address 0x10001"),
            std::string::npos);
  const std::string elf = test::read_file(firmware("edges.elf"));
  EXPECT_NE(refused(elf.substr(0, 30)).find("truncated"), std::string::npos);
  EXPECT_NE(refused(elf.substr(0, 200)).find("truncated"), std::string::npos);
  EXPECT_NE(refused(test::read_file("/proc/self/exe").substr(0, 4000)).find("for another processor"),
            std::string::npos);
  EXPECT_NE(error_of([] {
              Core(read_image(firmware("mega.elf")), uno);
            }).find("the image is for an atmega2560, not for an atmega328p"),
            std::string::npos);
  EXPECT_NE(error_of([] {
              Core(read_image(firmware("edges.hex")), {"atmega999", 16'000'000, 5.0});
            }).find("simavr has no microcontroller 'atmega999'"),
            std::string::npos);
  // Any byte may be wrong: that is a mistake with a name or an image, never anything else.
  for (std::size_t place = 0; place < elf.size(); place += 7) {
    std::string broken = elf;
    broken[place] = static_cast<char>(broken[place] ^ 0x55);
    write_file(folder / "image", broken);
    try {
      Core core(read_image(folder / "image"), uno);
      core.run_until(millisecond);
    } catch (const std::runtime_error&) {
    }
  }
}

// Instructions at random do all that firmware can do amiss.
TEST(AvrCoreWithNonsense, StopsByNameOrRunsButHarmsNothing) {
  std::size_t faults = 0;
  for (unsigned seed = 0; seed < 150; ++seed) {
    std::mt19937 random(seed);
    Image image{"nonsense"};
    image.flash.push_back({0, std::vector<std::uint8_t>(0x4000)});
    for (std::uint8_t& byte : image.flash[0].bytes) byte = static_cast<std::uint8_t>(random() & 0xff);
    const std::vector<std::string> mcus{"atmega328p", "atmega2560", "atmega32u4"};
    Core core(image, {mcus[seed % mcus.size()], 16'000'000, 5.0});
    core.outputs().watch({'B', 1});
    for (std::uint64_t i = 1; i <= 20; ++i) {
      core.set_input({'B', 0}, i % 2 == 0);
      core.run_until(10'000 * i);
    }
    if (core.fault()) ++faults;
  }
  EXPECT_GT(faults, 100U);
}

TEST_F(AvrCore, HexAndElfAreTheSameProgram) {
  for (const char* name : {"edges", "avoid", "signals"}) {
    Core elf(read_image(firmware(std::string(name) + ".elf")), uno);
    Core hex(read_image(firmware(std::string(name) + ".hex")), uno);
    elf.run_until(50 * millisecond);
    hex.run_until(50 * millisecond);
    EXPECT_EQ(elf.cycle(), hex.cycle());
    EXPECT_EQ(elf.program_counter(), hex.program_counter());
  }
}

TEST(AvrPins, MistakesAreToldWithFileAndLine) {
  const ScratchFolder folder;
  const auto refused = [&folder](const std::string& wires) {
    write_file(folder / "pins.yaml", "mcu: atmega328p\nwires:\n" + wires);
    return error_of([&] { read_pins(folder / "pins.yaml"); });
  };
  for (const auto& [wires, text] :
       {std::pair("  - {motor: a/0/velocity, scale: 1}\n", "pins.yaml:3: a motor requires 'forward'"),
        {"  - {motor: a/0/velocity, enable: D5}\n", "pins.yaml:3: 'scale' is missing"},
        {"  - {motor: a/0/velocity, scale: fast, enable: D5}\n", "pins.yaml:3: 'scale': expected a number"},
        {"  - {motor: a/0/velocity, scale: 1, enable: D99}\n", "pins.yaml:3: 'enable': 'D99' is not a pin"},
        {"  - {led: led/0/color, pin: D13}\n  - {lamp: b, pin: D1}\n",
         "pins.yaml:4: expected one of motor, servo, led"},
        {"  - {led: led/0/color, pin: D13, colour: red}\n", "pins.yaml:3: 'colour': unknown key"},
        {"  - {led: led/0/color, motor: a, pin: D13}\n", "has both 'motor' and 'led'"},
        {"  - {analog: a/0/reading, pin: B1, scale: 1}\n", "'pin': expected an analog input"},
        {"  - {analog: a/0/reading, pin: A0, points: [[0, 1]]}\n", "expected two points or more"},
        {"  - {analog: a/0/reading, pin: A0, points: [[1, 1], [0, 2]]}\n", "in ascending order"},
        {"  - {encoder: a/0/position, a: D2, edges_per_turn: 0}\n", "'edges_per_turn': expected a number above 0"},
        {"  - {bumper: a/0/touching, pin: D2, pressed: down}\n", "'pressed': expected low or high"},
        {"  - {bumper: [\n", "pins.yaml:"},
        {"  here\n", "expected 'wires' as a list"}}) {
    EXPECT_NE(refused(wires).find(text), std::string::npos) << refused(wires) << "\nnot: " << text;
  }
  EXPECT_NE(error_of([&] { read_pins(folder / "none.yaml"); }).find("no such file"), std::string::npos);
}

TEST(AvrPins, BoardsNumberTheirPinsAsArduinoDoes) {
  EXPECT_EQ(pin_of("D13", "atmega328p"), (Pin{'B', 5}));
  EXPECT_EQ(pin_of("A5", "atmega328p"), (Pin{'C', 5}));
  EXPECT_EQ(pin_of("D13", "atmega2560"), (Pin{'B', 7}));
  EXPECT_EQ(pin_of("D53", "atmega2560"), (Pin{'B', 0}));
  EXPECT_EQ(pin_of("A15", "atmega2560"), (Pin{'K', 7}));
  EXPECT_EQ(pin_of("D13", "atmega32u4"), (Pin{'C', 7}));
  EXPECT_EQ(pin_of("PD6", "attiny85"), (Pin{'D', 6}));
  EXPECT_NE(error_of([] { pin_of("D1", "attiny85"); }).find("expected a port and a bit"), std::string::npos);
}

// An observation and a command without a server.
class OneWheel {
 public:
  OneWheel() {
    start_.observation_channels = {{"wheel/0/position", "rad", 0, 1, -1e9, 1e9, 0.0}};
    start_.command_channels = {{"wheel/0/velocity", "rad/s", 0, 1, -100.0, 100.0, 0.0}};
  }
  const Start& start() const { return start_; }
  void sense(Board& board, double position, std::uint64_t begin, std::uint64_t end) const {
    board.sense(Observation(0, {}, {&position, 1}), begin, end);
  }

 private:
  Start start_;
};

TEST_F(AvrCore, AnEncoderMakesTheLastWayAgainEvenlyAndInQuadrature) {
  Pins pins{"pins.yaml"};
  pins.wires.push_back({Encoder{{"wheel/0/position"}, {'D', 2}, Pin{'D', 3}, 80.0}, 1});
  const auto board = make_board(pins);
  Core core(read_image(firmware("edges.elf")), uno);
  const OneWheel wheel;
  board->start(wheel.start(), core);
  std::vector<std::pair<std::uint64_t, int>> seen;
  const auto level = [&core](int bit) { return core.input({'D', bit}) ? 1 : 0; };
  const double turn = 2.0 * std::numbers::pi;
  wheel.sense(*board, 0.0, 0, 20 * millisecond);
  core.run_until(20 * millisecond);
  wheel.sense(*board, turn * 8.0 / 80.0, 20 * millisecond, 40 * millisecond);
  for (std::uint64_t ms = 20; ms < 40; ++ms) {
    core.run_until(ms * millisecond + millisecond / 2);
    seen.emplace_back(ms, level(2) * 2 + level(3));
  }
  core.run_until(40 * millisecond);
  // Eight edges in 20 ms: one each 2.5 ms, of A first.
  std::vector<int> order{0};
  for (const auto& [ms, levels] : seen)
    if (levels != order.back()) order.push_back(levels);
  EXPECT_EQ(order, (std::vector<int>{0, 2, 3, 1, 0, 2, 3, 1}));
  EXPECT_EQ(level(2) * 2 + level(3), 0);
  // And back.
  wheel.sense(*board, turn * 6.0 / 80.0, 40 * millisecond, 60 * millisecond);
  core.run_until(60 * millisecond);
  EXPECT_EQ(level(2) * 2 + level(3), 3);
}

TEST_F(AvrCore, ABoardMakesCommandsOfWhatPinsDo) {
  Start start;
  const auto channel = [](const char* name, std::uint32_t offset, std::uint32_t size) {
    return ChannelInfo{name, "1", offset, size, -1000.0, 1000.0, 0.0};
  };
  start.command_channels = {channel("wheel/0/velocity", 0, 1),   channel("head/0/position", 1, 1),
                            channel("led/0/color", 2, 3),        channel("buzzer/0/frequency", 5, 1),
                            channel("buzzer/0/intensity", 6, 1), channel("fin/0/position", 7, 1)};
  Pins pins{"pins.yaml"};
  const auto servo = [](const char* name, Pin pin) {
    return Servo{{name}, pin, Curve({{0.0005, -1.0}, {0.0015, 1.0}})};
  };
  const auto wire = [&pins](const Wire& what) { pins.wires.push_back({what, 1}); };
  wire(Motor{{"wheel/0/velocity"}, 8.0, Pin{'D', 6}, {}, Pin{'B', 3}, {}});  // 8 * 0.25 * (1 - 0.5)
  wire(servo("head/0/position", {'D', 2}));                                  // 1 ms
  wire(Led{"led/0/color", Pin{'D', 6}, {}, Pin{'B', 2}, {}, true});
  wire(Speaker{"buzzer", {'D', 2}, 0.5});
  wire(servo("fin/0/position", {'D', 7}));  // no pulses
  const auto board = make_board(pins);
  Core core(read_image(firmware("signals.elf")), uno);
  board->start(start, core);
  std::vector<double> values(8);
  for (std::uint64_t frame = 0; frame < 3; ++frame) {
    core.outputs().begin_window();
    board->sense(Observation(0, {}, {}), core.cycle(), 20 * millisecond * (frame + 1));
    core.run_until(20 * millisecond * (frame + 1));
    values.assign(8, 0.0);
    Command command(values);
    board->act(command);
  }
  EXPECT_NEAR(values[0], 1.0, 0.01);
  EXPECT_NEAR(values[1], 0.0, 0.01);
  EXPECT_NEAR(values[2], 0.75, 1e-12);  // lit while low
  EXPECT_EQ(values[3], 0.0);            // without a pin
  EXPECT_NEAR(values[4], 0.0, 1e-12);
  EXPECT_NEAR(values[5], 250.0, 1.0);
  EXPECT_EQ(values[6], 0.5);
  EXPECT_EQ(values[7], 0.0);
}

TEST_F(AvrCore, AWireThatTheRobotHasNotIsToldWithItsLine) {
  Pins pins{"pins.yaml"};
  pins.wires.push_back({Motor{{"weel/0/velocity"}, 1.0, Pin{'D', 5}, {}, {}, {}}, 7});
  Core core(read_image(firmware("edges.elf")), uno);
  const OneWheel wheel;
  const std::string unknown = error_of([&] { make_board(pins)->start(wheel.start(), core); });
  EXPECT_TRUE(unknown.starts_with("pins.yaml:7: ")) << unknown;
  EXPECT_NE(unknown.find("wheel/0/velocity"), std::string::npos) << unknown;
  pins.wires = {{Motor{{"wheel/0/velocity"}, 1.0, Pin{'F', 5}, {}, {}, {}}, 8}};
  EXPECT_EQ(error_of([&] { make_board(pins)->start(wheel.start(), core); }),
            "pins.yaml:8: an atmega328p has no pin PF5");
}

}  // namespace
}  // namespace cohort::avr
