#pragma once

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// Way and velocity of both tracks of a treel drive, exact. A track that slips counts its own motion, as an encoder on
/// its motor does.
class TreelEncoder final : public Sensor {
 public:
  TreelEncoder(const description::TreelEncoder& encoder, Mount mount) : encoder_(encoder), mount_(std::move(mount)) {}
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  description::TreelEncoder encoder_;
  Mount mount_;
};

}  // namespace cohort::sensing
