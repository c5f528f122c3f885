// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "tests/support/file_lock.hpp"
#include "tests/support/files.hpp"
#include "tests/support/process.hpp"

namespace cohort::test {

/// A script for node and the npm packages that it needs, copied from the sources to the build folder.
class NodeFolder {
 public:
  /// `node` and `npm` are programs; empty if they are missing. `source` also contains package.json and
  /// package-lock.json.
  NodeFolder(std::string node, std::string npm, std::filesystem::path source, std::filesystem::path folder)
      : node_(std::move(node)), npm_(std::move(npm)), source_(std::move(source)), folder_(std::move(folder)) {}

  /// Installs the packages once, in the first process that needs them. Returns the reason if this is impossible,
  /// otherwise nullopt.
  std::optional<std::string> prepare(const std::string& script) const {
    if (node_.empty()) return "there is no node: tools/dev/install-packages tools/dev/packages-node.txt";
    if (npm_.empty()) return "there is no npm: tools/dev/install-packages tools/dev/packages-node.txt";
    std::filesystem::create_directories(folder_);
    const FileLock lock(folder_ / "lock");
    install(script);
    return std::nullopt;
  }

  /// Returns the command that runs the script with these arguments.
  std::vector<std::string> command(const std::string& script, std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {node_, (folder_ / script).string()});
    return arguments;
  }
  Ended run(const std::string& script, const std::vector<std::string>& arguments) const {
    return run_to_end(command(script, arguments));
  }

 private:
  void install(const std::string& script) const {
    for (const std::string& name : {std::string("package.json"), std::string("package-lock.json"), script}) put(name);
    const std::string wanted = read_file(folder_ / "package-lock.json");
    if (read_file(folder_ / "installed") == wanted) return;
    const Ended ended = run_to_end({npm_, "ci", "--no-audit", "--no-fund", "--prefix", folder_.string()});
    ASSERT_EQ(ended.exit_code, 0) << ended.out << ended.err;
    write_file(folder_ / "installed", wanted);
  }

  // Replaces the file atomically, because another test's script may be reading it.
  void put(const std::string& name) const {
    const std::string content = read_file(source_ / name);
    if (read_file(folder_ / name) == content) return;
    write_file(folder_ / (name + ".new"), content);
    std::filesystem::rename(folder_ / (name + ".new"), folder_ / name);
  }

  std::string node_;
  std::string npm_;
  std::filesystem::path source_;
  std::filesystem::path folder_;
};

}  // namespace cohort::test
