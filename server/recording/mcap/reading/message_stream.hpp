#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "server/recording/mcap/reading/mcap_contents.hpp"

namespace cohort::recording {

enum class Order {
  log_time,  ///< equal times as they stand in the file
  file,
};

/// Which messages, and in which order.
struct MessageQuery {
  std::vector<ChannelId> channels{};  ///< empty: all
  Timestamp from{};
  Timestamp to{std::numeric_limits<std::uint64_t>::max()};  ///< also in it
  Order order = Order::log_time;
};

/// Messages of a file, one after the other. Holds the chunk that it is at, and in order of time those that overlap it.
/// May outlive its reader. One thread at a time.
class MessageStream {
 public:
  MessageStream(MessageStream&&) noexcept;
  MessageStream& operator=(MessageStream&&) noexcept;
  ~MessageStream();

  /// The next one, or none at the end. Its data live until the next call. Throws McapError at a chunk that cannot be
  /// read, at a message of an unknown channel, and where more chunks overlap in time than the limits allow.
  std::optional<Message> next();

 private:
  friend class McapReader;
  class Source;
  explicit MessageStream(std::unique_ptr<Source> source);
  std::unique_ptr<Source> source_;
};

}  // namespace cohort::recording
