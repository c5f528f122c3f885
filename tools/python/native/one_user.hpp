// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <atomic>
#include <stdexcept>

namespace cohort::python {

/// Admits one thread of one process at a time. It is needed because calls into C++ release Python's global interpreter
/// lock, and because a fork does not copy the threads of a worker pool.
class OneUser {
 public:
  class Turn {
   public:
    explicit Turn(OneUser& user) : user_(user) {
      if (user_.process_ != ::getpid())
        throw std::runtime_error("this object cannot be used after a fork: create another one in this process");
      if (user_.is_used_.exchange(true)) throw std::runtime_error("another thread is using this object");
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
    ~Turn() { user_.is_used_ = false; }

   private:
    OneUser& user_;
  };

 private:
  std::atomic<bool> is_used_ = false;
  pid_t process_ = ::getpid();
};

}  // namespace cohort::python
