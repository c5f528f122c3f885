// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cohort {

/// A file descriptor that poll(2) reports as readable while it is set. Thread-safe.
class EventDescriptor {
 public:
  /// Throws std::system_error.
  EventDescriptor();
  EventDescriptor(const EventDescriptor&) = delete;
  EventDescriptor& operator=(const EventDescriptor&) = delete;
  ~EventDescriptor();

  void set_readable(bool readable) const;
  int get() const { return descriptor_; }

 private:
  const int descriptor_;
};

}  // namespace cohort
