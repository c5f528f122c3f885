#pragma once

#include <optional>
#include <string>
#include <vector>

namespace cohort::tool {

/// The topics of the manual: the names of what may be written in worlds and experiments, and of groups of them.
std::vector<std::string> manual_topics();

/// The list of topics, for people.
std::string manual_contents();

/// What may be written, from the tables that files are checked against: of a group, of one thing, or of all whose names
/// contain `topic`. Nothing if there is none.
std::optional<std::string> manual_of(const std::string& topic);

}  // namespace cohort::tool
