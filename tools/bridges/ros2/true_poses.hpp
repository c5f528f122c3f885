// SPDX-License-Identifier: Apache-2.0
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

/// The true poses of robots. They come from the server's messages to observers, or from a request if such a message was
/// lost. Not thread-safe.
class TruePoses {
 public:
  /// Throws ControlError if the server's address or the identity cannot be used.
  explicit TruePoses(const ClientOptions& client);
  ~TruePoses();
  TruePoses(const TruePoses&) = delete;
  TruePoses& operator=(const TruePoses&) = delete;

  /// Drops the known poses, because another run begins.
  void forget();
  /// Returns the pose of a robot in the world at the tick of the present frame, at which the run waits. Throws
  /// ControlError if the server does not answer.
  WorldPose pose(std::uint32_t robot, const std::string& name, std::uint64_t tick);

 private:
  bool has(std::uint64_t tick);

  ClientOptions client_;
  Observer observer_;
  std::optional<WorldState> state_;
  std::unique_ptr<Control> control_;
};

}  // namespace cohort::ros2
