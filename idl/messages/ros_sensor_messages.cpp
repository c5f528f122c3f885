// SPDX-License-Identifier: Apache-2.0
#include "idl/messages/ros_sensor_messages.hpp"

#include <cstring>

namespace cohort::messages::ros {

void PointCloud2::set_points(const std::vector<float>& coordinates) {
  constexpr std::uint32_t size = sizeof(float);
  point_fields = {
      {"x", 0, PointField::float32, 1}, {"y", size, PointField::float32, 1}, {"z", 2 * size, PointField::float32, 1}};
  height = 1;
  width = static_cast<std::uint32_t>(coordinates.size() / 3);
  point_step = 3 * size;
  row_step = width * point_step;
  data.resize(row_step);
  if (row_step != 0) std::memcpy(data.data(), coordinates.data(), row_step);
  is_dense = true;
}

}  // namespace cohort::messages::ros
