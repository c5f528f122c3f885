// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/recording/mcap/reading/file_bytes.hpp"

/// Parts of a file that hold messages.
namespace cohort::recording {

/// Limits on the memory for a file's data, independent of the sizes that the file states.
struct ReadLimits {
  std::uint64_t chunk_size = std::uint64_t{1} << 29U;   ///< uncompressed bytes of a chunk
  std::uint64_t open_chunks = std::uint64_t{1} << 29U;  ///< uncompressed bytes of all chunks that overlap in time
  /// Uncompressed bytes of all chunks for each byte of the file, beyond `chunk_size`. Recordings of worlds in
  /// which nothing moves are below 10.
  std::uint64_t expansion = 1024;
};

/// The uncompressed bytes that may still be read from a file, in one pass.
class ReadBudget {
 public:
  ReadBudget(const FileBytes& file, const ReadLimits& limits);
  /// Throws McapError if this exceeds the budget.
  void spend(std::uint64_t bytes, const Place& place);

 private:
  std::uint64_t left_;
};

/// A chunk, or consecutive messages outside of chunks.
struct Block {
  std::uint64_t offset = 0;  ///< in the file
  std::uint64_t length = 0;  ///< length of all its records
  Timestamp start_time{};    ///< least log time of its messages
  Timestamp end_time{};      ///< greatest log time
  bool is_chunk = true;
  std::vector<ChannelId> channels{};  ///< channels with messages in it, in order; empty if unknown
};

/// Returns the uncompressed records of a chunk, from its head and its (compressed) bytes. Checks sizes, limits and CRC.
/// Throws McapError.
Bytes uncompressed(const ChunkHead& head, Bytes records, const ReadLimits& limits, const Place& place);

/// Returns the uncompressed records of a block. Throws McapError.
Bytes read_block(const FileBytes& file, const Block& block, const ReadLimits& limits, ReadBudget& budget);

/// Returns the place of the records that `read_block` returns.
Place place_in(const FileBytes& file, const Block& block);

/// A record within a block's records.
struct RecordView {
  Opcode opcode{};
  std::uint64_t offset = 0;  ///< among the records
  ByteView content;
};

/// Returns the record at `offset` of `records`, which come from `place`. Throws McapError if it is incomplete.
RecordView record_at(ByteView records, std::uint64_t offset, const Place& place);

/// Calls `use(RecordView, Place of its content)` for each record.
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
