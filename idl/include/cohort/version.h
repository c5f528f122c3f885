// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The version of Cohort, as in CMake: `find_package(Cohort 0.2)`. For C and C++.
// NOLINTBEGIN(cppcoreguidelines-macro-usage): C and the preprocessor need macros
#define COHORT_VERSION_MAJOR 0
#define COHORT_VERSION_MINOR 2
#define COHORT_VERSION_PATCH 0
#define COHORT_VERSION "0.2.0"
// NOLINTEND(cppcoreguidelines-macro-usage)
