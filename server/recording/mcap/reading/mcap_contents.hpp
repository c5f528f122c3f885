// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "server/recording/mcap/reading/mcap_blocks.hpp"

/// The contents of a file, without the messages and attachments themselves.
namespace cohort::recording {

struct Contents {
  Header header;
  std::map<SchemaId, Schema> schemas;
  std::map<ChannelId, Channel> channels;
  std::vector<Block> blocks;  ///< in the order of the file
  std::vector<AttachmentIndex> attachments;
  std::vector<MetadataIndex> metadata;
  Statistics statistics;
};

/// A part of a file that cannot be read.
struct Damage {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::string problem;
  bool is_chunk = false;
};

/// The result of a scan of a whole file.
struct Scan {
  Contents contents;  ///< only the readable part
  std::vector<Damage> damages;
  std::uint64_t lost_messages = 0;  ///< known to be in the damaged parts
  bool is_closed = false;           ///< the file ends as specified
};

/// Throws McapError if the file does not begin like an MCAP file.
void check_magic(const FileBytes& file);

/// Scans a whole file, including every chunk. After an unreadable part it continues with the next chunk, attachment or
/// metadata that it finds. Throws McapError if the file does not begin like an MCAP file.
Scan scan_file(const FileBytes& file, const ReadLimits& limits);

/// Reads the summary at the end of the file; nothing if the file has none. Throws McapError if it is damaged, or if the
/// file was not closed.
std::optional<Contents> read_summary(const FileBytes& file);

}  // namespace cohort::recording
