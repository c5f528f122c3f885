#pragma once

#include <cstdint>
#include <memory>

#include "server/recording/mcap/format/mcap.hpp"

/// zstd, the one compression of chunks that Cohort writes.
namespace cohort::recording {

/// Compresses; the same bytes give the same bytes. One thread at a time.
class Compressor {
 public:
  /// `level`: zstd's, 1 to 22.
  explicit Compressor(int level);
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;
  ~Compressor();

  /// Appends the compressed `bytes` to `to`. Throws std::runtime_error if there is no memory.
  void compress(ByteView bytes, Bytes& to);

 private:
  struct Context;
  std::unique_ptr<Context> context_;
  int level_;
};

/// Whether `size` bytes can have been compressed to `compressed_size`: zstd's densest block gives 128 KiB for 4 bytes
/// (RFC 8878, 3.1.1.2.2), and what cannot be compressed grows by little.
bool is_possible_size(std::uint64_t size, std::uint64_t compressed_size);

/// Fills `to` with what `bytes` hold. Throws std::runtime_error that says why if they hold something else than exactly
/// so many bytes.
void decompress(ByteView bytes, std::span<std::byte> to);

}  // namespace cohort::recording
