// SPDX-License-Identifier: Apache-2.0
#include "idl/messages/ros_messages.hpp"

#include <algorithm>

namespace cohort::messages::ros {

Time time(std::chrono::nanoseconds since_epoch) {
  constexpr std::chrono::seconds first(std::numeric_limits<std::int32_t>::min());
  constexpr std::chrono::seconds last(std::numeric_limits<std::int32_t>::max());
  const auto seconds = std::clamp(std::chrono::floor<std::chrono::seconds>(since_epoch), first, last);
  const std::chrono::nanoseconds rest = std::clamp<std::chrono::nanoseconds>(
      since_epoch - seconds, std::chrono::nanoseconds(0), std::chrono::nanoseconds(999'999'999));
  return {static_cast<std::int32_t>(seconds.count()), static_cast<std::uint32_t>(rest.count())};
}

std::chrono::nanoseconds nanoseconds(const Time& time) {
  return std::chrono::seconds(time.sec) + std::chrono::nanoseconds(time.nanosec);
}

}  // namespace cohort::messages::ros
