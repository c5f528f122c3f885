// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include "server/recording/mcap/reading/mcap_contents.hpp"

namespace cohort::recording {
namespace {

// A scanner of a file's records. Chunks take precedence over data outside of chunks, as they have CRCs.
class Scanner {
 public:
  Scanner(const FileBytes& file, const ReadLimits& limits)
      : file_(file), limits_(limits), budget_(file, limits), window_(file) {}

  Scan run() {
    check_magic(file_);
    std::uint64_t before = mcap_magic.size();  // where the previous record began
    std::uint64_t offset = before;
    while (offset < file_.size() && !is_at_end_) {
      try {
        const std::uint64_t next = read_record(offset);
        before = offset;
        offset = next;
      } catch (const McapError& error) {
        // The previous record may have had a wrong length, so it is searched too.
        const std::uint64_t found = find_record(std::max(may_look_again() ? before + 1 : offset + 1, trusted_));
        looked_again_ += offset - std::min(found, offset);
        add_damage(offset, std::max(found, offset) - offset, error.problem());
        offset = before = found;
      }
    }
    finish();
    return std::move(scan_);
  }

 private:
  // Limits the time of a scan, which overlapping records could make very long.
  bool may_look_again() const { return looked_again_ <= 8 * file_.size(); }

  ByteView small_record(std::uint64_t content, std::uint64_t size, const Place& place) {
    looked_at_ += size;
    if (looked_at_ > 8 * file_.size()) place.fail("too many overlapping records");
    return window_.get(content, size);
  }

  void add_damage(std::uint64_t offset, std::uint64_t length, std::string problem, bool is_chunk = false) {
    scan_.damages.push_back({offset, length, std::move(problem), is_chunk});
  }

  // Reads a record and returns the offset of the next one. Throws McapError if it is not a record, or extends beyond
  // the file.
  std::uint64_t read_record(std::uint64_t offset) {
    const Place place = file_.at(offset);
    const ByteView first = window_.peek(offset, record_head_size);
    if (first.size() < record_head_size) place.fail("the file ends within a record");
    const RecordHead head = read_record_head(first, place);
    const std::uint64_t content = offset + record_head_size;
    if (head.size > file_.size() - content)
      place.fail("a record of " + std::to_string(head.size) + " bytes begins here; the file ends after " +
                 std::to_string(file_.size() - content));
    if (head.opcode != Opcode::message) end_messages();
    switch (head.opcode) {
      case Opcode::header: scan_.contents.header = read_header(small_record(content, head.size, place), place); break;
      case Opcode::schema: add_schema(read_schema(small_record(content, head.size, place), place), place, false); break;
      case Opcode::channel:
        add_channel(read_channel(small_record(content, head.size, place), place), place, false);
        break;
      case Opcode::message: add_message(offset, head.size, place); break;
      case Opcode::chunk: add_chunk(offset, head.size, place); break;
      case Opcode::message_index: check_message_index(small_record(content, head.size, place), place); break;
      case Opcode::attachment: add_attachment(offset, head.size, place); break;
      case Opcode::metadata: add_metadata(offset, head.size, place); break;
      case Opcode::data_end: end_data(offset, head.size, place); break;
      case Opcode::footer: is_at_end_ = is_end(content + head.size, place); break;
      case Opcode::chunk_index:  // a part of the summary, if the end of the data is lost
      case Opcode::attachment_index:
      case Opcode::statistics:
      case Opcode::metadata_index:
      case Opcode::summary_offset: break;
      default:
        if (static_cast<std::uint8_t>(head.opcode) < 0x80)
          place.fail("unknown record type " + std::to_string(static_cast<int>(head.opcode)));
    }
    return content + head.size;
  }

  void add_schema(Schema schema, const Place& place, bool is_in_chunk) {
    if (schema.id == 0) return;
    const SchemaId id = schema.id;
    add_definition(scan_.contents.schemas, sure_schemas_, id, std::move(schema), is_in_chunk, place, "schema ");
  }
  void add_channel(Channel channel, const Place& place, bool is_in_chunk) {
    const ChannelId id = channel.id;
    add_definition(scan_.contents.channels, sure_channels_, id, std::move(channel), is_in_chunk, place, "channel ");
  }

