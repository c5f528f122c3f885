// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/hosting/nearest.hpp"

#include <algorithm>

#include "idl/text/edit_distance.hpp"

namespace cohort {

std::vector<std::string> nearest_names(std::string_view name, std::vector<std::string> names, std::size_t count) {
  std::stable_sort(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
    return edit_distance(a, name) < edit_distance(b, name);
  });
  if (names.size() > count) names.resize(count);
  return names;
}

}  // namespace cohort
