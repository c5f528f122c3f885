#pragma once

#include <optional>
#include <string>
#include <vector>

namespace cohort::tool {

/// The topics of the manual: the names of what may be written in worlds and experiments, and of groups of them.
std::vector<std::string> manual_topics();

/// The list of topics, for people.
std::string manual_contents();

/// Returns the topic whose name, or the first word of whose name, is nearest to `unknown`, if one is near.
std::optional<std::string> nearest_topic(const std::string& unknown);

/// Returns the manual of a topic, from the tables that files are checked against: that of a group, of one element, or
/// of all elements whose names contain `topic`. Returns nothing if there is none.
std::optional<std::string> manual_of(const std::string& topic);

}  // namespace cohort::tool
