// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/common/drawing/chart.hpp"

/// Charts of the responses of an s-bot's devices (docs/sbot.md), measured in small worlds, compared with closed forms
/// from the thesis (chapter 3) or from mechanics. Each run gives the same charts.
namespace cohort::figures {

Page proximity_and_ground();
Page light_and_sound();
Page motion();
Page gripping();
Page surroundings();

std::vector<Page> all_pages();

}  // namespace cohort::figures
