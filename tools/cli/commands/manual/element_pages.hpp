// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace cohort::tool {

/// Returns the page of docs/reference about the elements of SDFormat, made from the rules against which files are
/// checked.
std::string sdf_elements();

/// Returns the page of docs/reference about the elements of URDF.
std::string urdf_elements();

}  // namespace cohort::tool
