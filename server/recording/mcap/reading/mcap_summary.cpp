// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "server/recording/mcap/reading/mcap_contents.hpp"

namespace cohort::recording {
namespace {

constexpr std::uint64_t footer_size = 8 + 8 + 4;
constexpr std::uint64_t end_size = record_head_size + footer_size + mcap_magic.size();

bool is_magic(ByteView bytes) { return std::ranges::equal(bytes, std::as_bytes(std::span(mcap_magic))); }

struct End {
  std::uint64_t footer_offset = 0;
  Footer footer;
};

End read_end(const FileBytes& file) {
  if (file.size() < mcap_magic.size() + end_size)
    file.at(file.size()).fail("the file ends here, before its footer: it was not closed");
  End end;
  end.footer_offset = file.size() - end_size;
  const Bytes bytes = file.read(end.footer_offset, end_size);
  const Place place = file.at(end.footer_offset);
  const RecordHead head = read_record_head(bytes, place);
  if (!is_magic(ByteView(bytes).last(mcap_magic.size())) || head.opcode != Opcode::footer || head.size != footer_size)
    file.at(file.size()).fail("the file ends here without a footer: it was not closed, or its end is lost");
  end.footer = read_footer(ByteView(bytes).subspan(record_head_size, footer_size), place);
  return end;
}

void check_summary(const FileBytes& file, const End& end) {
  const Footer& footer = end.footer;
  const Place place = file.at(end.footer_offset);
  if (footer.summary_start < mcap_magic.size() || footer.summary_start > end.footer_offset)
    place.fail("the footer says that the summary begins at byte " + std::to_string(footer.summary_start) +
               ", which is not before the footer");
  const bool has_offsets = footer.summary_offset_start != 0;
  if (has_offsets &&
      (footer.summary_offset_start < footer.summary_start || footer.summary_offset_start > end.footer_offset))
    place.fail("the footer says that the summary's offsets begin at byte " +
               std::to_string(footer.summary_offset_start) + ", which is not in the summary");
  constexpr std::uint64_t before_crc = record_head_size + 8 + 8;
  if (footer.summary_crc != 0 && footer.summary_crc != file.crc(footer.summary_start, end.footer_offset + before_crc))
    file.at(footer.summary_start).fail("the summary is damaged: wrong CRC");
}

Block block_of(const ChunkIndex& index, const FileBytes& file, const Place& place) {
  if (index.length < record_head_size || index.offset > file.size() || index.length > file.size() - index.offset)
    place.fail("an index says that a chunk of " + std::to_string(index.length) + " bytes begins at byte " +
               std::to_string(index.offset) + "; the file has " + std::to_string(file.size()));
  Block block{index.offset, index.length, index.start_time, index.end_time, true, {}};
  block.channels.reserve(index.message_index_offsets.size());
  for (const auto& [channel, offset] : index.message_index_offsets) block.channels.push_back(channel);
  return block;
}

void add(Contents& contents, const RecordHead& head, ByteView content, const FileBytes& file, const Place& place) {
  switch (head.opcode) {
    case Opcode::schema: {
      Schema schema = read_schema(content, place);
      if (schema.id != 0) contents.schemas.insert_or_assign(schema.id, std::move(schema));
      break;
    }
    case Opcode::channel: {
      Channel channel = read_channel(content, place);
      contents.channels.insert_or_assign(channel.id, std::move(channel));
      break;
    }
    case Opcode::statistics: contents.statistics = read_statistics(content, place); break;
    case Opcode::chunk_index: contents.blocks.push_back(block_of(read_chunk_index(content, place), file, place)); break;
    case Opcode::attachment_index: contents.attachments.push_back(read_attachment_index(content, place)); break;
    case Opcode::metadata_index: contents.metadata.push_back(read_metadata_index(content, place)); break;
    default: break;
  }
}

// Checks that the indexed records are in the file, before the summary, and do not overlap; otherwise a small file could
// claim any amount of data.
void check_entries(const Contents& contents, const FileBytes& file, std::uint64_t summary_start) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> entries;  // offset and length
  for (const Block& block : contents.blocks) entries.emplace_back(block.offset, block.length);
  for (const AttachmentIndex& index : contents.attachments) entries.emplace_back(index.offset, index.length);
  for (const MetadataIndex& index : contents.metadata) entries.emplace_back(index.offset, index.length);
  std::ranges::sort(entries);
  std::uint64_t free = mcap_magic.size();
  for (const auto& [offset, length] : entries) {
    if (offset < free || offset > summary_start || length > summary_start - offset)
      file.at(summary_start)
          .fail("an index says that " + std::to_string(length) + " bytes begin at byte " + std::to_string(offset) +
                ", which overlaps another range or the summary");
    free = offset + length;
  }
}

}  // namespace

void check_magic(const FileBytes& file) {
  Bytes bytes = file.read(0, std::min<std::uint64_t>(file.size(), mcap_magic.size()));
  if (is_magic(bytes)) return;
  const bool is_text =
      std::ranges::all_of(bytes, [](std::byte byte) { return byte < std::byte{0x80} && byte != std::byte{0}; });
  const std::string found = bytes.empty() ? "it is empty"
                            : is_text     ? "it is a text file. If it is an experiment, 'cohort run " +
                                            file.path().filename().string() + " --record run.mcap' records it"
                                      : "it begins with other bytes";
  file.at(0).fail("this is not an MCAP file: it must begin with the bytes 89 4D 43 41 50 30 0D 0A, but " + found);
}

std::optional<Contents> read_summary(const FileBytes& file) {
  check_magic(file);
  const End end = read_end(file);
  if (end.footer.summary_start == 0) return {};
  check_summary(file, end);

  Contents contents;
  FileWindow window(file);
  const auto record = [&](std::uint64_t offset, const auto& use) {
    const Place place = file.at(offset);
    const RecordHead head = read_record_head(window.get(offset, record_head_size), place);
    if (head.size > file.size() - offset - record_head_size)
      place.fail("a record of " + std::to_string(head.size) + " bytes does not fit into the file");
    use(head, window.get(offset + record_head_size, head.size), place);
    return offset + record_head_size + head.size;
  };
  record(mcap_magic.size(), [&](const RecordHead& head, ByteView content, const Place& place) {
    if (head.opcode != Opcode::header) place.fail("expected the file's header");
    contents.header = read_header(content, place);
  });
  const std::uint64_t summary_end =
      end.footer.summary_offset_start == 0 ? end.footer_offset : end.footer.summary_offset_start;
  for (std::uint64_t offset = end.footer.summary_start; offset < summary_end;)
    offset = record(offset, [&](const RecordHead& head, ByteView content, const Place& place) {
      add(contents, head, content, file, place);
    });
  check_entries(contents, file, end.footer.summary_start);
  std::ranges::stable_sort(contents.blocks, {}, &Block::offset);
  return contents;
}

}  // namespace cohort::recording
