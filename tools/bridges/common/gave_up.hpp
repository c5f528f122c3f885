// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cohort::bridges {

/// Thrown to end the wait for firmware whose answer is no longer needed.
struct GaveUp {};

}  // namespace cohort::bridges
