// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/common/drawing/chart_page.hpp"

/// Pages of charts as SVG, with measured values as dots and theoretical values as thin lines. The functions are pure:
/// equal arguments give equal text.
namespace cohort::figures {

/// Returns the page as a self-contained SVG document.
std::string draw(const Page& page);

/// Returns `count` evenly spaced numbers from `first` to `last`.
std::vector<double> evenly(double first, double last, std::size_t count);

}  // namespace cohort::figures
