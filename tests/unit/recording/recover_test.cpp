// SPDX-License-Identifier: Apache-2.0
#include "server/recording/mcap/reading/recover.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "server/recording/mcap/format/mcap_records.hpp"
#include "server/recording/mcap/writing/disk_file.hpp"
#include "tests/support/recordings.hpp"

namespace cohort::recording {
namespace {

using namespace test;

std::vector<std::string> said_from(int first, int end) {
  std::vector<std::string> texts;
  texts.reserve(static_cast<std::size_t>(end - first));
  for (int i = first; i < end; ++i) texts.push_back(said(i));
  return texts;
}

std::uint64_t offset_of_chunk(const Bytes& bytes, std::size_t number) {
  const TemporaryFile file(bytes);
  return McapReader(file.path()).blocks().at(number).offset;
}

// Where the first message index after the chunks begins, and so on: the record of that kind number `number`.
std::uint64_t offset_of(const Bytes& bytes, Opcode opcode, int number = 0) {
  std::uint64_t found = 0;
  const std::filesystem::path name = "bytes";
  const ByteView records = ByteView(bytes).subspan(mcap_magic.size(), bytes.size() - 2 * mcap_magic.size());
  for_each_record(records, {&name, mcap_magic.size(), {}}, [&](const RecordView& record, const Place&) {
    if (record.opcode == opcode && number-- == 0) found = record.offset + mcap_magic.size();
  });
  EXPECT_NE(found, 0U);
  return found;
}

// Checks that `recover` makes a complete file of the bytes, with and without its summary.
struct Recovered {
  Recovery recovery;
  std::vector<std::string> messages;
  std::size_t attachments = 0;
};
Recovered recovered(const Bytes& bytes) {
  const TemporaryFile source(bytes);
  const TemporaryFile target;
  Recovered result;
  result.recovery = recover(source.path(), target.path());
  const McapReader reader(target.path());
  EXPECT_TRUE(reader.is_complete()) << reader.damage();
  const McapReader looking(target.path(), {.use_summary = false});
  EXPECT_TRUE(looking.is_complete()) << looking.damage();
  result.messages = messages_of(reader, {.order = Order::file});
  EXPECT_EQ(result.messages, messages_of(looking, {.order = Order::file}));
  EXPECT_EQ(result.messages.size(), result.recovery.kept.message_count);
  result.attachments = reader.attachments().size();
  return result;
}

TEST(Recover, AFileThatEndsWithinAChunkIsReadUpToThatChunk) {
  Bytes bytes = small_recording(20);
  bytes.resize(offset_of_chunk(bytes, 3) + 50);
  const TemporaryFile file(bytes);
  const McapReader reader(file.path());
  EXPECT_FALSE(reader.is_complete());
  EXPECT_NE(reader.damage().find("byte " + std::to_string(bytes.size() - 50) + ": a record of"), std::string::npos)
      << reader.damage();
  EXPECT_EQ(messages_of(reader), said_from(0, 12));

  const Recovered whole = recovered(bytes);
  EXPECT_EQ(whole.messages, said_from(0, 12));
  EXPECT_EQ(whole.attachments, 1U);
  EXPECT_EQ(whole.recovery.lost_bytes, 50U);
  EXPECT_EQ(whole.recovery.kept.chunk_count, 3U);
}

TEST(Recover, ADamagedChunkIsSkippedAndItsMessagesAreCounted) {
  Bytes bytes = small_recording(20);
  bytes[offset_of_chunk(bytes, 2) + 80] ^= std::byte{1};
  {
    const TemporaryFile file(bytes);
    const McapReader reader(file.path());
    MessageStream stream = reader.messages();
    for (int i = 0; i < 8; ++i) EXPECT_EQ(text_of(stream.next()->data), said(i));
    try {
      stream.next();
      ADD_FAILURE() << "the chunk is damaged";
    } catch (const McapError& error) {
      EXPECT_EQ(error.offset(), reader.blocks()[2].offset);
      EXPECT_NE(error.problem().find("the chunk is damaged"), std::string::npos) << error.what();
    }
  }
  std::vector<std::string> expected = said_from(0, 8);
  for (const std::string& text : said_from(12, 20)) expected.push_back(text);
  const Recovered whole = recovered(bytes);
  EXPECT_EQ(whole.messages, expected);
  EXPECT_EQ(whole.recovery.lost_chunks, 1U);
  EXPECT_EQ(whole.recovery.lost_messages, 4U);
  EXPECT_NE(whole.recovery.text().find("lost 1 damaged chunk with at least 4 messages"), std::string::npos)
      << whole.recovery.text();
}

// The first chunk holds the schemas and channels; they stand before it too.
TEST(Recover, LosingTheFirstChunkLosesNoOthers) {
  Bytes bytes = small_recording(20);
  bytes[offset_of_chunk(bytes, 0) + 80] ^= std::byte{1};
  bytes.resize(bytes.size() - 100);  // no summary to learn them from
  EXPECT_EQ(recovered(bytes).messages, said_from(4, 20));
}

TEST(Recover, AWrongLengthLosesOnlyThatRecord) {
  for (const std::size_t byte : {1U, 3U, 6U}) {  // a byte of the length of a chunk's record
    Bytes bytes = small_recording(20);
    bytes[offset_of_chunk(bytes, 1) + byte] ^= std::byte{0x10};
    std::vector<std::string> expected = said_from(0, 4);
    for (const std::string& text : said_from(8, 20)) expected.push_back(text);
    const Recovered whole = recovered(bytes);
    EXPECT_EQ(whole.messages, expected) << byte;
    EXPECT_EQ(whole.attachments, 1U);
  }
  // One of a message index that leads into the midst of the next chunk.
  Bytes bytes = small_recording(20);
  bytes[offset_of(bytes, Opcode::message_index, 1) + 1] ^= std::byte{0x40};
  EXPECT_EQ(recovered(bytes).messages, said_from(0, 20));
}

TEST(Recover, ADamagedAttachmentIsSkipped) {
  Bytes bytes = small_recording(20);
  bytes[offset_of(bytes, Opcode::attachment) + 70] ^= std::byte{1};
  const Recovered whole = recovered(bytes);
  EXPECT_EQ(whole.messages, said_from(0, 20));
  EXPECT_EQ(whole.attachments, 0U);
  EXPECT_NE(whole.recovery.text().find("the attachment 'world.sdf' is damaged"), std::string::npos)
      << whole.recovery.text();
}

TEST(Recover, ReorderedChunksAreAllRead) {
  const Bytes bytes = small_recording(20);
  const std::uint64_t first = offset_of_chunk(bytes, 1);
  const std::uint64_t second = offset_of_chunk(bytes, 2);
  const std::uint64_t end = offset_of_chunk(bytes, 3);
  Bytes swapped(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(first));
  const auto add = [&](std::uint64_t from, std::uint64_t to) {
    swapped.insert(swapped.end(), bytes.begin() + static_cast<std::ptrdiff_t>(from),
                   bytes.begin() + static_cast<std::ptrdiff_t>(to));
  };
  add(second, end);
  add(first, second);
  add(end, bytes.size());
  std::vector<std::string> expected = said_from(0, 4);
  for (const std::string& text : said_from(8, 12)) expected.push_back(text);
  for (const std::string& text : said_from(4, 8)) expected.push_back(text);
  for (const std::string& text : said_from(12, 20)) expected.push_back(text);
  EXPECT_EQ(recovered(swapped).messages, expected);
  // Its summary says where chunks were: either they are as long as each other, and read, or it is said.
  const TemporaryFile file(swapped);
  EXPECT_FALSE(McapReader(file.path(), {.use_summary = false}).is_complete());
  try {
    EXPECT_EQ(messages_of(McapReader(file.path())).size(), 20U);
  } catch (const McapError&) {
  }
}

TEST(Recover, RepairsADamagedFileInPlaceAndKeepsACompleteOne) {
  const Bytes bytes = small_recording(20);
  const TemporaryFile file(bytes);
  EXPECT_TRUE(recover(file.path(), file.path()).was_whole());
  EXPECT_EQ(read_bytes(file.path()), bytes);

  write_bytes(file.path(), ByteView(bytes).first(bytes.size() - 20));
  EXPECT_FALSE(recover(file.path(), file.path()).was_whole());
  const McapReader reader(file.path());
  EXPECT_TRUE(reader.is_complete()) << reader.damage();
  EXPECT_EQ(messages_of(reader), said_from(0, 20));

  const ByteView nothing = ByteView(bytes).first(40);
  write_bytes(file.path(), nothing);
  EXPECT_THROW(recover(file.path(), file.path()), McapError);
  EXPECT_EQ(read_bytes(file.path()), Bytes(nothing.begin(), nothing.end()));
}

TEST(Recover, RejectsOtherFilesAndActiveRecordings) {
  const TemporaryFile target;
  const TemporaryFile text(bytes_of("something else"));
  EXPECT_THROW(recover(text.path(), target.path()), McapError);
  EXPECT_THROW(recover("/no_such_folder/run.mcap", target.path()), FileError);
  EXPECT_THROW(recover("/tmp", target.path()), FileError);
  const TemporaryFile open;
  DiskFile recording(open.path());
  recording.write(small_recording(3));
  EXPECT_THROW(recover(open.path(), target.path()), FileError);
  EXPECT_EQ(McapReader(open.path()).statistics().message_count, 3U) << "but it may be read meanwhile";
}

// A file cut off at any byte is read as far as it goes, or refused with an error that says where.
void expect_readable_or_error(const Bytes& bytes, const std::string& what) {
  const TemporaryFile file(bytes);
  for (const bool use_summary : {true, false}) {
    try {
      const McapReader reader(file.path(), {.use_summary = use_summary});
      const std::vector<std::string> messages = messages_of(reader);
      for (const std::string& text : messages)
        EXPECT_TRUE(text.starts_with("message ")) << what << ": a message that was never written: " << text;
      for (const AttachmentIndex& index : reader.attachments()) reader.attachment(index);
      for (const MetadataIndex& index : reader.metadata()) reader.metadata(index);
    } catch (const McapError& error) {
      EXPECT_NE(std::string(error.what()).find(": byte "), std::string::npos) << what << ": " << error.what();
    }
  }
  const TemporaryFile target;
  try {
    recover(file.path(), target.path());
    const McapReader reader(target.path());
    EXPECT_TRUE(reader.is_complete()) << what << ": " << reader.damage();
    messages_of(reader);
  } catch (const McapError& error) {
    const bool has_nothing = std::string(error.what()).find("no message in the file can be read") != std::string::npos;
    EXPECT_TRUE(has_nothing || error.offset() == 0) << what << ": " << error.what();  // or it begins as no such file
  }
}

TEST(DamagedFile, IsReadUpToTheCutAtAnyByte) {
  const Bytes bytes = small_recording(9, 3);
  std::size_t before = 0;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const Bytes part(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    expect_readable_or_error(part, "cut off at " + std::to_string(size));
    if (size < mcap_magic.size()) continue;
    const TemporaryFile file(part);
    const McapReader reader(file.path());
    EXPECT_FALSE(reader.is_complete()) << size;
    const std::vector<std::string> messages = messages_of(reader);
    ASSERT_GE(messages.size(), before) << "more of the file, fewer messages, at byte " << size;
    EXPECT_EQ(messages, said_from(0, static_cast<int>(messages.size())));
    before = messages.size();
  }
  EXPECT_EQ(before, 9U);
}

TEST(DamagedFile, IsReadUpToTheCutAtEvery1000thByteOfALongFile) {
  const Bytes bytes = small_recording(20'000, 1000);
  ASSERT_GT(bytes.size(), 100'000U);
  std::size_t before = 0;
  for (std::size_t size = 1000; size < bytes.size(); size += 1000) {
    const TemporaryFile file(ByteView(bytes).first(size));
    const McapReader reader(file.path());
    EXPECT_FALSE(reader.is_complete());
    const auto count = static_cast<std::size_t>(reader.statistics().message_count);
    EXPECT_GE(count, before);
    EXPECT_EQ(count % 1000, 0U);
    if (count == 0) {
      EXPECT_THROW(recover(file.path(), file.path()), McapError);
      EXPECT_EQ(std::filesystem::file_size(file.path()), size);
      continue;
    }
    const Recovery recovery = recover(file.path(), file.path());
    EXPECT_EQ(recovery.kept.message_count, count);
    EXPECT_EQ(McapReader(file.path()).is_complete(), true);
    before = count;
  }
  EXPECT_EQ(before, 20'000U);
}

TEST(DamagedFile, IsReadAsFarAsPossibleOrRejectedAfterAnyBitFlip) {
  Bytes bytes = small_recording(6, 3);
  for (std::size_t byte = 0; byte < bytes.size(); ++byte) {
    for (int bit = 0; bit < 8; ++bit) {
      const std::byte flip{static_cast<unsigned char>(1 << bit)};
      bytes[byte] ^= flip;
      expect_readable_or_error(bytes, "bit " + std::to_string(bit) + " of byte " + std::to_string(byte));
      bytes[byte] ^= flip;
    }
  }
}

// Where a chunk or an index says that it is enormous, no memory is taken for it.
TEST(DamagedFile, IsRejectedBeforeAllocationIfItClaimsAnEnormousSize) {
  for (const std::uint64_t size : {std::uint64_t{1} << 29U, std::uint64_t{1} << 40U, ~std::uint64_t{0}}) {
    for (const char* compression : {"zstd", ""}) {
      const ChunkHead head{{}, {}, size, 0, compression, 100};
      const std::filesystem::path name = "bytes";
      EXPECT_THROW(uncompressed(head, Bytes(100), {}, Place{&name, 0, {}}), McapError);
    }
  }
  const std::filesystem::path name = "bytes";
  const ChunkHead lz4{{}, {}, 100, 0, "lz4", 100};
  try {
    uncompressed(lz4, Bytes(100), {}, Place{&name, 0, {}});
    ADD_FAILURE() << "lz4 is not read";
  } catch (const McapError& error) {
    EXPECT_NE(error.problem().find("lz4, which Cohort does not support"), std::string::npos);
  }
}

// The rest of the file is read.
TEST(DamagedFile, HasAnAttachmentOnceThatIsIndexedManyTimes) {
  Bytes bytes = small_recording(20);
  const std::uint64_t index = offset_of(bytes, Opcode::attachment_index);
  const std::uint64_t attachment = offset_of(bytes, Opcode::attachment);
  const std::filesystem::path name = "bytes";
  const Place place{&name, 0, {}};
  const auto record_end = [&](std::uint64_t offset) {
    return offset + record_head_size + read_record_head(ByteView(bytes).subspan(offset), place).size;
  };
  Footer footer = read_footer(ByteView(bytes).subspan(offset_of(bytes, Opcode::footer) + record_head_size), place);
  footer.summary_offset_start = 0;
  const auto with = [&](int copies, std::uint64_t offset) {
    Bytes more(bytes.begin() + static_cast<std::ptrdiff_t>(index),
               bytes.begin() + static_cast<std::ptrdiff_t>(record_end(index)));
    std::memcpy(more.data() + record_head_size, &offset, sizeof offset);
    Bytes changed(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(record_end(index)));
    for (int i = 0; i < copies; ++i) changed.insert(changed.end(), more.begin(), more.end());
    append_end(changed, footer, ByteView(changed).subspan(footer.summary_start));
    return changed;
  };
  const TemporaryFile whole(with(0, attachment));
  EXPECT_TRUE(McapReader(whole.path()).is_complete()) << "so much is right";
  for (const std::uint64_t offset : {attachment, attachment + 1, std::uint64_t{0}, ~std::uint64_t{0} - 5}) {
    const TemporaryFile file(with(1000, offset));
    EXPECT_THROW(read_summary(FileBytes(file.path())), McapError) << offset;
    const McapReader reader(file.path());
    EXPECT_EQ(reader.attachments().size(), 1U) << offset;
    EXPECT_EQ(messages_of(reader).size(), 20U) << offset;
  }
}

// All its chunks at one time, and together longer than the limit.
TEST(DamagedFile, IsReadInFileOrderOnlyIfAllChunksOverlap) {
  Bytes bytes;
  McapWriter writer([&](ByteView more) { bytes.insert(bytes.end(), more.begin(), more.end()); });
  const ChannelId channel = writer.add_channel("/t", 0, "cdr");
  const Bytes large(100'000);
  for (int i = 0; i < 20; ++i) {
    writer.write_message(channel, 0, Timestamp(0), {}, large);
    writer.write_message(channel, 0, Timestamp(9), {}, large);
    writer.flush_chunk();
  }
  writer.close();
  const TemporaryFile file(bytes);
  const McapReader reader(file.path(), {.limits = {.open_chunks = 1'000'000}});
  EXPECT_THROW(messages_of(reader), McapError);
  EXPECT_EQ(messages_of(reader, {.order = Order::file}).size(), 40U);
}

}  // namespace
}  // namespace cohort::recording
