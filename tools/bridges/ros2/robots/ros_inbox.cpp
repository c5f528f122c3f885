// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/robots/ros_inbox.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace cohort::ros2 {

RosInbox::RosInbox() : descriptor_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "cannot create an eventfd");
}

RosInbox::~RosInbox() { ::close(descriptor_); }

void RosInbox::put(Message message) {
  {
    const std::scoped_lock lock(mutex_);
    if (messages_.size() < most_messages)
      messages_.push_back(std::move(message));
    else
      ++dropped_;
  }
  wake();
}

void RosInbox::wake() {
  const std::uint64_t one = 1;
  static_cast<void>(::write(descriptor_, &one, sizeof one));
}

std::vector<RosInbox::Message> RosInbox::take() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(messages_, {});
}

std::uint64_t RosInbox::dropped() const {
  const std::scoped_lock lock(mutex_);
  return dropped_;
}

void RosInbox::wait(std::chrono::milliseconds at_most) {
  pollfd ready{descriptor_, POLLIN, 0};
  ::poll(&ready, 1, static_cast<int>(at_most.count()));
  clear();
}

void RosInbox::clear() {
  std::uint64_t count = 0;
  static_cast<void>(::read(descriptor_, &count, sizeof count));
}

}  // namespace cohort::ros2
