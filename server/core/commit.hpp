#pragma once

namespace cohort {

/// Returns the commit that the program was built from, or `unknown`. A program that knows defines it anew
/// (tools/cohort/commit.cpp), so that another commit links that program again, and no library or test.
const char* commit_of_program();

}  // namespace cohort
