#pragma once

#include <sdf/Types.hh>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/sdf/sdf_file.hpp"

namespace cohort::parsing {

/// Returns the errors of libsdformat for a file as problems, without consequences of other errors and without those
/// that checks of Cohort report better, and with a position wherever possible.
std::vector<Problem> problems_of(const sdf::Errors& errors, const SdfFile& file);

/// Returns a problem for each value in the tree of a file that libsdformat cannot read, and replaces it by its default.
std::vector<Problem> replace_bad_values(SdfFile& file);

}  // namespace cohort::parsing
