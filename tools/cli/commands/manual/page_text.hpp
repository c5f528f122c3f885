// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

/// Texts of pages in Markdown.
namespace cohort::tool {

/// Returns the comment at the top of a page that is made from the tables in a folder or a file.
std::string made_from(std::string_view tables);

/// Breaks lines at spaces outside of code. Lines after the first begin with `indent`.
std::string wrapped(std::string_view text, std::string_view indent);

/// Returns the anchor that GitHub makes of a heading.
std::string anchor_of(std::string_view title);

}  // namespace cohort::tool
