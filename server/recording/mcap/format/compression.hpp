// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "server/recording/mcap/format/mcap.hpp"

/// zstd, the only compression of chunks that Cohort writes.
namespace cohort::recording {

/// A compressor whose output depends only on the input. For one thread at a time.
class Compressor {
 public:
  /// `level`: zstd's level, 1 to 22.
  explicit Compressor(int level);
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;
  ~Compressor();

  /// Appends the compressed `bytes` to `to`. Throws std::runtime_error if it is out of memory.
  void compress(ByteView bytes, Bytes& to);

 private:
  struct Context;
  std::unique_ptr<Context> context_;
  int level_;
};

/// Returns true if `size` bytes can be compressed to `compressed_size`. zstd's densest block encodes 128 KiB in 4 bytes
/// (RFC 8878, 3.1.1.2.2), and incompressible data grows only slightly.
bool is_possible_size(std::uint64_t size, std::uint64_t compressed_size);

/// Decompresses `bytes` into `to`. Throws std::runtime_error with the reason unless they decompress to exactly the size
/// of `to`.
void decompress(ByteView bytes, std::span<std::byte> to);

}  // namespace cohort::recording
