#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// Coloured spots all round (description::OmnidirectionalCamera), as `markers_in_sight` finds them: what the s-bot's
/// camera makes of its image in the end.
class OmnidirectionalCamera final : public Sensor {
 public:
  OmnidirectionalCamera(const description::OmnidirectionalCamera& camera, Mount mount)
      : camera_(camera), mount_(std::move(mount)) {}
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  description::OmnidirectionalCamera camera_;
  Mount mount_;
};

}  // namespace cohort::sensing
