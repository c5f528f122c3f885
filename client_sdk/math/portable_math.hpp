#pragma once

#include <string>
#include <vector>

/// The C library picks its sin, cos, atan2 … at run time by what the CPU can do, and the variants differ in the last
/// bit: one binary would give two trajectories on two machines. portable_math.cpp therefore defines sin, cos, sincos,
/// tan, atan, atan2, asin, acos, exp, log, log2, log10, exp2
/// and pow itself, and those of float, from + - * / and sqrt only.
/// They are in every program that steps a world, which exports them so that the calls of Bullet and of every other
/// library bind to them; and in every controller, program and plugin alike, so that it answers the same wherever it
/// runs.
namespace cohort {

/// Returns the names of the functions that the libraries which this code needs do not get from portable_math.cpp. None
/// in our own programs, and none after `bind_library_calls` (library_calls.hpp). With such names, runs are not portable
/// between CPUs.
std::vector<std::string> functions_not_portable();

}  // namespace cohort
