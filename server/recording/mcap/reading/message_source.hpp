// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <queue>

#include "server/recording/mcap/reading/message_stream.hpp"

namespace cohort::recording {

/// The state of a stream.
class MessageStream::Source {
 public:
  /// `is_strict`: a message of an unknown channel is an error; otherwise it is skipped.
  Source(std::shared_ptr<const FileBytes> file, std::shared_ptr<const Contents> contents, const ReadLimits& limits,
         MessageQuery query, bool is_strict);

  std::optional<Message> next();

 private:
  // A block with its selected messages, in order.
  struct OpenBlock {
    const Block* block = nullptr;
    Bytes records;
    std::vector<std::pair<Timestamp, std::uint64_t>> messages;  // log time, offset among the records
    std::size_t next = 0;
  };
  // The next message of the block that is open at `open_[index]`.
  struct Head {
    Timestamp time{};
    std::uint64_t offset = 0;  // offset of the block in the file
    std::size_t index = 0;
  };
  struct IsLater {
    bool operator()(const Head& a, const Head& b) const {
      return std::pair(a.time, a.offset) > std::pair(b.time, b.offset);
    }
  };

  bool is_wanted(const Block& block) const;
  void open(const Block& block);
  void open_due();
  void add_head(std::size_t index);

  std::shared_ptr<const FileBytes> file_;
  std::shared_ptr<const Contents> contents_;
  ReadLimits limits_;
  ReadBudget budget_;
  MessageQuery query_;
  bool is_strict_;

  std::vector<const Block*> blocks_;  // selected blocks, in the order in which they are opened
  std::size_t next_block_ = 0;
  std::vector<OpenBlock> open_;  // slots; an empty slot has no block
  std::uint64_t open_bytes_ = 0;
  std::priority_queue<Head, std::vector<Head>, IsLater> heads_;
  std::optional<std::size_t> last_;  // the slot of the last message
};

}  // namespace cohort::recording
