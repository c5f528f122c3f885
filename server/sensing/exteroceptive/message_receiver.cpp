// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "server/sensing/placed.hpp"
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

/// Messages of nearby robots (description::RangeAndBearing), with the positions of the senders. A message is received
/// if the receiver is within the sender's range and a ray to the sender hits nothing but the two robots. Messages
/// between two deliveries accumulate, the newest tick first. Within a tick the nearest comes first, and of two at the
/// same distance the one with the lower beacon. Messages beyond the capacity are lost.
class MessageReceiver final : public SensorOf<description::RangeAndBearing> {
 public:
  using SensorOf::SensorOf;
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

  void remember(std::uint64_t tick, bool was_delivered) override;
  void hash(StateHash& hash) const override;
  void save(SnapshotWriter& writer) const override;
  void restore(SnapshotReader& reader) override;

 private:
  std::size_t size_of_one() const { return 3 + device_.message_size; }

  std::vector<double> heard_;   // range, bearing, elevation and message of each, in the order of the report
  std::vector<double> before_;  // those of ticks before `noted_tick_`
  std::uint64_t noted_tick_ = ~std::uint64_t{0};
};

std::vector<Channel> MessageReceiver::channels() const {
  constexpr double pi = std::numbers::pi;
  const auto size = static_cast<std::uint32_t>(device_.message_size);
  const auto most = static_cast<double>(device_.capacity);
  std::vector<Channel> channels{{device_.name + "/0/count", "1", 1, 0.0, most, 0.0, false}};
  for (std::size_t i = 0; i < device_.capacity; ++i) {
    const std::string name = device_.name + "/" + std::to_string(i);
    channels.push_back({name + "/range", "m", 1, 0.0, infinity, 0.0});
    channels.push_back({name + "/bearing", "rad", 1, -pi, pi, 0.0});
    channels.push_back({name + "/elevation", "rad", 1, -pi / 2.0, pi / 2.0, 0.0});
    channels.push_back({name + "/message", "1", size, -infinity, infinity, 0.0, false});
  }
  return channels;
}

void MessageReceiver::remember(std::uint64_t tick, bool was_delivered) {
  if (tick != noted_tick_) {
    noted_tick_ = tick;
    before_ = std::move(heard_);
    if (was_delivered) before_.clear();
  }
  const Pose X_WS = pose_of(device_, mount_);
  struct Near {
    double distance;
    std::uint32_t beacon;
  };
  std::vector<Near> near;
  mount_.emitters.for_each_beacon_near(X_WS.position, [&](std::uint32_t index) {
    const emission::Beacon& beacon = mount_.emitters.beacon(index);
    const double distance = (beacon.p_W - X_WS.position).norm();
    if (beacon.mount.body != mount_.body && beacon.message.size() == device_.message_size && distance <= beacon.range)
      near.push_back({distance, index});
  });
  std::sort(near.begin(), near.end(), [](const Near& a, const Near& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.beacon < b.beacon;
  });
  std::vector<double> heard;
  for (const Near& each : near) {
    if (heard.size() >= device_.capacity * size_of_one()) break;
    const emission::Beacon& beacon = mount_.emitters.beacon(each.beacon);
    const Eigen::Vector3d offset_W = beacon.p_W - X_WS.position;
    if (each.distance > 0.0 && !mount_.world.scene().is_free(X_WS.position, offset_W / each.distance, each.distance,
                                                             mount_.body, beacon.mount.body))
      continue;
    const Eigen::Vector3d p_S = X_WS.orientation.conjugate() * offset_W;
    heard.insert(heard.end(), {each.distance, std::atan2(p_S.y(), p_S.x()),
                               std::atan2(p_S.z(), std::sqrt(p_S.x() * p_S.x() + p_S.y() * p_S.y()))});
    heard.insert(heard.end(), beacon.message.begin(), beacon.message.end());
  }
  heard.insert(heard.end(), before_.begin(), before_.end());
  heard.resize(std::min(heard.size(), device_.capacity * size_of_one()));
  heard_ = std::move(heard);
}

void MessageReceiver::sense(std::uint64_t, std::span<double> values) const {
  std::ranges::fill(values, 0.0);
  values[0] = static_cast<double>(heard_.size() / size_of_one());
  std::ranges::copy(heard_, values.begin() + 1);
}

void MessageReceiver::hash(StateHash& hash) const {
  for (const double value : heard_) hash.add(value);
}

void MessageReceiver::save(SnapshotWriter& writer) const {
  writer.add(noted_tick_);
  for (const std::vector<double>* const messages : {&heard_, &before_}) {
    writer.add_count(messages->size());
    writer.add_all(messages->data(), messages->size());
  }
}

void MessageReceiver::restore(SnapshotReader& reader) {
  reader.read(noted_tick_);
  for (std::vector<double>* const messages : {&heard_, &before_}) {
    messages->resize(reader.read_count(sizeof(double)));
    if (messages->size() > device_.capacity * size_of_one())
      throw SnapshotError("snapshot: more messages than a robot can receive");
    reader.read_all(messages->data(), messages->size());
  }
}

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::RangeAndBearing& device, const Mount& mount) {
  return std::make_unique<MessageReceiver>(device, mount);
}

}  // namespace cohort::sensing
