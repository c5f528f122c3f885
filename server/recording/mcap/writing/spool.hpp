#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

#include "server/recording/mcap/writing/byte_store.hpp"

namespace cohort::recording {

/// Bytes on their way from the thread that writes a recording to whoever fetches them, part by part. That thread waits
/// while `capacity` bytes or more are not fetched. Any thread.
class Spool : public ByteStore {
 public:
  explicit Spool(std::size_t capacity) : capacity_(capacity) {}

  struct Part {
    Bytes bytes;                          ///< empty if there are none yet, or no more
    std::optional<std::uint64_t> size{};  ///< of all; none as long as more may come
  };
  /// At most `most` bytes from `offset` on. Those before it have arrived, and are forgotten. Nothing if bytes from
  /// there on were forgotten before, or are none of it.
  std::optional<Part> fetch(std::uint64_t offset, std::size_t most);
  /// Bytes that are not fetched.
  std::size_t size() const;
  /// All of it is there and was fetched, or nobody will.
  bool is_done() const;
  /// Nobody fetches any more: from now on writing fails.
  void abandon();

  void write(ByteView bytes) override;
  /// Does nothing: whoever fetches may have them, and a record is whole here or not at all.
  void cut_off(std::uint64_t size) override;
  void sync() override {}
  void finish() override;

 private:
  const std::size_t capacity_;
  mutable std::mutex mutex_;  // guards all below
  std::condition_variable has_room_;
  std::deque<std::byte> bytes_;  // from `start_` on
  std::uint64_t start_ = 0;      // of `bytes_` in the whole
  bool is_finished_ = false;
  bool is_abandoned_ = false;
};

}  // namespace cohort::recording
