#pragma once

#include <string>

namespace cohort::tool {

/// What `cohort --version` prints: the version, then what this program was built from, by, with and for, and whether
/// its mathematics is portable (client_sdk/math) as it runs here.
std::string version_text();

}  // namespace cohort::tool
