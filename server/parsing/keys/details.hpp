// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "server/parsing/keys/extension.hpp"

/// Explanations that are too long for the one line that an element has in its table. `cohort help` and docs/reference
/// show both. They are Markdown whose lines are short enough for a terminal, and links are relative to docs/reference.
namespace cohort::parsing {

struct Explanation {
  std::string_view name;
  std::string_view parent;  ///< as in Extension; empty for a topic of `cohort help`
  std::string_view text;
};

std::span<const Explanation> actuator_explanations();
std::span<const Explanation> sensor_explanations();
std::span<const Explanation> world_explanations();
std::span<const Explanation> experiment_explanations();

/// Returns the explanation of an element; empty if it has none.
std::string_view details_of(const Extension& element);

/// Returns the explanation of a topic, such as `sensors`; empty if it has none.
std::string_view details_of_topic(std::string_view topic);

}  // namespace cohort::parsing
