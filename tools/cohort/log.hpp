#pragma once

namespace cohort::tool {

/// Log lines go to standard error; COHORT_LOG sets the level (debug, info, warn, error, off; warn by default).
void set_up_log();

}  // namespace cohort::tool
