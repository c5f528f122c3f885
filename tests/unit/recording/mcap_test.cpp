// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numeric>

#include "server/recording/mcap/format/crc32.hpp"
#include "server/recording/mcap/format/mcap_records.hpp"
#include "tests/support/recordings.hpp"

namespace cohort::recording {
namespace {

using namespace test;

std::vector<std::string> all_said(int count) {
  std::vector<std::string> texts;
  texts.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) texts.push_back(said(i));
  return texts;
}

TEST(Crc32, MatchesTheStandardAndCanBeContinued) {
  EXPECT_EQ(crc32(bytes_of("123456789")), 0xCBF43926U);  // the check value of every catalogue of CRCs
  const std::string text = "The quick brown fox jumps over the lazy dog";
  EXPECT_EQ(crc32(bytes_of(text)), 0x414FA339U);
  for (std::size_t i = 0; i <= text.size(); ++i)
    EXPECT_EQ(crc32(bytes_of(text.substr(i)), crc32(bytes_of(text.substr(0, i)))), 0x414FA339U);
}

TEST(Mcap, ReadsWhatItHasWritten) {
  const TemporaryFile file(small_recording(10));
  const McapReader reader(file.path());
  EXPECT_TRUE(reader.is_complete()) << reader.damage();
  EXPECT_EQ(reader.header().profile, "ros2");
  EXPECT_EQ(reader.header().library.substr(0, 7), "cohort ");
  ASSERT_EQ(reader.schemas().size(), 1U);
  EXPECT_EQ(reader.schemas().at(1), (Schema{1, "std_msgs/msg/String", "ros2msg", "string data\n"}));
  ASSERT_NE(reader.channel("/odd"), nullptr);
  EXPECT_EQ(*reader.channel("/odd"), (Channel{2, 1, "/odd", "cdr", {{"offered_qos_profiles", ""}}}));
  EXPECT_EQ(reader.channel("/none"), nullptr);
  EXPECT_EQ(messages_of(reader), all_said(10));
  EXPECT_EQ(text_of(reader.attachment("world.sdf").data), "<sdf version='1.9'/>");
  EXPECT_EQ(reader.attachments().front().media_type, "application/xml");
  EXPECT_EQ(reader.metadata("run")->entries, (StringMap{{"seed", "7"}, {"experiment", "demo"}}));
  EXPECT_FALSE(reader.metadata("walk").has_value());
  EXPECT_THROW(reader.attachment("moon.sdf"), McapError);

  const Statistics& statistics = reader.statistics();
  EXPECT_EQ(statistics.message_count, 10U);
  EXPECT_EQ(statistics.schema_count, 1U);
  EXPECT_EQ(statistics.channel_count, 2U);
  EXPECT_EQ(statistics.attachment_count, 1U);
  EXPECT_EQ(statistics.metadata_count, 1U);
  EXPECT_EQ(statistics.chunk_count, 3U);
  EXPECT_EQ(statistics.start_time, Timestamp(0));
  EXPECT_EQ(statistics.end_time, Timestamp(9000));
  EXPECT_EQ(statistics.messages_of_channels, (std::map<ChannelId, std::uint64_t>{{1, 5}, {2, 5}}));
}

TEST(Mcap, TheSameCallsGiveTheSameBytes) { EXPECT_EQ(small_recording(50), small_recording(50)); }

TEST(Mcap, ScanningAFileFindsTheContentsOfItsSummary) {
  for (const bool compress : {true, false}) {
    const TemporaryFile file(small_recording(10, 4, {.compress = compress}));
    const McapReader by_summary(file.path());
    const McapReader by_looking(file.path(), {.use_summary = false});
    EXPECT_TRUE(by_looking.is_complete()) << by_looking.damage();
    EXPECT_EQ(by_looking.schemas(), by_summary.schemas());
    EXPECT_EQ(by_looking.channels(), by_summary.channels());
    EXPECT_EQ(by_looking.statistics().message_count, 10U);
    EXPECT_EQ(by_looking.statistics().messages_of_channels, by_summary.statistics().messages_of_channels);
    EXPECT_EQ(by_looking.statistics().end_time, Timestamp(9000));
    EXPECT_EQ(messages_of(by_looking), messages_of(by_summary));
    EXPECT_EQ(by_looking.attachments().size(), 1U);
    EXPECT_EQ(by_looking.metadata().size(), 1U);
  }
}

TEST(Mcap, MessagesAreSelectedByChannelAndTime) {
  const TemporaryFile file(small_recording(20));
  const McapReader reader(file.path());
  EXPECT_EQ(messages_of(reader, {.channels = {2}, .from = Timestamp(4001), .to = Timestamp(9000)}),
            (std::vector{said(5), said(7), said(9)}));
  EXPECT_EQ(messages_of(reader, {.from = Timestamp(18000)}), (std::vector{said(18), said(19)}));
  EXPECT_TRUE(messages_of(reader, {.from = Timestamp(20000)}).empty());
  EXPECT_TRUE(messages_of(reader, {.channels = {9}}).empty());
}

// Chunks that overlap in time, and times that go back within one.
TEST(Mcap, MessagesAreReadInOrderOfTimeOrOfTheFile) {
  Bytes bytes;
  McapWriter writer([&](ByteView more) { bytes.insert(bytes.end(), more.begin(), more.end()); });
  const ChannelId channel = writer.add_channel("/t", 0, "cdr");
  const std::vector<std::uint64_t> times = {5, 9, 1, 7, 3, 3, 12, 5, 0, 20, 6, 2};
  for (std::size_t i = 0; i < times.size(); ++i) {
    const std::string text = std::to_string(times[i]) + "/" + std::to_string(i);
    writer.write_message(channel, 0, Timestamp(times[i]), Timestamp(times[i]), bytes_of(text));
    if (i % 4 == 3) writer.flush_chunk();
  }
  writer.close();
  const TemporaryFile file(bytes);
  const McapReader reader(file.path());
  const std::vector<std::string> by_time = {"0/8", "1/2",  "2/11", "3/4", "3/5",  "5/0",
                                            "5/7", "6/10", "7/3",  "9/1", "12/6", "20/9"};
  EXPECT_EQ(messages_of(reader), by_time);
  const std::vector<std::string> by_file = {"5/0",  "9/1", "1/2", "7/3",  "3/4",  "3/5",
                                            "12/6", "5/7", "0/8", "20/9", "6/10", "2/11"};
  EXPECT_EQ(messages_of(reader, {.order = Order::file}), by_file);
}

TEST(Mcap, AFileWithoutMessagesIsComplete) {
  for (const bool use_summary : {true, false}) {
    const TemporaryFile file(small_recording(0));
    const McapReader reader(file.path(), {.use_summary = use_summary});
    EXPECT_TRUE(reader.is_complete()) << reader.damage();
    EXPECT_EQ(reader.channels().size(), 2U);
    EXPECT_TRUE(messages_of(reader).empty());
  }
}

// As other programs write them: no chunks, no summary.
TEST(Mcap, MessagesOutsideOfChunksAreRead) {
  Bytes bytes;
  append_magic(bytes);
  append(bytes, Header{"", "by hand"});
  append(bytes, Channel{3, 0, "/plain", "json", {}});
  append(bytes, Message{{3, 0, Timestamp(20), Timestamp(20)}, bytes_of("late")});
  append(bytes, Metadata{"between", {}});
  append(bytes, Message{{3, 1, Timestamp(10), Timestamp(10)}, bytes_of("early")});
  append_data_end(bytes, 0);
  append_end(bytes, {}, {});
  const TemporaryFile file(bytes);
  const McapReader reader(file.path());
  EXPECT_TRUE(reader.is_complete()) << reader.damage();
  EXPECT_EQ(messages_of(reader), (std::vector<std::string>{"early", "late"}));
  EXPECT_EQ(reader.statistics().message_count, 2U);
}

// Files as they were written once: what can be read today can be read tomorrow.
TEST(Mcap, RecordingsOfEarlierVersionsAreRead) {
  const auto messages = [](const std::string& name) {
    return messages_of(McapReader(COHORT_SOURCE_DIR "/tests/data/recordings/" + name));
  };
  EXPECT_EQ(messages("closed.mcap"), all_said(9));
  EXPECT_EQ(messages("uncompressed.mcap"), all_said(9));
  EXPECT_EQ(messages("unclosed.mcap"), all_said(8));
  EXPECT_EQ(messages("ros.mcap").size(), 2U);
  EXPECT_EQ(messages("without_crcs.mcap").size(), 9U);
  EXPECT_EQ(messages("without_chunks.mcap").size(), 4U);
}

TEST(Mcap, AChunkEndsAtItsMaximumSize) {
  const TemporaryFile file(small_recording(100, 1000, {.chunk_size = 1000}));
  const McapReader reader(file.path());
  EXPECT_GT(reader.statistics().chunk_count, 5U);
  EXPECT_EQ(messages_of(reader), all_said(100));
}

TEST(Mcap, ChunksThatExpandBeyondTheLimitAreNotRead) {
  const TemporaryFile file(small_recording(100, 1000, {.chunk_size = 1000}));
  const McapReader reader(file.path(), {.limits = {.chunk_size = 2000, .expansion = 0}});
  EXPECT_THROW(messages_of(reader), McapError);
  const McapReader with_room(file.path(), {.limits = {.chunk_size = 2000, .expansion = 1024}});
  EXPECT_EQ(messages_of(with_room), all_said(100));
}

TEST(Mcap, AWriterIsUnchangedAfterItsSinkFails) {
  Bytes bytes;
  bool is_full = false;
  McapWriter writer([&](ByteView more) {
    if (is_full) throw std::runtime_error("full");
    bytes.insert(bytes.end(), more.begin(), more.end());
  });
  const ChannelId channel = writer.add_channel("/t", 0, "cdr");
  writer.write_message(channel, 0, Timestamp(1), Timestamp(1), bytes_of("kept"));
  writer.flush_chunk();
  writer.write_message(channel, 1, Timestamp(2), Timestamp(2), bytes_of("lost"));
  is_full = true;
  EXPECT_THROW(writer.flush_chunk(), std::runtime_error);
  EXPECT_THROW(writer.close(), std::runtime_error);
  EXPECT_EQ(writer.size(), bytes.size());
  writer.discard_chunk();
  is_full = false;
  writer.close();
  const TemporaryFile file(bytes);
  const McapReader reader(file.path());
  EXPECT_TRUE(reader.is_complete()) << reader.damage();
  EXPECT_EQ(messages_of(reader), std::vector<std::string>{"kept"});
  EXPECT_TRUE(McapReader(file.path(), {.use_summary = false}).is_complete());
}

TEST(Mcap, AWriterRejectsUnknownSchemasAndChannels) {
  McapWriter writer([](ByteView) {});
  EXPECT_THROW(writer.add_channel("/t", 3, "cdr"), std::invalid_argument);
  EXPECT_THROW(writer.write_message(1, 0, {}, {}, {}), std::invalid_argument);
  writer.add_channel("/t", 0, "cdr");
  EXPECT_THROW(writer.add(Channel{1, 0, "/other", "cdr", {}}), std::invalid_argument);
}

}  // namespace
}  // namespace cohort::recording
