#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// Infrared proximity by one ray for each sensor. The reading is 1 - d / range for a surface at distance d along the
/// sensor's axis, 0 if there is none within range. The real sensor sees a cone
/// of 40 degrees and 20 cm (thesis, section 3.2.1); one ray is the simplest of its ray-casting models.
class ProximityRing final : public Sensor {
 public:
  ProximityRing(const description::ProximityRing& ring, Mount mount);
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  description::ProximityRing ring_;
  Mount mount_;
  std::vector<Eigen::Vector3d> directions_S_;
};

}  // namespace cohort::sensing
