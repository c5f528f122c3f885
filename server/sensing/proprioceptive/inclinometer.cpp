// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "server/sensing/placed.hpp"
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Inclination of S, from the direction u that is up, against gravity, in S: roll = atan2(u_y, u_z) and pitch =
/// atan2(-u_x, sqrt(u_y^2 + u_z^2)). These are the angles of the yaw-pitch-roll rotation from the world to S, for any
/// yaw (third row of the matrix: Diebel, "Representing attitude", 2006, section 5.6). Both are 0 without gravity.
class Inclinometer final : public SensorOf<description::Inclinometer> {
 public:
  using SensorOf::SensorOf;
  std::vector<Channel> channels() const override {
    constexpr double pi = std::numbers::pi;
    return {{device_.name + "/0/roll", "rad", 1, -pi, pi, 0.0},
            {device_.name + "/0/pitch", "rad", 1, -0.5 * pi, 0.5 * pi, 0.0}};
  }
  void sense(std::uint64_t, std::span<double> values) const override {
    const Eigen::Vector3d up_S = pose_of(device_, mount_).orientation.conjugate() * -mount_.description.gravity;
    values[0] = values[1] = 0.0;
    if (up_S.isZero(0.0)) return;
    values[0] = std::atan2(up_S.y(), up_S.z());
    values[1] = std::atan2(-up_S.x(), std::sqrt(up_S.y() * up_S.y() + up_S.z() * up_S.z()));
  }
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::Inclinometer& sensor, const Mount& mount) {
  return std::make_unique<Inclinometer>(sensor, mount);
}

}  // namespace cohort::sensing
