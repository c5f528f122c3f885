#pragma once

#include "server/description/input_error.hpp"

namespace cohort::description {

/// Returns the problem with an element and a message of a length that people read. A file may contain values of any
/// length.
Problem shortened(Problem problem);

}  // namespace cohort::description
