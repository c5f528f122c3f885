#pragma once

namespace cohort {

/// Makes everything that is loaded in this process, such as Bullet, call the functions of portable_math.cpp. Our own
/// programs do not need this: they export these functions, and the dynamic linker binds the calls of all libraries to
/// them. For a library that another program loads, such as a Python extension module, that is too late, because the
/// program's C library defines the names first. In that case this function changes the addresses that the dynamic
/// linker has written. It does nothing if our own program has loaded the library, for controllers in Python. Call it
/// before any computation that must be portable, and again after more libraries are loaded. Throws std::runtime_error
/// if the system does not allow the change.
void bind_library_calls();

}  // namespace cohort
