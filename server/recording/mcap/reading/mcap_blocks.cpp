// SPDX-License-Identifier: Apache-2.0
#include "server/recording/mcap/reading/mcap_blocks.hpp"

#include <algorithm>

#include "server/recording/mcap/format/compression.hpp"
#include "server/recording/mcap/format/crc32.hpp"

namespace cohort::recording {
namespace {

void check_sizes(const ChunkHead& head, const ReadLimits& limits, const Place& place) {
  if (head.compression == "lz4")
    place.fail(
        "the chunk is compressed with lz4, which Cohort does not support; it reads zstd and uncompressed chunks");
  if (!head.compression.empty() && head.compression != "zstd")
    place.fail("the chunk's compression is '" + head.compression + "', expected 'zstd' or '' (none)");
  if (head.uncompressed_size > limits.chunk_size)
    place.fail("the chunk has " + std::to_string(head.uncompressed_size) + " uncompressed bytes; the maximum is " +
               std::to_string(limits.chunk_size));
  const bool is_possible = head.compression.empty() ? head.uncompressed_size == head.compressed_size
                                                    : is_possible_size(head.uncompressed_size, head.compressed_size);
  if (!is_possible)
    place.fail("invalid chunk: " + std::to_string(head.compressed_size) + " compressed bytes cannot expand to " +
               std::to_string(head.uncompressed_size) + " bytes");
}

}  // namespace

Bytes uncompressed(const ChunkHead& head, Bytes records, const ReadLimits& limits, const Place& place) {
  check_sizes(head, limits, place);
  if (!head.compression.empty()) {
    Bytes out(static_cast<std::size_t>(head.uncompressed_size));
    try {
      decompress(records, out);
    } catch (const std::runtime_error& error) {
      place.fail(std::string("the chunk is damaged: ") + error.what());
    }
    records = std::move(out);
  }
  if (head.uncompressed_crc != 0 && head.uncompressed_crc != crc32(records))
    place.fail("the chunk is damaged: wrong CRC");
  return records;
}

ReadBudget::ReadBudget(const FileBytes& file, const ReadLimits& limits)
    : left_(limits.chunk_size + limits.expansion * file.size()) {}

void ReadBudget::spend(std::uint64_t bytes, const Place& place) {
  if (bytes > left_)
    place.fail("the chunks up to this one expand to more than is possible for a recording of this size");
  left_ -= bytes;
}

Bytes read_block(const FileBytes& file, const Block& block, const ReadLimits& limits, ReadBudget& budget) {
  if (!block.is_chunk) return file.read(block.offset, block.length);
  const Place place = file.at(block.offset);
  std::array<std::byte, record_head_size + longest_chunk_head> first{};
  if (block.offset > file.size()) file.read(block.offset, first);  // throws
  const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(first.size(), file.size() - block.offset));
  file.read(block.offset, std::span(first).first(size));
  const RecordHead record = read_record_head(ByteView(first).first(size), place);
  if (record.opcode != Opcode::chunk || record.size != block.length - record_head_size)
    place.fail("expected a chunk with " + std::to_string(block.length) + " bytes, found a record of type " +
               std::to_string(static_cast<int>(record.opcode)) + " with " + std::to_string(record.size) + " bytes");
  const ByteView content = ByteView(first).first(size).subspan(record_head_size);
  const ChunkHead head = read_chunk_head(content, record.size, place);
  const std::uint64_t before = chunk_content_size(head) - head.compressed_size;
  check_sizes(head, limits, place);
  budget.spend(head.uncompressed_size, place);
  return uncompressed(head, file.read(block.offset + record_head_size + before, head.compressed_size), limits, place);
}

Place place_in(const FileBytes& file, const Block& block) {
  Place place = file.at(block.offset);
  if (block.is_chunk) place.inside = 0;
  return place;
}

RecordView record_at(ByteView records, std::uint64_t offset, const Place& place) {
  Place here = place;
  (here.inside ? *here.inside : here.offset) += offset;
  if (offset > records.size()) here.fail("expected a record");
  const ByteView rest = records.subspan(static_cast<std::size_t>(offset));
  const RecordHead head = read_record_head(rest, here);
  if (head.size > rest.size() - record_head_size)
    here.fail("the record has " + std::to_string(head.size) + " bytes, but only " +
              std::to_string(rest.size() - record_head_size) + " are left");
  return {head.opcode, offset, rest.subspan(record_head_size, static_cast<std::size_t>(head.size))};
}

}  // namespace cohort::recording
