// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace cohort::fuzz {

/// A folder of this process with one file, which each input is written to; gone when the process ends.
class FuzzFile {
 public:
  explicit FuzzFile(const std::string& extension)
      : folder_(std::filesystem::temp_directory_path() / ("cohort_fuzz_" + std::to_string(getpid()))),
        file_(folder_ / ("input" + extension)) {
    std::filesystem::create_directories(folder_);
  }
  ~FuzzFile() { std::filesystem::remove_all(folder_); }
  FuzzFile(const FuzzFile&) = delete;
  FuzzFile& operator=(const FuzzFile&) = delete;

  const std::filesystem::path& holding(const std::uint8_t* data, std::size_t size) const {
    std::ofstream stream(file_, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    return file_;
  }
  void add(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }

 private:
  std::filesystem::path folder_;
  std::filesystem::path file_;
};

}  // namespace cohort::fuzz