  template <class Value>
  void add_definition(std::map<std::uint16_t, Value>& values, std::set<std::uint16_t>& sure, std::uint16_t id,
                      Value value, bool is_in_chunk, const Place& place, const char* what) {
    const auto found = values.find(id);
    if (found != values.end() && !(found->second == value))
      add_damage(place.offset, 0, what + std::to_string(id) + " has two different definitions");
    if (found == values.end() || (is_in_chunk && !sure.contains(id))) values.insert_or_assign(id, std::move(value));
    if (is_in_chunk) sure.insert(id);
  }

  void count(const Message& message, Block& block, std::map<ChannelId, std::uint64_t>& counts) const {
    const bool is_first = counts.empty();
    block.start_time = is_first ? message.log_time : std::min(block.start_time, message.log_time);
    block.end_time = is_first ? message.log_time : std::max(block.end_time, message.log_time);
    ++counts[message.channel];
  }
  void add_block(Block block, std::map<ChannelId, std::uint64_t> counts) {
    block.channels.reserve(counts.size());
    for (const auto& [channel, number] : counts) block.channels.push_back(channel);
    scan_.contents.blocks.push_back(std::move(block));
    counts_.push_back(std::move(counts));
  }

  void add_message(std::uint64_t offset, std::uint64_t size, const Place& place) {
    constexpr std::uint64_t head = 2 + 4 + 8 + 8;
    constexpr std::uint64_t longest_block = 1U << 20U;
    const Message message = read_message(window_.get(offset + record_head_size, std::min(size, head)), place);
    if (size > limits_.chunk_size) place.fail("a message of " + std::to_string(size) + " bytes is too long");
    if (loose_.length > longest_block) end_messages();
    if (loose_counts_.empty()) loose_ = {offset, 0, {}, {}, false, {}};
    count(message, loose_, loose_counts_);
    loose_.length += record_head_size + size;
  }
  void end_messages() {
    if (!loose_counts_.empty()) add_block(std::move(loose_), std::move(loose_counts_));
    loose_counts_ = {};
    loose_ = {};
  }

  void add_chunk(std::uint64_t offset, std::uint64_t size, const Place& place) {
    const std::uint64_t content = offset + record_head_size;
    const ChunkHead head = read_chunk_head(window_.peek(content, longest_chunk_head), size, place);
    const std::uint64_t length = record_head_size + size;
    // From here on, the end of the chunk is trusted.
    if (chunk_content_size(head) != size) place.fail("the chunk's length does not match its fields");
    trusted_ = offset + length;
    is_after_lost_chunk_ = false;
    try {
      const Block block{offset, length, {}, {}, true, {}};
      read_chunk(block, read_block(file_, block, limits_, budget_));
      ++scan_.contents.statistics.chunk_count;
    } catch (const McapError& error) {
      add_damage(offset, length, error.problem(), true);
      is_after_lost_chunk_ = true;
    }
  }

  void read_chunk(Block block, ByteView records) {
    std::map<ChannelId, std::uint64_t> counts;
    std::vector<std::pair<Schema, Place>> schemas;
    std::vector<std::pair<Channel, Place>> channels;
    for_each_record(records, place_in(file_, block), [&](const RecordView& record, const Place& place) {
      if (record.opcode == Opcode::message) count(recording::read_message(record.content, place), block, counts);
      if (record.opcode == Opcode::schema) schemas.emplace_back(recording::read_schema(record.content, place), place);
      if (record.opcode == Opcode::channel)
        channels.emplace_back(recording::read_channel(record.content, place), place);
    });
    for (auto& [schema, place] : schemas) add_schema(std::move(schema), place, true);
    for (auto& [channel, place] : channels) add_channel(std::move(channel), place, true);
    add_block(std::move(block), std::move(counts));
  }

  void check_message_index(ByteView content, const Place& place) {
    const MessageIndex index = read_message_index(content, place);
    if (is_after_lost_chunk_) scan_.lost_messages += index.entries.size();
  }

