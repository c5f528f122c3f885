#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// Ranges by one ray each, from the origin of S through what is the robot's own. The ray of bearing b and elevation e
/// goes along (cos e cos b, cos e sin b, sin e) in S; in n columns or rows the i-th is at
/// min + i (max - min) / (n - 1). What is nearer than the least range reads as that, and nothing within the greatest
/// one as the greatest, which noise leaves as it is.
class Lidar final : public Sensor {
 public:
  Lidar(const description::Lidar& lidar, Mount mount);
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  description::Lidar lidar_;
  Mount mount_;
  std::vector<Eigen::Vector3d> directions_S_;
  bool is_flat_ = true;  // all in the xy plane of S
  double nothing_;       // what is measured where nothing is
};

}  // namespace cohort::sensing
