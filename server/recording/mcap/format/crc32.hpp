#pragma once

#include <cstdint>

#include "server/recording/mcap/format/mcap.hpp"

namespace cohort::recording {

/// The CRC-32 of ISO 3309 and ITU-T V.42 (polynomial 0x04C11DB7, reflected), as MCAP, zip and PNG have it. `crc`: that
/// of the bytes before these.
std::uint32_t crc32(ByteView bytes, std::uint32_t crc = 0);

}  // namespace cohort::recording
