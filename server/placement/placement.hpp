// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cohort::description {}

/// Placement of the instances of populations, by a seed.
namespace cohort::placement {
using namespace description;  // all its names are of descriptions
}
