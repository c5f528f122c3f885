// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "server/recording/mcap/reading/message_stream.hpp"

namespace cohort::recording {

struct ReadOptions {
  ReadLimits limits{};
  bool use_summary = true;  ///< false: scan the whole file, as if it had none
};

/// A reader of an MCAP file. It finds the contents in the file's summary, or scans the whole file if there is none. It
/// reads zstd and uncompressed chunks, never more than `ReadLimits` at once, and checks every CRC of the data that it
/// reads.
///
/// A file that was not closed, or whose end is damaged, is read as far as possible: unreadable parts are left out, and
/// `damage` describes them. If the summary is intact but a chunk is not, reading that chunk throws; `recover` skips it.
///
/// All functions throw McapError, with file and byte. For any thread; streams are independent.
class McapReader {
 public:
  /// Throws FileError if the file cannot be opened, and McapError if it is not an MCAP file.
  explicit McapReader(const std::filesystem::path& file, const ReadOptions& options = {});

  const Header& header() const { return contents_->header; }
  const std::map<SchemaId, Schema>& schemas() const { return contents_->schemas; }
  const std::map<ChannelId, Channel>& channels() const { return contents_->channels; }
  /// Returns the first channel of that topic; null if there is none.
  const Channel* channel(std::string_view topic) const;
  /// Returns the statistics of the summary if the file has one.
  const Statistics& statistics() const { return contents_->statistics; }
  const std::vector<Block>& blocks() const { return contents_->blocks; }

  /// Returns true if all written data is readable, as far as opening the file shows.
  bool is_complete() const { return damage_.empty(); }
  /// Returns a sentence with the first damage, its byte, and its effect; empty if there is none.
  const std::string& damage() const { return damage_; }

  MessageStream messages(const MessageQuery& query = {}) const;

  const std::vector<AttachmentIndex>& attachments() const { return contents_->attachments; }
  Attachment attachment(const AttachmentIndex& index) const;
  /// Returns the first attachment of that name. Throws McapError if there is none.
  Attachment attachment(std::string_view name) const;

  const std::vector<MetadataIndex>& metadata() const { return contents_->metadata; }
  Metadata metadata(const MetadataIndex& index) const;
  /// Returns the first metadata record of that name, if there is one.
  std::optional<Metadata> metadata(std::string_view name) const;

 private:
  Bytes record(std::uint64_t offset, std::uint64_t length, Opcode opcode) const;

  std::shared_ptr<const FileBytes> file_;
  std::shared_ptr<const Contents> contents_;
  ReadLimits limits_;
  std::string damage_;
};

}  // namespace cohort::recording
