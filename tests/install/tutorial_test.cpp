// SPDX-License-Identifier: Apache-2.0

// Does what docs/tutorial.md says, to the letter: writes its files and runs its commands.

#include <gtest/gtest.h>

#include <fstream>
#include <regex>

#include "tests/pages/page.hpp"
#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

namespace fs = std::filesystem;

const std::string network_section = "## 6. ";

std::vector<std::string> hashes_in(const std::string& text) {
  const std::regex line("state hash +([0-9a-f]{16})");
  std::vector<std::string> hashes;
  for (std::sregex_iterator match(text.begin(), text.end(), line), end; match != end; ++match)
    hashes.push_back((*match)[1]);
  return hashes;
}

class Tutorial : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    home.emplace();
    fs::create_directories(*home / "cohort/build");
    fs::create_directory_symlink(COHORT_BUILD_DIR, *home / "cohort/build/release");
    const std::string document = read_file(COHORT_SOURCE_DIR "/docs/tutorial.md");
    const std::size_t network = document.find(network_section);
    ASSERT_NE(network, std::string::npos);
    on_one_host = document.substr(0, network);
    on_two_hosts = document.substr(network);
    ASSERT_EQ(hashes_in(on_one_host).size(), 1u);
    hash = hashes_in(on_one_host).front();
  }
  static void TearDownTestSuite() { home.reset(); }

  static Process::Environment environment(const ReservedDomain& domain) {
    return {{"HOME", home->path()},      {"COHORT_DOMAIN", domain.text()},
            {"COHORT_MODEL_PATH", ""},   {"COHORT_PLUGIN_PATH", ""},
            {"CXX", COHORT_CXX},         {"CXXFLAGS", COHORT_CXX_FLAGS},
            {"CMAKE_GENERATOR", "Ninja"}};
  }
  static fs::path write_script(const std::string& name, const std::string& text) {
    std::ofstream(*home / name) << text;
    return *home / name;
  }

  static inline std::optional<ScratchFolder> home;
  static inline std::string on_one_host;
  static inline std::string on_two_hosts;
  static inline std::string hash;
};

TEST_F(Tutorial, EveryCommandWorksAndGivesTheSameBits) {
  const ReservedDomain domain;
  Process reader({"/bin/bash", write_script("one_host.sh", "cd\n" + script_of(blocks_of(on_one_host)))},
                 environment(domain));
  ASSERT_EQ(reader.wait_for_exit(), 0) << reader.output();
  EXPECT_EQ(hashes_in(reader.output()), std::vector<std::string>(3, hash)) << reader.output();
  EXPECT_NE(read_file(*home / "walls/walls.svg").find(hash), std::string::npos);
  EXPECT_NE(read_file(COHORT_SOURCE_DIR "/docs/images/wall_follower.svg").find(hash), std::string::npos)
      << "the picture in the tutorial is of another run";
}

TEST_F(Tutorial, TheMistakeIsExplainedAsItSays) {
  ASSERT_TRUE(fs::exists(*home / "walls/build/wall_follower.so")) << "the test before builds it";
  std::string wrong = read_file(*home / "walls/walls.yaml");
  wrong.replace(wrong.find("distance:"), 8, "distence");
  std::ofstream(*home / "walls/walls.yaml") << wrong;
  const ReservedDomain domain;
  Process check({"/bin/bash",
                 write_script("check.sh", "cd ~/walls; exec ~/.local/bin/cohort check walls.yaml --load-controllers")},
                environment(domain));
  EXPECT_EQ(check.wait_for_exit(), 2);
  std::string shown;
  for (const Block& block : blocks_of(on_one_host))
    if (block.text.starts_with("walls.yaml:")) shown = block.text;
  EXPECT_EQ(check.output(), shown);
  wrong.replace(wrong.find("distence"), 8, "distance");
  std::ofstream(*home / "walls/walls.yaml") << wrong;
}

TEST_F(Tutorial, AnotherHostGivesTheSameBits) {
  ASSERT_TRUE(fs::exists(*home / "walls/build/wall_follower")) << "the first test builds it";
  const ReservedDomain domain;
  // A network namespace of our own, which touches nothing of this machine and in which the user of the test is root.
  const std::vector<std::string> alone = {"/usr/bin/unshare", "--map-root-user", "--net", "--mount"};
  const auto in_it = [&](const std::string& script) {
    std::vector<std::string> command = alone;
    command.insert(command.end(), {"/bin/bash", script});
    return command;
  };
  Process possible(in_it(write_script("possible.sh", "set -e\nmount -t tmpfs none /run\nip netns add try\n")));
  if (possible.wait_for_exit() != 0) GTEST_SKIP() << "no network namespaces here: " << possible.output();
  Process reader(in_it(write_script("two_hosts.sh",
                                    "mount -t tmpfs none /run\nip link set lo up\nsudo() { \"$@\"; }\n"
                                    "export PATH=~/.local/bin:$PATH\ncd ~/walls\n" +
                                        script_of(blocks_of(on_two_hosts)))),
                 environment(domain));
  ASSERT_EQ(reader.wait_for_exit(), 0) << reader.output();
  EXPECT_EQ(hashes_in(reader.output()), std::vector<std::string>(1, hash)) << reader.output();
}

}  // namespace
}  // namespace cohort::test
