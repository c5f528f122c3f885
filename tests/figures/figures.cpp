// SPDX-License-Identifier: Apache-2.0
#include "tests/figures/figures.hpp"

namespace cohort::figures {

std::vector<Page> all_pages() {
  return {proximity_and_ground(), light_and_sound(), motion(), gripping(), surroundings()};
}

}  // namespace cohort::figures
