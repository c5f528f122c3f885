#include <algorithm>
#include <cstring>

#include "idl/messages/ros_sensor_messages.hpp"

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
