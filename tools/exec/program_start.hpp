// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

#include "tools/exec/clock_page.hpp"
#include "tools/exec/program_options.hpp"

namespace cohort::exec {

/// The clock page as a file in memory, which this process and the program map.
class PageFile {
 public:
  /// Throws std::runtime_error.
  PageFile();
  ~PageFile();
  PageFile(const PageFile&) = delete;
  PageFile& operator=(const PageFile&) = delete;
  const std::string& path() const { return path_; }
  ClockPage& page() { return *static_cast<ClockPage*>(memory_); }

 private:
  std::string path_;
  void* memory_ = nullptr;
};

/// Starts a program with the library that replaces its clocks, and returns its process. Throws std::runtime_error that
/// says why it cannot be started.
pid_t start_program(ProgramOptions& options, const std::filesystem::path& program, const std::string& page_file);

}  // namespace cohort::exec
