// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/parsing/keys/extension.hpp"

/// The elements of worlds and the keys of experiments, by topic.
namespace cohort::tool {

struct Topic {
  std::string_view name;
  std::string_view text;
};

/// Returns the topics that group elements, and the topics that only consist of an explanation.
std::span<const Topic> topics();

/// Returns all elements, those of worlds first.
const std::vector<const parsing::Extension*>& manual_entries();

/// Returns the elements of a topic.
std::vector<const parsing::Extension*> entries_of(std::string_view topic);

/// Returns whether the element is a part of an experiment and not of a world.
bool is_of_experiments(const parsing::Extension& entry);

/// Returns the parent element of `entry`, with the prefix `cohort:` if it is an element of Cohort.
std::string parent_of(const parsing::Extension& entry);

}  // namespace cohort::tool
