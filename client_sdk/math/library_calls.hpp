// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cohort {

/// Makes the libraries that this code needs, such as Bullet, call the functions of portable_math.cpp. Our own programs
/// do not need this: they export these functions, and the dynamic linker binds the calls of all libraries to them. In a
/// library that another program loads, such as a Python extension module, the names are already bound to the C library
/// of that program. This function then changes the addresses that the dynamic linker has written. Other libraries of
/// the process, and the program itself, keep the functions of the C library. It does nothing in our own programs, which
/// also load the library for controllers in Python. Call it before any computation that must be portable. Throws
/// std::runtime_error if the system does not allow the change.
void bind_library_calls();

/// Makes everything that is loaded in this process call these functions until `release_process_calls`. Controllers in
/// the language of the program, such as Python, then get the same numbers as in our own programs. Calls are counted:
/// only the first binds, and only the last releases. Thread-safe. Throws as above.
void bind_process_calls();
void release_process_calls();

}  // namespace cohort
