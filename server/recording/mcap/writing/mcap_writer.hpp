#pragma once

#include <functional>
#include <optional>

#include "server/recording/mcap/format/compression.hpp"
#include "server/recording/mcap/format/mcap.hpp"

namespace cohort::recording {

/// Takes the next bytes of a file: all of them, or throws.
using ByteSink = std::function<void(ByteView)>;

/// `cohort` and its version.
std::string library_name();

struct McapWriterOptions {
  std::string profile = "ros2";
  std::string library = library_name();
  std::size_t chunk_size = std::size_t{1} << 20U;  ///< bytes of uncompressed records at which a chunk is ended
  bool compress = true;
  int level = 3;  ///< of zstd
};

/// Writes an MCAP file: messages in chunks, compressed, with CRCs and every index of the specification. The same calls
/// give the same bytes. Schemas and channels stand in the chunk before their first message, in the summary, and once
/// more before that chunk, so that the loss of a chunk is not the loss of all messages after it.
///
/// One thread at a time. The sink is called with whole records, and what it throws goes through; the writer is then as
/// before the call, so that whoever owns the sink may cut off what it took and go on, or `discard_chunk` and `close`.
/// Without `close` the file has no summary: readers have to look for what is in it.
class McapWriter {
 public:
  /// Writes the beginning of the file.
  explicit McapWriter(ByteSink sink, McapWriterOptions options = {});

  /// Ids are given from 1 on, in the order of the calls. Throws std::length_error beyond 65,535 of them.
  SchemaId add_schema(std::string name, std::string encoding, std::string data);
  /// The same. `schema`: 0 if there is none; otherwise one that was added, or std::invalid_argument is thrown.
  ChannelId add_channel(std::string topic, SchemaId schema, std::string message_encoding, StringMap metadata = {});
  /// With ids of the caller's, which must be new: for copying a file.
  void add(Schema schema);
  void add(Channel channel);

  /// Ends the chunk if it has its size then. Throws std::invalid_argument if there is no such channel.
  void write_message(ChannelId channel, std::uint32_t sequence, Timestamp log_time, Timestamp publish_time,
                     ByteView data);
  void add_attachment(const Attachment& attachment);
  void add_metadata(const Metadata& metadata);

  /// Ends the chunk, if any message is in it.
  void flush_chunk();
  /// Forgets the messages that are in no chunk yet.
  void discard_chunk();
  /// Ends the chunk and writes the summary. Nothing may be written after it.
  void close();

  /// Bytes that the sink has taken.
  std::uint64_t size() const { return size_; }
  /// Messages in the chunk that is not ended yet.
  std::uint64_t pending_messages() const { return pending_messages_; }
  /// Of what the sink has taken.
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
  std::uint32_t crc_ = 0;  // of the bytes that the sink has taken
  bool is_closed_ = false;

  std::map<SchemaId, Schema> schemas_;
  std::map<ChannelId, Channel> channels_;
  Bytes definitions_;  // records of schemas and channels that no chunk has yet

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
