#pragma once

#include <string>

namespace cohort::description {

/// Returns a text of a length that people read. A file may contain values of any length.
std::string shortened(std::string text);

}  // namespace cohort::description
