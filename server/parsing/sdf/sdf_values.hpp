// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/parsing/sdf/element.hpp"
#include "server/parsing/sdf/sdf_report.hpp"

namespace cohort::parsing {

/// Returns a direction as it is written in an element, if that is a unit vector except for rounding errors.
std::optional<Eigen::Vector3d> written_unit_vector(const Element* element);

/// Checks that every number below `element`, except in unsupported elements, is nothing but a number: not "1,5", "3 m"
/// or empty.
void check_numbers(const Element* element, const SdfReport& report);

}  // namespace cohort::parsing
