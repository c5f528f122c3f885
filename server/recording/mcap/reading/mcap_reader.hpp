#pragma once

#include <memory>
#include <optional>

#include "server/recording/mcap/reading/message_stream.hpp"

namespace cohort::recording {

struct ReadOptions {
  ReadLimits limits{};
  bool use_summary = true;  ///< false: look through the whole file, as if it had none
};

/// Reads an MCAP file: whose summary tells what is in it, by that; another by looking through all of it. It reads zstd
/// and uncompressed chunks, never more than `ReadLimits` at once, and checks every CRC of what it reads.
///
/// A file that was not closed or whose end is damaged is read as far as it can be: what cannot be read is left out, and
/// `damage` says so. Where the summary is whole but a chunk is not, reading that chunk throws; `recover` goes round it.
///
/// Everything throws McapError, with file and byte. Any thread; streams are independent.
class McapReader {
 public:
  /// Throws FileError if the file cannot be opened, McapError if it is no MCAP file.
  explicit McapReader(const std::filesystem::path& file, const ReadOptions& options = {});

  const Header& header() const { return contents_->header; }
  const std::map<SchemaId, Schema>& schemas() const { return contents_->schemas; }
  const std::map<ChannelId, Channel>& channels() const { return contents_->channels; }
  /// The first channel of that topic; null if there is none.
  const Channel* channel(std::string_view topic) const;
  /// Of a file with a summary, what that says.
  const Statistics& statistics() const { return contents_->statistics; }
  const std::vector<Block>& blocks() const { return contents_->blocks; }

  /// Whether everything that was written can be read, as far as opening the file shows.
  bool is_complete() const { return damage_.empty(); }
  /// A sentence with the first damage, its byte, and what it means; empty if there is none.
  const std::string& damage() const { return damage_; }

  MessageStream messages(const MessageQuery& query = {}) const;

  const std::vector<AttachmentIndex>& attachments() const { return contents_->attachments; }
  Attachment attachment(const AttachmentIndex& index) const;
  /// The first one of that name. Throws McapError if there is none.
  Attachment attachment(std::string_view name) const;

  const std::vector<MetadataIndex>& metadata() const { return contents_->metadata; }
  Metadata metadata(const MetadataIndex& index) const;
  /// The first one of that name; none if there is none.
  std::optional<Metadata> metadata(std::string_view name) const;

 private:
  Bytes record(std::uint64_t offset, std::uint64_t length, Opcode opcode) const;

  std::shared_ptr<const FileBytes> file_;
  std::shared_ptr<const Contents> contents_;
  ReadLimits limits_;
  std::string damage_;
};

}  // namespace cohort::recording
