// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/rtps/common/Guid.h>

#include <algorithm>

#include "tools/bridges/ros2/services/service_frames.hpp"

namespace cohort::bridges::ros2 {

inline Guid to_guid(const eprosima::fastrtps::rtps::GUID_t& guid) {
  Guid result{};
  std::copy_n(guid.guidPrefix.value, 12, result.begin());
  std::copy_n(guid.entityId.value, 4, result.begin() + 12);
  return result;
}

inline eprosima::fastrtps::rtps::GUID_t from_guid(const Guid& guid) {
  eprosima::fastrtps::rtps::GUID_t result;
  std::copy_n(guid.begin(), 12, result.guidPrefix.value);
  std::copy_n(guid.begin() + 12, 4, result.entityId.value);
  return result;
}

}  // namespace cohort::bridges::ros2
