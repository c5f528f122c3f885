// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// One end of a byte stream between a process and its child.
class ChildStream {
 public:
  /// The process at the other end has exited or closed its end.
  struct Lost : std::runtime_error {
    Lost() : std::runtime_error("the process at the other end has ended") {}
  };

  /// Closes `socket` when it is destroyed.
  explicit ChildStream(int socket) : socket_(socket) {}
  ChildStream(const ChildStream&) = delete;
  ChildStream& operator=(const ChildStream&) = delete;
  ~ChildStream();

  /// Both throw Lost.
  void send(const void* bytes, std::size_t size);
  void receive(void* bytes, std::size_t size);

  template <class Value>
  void send(const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    send(&value, sizeof value);
  }
  template <class Value>
  Value receive() {
    static_assert(std::is_trivially_copyable_v<Value>);
    Value value{};
    receive(&value, sizeof value);
    return value;
  }

 private:
  int socket_;
};

struct ChildLimits {
  std::uint64_t memory = std::uint64_t{1} << 30;  ///< in addition to its memory at the start [bytes]
  std::chrono::seconds processor_time{20};
  std::chrono::seconds wall_time{60};  ///< for a child that would wait forever
};

/// A copy of this process for work that may crash, never end, or exhaust the memory, without effect on this process.
/// The copy has one thread, no open file except its stream, and the memory of this process at the time of copying.
/// Other threads may have held locks at that time, so the work must not need any locks except those of malloc. The copy
/// has the rights of this process: the limits protect against accidents, not against malicious code.
class LimitedChild {
 public:
  using Work = std::function<void(ChildStream&)>;
  /// `many`: at each call of `begin`, the child does the work in a new copy of itself, to which the limits apply again.
  /// This process, which may be large, is copied only once. If a copy ends without finishing the work, the child ends
  /// in the same way.
  enum class Times { once, many };

  /// Throws std::system_error if no process can be created.
  LimitedChild(const ChildLimits& limits, const Work& work, Times times = Times::once);
  LimitedChild(const LimitedChild&) = delete;
  LimitedChild& operator=(const LimitedChild&) = delete;
  /// Kills the child if it has not ended.
  ~LimitedChild();

  ChildStream& stream() { return stream_; }

  /// Begins the work again, for Times::many. Throws ChildStream::Lost.
  void begin() { stream_.send('b'); }

  /// Ends the child, and returns why it had ended, such as "needed more than 1 GiB of memory". Call it at most once,
  /// after `stream` has thrown Lost.
  std::string end();

 private:
  /// The two ends of a new stream.
  struct Ends {
    Ends();
    int of_parent, of_child;
  };
  LimitedChild(Ends ends, const ChildLimits& limits, const Work& work, Times times);

  ChildLimits limits_;
  ChildStream stream_;
  pid_t process_ = -1;  // -1: has been waited for
};

}  // namespace cohort::parsing
