// SPDX-License-Identifier: Apache-2.0

// cohort-avr-bridge: compiled images for AVR microcontrollers drive robots of a simulation (docs/bridges/avr.md).

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tools/bridges/avr/benchmark.hpp"
#include "tools/bridges/avr/bridge.hpp"
#include "tools/bridges/avr/kilobot.hpp"
#include "tools/bridges/common/bridge_program.hpp"

namespace {

using namespace cohort;

enum class BoardKind { pins, kilobot };

struct Given {
  BoardKind board = BoardKind::pins;
  bool overhead = true;
  std::vector<std::string> images;
  std::string pins;
  std::string mcu;
  std::uint32_t frequency = 0;
  avr::SerialTo serial = avr::SerialTo::log;
  std::optional<unsigned> threads;
  double benchmark = 0.0;  // [s]
};

// Returns the chip: each property from the options, else from the pin map, else from the image.
avr::Chip chip_for(const Given& given, const avr::Pins& pins, const avr::Image& image) {
  avr::Chip chip{given.mcu, given.frequency, pins.supply};
  if (chip.mcu.empty()) chip.mcu = !pins.mcu.empty() ? pins.mcu : image.mcu;
  if (chip.frequency == 0) chip.frequency = pins.frequency.value_or(image.frequency.value_or(0));
  if (chip.mcu.empty())
    throw bridges::UsageError(image.file + " does not specify its microcontroller: --mcu is required");
  if (chip.frequency == 0)
    throw bridges::UsageError("--frequency is required: neither --pins nor the image specifies it");
  return chip;
}

// Reads all images and checks that each one fits its chip.
std::vector<avr::Robot::Options> read(const Given& given, const avr::Pins& pins) {
  std::vector<avr::Robot::Options> robots;
  for (const std::string& file : given.images) {
    avr::Robot::Options robot{avr::read_image(file), {}, given.serial, 0};
    robot.chip = given.board == BoardKind::kilobot ? avr::kilobot::chip() : chip_for(given, pins, robot.image);
    robot.serial = pins.serial.value_or(robot.chip.mcu == "atmega32u4" ? 1 : 0);
    avr::Core(robot.image, robot.chip);
    robots.push_back(std::move(robot));
  }
  return robots;
}

void add_options(bridges::BridgeProgram& program, Given& given) {
  CLI::App& app = program.app();
  app.add_option("--image", given.images,
                 "Compiled image (ELF or Intel HEX) for all robots, or one for each robot in the order of their ids")
      ->required()
      ->delimiter(',')
      ->type_name("FILE[,FILE...]");
  app.add_option("--pins", given.pins,
                 "Pin map: how the microcontroller's pins are wired to devices of the robot (YAML)")
      ->type_name("FILE");
  program.add_choice<BoardKind>(
      "--board", given.board, {{"pins", BoardKind::pins}, {"kilobot", BoardKind::kilobot}},
      "Board of the microcontroller: the one that --pins describes (pins, the default), or a Kilobot");
  program.add_choice<bool>(
      "--overhead", given.overhead, {{"run", true}, {"none", false}},
      "Overhead controller of Kilobots: one that starts them after 1 s (run, the default), or none");
  app.add_option("--mcu", given.mcu, "Microcontroller, such as atmega328p, atmega2560 or atmega32u4")
      ->type_name("NAME");
  app.add_option("--frequency", given.frequency, "Clock frequency of the microcontroller")->type_name("HZ");
  program.add_choice<avr::SerialTo>(
      "--serial", given.serial,
      {{"log", avr::SerialTo::log}, {"pty", avr::SerialTo::pty}, {"none", avr::SerialTo::none}},
      "Output of the serial port: lines on standard error (log, the default), a pseudo-terminal for each robot (pty), "
      "or none");
  app.add_option("--threads", given.threads,
                 "Number of threads that run microcontrollers (default: one per CPU; 1 for Kilobots)")
      ->check(CLI::Range(1, 256))
      ->type_name("N");
  app.add_option("--benchmark", given.benchmark,
                 "Run the image for this simulated time without a server, and print the speed")
      ->check(CLI::Range(0.001, 1e6))
      ->type_name("SECONDS");
  app.footer(
      "Example: cohort serve worlds/experiments/arduino.yaml &\n"
      "         cohort-avr-bridge --robots all --image sketch.elf --pins worlds/robots/two_wheeler/pins.yaml"
      "\n         cohort serve worlds/experiments/kilobot.yaml &\n"
      "         cohort-avr-bridge --board kilobot --robots all --image orbit.hex");
}

void run_benchmark(const Given& given) {
  constexpr unsigned kilobots = 8;
  const bool is_kilobot = given.board == BoardKind::kilobot;
  const avr::Pins pins = given.pins.empty() ? avr::Pins{} : avr::read_pins(given.pins);
  for (const avr::Robot::Options& robot : read(given, pins))
    if (is_kilobot)
      avr::kilobot::run_benchmark(robot.image, kilobots, given.overhead, given.benchmark);
    else
      avr::run_benchmark(robot.image, robot.chip, given.benchmark);
}

ClientEnd run_pins(const Given& given, const ClientOptions& client) {
  if (given.pins.empty()) throw bridges::UsageError("--pins is required: it describes the wiring of the pins");
  const avr::Pins pins = avr::read_pins(given.pins);
  const unsigned threads = given.threads.value_or(std::max(1U, std::thread::hardware_concurrency()));
  avr::Bridge bridge({client, read(given, pins), threads, [&pins] { return avr::make_board(pins); }});
  return bridge.run(stop_on_signals());
}

ClientEnd run_kilobots(const Given& given, const ClientOptions& client) {
  avr::kilobot::Air air;
  // Threads wait for each other so often that a second thread slows down a busy machine.
  avr::Bridge bridge({client, read(given, {}), given.threads.value_or(1),
                      [&] { return avr::kilobot::make_board(air, given.overhead); }, avr::kilobot::prepare, &air});
  return bridge.run(stop_on_signals());
}

// Throws UsageError for options that a Kilobot fixes: its microcontroller, clock and wiring.
void check_kilobot(const Given& given) {
  if (given.board != BoardKind::kilobot) return;
  if (!given.pins.empty()) throw bridges::UsageError("--pins cannot be used with --board kilobot");
  if (!given.mcu.empty()) throw bridges::UsageError("--mcu cannot be used with --board kilobot");
  if (given.frequency != 0) throw bridges::UsageError("--frequency cannot be used with --board kilobot");
}

}  // namespace

int main(int argc, char** argv) {
  Given given;
  bridges::BridgeProgram program(
      "cohort-avr-bridge", "microcontroller",
      "Runs unmodified firmware images for AVR microcontrollers, which drive robots of a simulation.");
  add_options(program, given);
  return program.run(argc, argv, [&given](const ClientOptions& client) {
    check_kilobot(given);
    if (given.benchmark > 0.0) {
      run_benchmark(given);
      return ClientEnd::finished;
    }
    return given.board == BoardKind::kilobot ? run_kilobots(given, client) : run_pins(given, client);
  });
}
