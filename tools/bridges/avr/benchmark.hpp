#pragma once

#include "tools/bridges/avr/core.hpp"

namespace cohort::avr {

/// Runs an image alone for so many simulated seconds, without a server, and prints how fast.
void run_benchmark(const Image& image, const Chip& chip, double seconds);

}  // namespace cohort::avr
