// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

/// The C library selects its sin, cos, atan2 … at run time by the features of the CPU, and the variants differ in the
/// last bit. One binary would then compute two trajectories on two machines. So portable_math.cpp defines these
/// functions, also for float, with + - * / and sqrt only: sin, cos, sincos, tan, atan, atan2, asin, acos, exp, log,
/// log2, log10, exp2 and pow.
///
/// Every program that steps a world contains and exports them, so that the calls of Bullet and all other libraries bind
/// to them. Every controller contains them, program or plugin, so that its answers are the same on every machine.
namespace cohort {

/// Returns the names of the functions that this code or its libraries still call in the C library instead of
/// portable_math.cpp. If there are any, runs are not portable between CPUs. Empty in our own programs, and after
/// `bind_library_calls` (library_calls.hpp).
std::vector<std::string> functions_not_portable();

}  // namespace cohort
