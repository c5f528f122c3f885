// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace cohort::session {

/// Size of the largest file that is read as a snapshot.
inline constexpr std::size_t most_snapshot_bytes = std::size_t{1} << 30U;

}  // namespace cohort::session
