#pragma once

#include <vector>

#include "tools/common/drawing/chart.hpp"

/// How each device of an s-bot responds (docs/sbot.md), measured in small worlds, beside the closed forms of the thesis
/// (chapter 3) or of mechanics. The same at each run.
namespace cohort::figures {

Page proximity_and_ground();
Page light_and_sound();
Page motion();
Page gripping();
Page surroundings();

std::vector<Page> all_pages();

}  // namespace cohort::figures
