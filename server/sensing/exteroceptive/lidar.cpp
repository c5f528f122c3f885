// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "server/geometry/scene/ray_fan.hpp"
#include "server/sensing/placed.hpp"
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

// Returns the i-th of n angles.
double angle(double least, double greatest, std::size_t i, std::size_t n) {
  if (n == 1) return 0.5 * (least + greatest);
  return least + static_cast<double>(i) * (greatest - least) / static_cast<double>(n - 1);
}

/// Ranges by one ray each, from the origin of S, through the robot's own bodies. The ray of bearing b and elevation e
/// has the direction (cos e cos b, cos e sin b, sin e) in S. In n columns or rows the i-th is at min + i (max - min) /
/// (n - 1). A distance below the least range reads as the least range, and no hit as the greatest range. Noise changes
/// neither of the two.
class Lidar final : public SensorOf<description::Lidar> {
 public:
  Lidar(const description::Lidar& lidar, const Mount& mount)
      : SensorOf(lidar, mount),
        // Noise does not change infinity, and the signal chain then clamps it to the range of the channel.
        too_near_(lidar.readout.noises.empty() ? lidar.min_range : -infinity),
        nothing_(lidar.readout.noises.empty() ? lidar.max_range : infinity) {
    for (std::size_t row = 0; row < lidar.rows; ++row) {
      const double elevation = angle(lidar.min_elevation, lidar.max_elevation, row, lidar.rows);
      const double level = std::cos(elevation);
      const double up = std::sin(elevation);
      is_flat_ = is_flat_ && up == 0.0;
      for (std::size_t column = 0; column < lidar.columns; ++column) {
        const double bearing = angle(lidar.min_bearing, lidar.max_bearing, column, lidar.columns);
        directions_S_.emplace_back(level * std::cos(bearing), level * std::sin(bearing), up);
      }
    }
  }
  std::vector<Channel> channels() const override {
    const auto rays = static_cast<std::uint32_t>(directions_S_.size());
    return {{device_.name + "/0/ranges", "m", rays, device_.min_range, device_.max_range, device_.max_range}};
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    const Pose X_WS = pose_of(device_, mount_);
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(device_.max_range);
    const geometry::Bounds region = is_flat_ ? geometry::bounds_of_disc(X_WS, device_.max_range)
                                             : geometry::Bounds{X_WS.position - reach, X_WS.position + reach};
    const geometry::RayFan fan(mount_.world.scene(), X_WS.position, region, mount_.body);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto hit = fan.cast(X_WS.position, X_WS.orientation * directions_S_[i], device_.max_range);
      if (!hit)
        values[i] = nothing_;
      else
        values[i] = hit->distance < device_.min_range ? too_near_ : hit->distance;
    }
  }

 private:
  std::vector<Eigen::Vector3d> directions_S_;
  bool is_flat_ = true;  // all rays are in the xy plane of S
  double too_near_;      // measured value of a hit below the least range
  double nothing_;       // measured value without a hit
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::Lidar& lidar, const Mount& mount) {
  return std::make_unique<Lidar>(lidar, mount);
}

}  // namespace cohort::sensing
