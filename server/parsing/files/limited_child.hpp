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

/// One end of a stream of bytes between a process and its child.
class ChildStream {
 public:
  /// The process at the other end has ended, or has closed its end.
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
  std::uint64_t memory = std::uint64_t{1} << 30;  ///< in addition to what it has when it starts [bytes]
  std::chrono::seconds processor_time{20};
  std::chrono::seconds wall_time{60};  ///< for one that waits for something that never comes
};

/// A copy of this process that does work which may crash, never end, or fill the memory, without harm to this process.
/// The copy has one thread, no open file but its stream, and this process's memory as it is now. Other threads may have
/// held locks when it was copied: what it calls must not need any but those of malloc. It has the rights of this
/// process, so the limits hold off accidents, not code that takes it over.
class LimitedChild {
 public:
  using Work = std::function<void(ChildStream&)>;

  /// Throws std::system_error if the system has no process to give.
  LimitedChild(const ChildLimits& limits, const Work& work);
  LimitedChild(const LimitedChild&) = delete;
  LimitedChild& operator=(const LimitedChild&) = delete;
  /// Kills it if it has not ended.
  ~LimitedChild();

  ChildStream& stream() { return stream_; }

  /// Ends the child, and returns why it ended if it had already, such as "needed more than 1 GiB of memory". For one
  /// that is called once, after `stream` has thrown Lost.
  std::string end();

 private:
  /// The two ends of a new stream.
  struct Ends {
    Ends();
    int of_parent, of_child;
  };
  LimitedChild(Ends ends, const ChildLimits& limits, const Work& work);

  ChildLimits limits_;
  ChildStream stream_;
  pid_t process_ = -1;  // -1: has been waited for
};

}  // namespace cohort::parsing
