// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cohort/control.hpp>

namespace cohort::tool {

/// Returns true if a request failed for this reason, or if a server before version 1.4 of the protocol cannot say so.
inline bool may_mean(const ControlError& error, ControlResult reason) {
  return error.result == reason || error.result == ControlResult::operation_failed;
}

}  // namespace cohort::tool
