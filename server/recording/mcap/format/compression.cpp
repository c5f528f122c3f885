// SPDX-License-Identifier: Apache-2.0
#include "server/recording/mcap/format/compression.hpp"

#include <zstd.h>

#include <stdexcept>
#include <string>

namespace cohort::recording {

struct Compressor::Context {
  ZSTD_CCtx* zstd = ZSTD_createCCtx();
};

Compressor::Compressor(int level) : context_(std::make_unique<Context>()), level_(level) {
  if (context_->zstd == nullptr) throw std::runtime_error("out of memory for zstd");
}

Compressor::~Compressor() { ZSTD_freeCCtx(context_->zstd); }

void Compressor::compress(ByteView bytes, Bytes& to) {
  const std::size_t before = to.size();
  to.resize(before + ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compressCCtx(context_->zstd, to.data() + before, to.size() - before, bytes.data(), bytes.size(), level_);
  if (ZSTD_isError(size) != 0) throw std::runtime_error(std::string("zstd: ") + ZSTD_getErrorName(size));
  to.resize(before + size);
}

bool is_possible_size(std::uint64_t size, std::uint64_t compressed_size) {
  constexpr std::uint64_t densest = (128U << 10U) / 4U;
  constexpr std::uint64_t overhead = 64U << 10U;
  return size / densest <= compressed_size && compressed_size <= size + size / 128 + overhead;
}

void decompress(ByteView bytes, std::span<std::byte> to) {
  // Decompresses in one call into memory of the right size, so that zstd needs no window of its own.
  const std::size_t size = ZSTD_decompress(to.data(), to.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(size) != 0) throw std::runtime_error(std::string("zstd: ") + ZSTD_getErrorName(size));
  if (size != to.size())
    throw std::runtime_error("it decompresses to " + std::to_string(size) + " bytes, not " + std::to_string(to.size()));
}

}  // namespace cohort::recording
