// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

#include "server/recording/mcap/writing/byte_store.hpp"

namespace cohort::recording {

/// A buffer between the thread that writes a recording and the client that fetches it in parts. The thread waits while
/// `capacity` bytes or more have not been fetched. For any thread.
class Spool : public ByteStore {
 public:
  explicit Spool(std::size_t capacity) : capacity_(capacity) {}

  struct Part {
    Bytes bytes;                          ///< empty if there are none yet, or no more
    std::optional<std::uint64_t> size{};  ///< total size; unknown while more may follow
  };
  /// Returns at most `most` bytes from `offset` on. Earlier bytes count as received, and are forgotten. Returns nothing
  /// if bytes from there on were already forgotten, or are out of range.
  std::optional<Part> fetch(std::uint64_t offset, std::size_t most);
  /// Returns the number of unfetched bytes.
  std::size_t size() const;
  /// Returns true if everything was written and fetched, or the spool was abandoned.
  bool is_done() const;
  /// Ends the fetching: from now on, writing fails.
  void abandon();

  void write(ByteView bytes) override;
  /// Does nothing, because the bytes may already have been fetched. Here, all written records are complete.
  void cut_off(std::uint64_t size) override;
  void sync() override {}
  void finish() override;

 private:
  const std::size_t capacity_;
  mutable std::mutex mutex_;  // guards all below
  std::condition_variable has_room_;
  std::deque<std::byte> bytes_;  // the bytes from `start_` on
  std::uint64_t start_ = 0;      // offset of `bytes_` in the whole data
  bool is_finished_ = false;
  bool is_abandoned_ = false;
};

}  // namespace cohort::recording
