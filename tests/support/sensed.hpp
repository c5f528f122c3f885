// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/sensing/make_sensor.hpp"
#include "server/sensing/readings/signal_chain.hpp"
#include "server/sensing/sensor.hpp"
#include "tests/support/worlds/small_world.hpp"

namespace cohort::test {

/// Returns a ball of 1 kg and 0.2 m diameter that carries one device on its link.
inline description::Model carrier(const description::Device& device) {
  description::Model model = loose("carrier", description::Sphere{0.1}, solid_sphere(1.0, 0.1));
  model.devices.push_back(device);
  return model;
}

/// A world with one carrier, and the readings of its device.
class Sensed {
 public:
  explicit Sensed(const description::Device& device, const Pose& X_WL = at(0, 0, 1)) : Sensed(carrier(device), X_WL) {}
  Sensed(const description::Model& model, const Pose& X_WL) : body(small.add(model, X_WL)) {}

  void add_wall(const Eigen::Vector3d& size, const Pose& X_WL) {
    small.add(static_shape("wall", description::Box{size}), X_WL);
  }
  std::vector<double> read() {
    make();
    std::vector<double> values(size_);
    sensor_->sense(0, values);
    return values;
  }
  /// Returns the values with noise, at this tick.
  std::vector<double> report(std::uint64_t tick) {
    std::vector<double> values = read();
    readout_->disturb(tick, values);
    return values;
  }
  const std::vector<Channel>& channels() {
    make();
    return channels_;
  }
  /// Returns the index of the first value of the channel `…/QUANTITY`.
  std::size_t offset_of(const std::string& quantity) {
    std::size_t offset = 0;
    for (const Channel& channel : channels()) {
      if (channel.name.ends_with("/" + quantity)) return offset;
      offset += channel.size;
    }
    ADD_FAILURE() << "no channel " << quantity;
    return 0;
  }
  double value(const std::string& quantity, std::size_t element = 0) { return read()[offset_of(quantity) + element]; }
  Eigen::Vector3d vector(const std::string& quantity, std::size_t first = 0) {
    const std::size_t offset = offset_of(quantity) + first;
    return Eigen::Vector3d::Map(read().data() + offset);
  }

  SmallWorld small;
  BodyId body;

 private:
  void make() {
    if (sensor_) return;
    const physics::World& world = small.world();
    emitters_.emplace(small.description, world);
    grippers_.emplace(small.description, small.world());
    const description::Model& model = small.description.models[small.description.instances[body.value].model];
    sensor_ = sensing::make_sensor({world, *emitters_, small.description, *grippers_, views_, body, DeviceId{0}, 1});
    if (sensor_->needs_record()) small.world().record(body);
    channels_ = sensor_->channels();
    for (const Channel& channel : channels_) size_ += channel.size;
    readout_.emplace(*description::readout_of(model.devices[0]), channels_, 1, "carrier", "sensor",
                     small.description.step);
  }

  std::optional<emission::Emitters> emitters_;
  std::optional<gripping::Grippers> grippers_;
  sensing::SharedViews views_;
  std::unique_ptr<sensing::Sensor> sensor_;
  std::optional<sensing::SignalChain> readout_;
  std::vector<Channel> channels_;
  std::size_t size_ = 0;
};

/// Returns noise on a quantity, or on one value of it.
inline description::Noise noise_on(const std::string& quantity, double deviation, int element = -1) {
  description::Noise noise;
  noise.quantity = quantity;
  noise.element = element;
  noise.deviation = deviation;
  return noise;
}

}  // namespace cohort::test
