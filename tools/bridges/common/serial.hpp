#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "tools/bridges/common/link.hpp"

namespace cohort::bridges {

/// Opens a serial device, raw, 8N1, for this program alone. One that is unplugged is lost, and connects again when a
/// device of that name can be opened. Throws std::runtime_error if there is none at first.
std::unique_ptr<Link> open_serial(const std::string& device, unsigned baud);

/// Makes a pseudo-terminal; unless it is empty, `symlink` points to its other end as long as the link lives, and must
/// not exist before. Throws std::runtime_error.
std::unique_ptr<Link> make_pty(const std::filesystem::path& symlink);

}  // namespace cohort::bridges
