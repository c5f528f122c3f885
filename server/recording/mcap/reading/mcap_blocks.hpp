#pragma once

#include "server/recording/mcap/reading/file_bytes.hpp"

/// Parts of a file that hold messages.
namespace cohort::recording {

/// More than this is not taken from a file, whatever it says of itself.
struct ReadLimits {
  std::uint64_t chunk_size = std::uint64_t{1} << 29U;   ///< uncompressed bytes of a chunk
  std::uint64_t open_chunks = std::uint64_t{1} << 29U;  ///< the same of all chunks that overlap in time
};

/// A chunk, or messages that follow each other outside of chunks.
struct Block {
  std::uint64_t offset = 0;  ///< in the file
  std::uint64_t length = 0;  ///< of all its records
  Timestamp start_time{};    ///< of its messages
  Timestamp end_time{};
  bool is_chunk = true;
  std::vector<ChannelId> channels{};  ///< that have messages in it, in order; empty if that is not known
};

/// The uncompressed records of a chunk, whose head and (compressed) bytes are given. Checks sizes, limits and CRC.
/// Throws McapError.
Bytes uncompressed(const ChunkHead& head, Bytes records, const ReadLimits& limits, const Place& place);

/// The uncompressed records of a block. Throws McapError.
Bytes read_block(const FileBytes& file, const Block& block, const ReadLimits& limits);

/// Where the records are that `read_block` gave.
Place place_in(const FileBytes& file, const Block& block);

/// A record among others.
struct RecordView {
  Opcode opcode{};
  std::uint64_t offset = 0;  ///< among the records
  ByteView content;
};

/// The record at `offset` of `records`, which come from `place`. Throws McapError if it is not whole.
RecordView record_at(ByteView records, std::uint64_t offset, const Place& place);

/// Calls `use(RecordView, Place of its content)` for each.
template <class Use>
void for_each_record(ByteView records, const Place& place, const Use& use) {
  for (std::uint64_t offset = 0; offset < records.size();) {
    const RecordView record = record_at(records, offset, place);
    Place here = place;
    (here.inside ? *here.inside : here.offset) += offset;
    use(record, here);
    offset += record_head_size + record.content.size();
  }
}

}  // namespace cohort::recording
