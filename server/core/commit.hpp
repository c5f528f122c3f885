// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cohort {

/// Returns the commit that the program was built from, or `unknown`. A program that knows it overrides this function
/// (tools/cli/commit.cpp), so that a new commit relinks only that program, and no library or test.
const char* commit_of_program();

}  // namespace cohort
