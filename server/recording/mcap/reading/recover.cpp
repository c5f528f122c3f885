// SPDX-License-Identifier: Apache-2.0
#include "server/recording/mcap/reading/recover.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>
#include <system_error>

#include "server/core/atomic_file.hpp"
#include "server/recording/mcap/writing/disk_file.hpp"
#include "server/recording/mcap/writing/mcap_writer.hpp"

namespace cohort::recording {
namespace {

std::string count(std::uint64_t number, const std::string& what) {
  return std::to_string(number) + " " + what + (number == 1 ? "" : "s");
}

// A writer of the parts that a scan found, in file order.
class Copy {
 public:
  Copy(const FileBytes& source, Scan& scan, const ReadLimits& limits, McapWriter& writer)
      : source_(source), scan_(scan), limits_(limits), budget_(source, limits), writer_(writer) {}

  void all() {
    const Contents& contents = scan_.contents;
    for (const auto& [id, schema] : contents.schemas) writer_.add(schema);
    for (const auto& [id, channel] : contents.channels) add_channel(channel);
    std::vector<std::pair<std::uint64_t, std::size_t>> parts;  // offset; blocks first, then attachments, then metadata
    parts.reserve(contents.blocks.size() + contents.attachments.size() + contents.metadata.size());
    const auto list = [&](const auto& values) {
      for (const auto& value : values) parts.emplace_back(value.offset, parts.size());
    };
    list(contents.blocks);
    list(contents.attachments);
    list(contents.metadata);
    std::ranges::sort(parts);
    for (const auto& [offset, number] : parts) copy(number);
    writer_.close();
  }

 private:
  void add_channel(Channel channel) {
    if (channel.schema != 0 && !scan_.contents.schemas.contains(channel.schema)) {
      scan_.damages.push_back(
          {source_.size(), 0, "the schema of channel '" + channel.topic + "' is lost; its messages are kept without it",
           false});
      channel.schema = 0;
    }
    writer_.add(std::move(channel));
  }

  void copy(std::size_t number) {
    const Contents& contents = scan_.contents;
    if (number < contents.blocks.size()) return copy_messages(contents.blocks[number]);
    number -= contents.blocks.size();
    if (number < contents.attachments.size()) {
      const AttachmentIndex& index = contents.attachments[number];
      return writer_.add_attachment(read_attachment(content(index.offset, index.length), source_.at(index.offset)));
    }
    const MetadataIndex& index = contents.metadata[number - contents.attachments.size()];
    writer_.add_metadata(read_metadata(content(index.offset, index.length), source_.at(index.offset)));
  }

  Bytes content(std::uint64_t offset, std::uint64_t length) const {
    return source_.read(offset + record_head_size, length - record_head_size);
  }

  void copy_messages(const Block& block) {
    const Bytes records = read_block(source_, block, limits_, budget_);
    for_each_record(records, place_in(source_, block), [&](const RecordView& record, const Place& place) {
      if (record.opcode != Opcode::message) return;
      const Message message = read_message(record.content, place);
      if (!scan_.contents.channels.contains(message.channel)) return;
      writer_.write_message(message.channel, message.sequence, message.log_time, message.publish_time, message.data);
    });
    writer_.flush_chunk();
  }

  const FileBytes& source_;
  Scan& scan_;
  const ReadLimits& limits_;
  ReadBudget budget_;
  McapWriter& writer_;
};

std::string library_of_recovered(const Header& header) {
  const std::string recovered = library_name() + ", recovered";
  return header.library.empty() ? recovered : recovered + " from a file of " + header.library;
}

Statistics write(const FileBytes& source, Scan& scan, const std::filesystem::path& target, const ReadLimits& limits) {
  const auto telling = [](const auto& act) {
    try {
      act();
    } catch (const WriteError& error) {
      throw FileError(error.what());
    }
  };
  std::optional<AtomicFile> file;
  telling([&] { file.emplace("the recording", target); });
  // Chunks are copied with their own sizes.
  constexpr std::size_t endless = std::numeric_limits<std::size_t>::max();
  const auto write_bytes = [&](ByteView bytes) {
    telling([&] { file->write({reinterpret_cast<const char*>(bytes.data()), bytes.size()}); });
  };
  McapWriter writer(write_bytes, {.profile = scan.contents.header.profile,
                                  .library = library_of_recovered(scan.contents.header),
                                  .chunk_size = endless});
  Copy(source, scan, limits, writer).all();
  telling([&] { file->commit(); });
  return writer.statistics();
}

// Requires messages to keep before a file is replaced; another file may also contain only attachments.
void expect_something_to_keep(const FileBytes& file, const Scan& scan, bool is_in_place) {
  const Contents& contents = scan.contents;
  const bool has_rest = !contents.attachments.empty() || !contents.metadata.empty();
  if (scan.damages.empty() || contents.statistics.message_count > 0 || (!is_in_place && has_rest)) return;
  std::string found = "no message in the file can be read";
  if (has_rest)
    found += ", only " + count(contents.attachments.size(), "attachment") + " and " +
             count(contents.metadata.size(), "record") + " of metadata, which '-o' writes to another file";
  file.at(scan.damages.front().offset)
      .fail(scan.damages.front().problem + "; " + found + "; the file has " + count(file.size(), "byte") +
            " and is not changed");
}

}  // namespace

Recovery recover(const std::filesystem::path& source, const std::filesystem::path& target, const ReadLimits& limits) {
  const FileBytes file(source);
  check_not_being_written(source);
  Scan scan = scan_file(file, limits);
  std::error_code ignored;
  const bool is_in_place = std::filesystem::equivalent(source, target, ignored);
  expect_something_to_keep(file, scan, is_in_place);

  Recovery recovery;
  recovery.kept = is_in_place && scan.damages.empty() ? scan.contents.statistics : write(file, scan, target, limits);
  recovery.damages = std::move(scan.damages);
  recovery.lost_messages = scan.lost_messages;
  for (const Damage& damage : recovery.damages) {
    recovery.lost_chunks += damage.is_chunk ? 1 : 0;
    recovery.lost_bytes += damage.length;
  }
  return recovery;
}

std::string Recovery::text() const {
  std::string text = "kept " + count(kept.message_count, "message") + " in " + count(kept.chunk_count, "chunk") + ", " +
                     count(kept.attachment_count, "attachment") + ", " + count(kept.metadata_count, "record") +
                     " of metadata\n";
  if (was_whole()) return text + "nothing was lost: the file is complete\n";
  text += "lost " + count(lost_chunks, "damaged chunk") + " with at least " + count(lost_messages, "message") + "; " +
          count(lost_bytes, "byte") + " could not be read\n";
  constexpr std::size_t most = 20;
  for (std::size_t i = 0; i < std::min(most, damages.size()); ++i)
    text += "  byte " + std::to_string(damages[i].offset) + ": " + damages[i].problem + "\n";
  if (damages.size() > most) text += "  and " + std::to_string(damages.size() - most) + " more\n";
  return text;
}

}  // namespace cohort::recording
