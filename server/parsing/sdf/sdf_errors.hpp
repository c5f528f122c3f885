#pragma once

#include <sdf/Types.hh>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/sdf/sdf_files.hpp"

namespace cohort::parsing {

/// What libsdformat found wrong in a file, as problems of ours: without the trail of consequences that it reports after
/// a cause, without what our own checks say better, and with a place wherever one can be found.
/// `tree` is what SdfFile::nodes are of.
std::vector<Problem> problems_of(const sdf::Errors& errors, const SdfFile& file, const XmlNode& tree);

/// Takes out of `errors` what SDFormat does not know, in a file that was not written for us. Of unknown attributes,
/// which libsdformat drops, `warnings` has each once; unknown elements it keeps.
void take_unknown_names(sdf::Errors& errors, const SdfFile& file, std::vector<Problem>& warnings);

/// Of all values in `tree` that libsdformat cannot read, the first of which it stops at. Puts the default into the
/// place of each, so that what else is wrong can be found.
std::vector<Problem> replace_bad_values(XmlNode& tree, const SdfFile& file);

}  // namespace cohort::parsing
