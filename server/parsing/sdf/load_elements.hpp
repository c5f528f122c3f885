#pragma once

#include <sdf/ParserConfig.hh>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/sdf/schema/build_elements.hpp"
#include "server/parsing/sdf/sdf_file.hpp"

namespace cohort::parsing {

/// Makes libsdformat's elements and objects of the tree of a file, which is without includes: sets `root`, `nodes`,
/// `loaded` and `sound`. Returns what is wrong with the file. A value that cannot be read is reported and replaced by
/// its default in the tree, so that what else is wrong is found too.
std::vector<Problem> load_elements(SdfFile& file, ElementBuilder& builder, const sdf::ParserConfig& config);

}  // namespace cohort::parsing
