// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace cohort::tool {

/// A page of docs/reference, in Markdown.
struct ReferencePage {
  std::string file;  ///< its name, without a folder
  std::string text;
};

/// Returns the pages of docs/reference, made from the tables that files are checked against.
std::vector<ReferencePage> reference_pages();

}  // namespace cohort::tool
