// SPDX-License-Identifier: Apache-2.0
#include "server/core/commit.hpp"

#include <cohort_build/commit.hpp>

namespace cohort {

const char* commit_of_program() { return build::commit; }

}  // namespace cohort
