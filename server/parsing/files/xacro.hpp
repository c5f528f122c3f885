#pragma once

#include <filesystem>
#include <string>

#include "server/parsing/files/input_file.hpp"
#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// Whether the program `xacro` may expand the file that a person names. It evaluates Python that the file holds, so
/// it runs only for the one file that a person names; what the file includes or names is never expanded.
enum class Xacro { refused, run };

/// The first element that only `xacro` understands; nullptr if there is none. `file` is what the document stands in.
const XmlNode* find_macro(const XmlNode& root, const std::filesystem::path& file);

/// What is said of a file with macros that may not be expanded.
std::string why_not_expanded(const std::filesystem::path& file);

/// Lets `input` answer for `file`, which a person has named and trusts, with what `xacro` makes of it, of the virtual
/// environment or else of the path. Does nothing to a file without macros. Throws InputError with what xacro says.
void expand_named(InputFiles& input, const std::filesystem::path& file);

}  // namespace cohort::parsing
