// SPDX-License-Identifier: Apache-2.0
#include "server/recording/mcap/format/mcap_records.hpp"

#include <stdexcept>

#include "server/recording/mcap/format/crc32.hpp"

namespace cohort::recording {
namespace {

template <class Number>
requires std::is_arithmetic_v<Number>
void add(Bytes& to, Number number) {
  const std::size_t at = to.size();
  to.resize(at + sizeof number);
  std::memcpy(to.data() + at, &number, sizeof number);
}

void add(Bytes& to, Timestamp time) { add(to, time.count()); }

void add_bytes(Bytes& to, ByteView bytes) { to.insert(to.end(), bytes.begin(), bytes.end()); }

ByteView bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }

void add_size(Bytes& to, std::size_t size) {
  if (size > std::numeric_limits<std::uint32_t>::max())
    throw std::length_error("a string or list has " + std::to_string(size) + " bytes; MCAP allows less than 4 GiB");
  add(to, static_cast<std::uint32_t>(size));
}

void add(Bytes& to, std::string_view text) {
  add_size(to, text.size());
  add_bytes(to, bytes_of(text));
}

// Appends the output of `write`, preceded by its length.
template <class Size, class Write>
void add_sized(Bytes& to, const Write& write) {
  const std::size_t at = to.size();
  add(to, Size{});
  write();
  const std::size_t size = to.size() - at - sizeof(Size);
  if (size > std::numeric_limits<Size>::max()) throw std::length_error("a list has more than 4 GiB");
  const Size known = static_cast<Size>(size);
  std::memcpy(to.data() + at, &known, sizeof known);
}

void add(Bytes& to, const StringMap& map) {
  add_sized<std::uint32_t>(to, [&] {
    for (const auto& [key, value] : map) {
      add(to, std::string_view(key));
      add(to, std::string_view(value));
    }
  });
}

void add(Bytes& to, const std::map<ChannelId, std::uint64_t>& map) {
  add_sized<std::uint32_t>(to, [&] {
    for (const auto& [channel, number] : map) {
      add(to, channel);
      add(to, number);
    }
  });
}

template <class Write>
void add_record(Bytes& to, Opcode opcode, const Write& write) {
  add(to, static_cast<std::uint8_t>(opcode));
  add_sized<std::uint64_t>(to, write);
}

}  // namespace

void append_magic(Bytes& to) { add_bytes(to, std::as_bytes(std::span(mcap_magic))); }

void append(Bytes& to, const Header& header) {
  add_record(to, Opcode::header, [&] {
    add(to, std::string_view(header.profile));
    add(to, std::string_view(header.library));
  });
}

void append(Bytes& to, const Schema& schema) {
  add_record(to, Opcode::schema, [&] {
    add(to, schema.id);
    add(to, std::string_view(schema.name));
    add(to, std::string_view(schema.encoding));
    add(to, std::string_view(schema.data));
  });
}

void append(Bytes& to, const Channel& channel) {
  add_record(to, Opcode::channel, [&] {
    add(to, channel.id);
    add(to, channel.schema);
    add(to, std::string_view(channel.topic));
    add(to, std::string_view(channel.message_encoding));
    add(to, channel.metadata);
  });
}

void append(Bytes& to, const Message& message) {
  add_record(to, Opcode::message, [&] {
    add(to, message.channel);
    add(to, message.sequence);
    add(to, message.log_time);
    add(to, message.publish_time);
    add_bytes(to, message.data);
  });
}

void append(Bytes& to, const Attachment& attachment) {
  add_record(to, Opcode::attachment, [&] {
    const std::size_t start = to.size();
    add(to, attachment.log_time);
    add(to, attachment.create_time);
    add(to, std::string_view(attachment.name));
    add(to, std::string_view(attachment.media_type));
    add(to, static_cast<std::uint64_t>(attachment.data.size()));
    add_bytes(to, attachment.data);
    add(to, crc32(ByteView(to).subspan(start)));
  });
}

void append(Bytes& to, const Metadata& metadata) {
  add_record(to, Opcode::metadata, [&] {
    add(to, std::string_view(metadata.name));
    add(to, metadata.entries);
  });
}

void append(Bytes& to, const MessageIndex& index) {
  add_record(to, Opcode::message_index, [&] {
    add(to, index.channel);
    add_sized<std::uint32_t>(to, [&] {
      for (const MessageIndex::Entry& entry : index.entries) {
        add(to, entry.log_time);
        add(to, entry.offset);
      }
    });
  });
}

void append(Bytes& to, const ChunkIndex& index) {
  add_record(to, Opcode::chunk_index, [&] {
    add(to, index.start_time);
    add(to, index.end_time);
    add(to, index.offset);
    add(to, index.length);
    add(to, index.message_index_offsets);
    add(to, index.message_index_length);
    add(to, std::string_view(index.compression));
    add(to, index.compressed_size);
    add(to, index.uncompressed_size);
  });
}

void append(Bytes& to, const AttachmentIndex& index) {
  add_record(to, Opcode::attachment_index, [&] {
    add(to, index.offset);
    add(to, index.length);
    add(to, index.log_time);
    add(to, index.create_time);
    add(to, index.data_size);
    add(to, std::string_view(index.name));
    add(to, std::string_view(index.media_type));
  });
}

void append(Bytes& to, const MetadataIndex& index) {
  add_record(to, Opcode::metadata_index, [&] {
    add(to, index.offset);
    add(to, index.length);
    add(to, std::string_view(index.name));
  });
}

void append(Bytes& to, const Statistics& statistics) {
  add_record(to, Opcode::statistics, [&] {
    add(to, statistics.message_count);
    add(to, statistics.schema_count);
    add(to, statistics.channel_count);
    add(to, statistics.attachment_count);
    add(to, statistics.metadata_count);
    add(to, statistics.chunk_count);
    add(to, statistics.start_time);
    add(to, statistics.end_time);
    add(to, statistics.messages_of_channels);
  });
}

void append(Bytes& to, const SummaryOffset& offset) {
  add_record(to, Opcode::summary_offset, [&] {
    add(to, static_cast<std::uint8_t>(offset.group));
    add(to, offset.start);
    add(to, offset.length);
  });
}

void append_data_end(Bytes& to, std::uint32_t crc) {
  add_record(to, Opcode::data_end, [&] { add(to, crc); });
}

void append_end(Bytes& to, const Footer& footer, ByteView summary_before) {
  std::uint32_t crc = crc32(summary_before);
  const std::size_t start = to.size();
  add_record(to, Opcode::footer, [&] {
    add(to, footer.summary_start);
    add(to, footer.summary_offset_start);
    add(to, std::uint32_t{0});
  });
  const std::size_t at = to.size() - sizeof crc;
  crc = crc32(ByteView(to).subspan(start, at - start), crc);
  std::memcpy(to.data() + at, &crc, sizeof crc);
  append_magic(to);
}

std::uint64_t chunk_content_size(const ChunkHead& head) {
  return 8 + 8 + 8 + 4 + 4 + head.compression.size() + 8 + head.compressed_size;
}

void append_chunk_head(Bytes& to, const ChunkHead& head) {
  add(to, static_cast<std::uint8_t>(Opcode::chunk));
  add(to, chunk_content_size(head));
  add(to, head.start_time);
  add(to, head.end_time);
  add(to, head.uncompressed_size);
  add(to, head.uncompressed_crc);
  add(to, std::string_view(head.compression));
  add(to, head.compressed_size);
}

}  // namespace cohort::recording
