#pragma once

#include <unistd.h>

#include <atomic>
#include <stdexcept>

namespace cohort::python {

/// Lets one thread of one process in at a time: calls into C++ give up Python's global lock, and after a fork the
/// threads of a pool of workers are gone.
class OneUser {
 public:
  class Turn {
   public:
    explicit Turn(OneUser& user) : user_(user) {
      if (user_.process_ != ::getpid())
        throw std::runtime_error("it was made before this process was forked: make another one in this process");
      if (user_.is_used_.exchange(true)) throw std::runtime_error("another thread is using it now");
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
