// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace cohort::tool {

/// Returns the text of `cohort --version`: the version, the source commit, compiler, libraries and target of the build,
/// and whether its mathematics (client_sdk/math) is portable at run time.
std::string version_text();

}  // namespace cohort::tool
