// SPDX-License-Identifier: Apache-2.0
#include "server/recording/mcap/writing/spool.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "server/recording/mcap/format/mcap_error.hpp"
#include "server/recording/mcap/writing/recording_file.hpp"
#include "tests/support/patience.hpp"
#include "tests/support/recordings.hpp"

namespace cohort::recording {
namespace {

using namespace test;

std::string fetched(Spool& spool, std::uint64_t offset, std::size_t most = 1000) {
  const auto part = spool.fetch(offset, most);
  return part ? text_of(part->bytes) : "nothing";
}

TEST(Spool, KeepsPartsUntilTheNextOnesAreRequested) {
  Spool spool(100);
  EXPECT_EQ(fetched(spool, 0), "");
  spool.write(bytes_of("abc"));
  spool.write(bytes_of("def"));
  EXPECT_EQ(fetched(spool, 0, 4), "abcd");
  EXPECT_EQ(fetched(spool, 0, 4), "abcd") << "the reply was lost";
  EXPECT_EQ(fetched(spool, 4), "ef");
  EXPECT_EQ(fetched(spool, 3), "nothing") << "it has arrived, as was said";
  EXPECT_EQ(fetched(spool, 7), "nothing") << "there is none yet";
  EXPECT_EQ(spool.fetch(6, 10)->size, std::nullopt);
  spool.write(bytes_of("gh"));
  spool.finish();
  EXPECT_EQ(spool.fetch(6, 10)->size, 8U);
  EXPECT_FALSE(spool.is_done()) << "the last part may be lost";
  EXPECT_EQ(fetched(spool, 8), "");
  EXPECT_TRUE(spool.is_done());
}

TEST(Spool, BlocksItsWriterUntilThereIsRoom) {
  Spool spool(10);
  std::atomic<int> written = 0;
  std::thread writer([&] {
    for (int i = 0; i < 100; ++i) {
      spool.write(bytes_of("sixteen letters."));
      ++written;
    }
    spool.finish();
  });
  std::string all;
  while (!spool.is_done()) {
    const auto part = spool.fetch(all.size(), 5);
    ASSERT_TRUE(part);
    all += text_of(part->bytes);
    EXPECT_LE(written, static_cast<int>(all.size() / 16) + 2);
  }
  writer.join();
  EXPECT_EQ(all.size(), 1600U);
}

TEST(Spool, ReleasesItsWriterWhenAbandoned) {
  Spool spool(10);
  spool.write(bytes_of("a long sentence"));
  std::thread writer([&] { EXPECT_THROW(spool.write(bytes_of("more")), FileError); });
  spool.abandon();
  writer.join();
  EXPECT_TRUE(spool.is_done());
}

// Unfetched data is bounded, and the fetched data is a complete file.
TEST(Spool, EndsARecordingWhenTooMuchIsQueued) {
  const auto spool = std::make_shared<Spool>(1000);
  RecordingFile recording(spool, {.mcap = {.chunk_size = 500, .compress = false}, .most_essential_queued = 10'000});
  const ChannelId channel = recording.add_channel("/commands", 0, "cdr");
  int accepted = 0;
  while (recording.write_message(channel, 0, {}, {}, bytes_of(said(accepted)), Importance::essential)) {
    ++accepted;
    ASSERT_LT(accepted, 10'000);
  }
  ASSERT_TRUE(recording.error());
  EXPECT_NE(recording.error()->find("waiting to be written"), std::string::npos) << *recording.error();
  Bytes file;
  while (!spool->is_done()) {
    const auto part = spool->fetch(file.size(), 100);
    file.insert(file.end(), part->bytes.begin(), part->bytes.end());
  }
  recording.close();
  const TemporaryFile kept(file);
  const McapReader reader(kept.path());
  EXPECT_TRUE(reader.is_complete()) << reader.damage();
  EXPECT_EQ(messages_of(reader).size(), static_cast<std::size_t>(accepted));
}

}  // namespace
}  // namespace cohort::recording
