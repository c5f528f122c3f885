// SPDX-License-Identifier: Apache-2.0

// Runs every command of every page, as a reader would.

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <iostream>
#include <optional>
#include <regex>
#include <sstream>

#include "tests/pages/page.hpp"
#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

namespace fs = std::filesystem;

const fs::path source = COHORT_SOURCE_DIR;

/// Pages with blocks of code, relative to the sources. The tutorial has a test of its own.
std::vector<std::string> pages() {
  std::vector<std::string> pages = {"README.md", "docker/README.md", "worlds/README.md"};
  for (const auto& entry : fs::recursive_directory_iterator(source / "docs"))
    if (entry.path().extension() == ".md" && entry.path().filename() != "tutorial.md")
      pages.push_back(fs::relative(entry.path(), source));
  std::erase_if(pages, [](const std::string& page) { return blocks_of(read_file(source / page)).empty(); });
  std::ranges::sort(pages);
  return pages;
}

/// The empty home of a reader, with a folder `cohort` that looks like a clone in which tools/demo has run.
class Reader {
 public:
  Reader() {
    const fs::path clone = *home_ / "cohort";
    fs::create_directories(clone / "build");
    for (const char* part :
         {"client_sdk", "docker", "docs", "idl", "server", "tests", "tools", "CMakeLists.txt", "CMakePresets.json"})
      fs::create_symlink(source / part, clone / part);
    fs::copy(source / "worlds", clone / "worlds",
             fs::copy_options::recursive);  // experiments in it read no other folder
    fs::create_directory_symlink(COHORT_BUILD_DIR, clone / "build/release");
    if (fs::exists(source / "build/python")) fs::create_symlink(source / "build/python", clone / "build/python");
  }

  /// Runs a script in a network of its own, in which hosts of the pages (10.0.0.5 …) are this one. Cohort is on the
  /// paths, as if it were installed, unless `is_new`.
  Ended run(const std::string& script, bool is_new = false) {
    std::ofstream(*home_ / "page.sh") << "mount -t tmpfs none /run\nip link set lo up\n"
                                         "for host in 5 7 8; do ip address add 10.0.0.$host/32 dev lo; done\n"
                                         "cd ~/cohort\n"
                                      << script;
    Process::Environment environment = {{"HOME", home_->path()},     {"PATH", std::getenv("PATH")},
                                        {"COHORT_MODEL_PATH", ""},   {"COHORT_PLUGIN_PATH", ""},
                                        {"PYTHONPATH", ""},          {"COHORT_PYTHON", ""},
                                        {"CXX", COHORT_CXX},         {"CXXFLAGS", COHORT_CXX_FLAGS},
                                        {"CMAKE_GENERATOR", "Ninja"}};
    if (!is_new) {
      environment["PATH"].insert(0, COHORT_PROGRAMS ":");
      environment["PYTHONPATH"] = COHORT_BUILD_DIR "/python";
    }
    return run_to_end({"/usr/bin/unshare", "--map-root-user", "--net", "--mount", "/bin/bash", *home_ / "page.sh"},
                      environment);
  }

 private:
  std::optional<ScratchFolder> home_{std::in_place};
};

class Pages : public ::testing::TestWithParam<std::string> {};

TEST_P(Pages, EveryBlockOfCodeNamesItsLanguage) {
  for (const Block& block : blocks_of(read_file(source / GetParam())))
    EXPECT_FALSE(block.language.empty()) << GetParam() << ":" << block.line
                                         << ": write ```sh for commands, ```text for what programs print";
}

TEST_P(Pages, EveryCommandWorks) {
  const std::vector<Block> blocks = blocks_of(read_file(source / GetParam()));
  if (std::ranges::none_of(blocks, [](const Block& block) { return block.language == "sh"; })) return;
  Reader reader;
  if (const Ended possible = reader.run(""); possible.exit_code != 0)
    GTEST_SKIP() << "no network namespaces here: " << possible.err;
  const auto begin = std::chrono::steady_clock::now();
  const Ended ended = reader.run(script_of(blocks), GetParam() == "README.md");
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(ended.exit_code, 0) << ended.out << ended.err;
  std::istringstream errors(ended.err);
  for (std::string line; std::getline(errors, line);)
    if (line.starts_with("left out: ")) std::cout << GetParam() << ": " << line << "\n";
  std::cout << GetParam() << ": " << seconds.count() << " s\n";
}

INSTANTIATE_TEST_SUITE_P(Each, Pages, ::testing::ValuesIn(pages()), [](const auto& page) {
  return std::regex_replace(page.param, std::regex("[^A-Za-z0-9]+"), "_");
});

}  // namespace
}  // namespace cohort::test
