// SPDX-License-Identifier: Apache-2.0
#include "server/recording/mcap/format/crc32.hpp"

#include <zlib.h>

namespace cohort::recording {

std::uint32_t crc32(ByteView bytes, std::uint32_t crc) {
  if (bytes.empty()) return crc;  // zlib treats an empty input as a restart
  return static_cast<std::uint32_t>(::crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace cohort::recording
