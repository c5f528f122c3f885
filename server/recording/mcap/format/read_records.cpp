// SPDX-License-Identifier: Apache-2.0
#include "server/recording/mcap/format/crc32.hpp"
#include "server/recording/mcap/format/mcap_records.hpp"

namespace cohort::recording {

void Place::fail(const std::string& problem) const {
  throw McapError(*file, offset,
                  inside ? "byte " + std::to_string(*inside) + " of the chunk's records: " + problem : problem);
}

ByteView Cursor::take(std::uint64_t size, const char* field) {
  if (size > bytes_.size())
    place_->fail("'" + std::string(field) + "' has " + std::to_string(size) + " bytes, but its record has only " +
                 std::to_string(bytes_.size()) + " left");
  const ByteView taken = bytes_.first(static_cast<std::size_t>(size));
  bytes_ = bytes_.subspan(static_cast<std::size_t>(size));
  return taken;
}

std::string Cursor::text(const char* field) {
  const ByteView bytes = take(number<std::uint32_t>(field), field);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

StringMap Cursor::map(const char* field) {
  Cursor entries(take(number<std::uint32_t>(field), field), *place_);
  StringMap map;
  while (entries.left() > 0) {
    std::string key = entries.text(field);
    map.insert_or_assign(std::move(key), entries.text(field));
  }
  return map;
}

std::map<ChannelId, std::uint64_t> Cursor::numbers_by_channel(const char* field) {
  Cursor entries(take(number<std::uint32_t>(field), field), *place_);
  std::map<ChannelId, std::uint64_t> map;
  while (entries.left() > 0) {
    const auto channel = entries.number<ChannelId>(field);
    map.insert_or_assign(channel, entries.number<std::uint64_t>(field));
  }
  return map;
}

RecordHead read_record_head(ByteView bytes, const Place& place) {
  Cursor cursor(bytes, place);
  RecordHead head;
  head.opcode = static_cast<Opcode>(cursor.number<std::uint8_t>("opcode"));
  head.size = cursor.number<std::uint64_t>("length");
  return head;
}

Header read_header(ByteView content, const Place& place) {
  Cursor cursor(content, place);
  Header header;
  header.profile = cursor.text("profile");
  header.library = cursor.text("library");
  return header;
}

Footer read_footer(ByteView content, const Place& place) {
  Cursor cursor(content, place);
  Footer footer;
  footer.summary_start = cursor.number<std::uint64_t>("summary_start");
  footer.summary_offset_start = cursor.number<std::uint64_t>("summary_offset_start");
  footer.summary_crc = cursor.number<std::uint32_t>("summary_crc");
  return footer;
}

Schema read_schema(ByteView content, const Place& place) {
  Cursor cursor(content, place);
  Schema schema;
  schema.id = cursor.number<SchemaId>("id");
  schema.name = cursor.text("name");
  schema.encoding = cursor.text("encoding");
  schema.data = cursor.text("data");
  return schema;
}

Channel read_channel(ByteView content, const Place& place) {
  Cursor cursor(content, place);
  Channel channel;
  channel.id = cursor.number<ChannelId>("id");
  channel.schema = cursor.number<SchemaId>("schema_id");
  channel.topic = cursor.text("topic");
  channel.message_encoding = cursor.text("message_encoding");
  channel.metadata = cursor.map("metadata");
  return channel;
}

Message read_message(ByteView content, const Place& place) {
  Cursor cursor(content, place);
  Message message;
  message.channel = cursor.number<ChannelId>("channel_id");
  message.sequence = cursor.number<std::uint32_t>("sequence");
  message.log_time = cursor.time("log_time");
  message.publish_time = cursor.time("publish_time");
  message.data = cursor.rest();
  return message;
}

Attachment read_attachment(ByteView content, const Place& place) {
  Cursor cursor(content, place);
  Attachment attachment;
  attachment.log_time = cursor.time("log_time");
  attachment.create_time = cursor.time("create_time");
  attachment.name = cursor.text("name");
  attachment.media_type = cursor.text("media_type");
  const ByteView data = cursor.take(cursor.number<std::uint64_t>("data"), "data");
  const std::size_t before_crc = content.size() - cursor.left();
  const auto crc = cursor.number<std::uint32_t>("crc");
  if (crc != 0 && crc != crc32(content.first(before_crc)))
    place.fail("the attachment '" + attachment.name + "' is damaged: wrong CRC");
  attachment.data.assign(data.begin(), data.end());
  return attachment;
}

Metadata read_metadata(ByteView content, const Place& place) {
  Cursor cursor(content, place);
  Metadata metadata;
  metadata.name = cursor.text("name");
  metadata.entries = cursor.map("metadata");
  return metadata;
}

ChunkHead read_chunk_head(ByteView content, std::uint64_t size, const Place& place) {
  Cursor cursor(content, place);
  ChunkHead head;
  head.start_time = cursor.time("message_start_time");
  head.end_time = cursor.time("message_end_time");
  head.uncompressed_size = cursor.number<std::uint64_t>("uncompressed_size");
  head.uncompressed_crc = cursor.number<std::uint32_t>("uncompressed_crc");
  head.compression = cursor.text("compression");
  head.compressed_size = cursor.number<std::uint64_t>("records");
  const std::uint64_t before = content.size() - cursor.left();
  if (head.compressed_size > size - before)
    place.fail("the chunk's content has " + std::to_string(head.compressed_size) + " bytes, but its record has only " +
               std::to_string(size - before) + " left");
  return head;
}

MessageIndex read_message_index(ByteView content, const Place& place) {
  Cursor cursor(content, place);
  MessageIndex index;
  index.channel = cursor.number<ChannelId>("channel_id");
  Cursor entries(cursor.take(cursor.number<std::uint32_t>("records"), "records"), place);
  index.entries.reserve(entries.left() / 16);
  while (entries.left() > 0) {
    const Timestamp time = entries.time("log_time");
    index.entries.push_back({time, entries.number<std::uint64_t>("offset")});
  }
  return index;
}

ChunkIndex read_chunk_index(ByteView content, const Place& place) {
  Cursor cursor(content, place);
  ChunkIndex index;
  index.start_time = cursor.time("message_start_time");
  index.end_time = cursor.time("message_end_time");
  index.offset = cursor.number<std::uint64_t>("chunk_start_offset");
  index.length = cursor.number<std::uint64_t>("chunk_length");
  index.message_index_offsets = cursor.numbers_by_channel("message_index_offsets");
  index.message_index_length = cursor.number<std::uint64_t>("message_index_length");
  index.compression = cursor.text("compression");
  index.compressed_size = cursor.number<std::uint64_t>("compressed_size");
  index.uncompressed_size = cursor.number<std::uint64_t>("uncompressed_size");
  return index;
}

AttachmentIndex read_attachment_index(ByteView content, const Place& place) {
  Cursor cursor(content, place);
  AttachmentIndex index;
  index.offset = cursor.number<std::uint64_t>("offset");
  index.length = cursor.number<std::uint64_t>("length");
  index.log_time = cursor.time("log_time");
  index.create_time = cursor.time("create_time");
  index.data_size = cursor.number<std::uint64_t>("data_size");
  index.name = cursor.text("name");
  index.media_type = cursor.text("media_type");
  return index;
}

MetadataIndex read_metadata_index(ByteView content, const Place& place) {
  Cursor cursor(content, place);
  MetadataIndex index;
  index.offset = cursor.number<std::uint64_t>("offset");
  index.length = cursor.number<std::uint64_t>("length");
  index.name = cursor.text("name");
  return index;
}

Statistics read_statistics(ByteView content, const Place& place) {
  Cursor cursor(content, place);
  Statistics statistics;
  statistics.message_count = cursor.number<std::uint64_t>("message_count");
  statistics.schema_count = cursor.number<std::uint16_t>("schema_count");
  statistics.channel_count = cursor.number<std::uint32_t>("channel_count");
  statistics.attachment_count = cursor.number<std::uint32_t>("attachment_count");
  statistics.metadata_count = cursor.number<std::uint32_t>("metadata_count");
  statistics.chunk_count = cursor.number<std::uint32_t>("chunk_count");
  statistics.start_time = cursor.time("message_start_time");
  statistics.end_time = cursor.time("message_end_time");
  statistics.messages_of_channels = cursor.numbers_by_channel("channel_message_counts");
  return statistics;
}

}  // namespace cohort::recording
