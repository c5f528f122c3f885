#pragma once

#include <sdf/ParserConfig.hh>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/sdf/schema/build_elements.hpp"
#include "server/parsing/sdf/sdf_file.hpp"

namespace cohort::parsing {

/// Makes the elements and objects of libsdformat from the tree of a file, which has no includes: sets `root`, `nodes`,
/// `loaded` and `sound`. Returns the problems of the file. An invalid value is reported and replaced by its default in
/// the tree, so that further problems are found.
std::vector<Problem> load_elements(SdfFile& file, ElementBuilder& builder, const sdf::ParserConfig& config);

}  // namespace cohort::parsing
