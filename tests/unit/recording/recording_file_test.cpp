// SPDX-License-Identifier: Apache-2.0
#include "server/recording/mcap/writing/recording_file.hpp"

#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "server/recording/mcap/format/mcap_error.hpp"
#include "server/recording/mcap/writing/disk_file.hpp"
#include "tests/support/patience.hpp"
#include "tests/support/recordings.hpp"

namespace cohort::recording {
namespace {

using namespace test;

void write_one(RecordingFile& file, ChannelId channel, int i, Importance importance = Importance::essential) {
  const Timestamp time(static_cast<std::uint64_t>(i));
  file.write_message(channel, static_cast<std::uint32_t>(i), time, time, bytes_of(said(i)), importance);
}

TEST(RecordingFile, KeepsEverythingInTheOrderOfTheCalls) {
  const TemporaryFile file;
  constexpr int count = 50'000;
  {
    RecordingFile recording(file.path());
    const SchemaId schema = recording.add_schema("std_msgs/msg/String", "ros2msg", "string data\n");
    const ChannelId first = recording.add_channel("/first", schema, "cdr");
    for (int i = 0; i < count / 2; ++i) write_one(recording, first, i);
    recording.add_attachment({{}, {}, "snapshot", "application/octet-stream", Bytes(3'000'000)});
    const ChannelId second = recording.add_channel("/second", schema, "cdr");
    for (int i = count / 2; i < count; ++i) write_one(recording, second, i);
    recording.add_metadata({"run", {{"seed", "1"}}});
    recording.close();
    EXPECT_EQ(recording.error(), std::nullopt);
    EXPECT_TRUE(recording.dropped().empty());
    EXPECT_EQ(recording.queued(), 0U);
    EXPECT_FALSE(recording.write_message(first, 0, {}, {}, {}, Importance::essential)) << "it is closed";
  }
  const McapReader reader(file.path());
  EXPECT_TRUE(reader.is_complete()) << reader.damage();
  const std::vector<std::string> messages = messages_of(reader, {.order = Order::file});
  ASSERT_EQ(messages.size(), static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) ASSERT_EQ(messages[static_cast<std::size_t>(i)], said(i));
  EXPECT_EQ(reader.attachment("snapshot").data.size(), 3'000'000U);
  EXPECT_EQ(reader.channel("/second")->id, 2);
}

TEST(RecordingFile, DropsDisplayMessagesOnlyAndCountsThem) {
  const TemporaryFile file;
  RecordingFile recording(file.path(), {.most_queued = 3});  // so that no display message has room, ever
  const ChannelId commands = recording.add_channel("/commands", 0, "cdr");
  const ChannelId poses = recording.add_channel("/poses", 0, "cdr");
  for (int i = 0; i < 1000; ++i) {
    write_one(recording, commands, i);
    EXPECT_FALSE(recording.write_message(poses, 0, {}, {}, bytes_of("pose"), Importance::display));
  }
  EXPECT_TRUE(recording.write_message(poses, 0, {}, {}, bytes_of("pose"), Importance::essential));
  recording.close();
  EXPECT_EQ(recording.error(), std::nullopt);
  EXPECT_EQ(recording.dropped(), (std::map<ChannelId, std::uint64_t>{{poses, 1000}}));
  const std::map<ChannelId, std::uint64_t> kept = {{commands, 1000}, {poses, 1}};
  EXPECT_EQ(McapReader(file.path()).statistics().messages_of_channels, kept);
}

TEST(RecordingFile, ReportsWhyItCannotStart) {
  const auto problem = [](const std::filesystem::path& path) -> std::string {
    try {
      const RecordingFile recording(path);
    } catch (const FileError& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(problem("/no_such_folder/run.mcap"),
            "the recording /no_such_folder/run.mcap cannot be written: No such file or directory; its folder must "
            "exist");
  EXPECT_NE(problem("/tmp").find("cannot be written: Is a directory"), std::string::npos) << problem("/tmp");
  EXPECT_NE(problem("/dev/null").find("it is not a regular file"), std::string::npos) << problem("/dev/null");
  const TemporaryFile file;
  const RecordingFile recording(file.path());
  EXPECT_NE(problem(file.path()).find("another process is recording to it"), std::string::npos);
}

// The file has everything that `write` could put on the disk, and the recording reports why it ended.
void expect_stopped_early(const std::filesystem::path& path, const std::string& reason) {
  RecordingFile recording(path, {.mcap = {.chunk_size = 10'000, .compress = false}});
  const ChannelId channel = recording.add_channel("/t", 0, "cdr");
  for (int i = 0; i < 20'000; ++i) write_one(recording, channel, i);
  recording.close();
  ASSERT_TRUE(recording.error().has_value());
  EXPECT_NE(recording.error()->find(reason), std::string::npos) << *recording.error();
  EXPECT_NE(recording.error()->find(path.string()), std::string::npos) << *recording.error();
  const McapReader reader(path);
  const std::vector<std::string> messages = messages_of(reader);
  EXPECT_GT(messages.size(), 100U);
  EXPECT_LT(messages.size(), 20'000U);
  for (std::size_t i = 0; i < messages.size(); ++i) ASSERT_EQ(messages[i], said(static_cast<int>(i)));
}

TEST(RecordingFile, KeepsItsMessagesAtTheFileSizeLimitAndReportsIt) {
  const TemporaryFile file;
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{300'000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  expect_stopped_early(file.path(), "ulimit -f");
  setrlimit(RLIMIT_FSIZE, &before);
}

// A recording of which nothing came to the disk takes no other's place.
TEST(RecordingFile, KeepsTheReplacedFileUntilDataIsOnTheDisk) {
  const TemporaryFile file(test::small_recording(3));
  {
    DiskFile unsynced(file.path());
    unsynced.write(bytes_of("the beginning of another"));
    EXPECT_EQ(messages_of(McapReader(file.path())).size(), 3U);
    EXPECT_THROW(DiskFile(file.path()), FileError) << "another recorder writes to it";
  }
  EXPECT_EQ(messages_of(McapReader(file.path())).size(), 3U);
  RecordingFile recording(file.path());
  const ChannelId channel = recording.add_channel("/t", 0, "cdr");
  for (int i = 0; i < 5; ++i) write_one(recording, channel, i);
  recording.close();
  EXPECT_EQ(recording.error(), std::nullopt);
  EXPECT_EQ(messages_of(McapReader(file.path())).size(), 5U);
}

// In a process of its own, whose mount other processes do not see.
TEST(RecordingFile, KeepsItsMessagesOnAFullDiskAndReportsIt) {
  constexpr int no_mount = 77;
  char folder[] = "/tmp/cohort_full_XXXXXX";
  ASSERT_NE(mkdtemp(folder), nullptr);
  const pid_t child = fork();
  if (child == 0) {
    const bool has_disk = unshare(CLONE_NEWNS) == 0 && mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
                          mount("none", folder, "tmpfs", 0, "size=300k") == 0;
    if (!has_disk) _exit(no_mount);
    expect_stopped_early(std::filesystem::path(folder) / "run.mcap", "free some space");
    _exit(::testing::Test::HasFailure() ? 1 : 0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  rmdir(folder);
  if (WIFEXITED(status) && WEXITSTATUS(status) == no_mount) GTEST_SKIP() << "a small tmpfs needs the right to mount";
  EXPECT_EQ(status, 0);
}

// A process that does `work` until it is killed; with this one if that dies.
template <class Work>
pid_t start(const Work& work) {
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    work();
    _exit(1);
  }
  return child;
}

std::size_t messages_on_disk(const std::filesystem::path& path) {
  try {
    return McapReader(path).statistics().message_count;
  } catch (const McapError&) {
    return 0;  // not even its beginning
  }
}

// The child writes ten messages and then nothing: they are on the disk soon all the same, and stay there when it is
// killed.
TEST(RecordingFile, KeepsMessagesOlderThanTheFlushIntervalAfterAKill) {
  const TemporaryFile file;
  std::filesystem::remove(file.path());
  const pid_t child = start([&] {
    RecordingFile recording(file.path(), {.flush_interval = std::chrono::milliseconds(20)});
    const ChannelId channel = recording.add_channel("/t", 0, "cdr");
    for (int i = 0; i < 10; ++i) write_one(recording, channel, i);
    for (;;) pause();
  });
  eventually([&] { return std::filesystem::exists(file.path()) && messages_on_disk(file.path()) >= 10; });
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  const McapReader reader(file.path());
  EXPECT_FALSE(reader.is_complete());
  EXPECT_NE(reader.damage().find("it was not closed"), std::string::npos) << reader.damage();
  EXPECT_EQ(messages_of(reader).size(), 10U);
}

// Killed at any moment, the file is readable up to the last chunk, without a gap.
TEST(RecordingFile, LeavesNoGapWhenKilledWhileWriting) {
  const TemporaryFile file;
  for (int round = 0; round < 10; ++round) {
    std::filesystem::remove(file.path());
    const pid_t child = start([&] {
      RecordingFile recording(file.path(), {.mcap = {.chunk_size = 5'000}});
      const ChannelId channel = recording.add_channel("/t", 0, "cdr");
      for (int i = 0;; ++i) {
        write_one(recording, channel, i);
        if (recording.queued() > 1'000'000) usleep(100);
      }
    });
    eventually([&] { return std::filesystem::exists(file.path()) && messages_on_disk(file.path()) >= 1000; });
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const std::vector<std::string> messages = messages_of(McapReader(file.path()));
    ASSERT_GE(messages.size(), 1000U);
    for (std::size_t i = 0; i < messages.size(); ++i) ASSERT_EQ(messages[i], said(static_cast<int>(i)));
  }
}

}  // namespace
}  // namespace cohort::recording
