// SPDX-License-Identifier: Apache-2.0
#include "server/recording/mcap/reading/mcap_reader.hpp"

#include <algorithm>

#include "server/recording/mcap/reading/message_source.hpp"

namespace cohort::recording {
namespace {

bool tells_where_messages_are(const Contents& contents) {
  return !contents.blocks.empty() || (contents.channels.empty() && contents.statistics.message_count == 0);
}

std::string sentence(const FileBytes& file, const Scan& scan) {
  if (scan.damages.empty()) return {};
  const Damage& first = scan.damages.front();
  std::string text = file.path().string() + ": byte " + std::to_string(first.offset) + ": " + first.problem;
  if (scan.damages.size() > 1) text += " (and " + std::to_string(scan.damages.size() - 1) + " more)";
  return text + "; " + std::to_string(scan.contents.statistics.message_count) +
         " messages can be read; 'cohort recover' writes them to a valid file";
}

}  // namespace

McapReader::McapReader(const std::filesystem::path& file, const ReadOptions& options)
    : file_(std::make_shared<const FileBytes>(file)), limits_(options.limits) {
  if (options.use_summary) {
    try {
      std::optional<Contents> summary = read_summary(*file_);
      if (summary && tells_where_messages_are(*summary)) {
        contents_ = std::make_shared<const Contents>(std::move(*summary));
        return;
      }
    } catch (const McapError& error) {
      if (error.offset() == 0) throw;  // not an MCAP file at all
    }
  }
  Scan scan = scan_file(*file_, limits_);
  damage_ = sentence(*file_, scan);
  contents_ = std::make_shared<const Contents>(std::move(scan.contents));
}

const Channel* McapReader::channel(std::string_view topic) const {
  const auto found = std::ranges::find_if(channels(), [&](const auto& entry) { return entry.second.topic == topic; });
  return found == channels().end() ? nullptr : &found->second;
}

Bytes McapReader::record(std::uint64_t offset, std::uint64_t length, Opcode opcode) const {
  const Place place = file_->at(offset);
  const Bytes bytes = file_->read(offset, length);
  const RecordHead head = read_record_head(bytes, place);
  if (head.opcode != opcode || head.size != length - record_head_size)
    place.fail("expected a record of type " + std::to_string(static_cast<int>(opcode)) + " with " +
               std::to_string(length) + " bytes, found type " + std::to_string(static_cast<int>(head.opcode)));
  return {bytes.begin() + record_head_size, bytes.end()};
}

Attachment McapReader::attachment(const AttachmentIndex& index) const {
  return read_attachment(record(index.offset, index.length, Opcode::attachment), file_->at(index.offset));
}

Attachment McapReader::attachment(std::string_view name) const {
  const auto found = std::ranges::find(attachments(), name, &AttachmentIndex::name);
  if (found != attachments().end()) return attachment(*found);
  file_->at(file_->size()).fail("the file has no attachment '" + std::string(name) + "'");
}

Metadata McapReader::metadata(const MetadataIndex& index) const {
  return read_metadata(record(index.offset, index.length, Opcode::metadata), file_->at(index.offset));
}

std::optional<Metadata> McapReader::metadata(std::string_view name) const {
  const auto found = std::ranges::find(metadata(), name, &MetadataIndex::name);
  if (found == metadata().end()) return {};
  return metadata(*found);
}

MessageStream McapReader::messages(const MessageQuery& query) const {
  return MessageStream(std::make_unique<MessageStream::Source>(file_, contents_, limits_, query, is_complete()));
}

}  // namespace cohort::recording
