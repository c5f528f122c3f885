// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

/// Recordings: MCAP files (https://mcap.dev/spec), their writer, reader and recovery, and the ROS 2 messages in them.
namespace cohort::recording {

using Bytes = std::vector<std::byte>;
using ByteView = std::span<const std::byte>;

/// Nanoseconds since an epoch that the application defines; in Cohort's files, simulated time.
using Timestamp = std::chrono::duration<std::uint64_t, std::nano>;

using SchemaId = std::uint16_t;   ///< from 1; 0: no schema
using ChannelId = std::uint16_t;  ///< unique in a file
using StringMap = std::map<std::string, std::string>;

/// The magic bytes at the beginning and at the end of a file.
inline constexpr std::array<std::uint8_t, 8> mcap_magic = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};

/// The first byte of a record. The length of the content follows, in eight bytes.
enum class Opcode : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0A,
  statistics = 0x0B,
  metadata = 0x0C,
  metadata_index = 0x0D,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

/// Size of opcode and length [bytes].
inline constexpr std::size_t record_head_size = 9;

struct Header {
  std::string profile;  ///< such as `ros2`
  std::string library;  ///< the library that wrote the file
};

struct Schema {
  SchemaId id = 0;
  std::string name;      ///< such as `geometry_msgs/msg/Pose`
  std::string encoding;  ///< such as `ros2msg`
  std::string data;

  bool operator==(const Schema&) const = default;
};

struct Channel {
  ChannelId id = 0;
  SchemaId schema = 0;
  std::string topic;
  std::string message_encoding;  ///< such as `cdr`
  StringMap metadata;

  bool operator==(const Channel&) const = default;
};

struct MessageHead {
  ChannelId channel = 0;
  std::uint32_t sequence = 0;
  Timestamp log_time{};
  Timestamp publish_time{};
};

/// A message that does not own its bytes; the function that returns one documents their lifetime.
struct Message : MessageHead {
  ByteView data;
};

struct Attachment {
  Timestamp log_time{};
  Timestamp create_time{};
  std::string name;
  std::string media_type;
  Bytes data;
};

struct Metadata {
  std::string name;
  StringMap entries;
};

/// The beginning of a chunk record, before its messages.
struct ChunkHead {
  Timestamp start_time{};  ///< least log time in the chunk; 0 without messages
  Timestamp end_time{};    ///< greatest log time
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;  ///< 0: none
  std::string compression;             ///< `zstd`, `lz4` or empty
  std::uint64_t compressed_size = 0;
};

struct MessageIndex {
  struct Entry {
    Timestamp log_time{};
    std::uint64_t offset = 0;  ///< offset of the message's record in the chunk's uncompressed records
  };
  ChannelId channel = 0;
  std::vector<Entry> entries;
};

struct ChunkIndex {
  Timestamp start_time{};
  Timestamp end_time{};
  std::uint64_t offset = 0;  ///< offset of the chunk's record in the file
  std::uint64_t length = 0;  ///< length of the whole record
  std::map<ChannelId, std::uint64_t> message_index_offsets;
  std::uint64_t message_index_length = 0;
  std::string compression;
  std::uint64_t compressed_size = 0;
  std::uint64_t uncompressed_size = 0;
};

struct AttachmentIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;  ///< length of the whole record
  Timestamp log_time{};
  Timestamp create_time{};
  std::uint64_t data_size = 0;
  std::string name;
  std::string media_type;
};

struct MetadataIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;  ///< length of the whole record
  std::string name;
};

struct Statistics {
  std::uint64_t message_count = 0;
  std::uint16_t schema_count = 0;
  std::uint32_t channel_count = 0;
  std::uint32_t attachment_count = 0;
  std::uint32_t metadata_count = 0;
  std::uint32_t chunk_count = 0;
  Timestamp start_time{};  ///< least log time of all messages; 0 if there are none
  Timestamp end_time{};    ///< greatest log time
  std::map<ChannelId, std::uint64_t> messages_of_channels;
};

struct SummaryOffset {
  Opcode group{};
  std::uint64_t start = 0;
  std::uint64_t length = 0;
};

struct Footer {
  std::uint64_t summary_start = 0;         ///< 0: no summary
  std::uint64_t summary_offset_start = 0;  ///< 0: none
  std::uint32_t summary_crc = 0;           ///< 0: none
};

}  // namespace cohort::recording