  // If the lengths in a record match, its end is trusted, even if its content is wrong.
  template <class Add>
  void add_part(std::uint64_t offset, std::uint64_t size, bool fits, const Place& place, const Add& add) {
    if (!fits) place.fail("the record's length does not match its fields");
    trusted_ = offset + record_head_size + size;
    try {
      add(file_.read(offset + record_head_size, size));
    } catch (const McapError& error) {
      add_damage(offset, record_head_size + size, error.problem());
    }
  }
  void add_attachment(std::uint64_t offset, std::uint64_t size, const Place& place) {
    add_part(offset, size, end_of_attachment(offset, size) <= size, place, [&](const Bytes& content) {
      const Attachment attachment = recording::read_attachment(content, place);
      scan_.contents.attachments.push_back({offset, record_head_size + size, attachment.log_time,
                                            attachment.create_time, attachment.data.size(), attachment.name,
                                            attachment.media_type});
      ++scan_.contents.statistics.attachment_count;
    });
  }
  void add_metadata(std::uint64_t offset, std::uint64_t size, const Place& place) {
    add_part(offset, size, end_of_metadata(offset, size) <= size, place, [&](const Bytes& content) {
      const Metadata metadata = recording::read_metadata(content, place);
      scan_.contents.metadata.push_back({offset, record_head_size + size, metadata.name});
      ++scan_.contents.statistics.metadata_count;
    });
  }

  void end_data(std::uint64_t offset, std::uint64_t size, const Place& place) {
    if (size != 4) place.fail("the DataEnd record has " + std::to_string(size) + " bytes, expected 4");
    Cursor cursor(window_.get(offset + record_head_size, size), place);
    const auto crc = cursor.number<std::uint32_t>("data_section_crc");
    if (crc != 0 && scan_.damages.empty() && crc != file_.crc(0, offset))
      add_damage(0, 0, "the CRC of all data is wrong, but no chunk is damaged");
    try {
      const std::optional<Contents> summary = read_summary(file_);
      scan_.is_closed = true;
      if (summary) {
        // Adds definitions that the readable chunks lack.
        scan_.contents.schemas.insert(summary->schemas.begin(), summary->schemas.end());
        scan_.contents.channels.insert(summary->channels.begin(), summary->channels.end());
      }
    } catch (const McapError& error) {
      add_damage(error.offset(), 0, error.problem());
    }
    is_at_end_ = true;
  }

  // Returns true if a footer that ends there is the file's footer.
  bool is_end(std::uint64_t offset, const Place& place) const {
    if (offset + mcap_magic.size() != file_.size()) place.fail("found a footer before the end of the file");
    return true;
  }

  static constexpr std::uint64_t nowhere = ~std::uint64_t{0};

  // Returns the offset after a field that is preceded by its own length of `bytes` bytes, at `at` in the content of the
  // record at `offset`. Returns no offset if that is beyond the record's `size`.
  std::uint64_t end_of_sized(std::uint64_t offset, std::uint64_t size, std::uint64_t at, std::size_t bytes) {
    if (at > size || size - at < bytes) return nowhere;
    std::uint64_t length = 0;
    std::memcpy(&length, window_.get(offset + record_head_size + at, bytes).data(), bytes);
    return length > size - at - bytes ? nowhere : at + bytes + length;
  }
  // Returns the end of the last field in the record's content, from the lengths in it.
  std::uint64_t end_of_chunk(std::uint64_t offset, std::uint64_t size) {
    return end_of_sized(offset, size, end_of_sized(offset, size, 8 + 8 + 8 + 4, 4), 8);
  }
  std::uint64_t end_of_attachment(std::uint64_t offset, std::uint64_t size) {
    const std::uint64_t type = end_of_sized(offset, size, end_of_sized(offset, size, 8 + 8, 4), 4);
    const std::uint64_t data = end_of_sized(offset, size, type, 8);
    return data == nowhere ? nowhere : data + 4;
  }
  std::uint64_t end_of_metadata(std::uint64_t offset, std::uint64_t size) {
    return end_of_sized(offset, size, end_of_sized(offset, size, 0, 4), 4);
  }

