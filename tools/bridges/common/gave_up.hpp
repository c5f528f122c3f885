#pragma once

namespace cohort::bridges {

/// Thrown while a bridge waits for firmware, when its answer is no longer needed.
struct GaveUp {};

}  // namespace cohort::bridges
