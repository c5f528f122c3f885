#pragma once

#include <cohort/controller.hpp>
#include <memory>

#include "tools/bridges/avr/avr_robot.hpp"
#include "tools/bridges/avr/kilobot_infrared.hpp"

/// Kilobots: robots of the model `kilobot` with the firmware of real ones (docs/bridges/kilobot.md).
namespace cohort::avr::kilobot {

/// The microcontroller of all Kilobots, before `prepare`.
Chip chip();

/// Gives a robot its own number and calibration in the EEPROM, unless the image has them. By the seed of its
/// controller, also sets a clock within 1 % of 8 MHz and a power-on within half a second.
void prepare(Robot::Options& options, const Start& start);

/// Makes the board of one robot, whose light is in `air`. With `overhead`, the overhead controller tells it to run.
std::unique_ptr<Board> make_board(Air& air, bool overhead);

/// Returns a message of the overhead controller: its type, and a sum by which firmware knows that it arrived whole.
std::array<std::uint8_t, 12> overhead_message(std::uint8_t type);

/// Runs an image on so many Kilobots in a ring, each in reach of two others, without a server and on one thread, and
/// prints how fast.
void run_benchmark(const Image& image, unsigned robots, bool overhead, double seconds);

}  // namespace cohort::avr::kilobot
