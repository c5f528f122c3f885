// SPDX-License-Identifier: Apache-2.0
#include "server/core/atomic_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>

#include "tests/support/files.hpp"

namespace cohort {
namespace {

using test::read_file;
using test::ScratchFolder;
using test::write_file;

std::size_t entries(const ScratchFolder& folder) {
  const std::filesystem::directory_iterator all(folder / ".");
  return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

mode_t mode_of(const std::filesystem::path& file) {
  struct stat status {};
  EXPECT_EQ(stat(file.c_str(), &status), 0);
  return status.st_mode & 07777U;
}

void put(const std::filesystem::path& file, std::string_view contents) {
  AtomicFile out("the text", file);
  out.write(contents);
  out.commit();
}

// No file may be longer than this while it lives: what a full disk is to who writes.
class ShortFiles {
 public:
  explicit ShortFiles(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ShortFiles(const ShortFiles&) = delete;
  ShortFiles& operator=(const ShortFiles&) = delete;
  ~ShortFiles() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(AtomicFile, ReplacesAnExistingFileOnceComplete) {
  const ScratchFolder folder;
  put(folder / "a", "first");
  EXPECT_EQ(read_file(folder / "a"), "first");
  {
    AtomicFile out("the text", folder / "a");
    out.write("second");
    EXPECT_EQ(read_file(folder / "a"), "first");
    EXPECT_EQ(entries(folder), 2u);
    out.commit();
  }
  EXPECT_EQ(read_file(folder / "a"), "second");
  EXPECT_EQ(entries(folder), 1u);
}

TEST(AtomicFile, KeepsAnExistingFileIfWritingFails) {
  const ScratchFolder folder;
  put(folder / "a", "good");
  {
    const ShortFiles limit(1000);
    try {
      put(folder / "a", std::string(2000, 'x'));
      ADD_FAILURE() << "it cannot have been written";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(),
                "the text cannot be written to " + (folder / "a").string() + ": " + why_not_written(EFBIG));
    }
  }
  { const AtomicFile given_up("the text", folder / "a"); }
  EXPECT_EQ(read_file(folder / "a"), "good");
  EXPECT_EQ(entries(folder), 1u);
  EXPECT_THROW(put(folder / "no_folder" / "a", ""), std::runtime_error);
  EXPECT_THROW(put(folder / ".", ""), std::runtime_error);
}

TEST(AtomicFile, ReplacesLinksAndKeepsPermissions) {
  const ScratchFolder folder;
  write_file(folder / "theirs", "theirs");
  std::filesystem::create_symlink(folder / "theirs", folder / "a");
  put(folder / "a", "ours");
  EXPECT_EQ(read_file(folder / "theirs"), "theirs");
  EXPECT_FALSE(std::filesystem::is_symlink(folder / "a"));
  chmod((folder / "a").c_str(), 0640);
  put(folder / "a", "again");
  EXPECT_EQ(mode_of(folder / "a"), 0640u);
  std::ofstream(folder / "usual").close();
  put(folder / "new", "");
  EXPECT_EQ(mode_of(folder / "new"), mode_of(folder / "usual"));
}

TEST(AtomicFile, WritesToSpecialFilesInPlace) {
  put("/dev/null", "nothing");
  EXPECT_THROW(put("/dev/full", "something"), std::runtime_error);
  EXPECT_FALSE(std::filesystem::is_regular_file("/dev/null"));
}

}  // namespace
}  // namespace cohort
