// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "server/recording/mcap/format/mcap.hpp"

namespace cohort::recording {

/// Returns the CRC-32 of ISO 3309 and ITU-T V.42 (polynomial 0x04C11DB7, reflected), as used by MCAP, zip and PNG.
/// `crc`: the CRC of the preceding bytes.
std::uint32_t crc32(ByteView bytes, std::uint32_t crc = 0);

}  // namespace cohort::recording
