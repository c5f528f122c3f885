// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/bridges/avr/core.hpp"

namespace cohort::avr {

/// Runs an image for this simulated time [s] without a server, and prints the speed.
void run_benchmark(const Image& image, const Chip& chip, double seconds);

}  // namespace cohort::avr
