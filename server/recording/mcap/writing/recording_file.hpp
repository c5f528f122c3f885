// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "server/recording/mcap/writing/byte_store.hpp"
#include "server/recording/mcap/writing/mcap_writer.hpp"

namespace cohort::recording {

enum class Importance {
  essential,  ///< never dropped while the recording is active: commands, events
  display,    ///< dropped while more than `RecordingOptions::most_queued` bytes are queued
};

struct RecordingOptions {
  McapWriterOptions mcap{};
  std::size_t most_queued = std::size_t{64} << 20U;  ///< bytes
  /// Limit of all bytes that are queued for a stalled disk; beyond it the recording ends with an error.
  std::size_t most_essential_queued = std::size_t{1} << 30U;
  /// The maximum wall time that a message waits before its chunk is ended and written.
  std::chrono::nanoseconds flush_interval = std::chrono::milliseconds(750);
};

/// An MCAP file that is compressed and written by a thread of its own: callers only copy bytes, and never wait for the
/// disk or another store. Messages reach the operating system within `flush_interval` plus the time for compressing and
/// writing, so a killed process loses no more than that. Once a second the file is synchronized to the disk.
///
/// After the constructor nothing throws. A failed write is retried once. If that fails too, or memory runs out, the
/// incomplete chunk is cut off and the file is closed if there is room for its summary. Later messages are ignored, and
/// `error` says what happened.
///
/// For any thread; messages of different threads are in the order of the calls.
class RecordingFile {
 public:
  /// Creates or replaces the file. Throws FileError if there is no such folder or no permission, or if another process
  /// is recording to it.
  explicit RecordingFile(const std::filesystem::path& path, RecordingOptions options = {});
  /// Records to a store that the caller provides.
  explicit RecordingFile(std::shared_ptr<ByteStore> store, RecordingOptions options = {});
  RecordingFile(const RecordingFile&) = delete;
  RecordingFile& operator=(const RecordingFile&) = delete;
  /// Closes the file.
  ~RecordingFile();

  /// Act like the functions of McapWriter, with the same ids for the same calls.
  SchemaId add_schema(std::string name, std::string encoding, std::string data) noexcept;
  ChannelId add_channel(std::string topic, SchemaId schema, std::string message_encoding,
                        StringMap metadata = {}) noexcept;
  void add_attachment(Attachment attachment) noexcept;
  void add_metadata(Metadata metadata) noexcept;

  /// Copies the message; returns false if it was dropped.
  bool write_message(ChannelId channel, std::uint32_t sequence, Timestamp log_time, Timestamp publish_time,
                     ByteView data, Importance importance) noexcept;

  /// Ends the recording in its present state, with `why` as its `error`.
  void end_early(const std::string& why);

  /// Returns the numbers of dropped display messages, by channel.
  std::map<ChannelId, std::uint64_t> dropped() const;
  /// Returns the number of bytes that wait to be compressed.
  std::size_t queued() const;
  /// Returns why the recording ended early, as a sentence for the user; nothing if it did not.
  std::optional<std::string> error() const;

  /// Passes the queued messages to the operating system. Returns when this is done, or `error` says why not.
  void flush();
  /// Writes the queued messages and the summary. Returns when all is on the disk, or `error` says why not. Later
  /// messages are ignored.
  void close();
  /// Starts `close` without waiting for it.
  void begin_closing();
  /// Returns true once nothing more will be written.
  bool is_closed() const;

 private:
  using Clock = std::chrono::steady_clock;
  using Call = std::function<void(McapWriter&)>;
  // Consecutive messages, with an entry before each.
  struct Block {
    Bytes bytes;
    std::vector<Call> calls;
  };

  void write(ByteView bytes);
  void end(const std::string& why);
  template <class Add>
  bool is_added(const Add& add);
  void add_call(Call call, std::size_t bytes);
  void add_entry(const MessageHead& head, std::uint64_t size, bool is_call, ByteView data);
  Block& block_for(std::size_t size);
  void write_blocks();
  bool wait_for_blocks(std::deque<Block>& blocks, std::uint64_t& flushes);
  void write_block(const Block& block);
  void end_chunk_if_due(bool is_last, bool is_flushed);
  void ask_for_sync();
  void release(Block block);
  void give_up(const std::exception& reason);
  std::string is_closed_up(bool with_chunk);
  std::string keep_unclosed();
  void sync_now_and_then();
  void stop_syncing();

  RecordingOptions options_;
  std::shared_ptr<ByteStore> store_;
  std::uint64_t size_ = 0;  // size of the file; only for the writer's thread once it runs, like the next member
  McapWriter writer_;

  mutable std::mutex mutex_;  // guards the members below up to the next line
  std::condition_variable wake_;
  std::condition_variable flushed_;
  std::deque<Block> queue_;
  std::vector<Block> spare_;
  std::size_t queued_ = 0;  // bytes, including blocks that the writer has taken
  std::optional<Clock::time_point> first_queued_at_;
  std::map<ChannelId, std::uint64_t> dropped_;
  SchemaId last_schema_ = 0;
  ChannelId last_channel_ = 0;
  std::string error_;
  std::uint64_t flushes_wanted_ = 0;
  std::uint64_t flushes_done_ = 0;
  bool is_closing_ = false;
  bool is_closed_ = false;

  std::optional<Clock::time_point> chunk_began_at_;  // used by the writer's thread only, like the next member
  std::uint64_t size_to_sync_ = 0;

  std::mutex sync_mutex_;  // guards the next three members
  std::condition_variable sync_wake_;
  bool wants_sync_ = false;
  bool ends_syncing_ = false;

  std::thread sync_thread_;
  std::thread writer_thread_;
};

}  // namespace cohort::recording
