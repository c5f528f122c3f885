#pragma once

#include <optional>

#include "server/recording/mcap/reading/mcap_blocks.hpp"

/// What is in a file, but for messages and attachments themselves.
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

/// What looking through a whole file found.
struct Scan {
  Contents contents;  ///< only what can be read
  std::vector<Damage> damages;
  std::uint64_t lost_messages = 0;  ///< that are known to be among the damages
  bool is_closed = false;           ///< it ends as a file should
};

/// Throws McapError if the file does not begin as an MCAP file does.
void check_magic(const FileBytes& file);

/// Looks through a whole file, every chunk included; where something cannot be read, it goes on with the next chunk,
/// attachment or metadata that it finds. Throws McapError if the file does not begin as an MCAP file.
Scan scan_file(const FileBytes& file, const ReadLimits& limits);

/// What the summary at the end of the file says. Nothing if the file has none. Throws McapError if it is damaged, or if
/// the file was never closed.
std::optional<Contents> read_summary(const FileBytes& file);

}  // namespace cohort::recording
