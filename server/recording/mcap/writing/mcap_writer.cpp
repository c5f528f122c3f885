// SPDX-License-Identifier: Apache-2.0
#include "server/recording/mcap/writing/mcap_writer.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <stdexcept>

#include "idl/include/cohort/version.h"
#include "server/recording/mcap/format/crc32.hpp"
#include "server/recording/mcap/format/mcap_records.hpp"

namespace cohort::recording {
namespace {

template <class Map>
std::uint16_t next_id(const Map& map, const char* what) {
  if (map.empty()) return 1;
  const std::uint16_t last = map.rbegin()->first;
  if (last == std::numeric_limits<std::uint16_t>::max())
    throw std::length_error(std::string("an MCAP file has at most 65,535 ") + what);
  return static_cast<std::uint16_t>(last + 1);
}

// Appends the records of a map of schemas or channels by id.
template <class Id, class Value>
void append_each(Bytes& to, const std::map<Id, Value>& values) {
  for (const auto& [id, value] : values) append(to, value);
}

template <class Value>
void append_each(Bytes& to, const std::vector<Value>& values) {
  for (const Value& value : values) append(to, value);
}

void append_each(Bytes& to, const Statistics& statistics) { append(to, statistics); }

}  // namespace

std::string library_name() { return "cohort " COHORT_VERSION; }

McapWriter::McapWriter(ByteSink sink, McapWriterOptions options)
    : sink_(std::move(sink)), options_(std::move(options)) {
  if (options_.compress) compressor_.emplace(options_.level);
  Bytes bytes;
  append_magic(bytes);
  append(bytes, Header{options_.profile, options_.library});
  write(bytes);
}

void McapWriter::write(ByteView bytes) {
  assert(!is_closed_);
  sink_(bytes);
  size_ += bytes.size();
  crc_ = crc32(bytes, crc_);
}

SchemaId McapWriter::add_schema(std::string name, std::string encoding, std::string data) {
  const SchemaId id = next_id(schemas_, "schemas");
  add(Schema{id, std::move(name), std::move(encoding), std::move(data)});
  return id;
}

ChannelId McapWriter::add_channel(std::string topic, SchemaId schema, std::string message_encoding,
                                  StringMap metadata) {
  const ChannelId id = next_id(channels_, "channels");
  add(Channel{id, schema, std::move(topic), std::move(message_encoding), std::move(metadata)});
  return id;
}

void McapWriter::add(Schema schema) {
  if (schema.id == 0) throw std::invalid_argument("the id of a schema must not be 0");
  const auto [added, is_new] = schemas_.emplace(schema.id, std::move(schema));
  if (!is_new) throw std::invalid_argument("schema " + std::to_string(added->first) + " already exists");
  append(definitions_, added->second);
  append(chunk_, added->second);
}

void McapWriter::add(Channel channel) {
  if (channel.schema != 0 && !schemas_.contains(channel.schema))
    throw std::invalid_argument("channel " + channel.topic + " refers to schema " + std::to_string(channel.schema) +
                                ", which was not added");
  const auto [added, is_new] = channels_.emplace(channel.id, std::move(channel));
  if (!is_new) throw std::invalid_argument("channel " + std::to_string(added->first) + " already exists");
  append(definitions_, added->second);
  append(chunk_, added->second);
}

void McapWriter::write_message(ChannelId channel, std::uint32_t sequence, Timestamp log_time, Timestamp publish_time,
                               ByteView data) {
  if (!channels_.contains(channel))
    throw std::invalid_argument("channel " + std::to_string(channel) + " does not exist");
  MessageIndex& index = message_indexes_[channel];
  index.channel = channel;
  index.entries.push_back({log_time, chunk_.size()});
  try {
    append(chunk_, Message{{channel, sequence, log_time, publish_time}, data});
  } catch (const std::bad_alloc&) {  // the writer drops the incomplete message
    chunk_.resize(index.entries.back().offset);
    index.entries.pop_back();
    throw;
  }
  chunk_start_ = pending_messages_ == 0 ? log_time : std::min(chunk_start_, log_time);
  chunk_end_ = pending_messages_ == 0 ? log_time : std::max(chunk_end_, log_time);
  ++pending_messages_;
  if (chunk_.size() >= options_.chunk_size) flush_chunk();
}

void McapWriter::append_message_indexes(Bytes& to, ChunkIndex& index) const {
  const std::uint64_t start = size_ + to.size();
  for (const auto& [channel, messages] : message_indexes_) {
    if (messages.entries.empty()) continue;
    index.message_index_offsets.emplace(channel, size_ + to.size());
    append(to, messages);
  }
  index.message_index_length = size_ + to.size() - start;
}

void McapWriter::flush_chunk() {
  if (pending_messages_ == 0) return;
  assert(chunk_start_ <= chunk_end_);
  Bytes compressed;
  if (compressor_) compressor_->compress(chunk_, compressed);
  const ByteView records = compressor_ ? compressed : chunk_;
  const ChunkHead head{chunk_start_,  chunk_end_, chunk_.size(), crc32(chunk_), compressor_ ? "zstd" : "",
                       records.size()};

  Bytes bytes = definitions_;
  ChunkIndex index{.start_time = chunk_start_,
                   .end_time = chunk_end_,
                   .offset = size_ + bytes.size(),
                   .length = record_head_size + chunk_content_size(head),
                   .message_index_offsets = {},
                   .message_index_length = 0,
                   .compression = head.compression,
                   .compressed_size = head.compressed_size,
                   .uncompressed_size = head.uncompressed_size};
  append_chunk_head(bytes, head);
  bytes.insert(bytes.end(), records.begin(), records.end());
  append_message_indexes(bytes, index);
  write(bytes);

  const bool is_first = statistics_.message_count == 0;
  statistics_.start_time = is_first ? chunk_start_ : std::min(statistics_.start_time, chunk_start_);
  statistics_.end_time = is_first ? chunk_end_ : std::max(statistics_.end_time, chunk_end_);
  statistics_.message_count += pending_messages_;
  ++statistics_.chunk_count;
  for (const auto& [channel, messages] : message_indexes_)
    if (!messages.entries.empty()) statistics_.messages_of_channels[channel] += messages.entries.size();
  chunk_indexes_.push_back(std::move(index));
  definitions_.clear();
  discard_chunk();
}

void McapWriter::discard_chunk() {
  chunk_ = definitions_;
  for (auto& [channel, messages] : message_indexes_) messages.entries.clear();
  pending_messages_ = 0;
}

void McapWriter::add_attachment(const Attachment& attachment) {
  Bytes bytes;
  append(bytes, attachment);
  const AttachmentIndex index{
      size_,           bytes.size(),         attachment.log_time, attachment.create_time, attachment.data.size(),
      attachment.name, attachment.media_type};
  write(bytes);
  attachment_indexes_.push_back(index);
  ++statistics_.attachment_count;
}

void McapWriter::add_metadata(const Metadata& metadata) {
  Bytes bytes;
  append(bytes, metadata);
  const MetadataIndex index{size_, bytes.size(), metadata.name};
  write(bytes);
  metadata_indexes_.push_back(index);
  ++statistics_.metadata_count;
}

template <class Records>
void McapWriter::append_group(Bytes& to, std::uint64_t start, Opcode opcode, const Records& records) {
  const std::size_t before = to.size();
  append_each(to, records);
  if (to.size() > before) summary_offsets_.push_back({opcode, start + before, to.size() - before});
}

// Returns the summary, its offsets and the end of the file, which begin at `start`.
Bytes McapWriter::summary(std::uint64_t start) {
  Statistics statistics = statistics_;
  statistics.schema_count = static_cast<std::uint16_t>(schemas_.size());
  statistics.channel_count = static_cast<std::uint32_t>(channels_.size());
  summary_offsets_.clear();
  Bytes bytes;
  append_group(bytes, start, Opcode::schema, schemas_);
  append_group(bytes, start, Opcode::channel, channels_);
  append_group(bytes, start, Opcode::statistics, statistics);
  append_group(bytes, start, Opcode::chunk_index, chunk_indexes_);
  append_group(bytes, start, Opcode::attachment_index, attachment_indexes_);
  append_group(bytes, start, Opcode::metadata_index, metadata_indexes_);
  const Footer footer{start, start + bytes.size(), 0};
  append_each(bytes, summary_offsets_);
  append_end(bytes, footer, Bytes(bytes));
  return bytes;
}

void McapWriter::close() {
  if (is_closed_) return;
  flush_chunk();
  Bytes bytes = definitions_;
  append_data_end(bytes, crc32(definitions_, crc_));
  const Bytes rest = summary(size_ + bytes.size());
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  write(bytes);
  definitions_.clear();
  is_closed_ = true;
}

}  // namespace cohort::recording
