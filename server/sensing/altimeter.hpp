#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// Height of the origin of S above where it was at first, and its velocity upwards, both along the world's z axis.
/// "At first" is when this is made: before the first step of a run, also of one that is then restored.
class Altimeter final : public Sensor {
 public:
  Altimeter(const description::Altimeter& altimeter, Mount mount);
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  description::Altimeter altimeter_;
  Mount mount_;
  double first_height_;  // [m]
};

}  // namespace cohort::sensing
