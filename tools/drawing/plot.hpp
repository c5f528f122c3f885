#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "tools/drawing/run_trace.hpp"

namespace cohort::tool {

struct PlotCaption {
  std::string experiment;
  std::chrono::nanoseconds time{0};  ///< simulated
  std::uint64_t state_hash = 0;
};

/// A run from above or from the side, as an SVG document: solids, each robot's path, start and end, contacts, a grid
/// and a scale bar in metres, a legend and a caption. Depends on nothing outside of itself; the same arguments give the
/// same bytes. The picture shows obstacles, objects and paths in full; a floor fills it as far as it reaches.
std::string draw_plot(const RunTrace& trace, const PlotCaption& caption);

}  // namespace cohort::tool
