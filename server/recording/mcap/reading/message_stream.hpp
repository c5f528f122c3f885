// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "server/recording/mcap/reading/mcap_contents.hpp"

namespace cohort::recording {

enum class Order {
  log_time,  ///< messages with equal times in file order
  file,
};

/// A selection of messages, and their order.
struct MessageQuery {
  std::vector<ChannelId> channels{};  ///< empty: all
  Timestamp from{};
  Timestamp to{std::numeric_limits<std::uint64_t>::max()};  ///< inclusive
  Order order = Order::log_time;
};

/// The messages of a file, in sequence. The stream keeps the current chunk in memory and, in the order of log times,
/// also the chunks that overlap it in time. It may outlive its reader. For one thread at a time.
class MessageStream {
 public:
  MessageStream(MessageStream&&) noexcept;
  MessageStream& operator=(MessageStream&&) noexcept;
  ~MessageStream();

  /// Returns the next message, or nothing at the end. Its data is valid until the next call. Throws McapError at an
  /// unreadable chunk, at a message of an unknown channel, and where more chunks overlap in time than the limits allow.
  std::optional<Message> next();

 private:
  friend class McapReader;
  class Source;
  explicit MessageStream(std::unique_ptr<Source> source);
  std::unique_ptr<Source> source_;
};

}  // namespace cohort::recording
