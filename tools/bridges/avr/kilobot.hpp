// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cohort/controller.hpp>
#include <memory>

#include "tools/bridges/avr/avr_robot.hpp"
#include "tools/bridges/avr/kilobot_infrared.hpp"

/// Kilobots: robots of the model `kilobot` that run the firmware of real Kilobots (docs/bridges/kilobot.md).
namespace cohort::avr::kilobot {

/// The microcontroller of all Kilobots, before `prepare`.
Chip chip();

/// Writes a robot's number and calibration to the EEPROM, unless the image contains them. Also sets a clock within 1 %
/// of 8 MHz and a power-on within half a second, both drawn with the seed of the robot's controller.
void prepare(Robot::Options& options, const Start& start);

/// Makes the board of one robot, which sends and receives light through `air`. With `overhead`, the overhead controller
/// commands it to run.
std::unique_ptr<Board> make_board(Air& air, bool overhead);

/// Returns a message of the overhead controller: its type and its checksum.
std::array<std::uint8_t, 12> overhead_message(std::uint8_t type);

/// Runs an image on this many Kilobots in a ring, each in range of two others, without a server and on one thread.
/// Prints the speed.
void run_benchmark(const Image& image, unsigned robots, bool overhead, double seconds);

}  // namespace cohort::avr::kilobot
