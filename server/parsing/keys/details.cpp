// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/keys/details.hpp"

namespace cohort::parsing {
namespace {

std::string_view details(std::string_view name, std::string_view parent) {
  for (const auto& all :
       {actuator_explanations(), sensor_explanations(), world_explanations(), experiment_explanations()})
    for (const Explanation& each : all)
      if (each.name == name && each.parent == parent) return each.text.substr(each.text.starts_with('\n') ? 1 : 0);
  return {};
}

}  // namespace

std::string_view details_of(const Extension& element) {
  // The parent of a whole experiment is empty, as that of a topic is.
  return element.parent.empty() ? std::string_view() : details(element.name, element.parent);
}

std::string_view details_of_topic(std::string_view topic) { return details(topic, ""); }

}  // namespace cohort::parsing
