// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "tools/common/drawing/run_trace.hpp"

namespace cohort::tool {

struct PlotCaption {
  std::string experiment;
  std::chrono::nanoseconds time{0};  ///< simulated
  std::uint64_t state_hash = 0;
};

/// Returns a plot of a run, seen from above or from the side, as a self-contained SVG document. It shows solids,
/// contacts, each robot's path, start and end, a grid and a scale bar in metres, a legend and a caption. Equal
/// arguments give equal bytes. The picture contains all obstacles, objects and paths; floors may extend beyond it.
std::string draw_plot(const RunTrace& trace, const PlotCaption& caption);

}  // namespace cohort::tool
