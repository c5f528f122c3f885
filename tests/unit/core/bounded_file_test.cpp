// SPDX-License-Identifier: Apache-2.0
#include "server/core/bounded_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <thread>

#include "tests/support/files.hpp"

namespace cohort {
namespace {

std::string refusal_of(const std::filesystem::path& file, std::size_t most) {
  try {
    read_bounded(file, most);
    return "";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(BoundedFile, IsReadUpToItsLimit) {
  const test::ScratchFolder folder;
  const std::string text(3'000'000, 'x');
  test::write_file(folder / "file", text);
  EXPECT_EQ(read_bounded(folder / "file", text.size()), text);
  EXPECT_EQ(refusal_of(folder / "file", std::size_t{1} << 20U),
            "cannot read " + (folder / "file").string() + ": it is longer than 1 MiB, the limit for this kind of file");
  test::write_file(folder / "empty", "");
  EXPECT_EQ(read_bounded(folder / "empty", 0), "");
}

TEST(BoundedFile, MayBeAPipe) {
  const test::ScratchFolder folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const auto read_while_written = [&](std::size_t most) {
    std::thread writer([&] { test::write_file(pipe, std::string(2000, 'x')); });
    const std::string refusal = refusal_of(pipe, most);
    writer.join();
    return refusal;
  };
  EXPECT_EQ(read_while_written(2000), "");
  EXPECT_NE(read_while_written(1999), "");
}

TEST(BoundedFile, IsNoDeviceAndNoFileWithoutData) {
  const test::ScratchFolder folder;
  EXPECT_EQ(refusal_of("/dev/zero", 100), "cannot read /dev/zero: it is a device");
  EXPECT_NE(refusal_of("/nowhere", 100), "");
  EXPECT_NE(refusal_of(folder.path(), 100), "");
  test::write_file(folder / "sparse", "");
  std::filesystem::resize_file(folder / "sparse", std::uintmax_t{1} << 40U);
  EXPECT_NE(refusal_of(folder / "sparse", std::size_t{1} << 30U), "");
}

}  // namespace
}  // namespace cohort
