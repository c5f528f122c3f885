#pragma once

#include <ode/ode.h>

#include <stdexcept>

namespace cohort::bench {

/// Whoever uses ODE first starts it; it holds no more than tables.
inline void start_ode() {
  static const bool started = [] { return dInitODE2(0) != 0; }();
  if (!started) throw std::runtime_error("ODE does not start");
}

}  // namespace cohort::bench
