// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cohort::tool {

/// Returns the CPU time of this process and of all processes that it has started, ended or not [s].
double cpu_seconds();

}  // namespace cohort::tool
