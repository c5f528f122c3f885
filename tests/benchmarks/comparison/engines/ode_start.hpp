// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ode/ode.h>

#include <stdexcept>

namespace cohort::bench {

/// Initialises ODE on the first call; ODE only allocates tables.
inline void start_ode() {
  static const bool started = [] { return dInitODE2(0) != 0; }();
  if (!started) throw std::runtime_error("cannot initialise ODE");
}

}  // namespace cohort::bench
