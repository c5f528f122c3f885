#pragma once

#include <cohort/client.hpp>
#include <cohort/observer.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace cohort {
class Control;
}

namespace cohort::ros2 {

/// Where robots are, as the simulation knows it: from what the server tells observers of each tick, or, where that was
/// lost, from a question. One thread.
class TruePoses {
 public:
  /// Throws ControlError if the server's address or the identity cannot be used.
  explicit TruePoses(const ClientOptions& client);
  ~TruePoses();
  TruePoses(const TruePoses&) = delete;
  TruePoses& operator=(const TruePoses&) = delete;

  /// Another run begins: what is known is of the former one.
  void forget();
  /// Returns the pose of a robot at the tick of the frame under way, at which the run stands. Throws ControlError if
  /// the server does not say it.
  WorldPose pose(std::uint32_t robot, const std::string& name, std::uint64_t tick);

 private:
  bool has(std::uint64_t tick);

  ClientOptions client_;
  Observer observer_;
  std::optional<WorldState> state_;
  std::unique_ptr<Control> control_;
};

}  // namespace cohort::ros2
