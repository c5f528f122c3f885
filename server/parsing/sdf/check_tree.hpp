// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// The most problems that are reported for a file.
inline constexpr std::size_t most_problems = 100;

/// Checks a tree of SDF against the rules: unknown and missing elements and attributes, and values. An element whose
/// value is reported gets its default value, so that it is not reported again. Reports at most `most_problems`.
std::vector<Problem> check_tree(XmlNode& sdf);

}  // namespace cohort::parsing
