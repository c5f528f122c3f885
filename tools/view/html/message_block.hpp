// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/view/messages/topics.hpp"

namespace cohort::view {

/// A sequence of messages, packed for a page. It begins with the number of messages, and the topic and size of each.
/// Then come the messages, as one series for each topic and size, in the order of the first message of each. All
/// numbers are uint32, little-endian.
///
/// A series is a table with a row for each 32-bit word of its messages and a column for each message. Its first number
/// is 1 if the entries are differences to the entry on the left, and 0 if they are the words themselves. A difference d
/// is stored as `(d << 1) ^ (d >> 31)`. The bytes of equal significance of all entries are adjacent, row by row.
///
/// Poses change steadily, so their rows of differences are long runs of similar small numbers, which deflate makes
/// small. The noise of sensors makes differences larger than values. Unpacking restores the bytes of each message
/// (tools/view/page/src/data/packed.ts).
class MessageBlock {
 public:
  void add(Topic topic, const recording::Bytes& data);
  bool is_empty() const { return messages_.empty(); }
  /// Returns the number of bytes before compression.
  std::size_t raw_size() const { return raw_size_; }
  /// Returns the compressed messages as base64, and removes all messages.
  std::string take_text();

 private:
  struct Message {
    Topic topic;
    std::size_t size;  // in bytes
    std::vector<std::uint32_t> words;
  };
  using Series = std::vector<const Message*>;

  std::vector<Series> series() const;

  std::vector<Message> messages_;
  std::size_t raw_size_ = 0;
};

/// Returns bytes compressed by deflate with the header of zlib, as base64.
std::string packed_text(std::string_view bytes);

}  // namespace cohort::view
