// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/src/network_clock.hpp"

#include <dlfcn.h>

namespace cohort {
namespace {

// Looks up functions of the library that replaces a program's clocks (tools/exec/preload), if it is loaded.
template <class Function>
Function of_preload(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_DEFAULT, name));
}

void use_real_time(int change) {
  static const auto use = of_preload<void (*)(int)>("cohort_exec_use_real_time");
  if (use != nullptr) use(change);
}

}  // namespace

NetworkClock::time_point NetworkClock::now() noexcept {
  static const auto real_time = of_preload<std::int64_t (*)()>("cohort_exec_real_time");
  if (real_time != nullptr) return time_point(duration(real_time()));
  return time_point(std::chrono::steady_clock::now().time_since_epoch());
}

WaitsByNetworkClock::WaitsByNetworkClock() noexcept { use_real_time(1); }
WaitsByNetworkClock::~WaitsByNetworkClock() { use_real_time(-1); }

}  // namespace cohort
