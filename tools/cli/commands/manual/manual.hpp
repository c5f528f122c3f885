// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace cohort::tool {

/// Returns the topics of the manual: the names of the elements of worlds and the keys of experiments, and of groups of
/// them.
std::vector<std::string> manual_topics();

/// Returns the list of topics as text for the user.
std::string manual_contents();

/// Returns the topic whose name, or the first word of its name, is nearest to `unknown`; nullopt if none is near.
std::optional<std::string> nearest_topic(const std::string& unknown);

/// Returns the manual of a topic, made from the tables against which files are checked. It covers a group, one element,
/// or all elements whose names contain `topic`. Returns nullopt if there is none.
std::optional<std::string> manual_of(const std::string& topic);

}  // namespace cohort::tool
