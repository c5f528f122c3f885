// SPDX-License-Identifier: Apache-2.0
#include "server/core/commit.hpp"

namespace cohort {

[[gnu::weak, gnu::noinline]] const char* commit_of_program() { return "unknown"; }

}  // namespace cohort
