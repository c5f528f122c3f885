// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "tools/bridges/common/descriptor.hpp"
#include "tools/bridges/ros2/services/service_frames.hpp"

namespace cohort::bridges::ros2 {

/// The process of the helper `cohort-ros2-services`, which the destructor ends. Not thread-safe.
class ServiceProcess {
 public:
  /// Starts `command`, which begins with the program's path. The program inherits standard error. Throws
  /// std::system_error.
  explicit ServiceProcess(const std::vector<std::string>& command);
  ServiceProcess(const ServiceProcess&) = delete;
  ServiceProcess& operator=(const ServiceProcess&) = delete;
  /// Closes the socket, which makes the helper end, and kills the helper if it has not ended after two seconds.
  ~ServiceProcess();

  /// Sends a frame, and waits until the helper accepts it. Does nothing once the helper has ended. Throws
  /// std::length_error if the frame is too large.
  void send(const FrameToHelper& frame);

  /// Returns the next frame of the helper, if one arrives within `patience`. Throws std::runtime_error if it is not a
  /// valid frame.
  std::optional<FrameToBridge> receive(std::chrono::milliseconds patience = {});

  /// Returns whether the helper has ended, as far as send() and receive() have seen.
  bool has_ended() const { return !socket_.is_open(); }

  /// Returns the descriptor to wait on for frames or the end; −1 once the helper has ended.
  int descriptor() const { return socket_.number(); }
  pid_t pid() const { return pid_; }

 private:
  void read_what_is_there();

  Descriptor socket_;
  pid_t pid_ = -1;
  FrameStream<FrameToBridge> stream_;
};

}  // namespace cohort::bridges::ros2
