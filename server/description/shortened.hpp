// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace cohort::description {

/// Returns the text, shortened if it is too long for people to read. A file may contain values of any length.
std::string shortened(std::string text);

}  // namespace cohort::description
