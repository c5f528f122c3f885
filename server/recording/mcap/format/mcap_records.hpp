// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>

#include "server/recording/mcap/format/mcap.hpp"
#include "server/recording/mcap/format/mcap_error.hpp"

/// Conversion between MCAP records and bytes.
namespace cohort::recording {

/// Each function appends a whole record, with opcode and length. Throws std::length_error if a text is too long for the
/// format.
void append(Bytes& to, const Header& header);
void append(Bytes& to, const Schema& schema);
void append(Bytes& to, const Channel& channel);
void append(Bytes& to, const Message& message);
void append(Bytes& to, const Attachment& attachment);
void append(Bytes& to, const Metadata& metadata);
void append(Bytes& to, const MessageIndex& index);
void append(Bytes& to, const ChunkIndex& index);
void append(Bytes& to, const AttachmentIndex& index);
void append(Bytes& to, const MetadataIndex& index);
void append(Bytes& to, const Statistics& statistics);
void append(Bytes& to, const SummaryOffset& offset);
void append_data_end(Bytes& to, std::uint32_t crc);
/// Appends the footer's record, with the CRC of `summary_before` and of the footer's own first fields, and the magic
/// bytes.
void append_end(Bytes& to, const Footer& footer, ByteView summary_before);
/// Appends a chunk's record up to its (compressed) records, which are `head.compressed_size` bytes and must follow.
void append_chunk_head(Bytes& to, const ChunkHead& head);
void append_magic(Bytes& to);

/// Returns the length of the content of a chunk's record.
std::uint64_t chunk_content_size(const ChunkHead& head);

/// The source of bytes, for error messages.
struct Place {
  const std::filesystem::path* file = nullptr;
  std::uint64_t offset = 0;             ///< offset of the first byte in the file, or of the chunk that contains it
  std::optional<std::uint64_t> inside;  ///< offset of the first byte in the chunk's uncompressed records

  [[noreturn]] void fail(const std::string& problem) const;
};

/// A cursor that reads numbers and texts in sequence. Throws McapError, which names `field`, if there are too few
/// bytes.
class Cursor {
 public:
  Cursor(ByteView bytes, const Place& place) : bytes_(bytes), place_(&place) {}

  template <class Number>
  requires std::is_arithmetic_v<Number> Number number(const char* field) {
    const ByteView bytes = take(sizeof(Number), field);
    Number number{};
    std::memcpy(&number, bytes.data(), sizeof number);
    return number;
  }
  Timestamp time(const char* field) { return Timestamp(number<std::uint64_t>(field)); }
  /// Reads a text that is preceded by its length.
  std::string text(const char* field);
  StringMap map(const char* field);
  /// Reads pairs of 16 and 64 bits.
  std::map<ChannelId, std::uint64_t> numbers_by_channel(const char* field);
  ByteView take(std::uint64_t size, const char* field);
  ByteView rest() { return take(bytes_.size(), ""); }
  std::size_t left() const { return bytes_.size(); }

 private:
  ByteView bytes_;
  const Place* place_;
};

/// A record's opcode and the length of its content, without the `record_head_size` bytes of these two.
struct RecordHead {
  Opcode opcode{};
  std::uint64_t size = 0;
};

/// Each function reads the content of a record. Fields that a later version adds are ignored. Throws McapError.
RecordHead read_record_head(ByteView bytes, const Place& place);
Header read_header(ByteView content, const Place& place);
Footer read_footer(ByteView content, const Place& place);
Schema read_schema(ByteView content, const Place& place);
Channel read_channel(ByteView content, const Place& place);
Message read_message(ByteView content, const Place& place);
/// Checks the CRC.
Attachment read_attachment(ByteView content, const Place& place);
Metadata read_metadata(ByteView content, const Place& place);
/// Reads the head of a chunk. `content` may be cut off where the records begin; `size` is the length of the whole
/// content.
ChunkHead read_chunk_head(ByteView content, std::uint64_t size, const Place& place);
MessageIndex read_message_index(ByteView content, const Place& place);
ChunkIndex read_chunk_index(ByteView content, const Place& place);
AttachmentIndex read_attachment_index(ByteView content, const Place& place);
MetadataIndex read_metadata_index(ByteView content, const Place& place);
Statistics read_statistics(ByteView content, const Place& place);

/// The greatest size of a chunk's content before its records, for the registered compressions.
inline constexpr std::size_t longest_chunk_head = 8 + 8 + 8 + 4 + 4 + 16 + 8;

}  // namespace cohort::recording
