#pragma once

#include <map>
#include <string>

#include "tools/view/messages/topics.hpp"

namespace cohort::view {

/// A sequence of messages, packed for a page. Each message is stored as its topic and its size (uint32 each), and then
/// as the differences of its 32-bit words to the preceding message of its topic and size in the block, or to zeros. A
/// difference d is stored as `(d << 1) ^ (d >> 31)`, and the bytes of equal significance of all words are adjacent.
/// Poses change little between two frames, so most of these bytes are zero, and deflate makes them small. Unpacking
/// restores the bytes of each message (tools/view/page/src/packed.ts).
class MessageBlock {
 public:
  void add(Topic topic, const recording::Bytes& data);
  bool is_empty() const { return raw_.empty(); }
  /// Returns the number of bytes before compression.
  std::size_t raw_size() const { return raw_.size(); }
  /// Returns the compressed messages as base64, and removes all messages.
  std::string take_text();

 private:
  std::string raw_;
  std::map<Topic, std::vector<std::uint32_t>> last_;
};

/// Returns bytes compressed by deflate with the header of zlib, as base64.
std::string packed_text(std::string_view bytes);

}  // namespace cohort::view
