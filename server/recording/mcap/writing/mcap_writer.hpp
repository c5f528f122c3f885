// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "server/recording/mcap/format/compression.hpp"
#include "server/recording/mcap/format/mcap.hpp"

namespace cohort::recording {

/// A function that either takes all of the next bytes of a file, or throws.
using ByteSink = std::function<void(ByteView)>;

/// Returns `cohort` and its version.
std::string library_name();

struct McapWriterOptions {
  std::string profile = "ros2";
  std::string library = library_name();
  std::size_t chunk_size = std::size_t{1} << 20U;  ///< size of the uncompressed records at which a chunk ends [bytes]
  bool compress = true;
  int level = 3;  ///< zstd level
};

/// A writer of MCAP files: compressed chunks of messages, with CRCs and every index of the specification. The same
/// calls produce the same bytes. Schemas and channels are written in the chunk before their first message, in the
/// summary, and once more before that chunk. So a lost chunk does not make later messages unreadable.
///
/// For one thread at a time. The sink is called with whole records, and its exceptions pass through; the writer is then
/// in the state before the call. The caller may then cut off the sink's data and continue, or call `discard_chunk` and
/// `close`. Without `close` the file has no summary, and readers have to scan it.
class McapWriter {
 public:
  /// Writes the beginning of the file.
  explicit McapWriter(ByteSink sink, McapWriterOptions options = {});

  /// Adds a schema. Ids start at 1, in the order of the calls. Throws std::length_error beyond 65,535 of them.
  SchemaId add_schema(std::string name, std::string encoding, std::string data);
  /// Adds a channel; its id is assigned in the same way. `schema`: the id of an added schema, or 0 for none. Throws
  /// std::invalid_argument for other schemas.
  ChannelId add_channel(std::string topic, SchemaId schema, std::string message_encoding, StringMap metadata = {});
  /// Adds a schema or a channel with an id that the caller has chosen and that must be new; for copying a file.
  void add(Schema schema);
  void add(Channel channel);

  /// Writes a message, and ends the chunk if that has reached its size. Throws std::invalid_argument if the channel
  /// does not exist.
  void write_message(ChannelId channel, std::uint32_t sequence, Timestamp log_time, Timestamp publish_time,
                     ByteView data);
  void add_attachment(const Attachment& attachment);
  void add_metadata(const Metadata& metadata);

  /// Ends the chunk if it has messages.
  void flush_chunk();
  /// Discards the messages of the chunk that is not ended yet.
  void discard_chunk();
  /// Ends the chunk and writes the summary. Nothing may be written afterwards.
  void close();

  /// Returns the number of bytes that the sink has taken.
  std::uint64_t size() const { return size_; }
  /// Returns the number of messages in the chunk that is not ended yet.
  std::uint64_t pending_messages() const { return pending_messages_; }
  /// Returns statistics of the data that the sink has taken.
  const Statistics& statistics() const { return statistics_; }

 private:
  void write(ByteView bytes);
  void append_message_indexes(Bytes& to, ChunkIndex& index) const;
  template <class Records>
  void append_group(Bytes& to, std::uint64_t start, Opcode opcode, const Records& records);
  Bytes summary(std::uint64_t start);

  ByteSink sink_;
  McapWriterOptions options_;
  std::optional<Compressor> compressor_;
  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;  // CRC of the bytes that the sink has taken
  bool is_closed_ = false;

  std::map<SchemaId, Schema> schemas_;
  std::map<ChannelId, Channel> channels_;
  Bytes definitions_;  // records of schemas and channels that are in no chunk yet

  Bytes chunk_;  // uncompressed records
  std::map<ChannelId, MessageIndex> message_indexes_;
  std::uint64_t pending_messages_ = 0;
  Timestamp chunk_start_{};
  Timestamp chunk_end_{};

  std::vector<ChunkIndex> chunk_indexes_;
  std::vector<AttachmentIndex> attachment_indexes_;
  std::vector<MetadataIndex> metadata_indexes_;
  std::vector<SummaryOffset> summary_offsets_;
  Statistics statistics_;
};

}  // namespace cohort::recording
