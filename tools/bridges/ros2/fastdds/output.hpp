// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

#include "tools/bridges/ros2/services/service_frames.hpp"

namespace cohort::bridges::ros2 {

/// The stream of frames to the bridge. A separate thread writes it, so that threads which answer the bridge never wait
/// for the bridge. Thread-safe.
class Output {
 public:
  explicit Output(int descriptor);
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  ~Output();

  /// Sends a frame without waiting.
  void send(const FrameToBridge& frame);
  /// Drops all frames that are not written yet, and all that are sent later, so that no thread waits here any more.
  void close();
  /// Waits until the bridge has read most of the earlier frames, then sends a request. Drops it if it is too large for
  /// a frame.
  void send_request(const RequestReceived& request);

 private:
  void write_frames();

  const int descriptor_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::string> frames_;
  std::size_t waiting_bytes_ = 0;
  bool ending_ = false;
  std::thread writer_;
};

}  // namespace cohort::bridges::ros2
