#pragma once

#include <cstddef>
#include <filesystem>

#include "tools/drawing/viewpoint.hpp"

namespace cohort::tool {

/// The files that a run writes (OneRun); empty: not that one.
struct Outputs {
  std::filesystem::path summary{};
  std::filesystem::path plot{};
  Viewpoint viewpoint = Viewpoint::above;  ///< of the plot
  std::filesystem::path recording{};
  std::filesystem::path csv{};  ///< what the experiment prints
};

/// Those of one of `count` runs: each has files of its own, `summary-2.json` of the second for `summary.json`.
Outputs numbered(const Outputs& outputs, std::size_t number, std::size_t count);

/// Throws std::runtime_error that says which cannot be written and why, before a long run rather than after it.
void check_writable(const Outputs& outputs);

}  // namespace cohort::tool
