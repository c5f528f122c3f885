#pragma once

#include <sdf/Types.hh>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/sdf/sdf_file.hpp"

namespace cohort::parsing {

/// What libsdformat found wrong in a file, as problems of ours: without the trail of consequences that it reports after
/// a cause, without what our own checks say better, and with a place wherever one can be found.
std::vector<Problem> problems_of(const sdf::Errors& errors, const SdfFile& file);

/// Returns a problem for each value in the tree of a file that libsdformat cannot read. Puts the default into the place
/// of each.
std::vector<Problem> replace_bad_values(SdfFile& file);

}  // namespace cohort::parsing
