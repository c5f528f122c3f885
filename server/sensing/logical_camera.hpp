#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// Which objects have the origin of their root link within a frustum along the x axis of S, whatever hides it: y/x and
/// z/x there are at most tan(fov / 2), and that over the aspect ratio (as Gazebo's logical camera). The nearest ones
/// are reported, with their poses in S; of two as near, the one with the lower index first.
class LogicalCamera final : public Sensor {
 public:
  LogicalCamera(const description::LogicalCamera& camera, Mount mount);
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  bool is_seen(const Eigen::Vector3d& p_S) const;

  description::LogicalCamera camera_;
  Mount mount_;
  double width_;   // half of what is seen at 1 m [m]
  double height_;  // the same
};

}  // namespace cohort::sensing
