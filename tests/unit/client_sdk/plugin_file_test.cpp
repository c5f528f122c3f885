// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/hosting/plugin_file.hpp"

#include <elf.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <random>
#include <string>

#include "client_sdk/hosting/plugin_loader.hpp"
#include "tests/support/files.hpp"

namespace cohort {
namespace {

using namespace test;

class PluginFiles : public ::testing::Test {
 protected:
  // Returns the error of a plugin of these bytes; nothing if it could be loaded.
  std::string mistake_in(const std::string& bytes) const {
    write_file(file_, bytes);
    try {
      check_plugin_file(file_);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  Elf64_Ehdr header() const {
    Elf64_Ehdr header;
    std::memcpy(&header, plugin_.data(), sizeof header);
    return header;
  }

  const std::string plugin_ = read_file(find_plugin("constant", default_plugin_directories()));

 private:
  ScratchFolder folder_;
  std::filesystem::path file_ = folder_ / "plugin.so";
};

TEST_F(PluginFiles, OfThisBuildAreAccepted) { EXPECT_EQ(mistake_in(plugin_), ""); }

TEST_F(PluginFiles, ThatAreTruncatedAreRefused) {
  for (std::size_t size = 0; size < plugin_.size(); size += size < 128 ? 1 : plugin_.size() / 64)
    EXPECT_NE(mistake_in(plugin_.substr(0, size)), "") << size;
}

TEST_F(PluginFiles, WithTablesBeyondTheirEndAreDamaged) {
  for (const std::size_t place : {offsetof(Elf64_Ehdr, e_shoff), offsetof(Elf64_Ehdr, e_phoff)})
    for (const std::uint64_t offset : {std::uint64_t{plugin_.size()}, ~std::uint64_t{0}}) {
      std::string bytes = plugin_;
      std::memcpy(bytes.data() + place, &offset, sizeof offset);
      EXPECT_NE(mistake_in(bytes).find("is damaged: a table lies beyond the end of the file"), std::string::npos);
    }
}

TEST_F(PluginFiles, WithRandomBytesInTheirTablesAreCheckedInBounds) {
  std::mt19937 random(1);
  const std::size_t tables = header().e_shoff;
  for (int trial = 0; trial < 300; ++trial) {
    std::string bytes = plugin_;
    for (int change = 0; change < 8; ++change) {
      const std::size_t begin = change % 2 == 0 ? 0 : tables;
      const std::size_t end = change % 2 == 0 ? std::min<std::size_t>(bytes.size(), 4096) : bytes.size();
      bytes[begin + random() % (end - begin)] = static_cast<char>(random());
    }
    mistake_in(bytes);  // which neither crashes nor throws anything else
  }
}

}  // namespace
}  // namespace cohort
