#pragma once

namespace cohort::tool {

/// Returns the CPU time of this process and of the processes that it has started, also of those that still run [s].
double cpu_seconds();

}  // namespace cohort::tool
