// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "idl/include/cohort/version.h"
#include "tests/support/process.hpp"

// The scripts of tools/dev that maintainers use.
namespace cohort {
namespace {

namespace fs = std::filesystem;

constexpr const char* scripts = COHORT_SOURCE_DIR "/tools/dev/";

test::Ended run(std::vector<std::string> command) {
  return test::run_to_end(command, {{"GIT_AUTHOR_NAME", "a"},
                                    {"GIT_AUTHOR_EMAIL", "a@b"},
                                    {"GIT_COMMITTER_NAME", "a"},
                                    {"GIT_COMMITTER_EMAIL", "a@b"},
                                    {"GIT_CONFIG_NOSYSTEM", "1"}});
}

// A repository with the script and what it reads.
class Releases : public ::testing::Test {
 protected:
  Releases() {
    fs::create_directories(top_ / "tools/dev");
    fs::copy(std::string(scripts) + "release", top_ / "tools/dev/release");
    fs::copy(COHORT_SOURCE_DIR "/CMakeLists.txt", top_ / "CMakeLists.txt");
    fs::copy(COHORT_SOURCE_DIR "/CHANGELOG.md", top_ / "CHANGELOG.md");
    git({"init", "--quiet"});
    git({"add", "."});
    git({"commit", "--quiet", "--message", "Begin"});
  }
  void git(std::vector<std::string> words) {
    words.insert(words.begin(), {"git", "-C", top_});
    const test::Ended ended = run(words);
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
  }
  test::Ended release(const std::string& tag, const std::string& folder, const std::string& part = "sources") {
    return run({top_ / "tools/dev/release", tag, top_ / folder, part});
  }

  test::ScratchFolder folder_;
  fs::path top_ = folder_.path();
};

TEST_F(Releases, HaveTheSourcesOfTheTagAndChecksums) {
  git({"tag", "v" COHORT_VERSION});
  test::write_file(top_ / "CHANGELOG.md", "changed since\n");
  const test::Ended made = release("v" COHORT_VERSION, "first");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string archive = "cohort-" COHORT_VERSION ".tar.gz";
  const test::Ended checked = run({"sh", "-c", "cd '" + (top_ / "first").string() + "' && sha256sum -c SHA256SUMS"});
  EXPECT_EQ(checked.out, archive + ": OK\n") << checked.err;
  const test::Ended text = run({"tar", "-xzOf", top_ / "first" / archive, "cohort-" COHORT_VERSION "/CHANGELOG.md"});
  EXPECT_EQ(text.out, test::read_file(COHORT_SOURCE_DIR "/CHANGELOG.md"));

  ASSERT_EQ(release("v" COHORT_VERSION, "second").exit_code, 0);
  EXPECT_EQ(test::read_file(top_ / "first" / archive), test::read_file(top_ / "second" / archive));
}

TEST_F(Releases, AreRefusedWithTheReason) {
  git({"tag", "v" COHORT_VERSION});
  git({"tag", "v9.9.9"});
  const auto error_of = [&](const test::Ended& ended) {
    EXPECT_EQ(ended.exit_code, 2);
    return ended.err;
  };
  EXPECT_EQ(error_of(release("v1", "new")), "tools/dev/release: there is no tag 'v1'\n");
  EXPECT_EQ(error_of(release("v9.9.9", "new")), "tools/dev/release: the tag is 'v9.9.9'; expected 'v" COHORT_VERSION
                                                "', since CMakeLists.txt there has version " COHORT_VERSION "\n");
  EXPECT_EQ(error_of(release("v" COHORT_VERSION, "new", "pictures")),
            "tools/dev/release: unknown part 'pictures'; expected sources, packages, wheel or images\n");
  EXPECT_NE(error_of(release("v" COHORT_VERSION, "tools")).find("is not empty"), std::string::npos);
  EXPECT_FALSE(fs::exists(top_ / "new"));
}

TEST(CommitMessages, AreCheckedByTheHook) {
  const test::ScratchFolder folder;
  const auto error_of = [&](const std::string& message) {
    const fs::path file = folder.path() / "message";
    test::write_file(file, message);
    const test::Ended ended = run({std::string(scripts) + "hooks/commit-msg", file});
    EXPECT_EQ(ended.exit_code, ended.err.empty() ? 0 : 1);
    return ended.err.substr(0, ended.err.find('\n'));
  };
  const std::string longest(72, 'a');
  EXPECT_EQ(error_of("Add a sensor\n\nUsers need it.\n# a comment of git\n"), "");
  EXPECT_EQ(error_of(longest), "");
  EXPECT_EQ(error_of("Merge branch 'of a name that is longer than the seventy-two characters of others'"), "");
  EXPECT_EQ(error_of(longest + "a"), "commit refused: the first line has 73 characters; expected at most 72");
  EXPECT_EQ(error_of("# only comments\n"), "commit refused: the first line is empty; expected a summary");
  EXPECT_EQ(error_of("Add a sensor.\n"), "commit refused: the first line ends with a full stop; expected none");
  EXPECT_EQ(error_of("Add a sensor\nUsers need it.\n"),
            "commit refused: the second line is not empty; the text begins on the third");
}

}  // namespace
}  // namespace cohort
