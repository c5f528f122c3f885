#pragma once

#include <string>
#include <vector>

/// The C library picks its sin, cos, atan2 … at run time by what the CPU can do, and the variants differ in the last
/// bit: one binary would give two trajectories on two machines. portable_math.cpp therefore defines these functions
/// itself, from + - * / and sqrt only, in every program that steps a world; Bullet's calls resolve to them because the
/// programs are linked with their symbols exported.
namespace cohort {

/// The functions that other libraries of this process would not get from portable_math.cpp, by name. Empty in our own
/// programs; a host program that loads the simulation as a plugin may lack the exports, and its runs are then not
/// portable between CPUs.
std::vector<std::string> functions_not_portable();

}  // namespace cohort
