#pragma once

#include <sdf/Element.hh>

#include "server/parsing/sdf/sdf_report.hpp"

namespace cohort::parsing {

/// Warns of every element at or below `element` that would change motion or sensing in another simulator and is not
/// simulated here. Models inside of a world are left out: they are looked at one by one.
void warn_of_unsupported(const sdf::ElementPtr& element, const SdfReport& report);

}  // namespace cohort::parsing
