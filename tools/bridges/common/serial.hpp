// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "tools/bridges/common/link.hpp"

namespace cohort::bridges {

/// Opens a serial device, raw, 8N1, for exclusive use. If the device is unplugged, the link is lost; it connects again
/// when a device of that name can be opened. Throws std::runtime_error if the device cannot be opened at the start.
std::unique_ptr<Link> open_serial(const std::string& device, unsigned baud);

/// Makes a pseudo-terminal. Unless `symlink` is empty, it is created as a symbolic link to the other end, and removed
/// with the link. Throws std::runtime_error, also if `symlink` exists.
std::unique_ptr<Link> make_pty(const std::filesystem::path& symlink);

}  // namespace cohort::bridges
