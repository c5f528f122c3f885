// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <compare>

#include "server/sensing/placed.hpp"
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

constexpr std::size_t capacity = description::LogicalCamera::capacity;

struct Seen {
  double squared_distance = 0.0;
  std::uint32_t object = 0;
  friend auto operator<=>(const Seen&, const Seen&) = default;
};

/// Objects whose root link's origin is within a frustum along the x axis of S, even if occluded. There y/x is at most
/// tan(fov / 2), and z/x that over the aspect ratio (as in Gazebo's logical camera). The nearest ones are reported,
/// with their poses in S; of two at the same distance, the one with the lower index comes first.
class LogicalCamera final : public SensorOf<description::LogicalCamera> {
 public:
  LogicalCamera(const description::LogicalCamera& camera, const Mount& mount)
      : SensorOf(camera, mount),
        width_(std::sin(0.5 * camera.horizontal_fov) / std::cos(0.5 * camera.horizontal_fov)),
        height_(width_ / camera.aspect_ratio) {}
  std::vector<Channel> channels() const override {
    constexpr auto size = static_cast<std::uint32_t>(capacity);
    const std::string prefix = device_.name + "/0/";
    return {{prefix + "count", "1", 1, 0.0, static_cast<double>(capacity), 0.0, false},
            {prefix + "object", "1", size, -1.0, 4294967295.0, -1.0, false},
            {prefix + "position", "m", 3 * size, -infinity, infinity, 0.0, false},
            {prefix + "orientation", "1", 4 * size, -1.0, 1.0, 0.0, false}};
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    const physics::World& world = mount_.world;
    const Pose X_SW = pose_of(device_, mount_).inverse();
    std::vector<Seen> seen;
    for (std::uint32_t object = 0; object < world.body_count(); ++object) {
      const BodyId body{object};
      if (body == mount_.body || !world.is_active(body)) continue;
      const Eigen::Vector3d p_S = X_SW * world.link_pose(body, LinkId{0}).position;
      if (is_seen(p_S)) seen.push_back({p_S.squaredNorm(), object});
    }
    std::ranges::sort(seen);
    const std::size_t count = std::min(seen.size(), capacity);
    std::ranges::fill(values, 0.0);
    values[0] = static_cast<double>(count);
    const std::span<double> objects = values.subspan(1, capacity);
    const std::span<double> positions = values.subspan(1 + capacity, 3 * capacity);
    const std::span<double> orientations = values.subspan(1 + 4 * capacity, 4 * capacity);
    std::ranges::fill(objects, -1.0);
    for (std::size_t i = 0; i < count; ++i) {
      const Pose X_SO = X_SW * world.link_pose(BodyId{seen[i].object}, LinkId{0});
      objects[i] = static_cast<double>(seen[i].object);
      write(X_SO.position, positions.subspan(3 * i));
      write(X_SO.orientation, orientations.subspan(4 * i));
    }
  }

 private:
  bool is_seen(const Eigen::Vector3d& p_S) const {
    return p_S.x() >= device_.near && p_S.x() <= device_.far && std::abs(p_S.y()) <= width_ * p_S.x() &&
           std::abs(p_S.z()) <= height_ * p_S.x();
  }

  double width_;   // half the width of the frustum at 1 m [m]
  double height_;  // half the height likewise
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::LogicalCamera& camera, const Mount& mount) {
  return std::make_unique<LogicalCamera>(camera, mount);
}

}  // namespace cohort::sensing
