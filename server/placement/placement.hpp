#pragma once

namespace cohort::description {}

/// Populations to instances, by a seed.
namespace cohort::placement {
using namespace description;  // it speaks of nothing else
}
