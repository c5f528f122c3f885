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
  essential,  ///< never dropped while the recording goes on: commands, events
  display,    ///< dropped while more than `RecordingOptions::most_queued` bytes wait for the disk
};

struct RecordingOptions {
  McapWriterOptions mcap{};
  std::size_t most_queued = std::size_t{64} << 20U;  ///< bytes
  /// Bytes of all that waits for a disk that has stalled: the recording ends with an error when they are more.
  std::size_t most_essential_queued = std::size_t{1} << 30U;
  /// How long a message waits at the most before its chunk is ended and written, in wall time.
  std::chrono::nanoseconds flush_interval = std::chrono::milliseconds(750);
};

/// An MCAP file that a thread of its own compresses and writes: whoever records only copies bytes, and never waits for
/// the disk, or for whatever the store is. What is older than `flush_interval` and the time that compressing and
/// writing it takes has been given to the operating system, so that a killed process loses no more; once a second the
/// disk is told to have it.
///
/// After the constructor nothing throws. What cannot be written is tried once more. If that fails too, or there is no
/// memory, the chunk that could not be written whole is cut off, the file is closed if there is room for its summary,
/// everything later is ignored, and `error` says what happened.
///
/// Any thread; what different threads write stands in the file in the order of the calls.
class RecordingFile {
 public:
  /// Makes the file, or replaces it. Throws FileError: no such folder, no permission, another process records to it.
  explicit RecordingFile(const std::filesystem::path& path, RecordingOptions options = {});
  /// The same to a store of the caller's.
  explicit RecordingFile(std::shared_ptr<ByteStore> store, RecordingOptions options = {});
  RecordingFile(const RecordingFile&) = delete;
  RecordingFile& operator=(const RecordingFile&) = delete;
  /// Closes it.
  ~RecordingFile();

  /// As McapWriter, with the same ids for the same calls.
  SchemaId add_schema(std::string name, std::string encoding, std::string data) noexcept;
  ChannelId add_channel(std::string topic, SchemaId schema, std::string message_encoding,
                        StringMap metadata = {}) noexcept;
  void add_attachment(Attachment attachment) noexcept;
  void add_metadata(Metadata metadata) noexcept;

  /// Copies the message; false if it was dropped.
  bool write_message(ChannelId channel, std::uint32_t sequence, Timestamp log_time, Timestamp publish_time,
                     ByteView data, Importance importance) noexcept;

  /// What was written until now is all of it: `error` says why.
  void end_early(const std::string& why);

  /// Display messages that were dropped, by channel.
  std::map<ChannelId, std::uint64_t> dropped() const;
  /// Bytes that wait to be compressed.
  std::size_t queued() const;
  /// Why the recording ended early: a sentence for the user; none if it did not.
  std::optional<std::string> error() const;

  /// Writes what waits and the summary, and returns when all of it is on the disk or `error` says why not. Whatever is
  /// written afterwards is ignored.
  void close();
  /// The same without waiting for it.
  void begin_closing();
  /// Whether nothing will be written any more.
  bool is_closed() const;

 private:
  using Clock = std::chrono::steady_clock;
  using Call = std::function<void(McapWriter&)>;
  // Messages one after the other, and what stands between them.
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
  bool wait_for_blocks(std::deque<Block>& blocks);
  void write_block(const Block& block);
  void end_chunk_if_due(bool is_last);
  void ask_for_sync();
  void release(Block block);
  void give_up(const std::exception& reason);
  std::string is_closed_up(bool with_chunk);
  std::string keep_unclosed();
  void sync_now_and_then();
  void stop_syncing();

  RecordingOptions options_;
  std::shared_ptr<ByteStore> store_;
  std::uint64_t size_ = 0;  // of what was written, of the writer's thread like the next, once that runs
  McapWriter writer_;

  mutable std::mutex mutex_;  // guards all below up to the next line
  std::condition_variable wake_;
  std::deque<Block> queue_;
  std::vector<Block> spare_;
  std::size_t queued_ = 0;  // bytes, also of blocks that the writer has taken
  std::optional<Clock::time_point> first_queued_at_;
  std::map<ChannelId, std::uint64_t> dropped_;
  SchemaId last_schema_ = 0;
  ChannelId last_channel_ = 0;
  std::string error_;
  bool is_closing_ = false;
  bool is_closed_ = false;

  std::optional<Clock::time_point> chunk_began_at_;  // the writer's, like the next
  std::uint64_t size_to_sync_ = 0;

  std::mutex sync_mutex_;  // guards the next three
  std::condition_variable sync_wake_;
  bool wants_sync_ = false;
  bool ends_syncing_ = false;

  std::thread sync_thread_;
  std::thread writer_thread_;
};

}  // namespace cohort::recording