  // Returns true if the lengths in a possible record match each other.
  bool seems_a_record(std::uint64_t offset) {
    const ByteView first = window_.peek(offset, record_head_size);
    if (first.size() < record_head_size) return false;
    const auto [opcode, size] = read_record_head(first, file_.at(offset));
    if (size > file_.size() - offset - record_head_size) return false;
    switch (opcode) {
      case Opcode::chunk: return end_of_chunk(offset, size) == size;
      case Opcode::attachment: return end_of_attachment(offset, size) == size;
      case Opcode::metadata: return end_of_metadata(offset, size) == size;
      case Opcode::data_end: return size == 4;
      default: return false;
    }
  }

  // Returns the next offset, from `offset` on, at which a chunk, an attachment, metadata or the end of the data seems
  // to begin. Returns the end of the file if there is none.
  std::uint64_t find_record(std::uint64_t offset) {
    while (offset < file_.size() && !seems_a_record(offset)) ++offset;
    return offset;
  }

  // Programs write messages either into chunks or outside of them. In a damaged file with chunks, an apparent message
  // outside of them is another record with a wrong opcode.
  void forget_loose_messages() {
    std::vector<Block> chunks;
    std::vector<std::map<ChannelId, std::uint64_t>> counts;
    Damage damage;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      Block& block = scan_.contents.blocks[i];
      if (block.is_chunk) {
        chunks.push_back(std::move(block));
        counts.push_back(std::move(counts_[i]));
      } else {
        if (damage.length == 0) damage.offset = block.offset;
        damage.length += block.length;
      }
    }
    if (damage.length > 0) add_damage(damage.offset, damage.length, "unexpected messages outside of the chunks");
    scan_.contents.blocks = std::move(chunks);
    counts_ = std::move(counts);
  }

  void count_messages() {
    Contents& contents = scan_.contents;
    Statistics& statistics = contents.statistics;
    for (std::size_t i = 0; i < contents.blocks.size(); ++i) {
      if (counts_[i].empty()) continue;
      const Block& block = contents.blocks[i];
      const bool is_first = statistics.messages_of_channels.empty();
      statistics.start_time = is_first ? block.start_time : std::min(statistics.start_time, block.start_time);
      statistics.end_time = is_first ? block.end_time : std::max(statistics.end_time, block.end_time);
      for (const auto& [channel, number] : counts_[i]) {
        statistics.messages_of_channels[channel] += number;
        statistics.message_count += number;
      }
    }
    for (const auto& [channel, number] : statistics.messages_of_channels) {
      if (contents.channels.contains(channel)) continue;
      add_damage(
          file_.size(), 0,
          std::to_string(number) + " messages have channel " + std::to_string(channel) + ", whose definition is lost");
      scan_.lost_messages += number;
      statistics.message_count -= number;
    }
    std::erase_if(statistics.messages_of_channels,
                  [&](const auto& entry) { return !contents.channels.contains(entry.first); });
    statistics.schema_count = static_cast<std::uint16_t>(contents.schemas.size());
    statistics.channel_count = static_cast<std::uint32_t>(contents.channels.size());
  }

  void finish() {
    end_messages();
    if (!scan_.is_closed && scan_.damages.empty())
      add_damage(file_.size(), 0, "the file ends here without a summary: it was not closed");
    if (!scan_.damages.empty() && scan_.contents.statistics.chunk_count > 0) forget_loose_messages();
    count_messages();
  }

  const FileBytes& file_;
  ReadLimits limits_;
  ReadBudget budget_;
  FileWindow window_;
  Scan scan_;
  bool is_at_end_ = false;
  bool is_after_lost_chunk_ = false;
  std::uint64_t looked_again_ = 0;  // in bytes, like the next member
  std::uint64_t looked_at_ = 0;
  std::uint64_t trusted_ = 0;  // the boundaries of records are known up to here
  std::set<std::uint16_t> sure_schemas_;
  std::set<std::uint16_t> sure_channels_;
  std::vector<std::map<ChannelId, std::uint64_t>> counts_;  // messages of each block
  Block loose_;                                             // messages outside of chunks, until their block ends
  std::map<ChannelId, std::uint64_t> loose_counts_;
};

}  // namespace

Scan scan_file(const FileBytes& file, const ReadLimits& limits) { return Scanner(file, limits).run(); }

}  // namespace cohort::recording
