// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/fastdds/output.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <iostream>
#include <stdexcept>
#include <utility>

namespace cohort::bridges::ros2 {
namespace {

constexpr std::size_t most_waiting_bytes = 2 * largest_frame;

bool write_all(int descriptor, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t more = ::write(descriptor, bytes.data() + done, bytes.size() - done);
    if (more >= 0)
      done += static_cast<std::size_t>(more);
    else if (errno != EINTR)
      return false;
  }
  return true;
}

}  // namespace

Output::Output(int descriptor) : descriptor_(descriptor), writer_([this] { write_frames(); }) {}

Output::~Output() {
  close();
  writer_.join();
}

void Output::close() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  ::shutdown(descriptor_, SHUT_WR);  // the thread may block in a write without a reader
}

void Output::send(const FrameToBridge& frame) {
  std::string bytes = encode(frame);
  {
    const std::lock_guard lock(mutex_);
    waiting_bytes_ += bytes.size();
    frames_.push_back(std::move(bytes));
  }
  changed_.notify_all();
}

void Output::send_request(const RequestReceived& request) {
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return ending_ || waiting_bytes_ < most_waiting_bytes; });
  }
  try {
    send(request);
  } catch (const std::length_error& error) {
    std::cerr << "cohort-ros2-services: a request is dropped: " << error.what() << '\n';
  }
}

void Output::write_frames() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ending_ || !frames_.empty(); });
    if (ending_) return;
    const std::string bytes = std::move(frames_.front());
    frames_.pop_front();
    lock.unlock();
    const bool is_written = write_all(descriptor_, bytes);
    lock.lock();
    waiting_bytes_ -= bytes.size();
    if (!is_written) ending_ = true;  // the bridge is gone, as the reading side finds out
    changed_.notify_all();
  }
}

}  // namespace cohort::bridges::ros2
