#pragma once

#include "server/recording/mcap/reading/mcap_contents.hpp"

namespace cohort::recording {

/// What `recover` found and kept.
struct Recovery {
  Statistics kept;
  std::vector<Damage> damages;      ///< empty: the file was whole
  std::uint64_t lost_chunks = 0;    ///< that are there, but damaged
  std::uint64_t lost_messages = 0;  ///< that are known to be lost; more may be, of what is not there at all
  std::uint64_t lost_bytes = 0;

  bool was_whole() const { return damages.empty(); }
  /// For people: a line for what was kept, one for what was lost, and one for each damage, at most 20.
  std::string text() const;
};

/// Writes a closed file of everything in `source` that can be read: messages with their channels in the order of the
/// file, attachments and metadata. It is written beside `target` and takes its place when it is whole; `target` may be
/// `source`. Then a file that is whole is left as it is. Throws FileError if a file cannot be opened or written, or is
/// being recorded to; McapError, with `target` as it was, if `source` is no MCAP file, or damaged and without a message
/// that can be read. To another file it also writes attachments and metadata alone.
Recovery recover(const std::filesystem::path& source, const std::filesystem::path& target,
                 const ReadLimits& limits = {});

}  // namespace cohort::recording
