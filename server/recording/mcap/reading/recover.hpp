// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/recording/mcap/reading/mcap_contents.hpp"

namespace cohort::recording {

/// The result of `recover`.
struct Recovery {
  Statistics kept;
  std::vector<Damage> damages;      ///< empty: the file was complete
  std::uint64_t lost_chunks = 0;    ///< found, but damaged
  std::uint64_t lost_messages = 0;  ///< known to be lost; missing parts may have had more
  std::uint64_t lost_bytes = 0;

  bool was_whole() const { return damages.empty(); }
  /// Returns a human-readable text: a line on the kept data, one on the lost data, and one for each damage, at most 20.
  std::string text() const;
};

/// Writes all readable data of `source` to a closed file: messages with their channels in file order, attachments and
/// metadata. The file is written beside `target` and replaces it when it is complete. `target` may be `source`; then a
/// complete file is not changed. Throws FileError if a file cannot be opened or written, or is being recorded. Throws
/// McapError, and keeps `target` unchanged, if `source` is not an MCAP file, or is damaged and has no readable message.
/// If `target` is a different file, attachments or metadata without messages are enough.
Recovery recover(const std::filesystem::path& source, const std::filesystem::path& target,
                 const ReadLimits& limits = {});

}  // namespace cohort::recording
