#pragma once

namespace cohort {

/// Makes everything that is loaded in this process, such as Bullet, call the functions of portable_math.cpp. In our
/// programs there is nothing to do: they export these functions, and the dynamic linker binds the calls of all
/// libraries to them. A library that a program loads, such as an extension module of Python, comes too late for that:
/// the program's C library has the names first. In a program of ours, which loads it for controllers in Python, this
/// does nothing. Otherwise this changes the addresses that the dynamic linker has written. To be called before anything
/// that must be portable is computed; again, for what has been loaded since. Throws std::runtime_error if the system
/// does not allow it.
void bind_library_calls();

}  // namespace cohort
