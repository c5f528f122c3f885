// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/src/event_descriptor.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <system_error>

namespace cohort {
namespace {

int open_event_descriptor() {
  const int descriptor = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (descriptor < 0) throw std::system_error(errno, std::generic_category(), "cannot create an eventfd");
  return descriptor;
}

}  // namespace

EventDescriptor::EventDescriptor() : descriptor_(open_event_descriptor()) {}
EventDescriptor::~EventDescriptor() { ::close(descriptor_); }

void EventDescriptor::set_readable(bool readable) const {
  std::uint64_t count = 1;
  // Fails only if the descriptor is already in this state.
  if (readable)
    static_cast<void>(!::write(descriptor_, &count, sizeof count));
  else
    static_cast<void>(!::read(descriptor_, &count, sizeof count));
}

}  // namespace cohort
