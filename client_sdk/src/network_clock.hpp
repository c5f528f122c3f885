// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace cohort {

/// The machine's monotonic clock, for network time-outs. It measures real time even in a program whose clocks `cohort
/// exec` replaces with simulated time. In other programs it is std::chrono::steady_clock.
struct NetworkClock {
  // NOLINTBEGIN(readability-identifier-naming): as std::chrono has them.
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<NetworkClock>;
  // NOLINTEND(readability-identifier-naming)
  static constexpr bool is_steady = true;

  static time_point now() noexcept;
};

/// Makes waits of the calling thread use the machine's clock during the lifetime of this object.
class WaitsByNetworkClock {
 public:
  WaitsByNetworkClock() noexcept;
  ~WaitsByNetworkClock();
  WaitsByNetworkClock(const WaitsByNetworkClock&) = delete;
  WaitsByNetworkClock& operator=(const WaitsByNetworkClock&) = delete;
};

}  // namespace cohort
