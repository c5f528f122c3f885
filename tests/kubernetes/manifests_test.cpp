// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/node_folder.hpp"

namespace cohort::test {
namespace {

namespace fs = std::filesystem;

const fs::path docker = COHORT_SOURCE_DIR "/docker";

class Manifests : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto missing = folder.prepare(script)) GTEST_SKIP() << *missing;
  }
  static Ended check(const fs::path& file) { return folder.run(script, {file}); }

 private:
  inline static const std::string script = "check_manifests.mjs";
  inline static const NodeFolder folder{COHORT_NODE, COHORT_NPM, COHORT_SOURCE_DIR "/tests/kubernetes",
                                        COHORT_NODE_FOLDER};
};

TEST_F(Manifests, AreAsKubernetesWantsThem) {
  int files = 0;
  for (const auto& entry : fs::directory_iterator(docker / "kubernetes")) {
    const Ended checked = check(entry.path());
    EXPECT_EQ(checked.exit_code, 0) << checked.out << checked.err;
    ++files;
  }
  EXPECT_EQ(files, 3);
}

TEST_F(Manifests, WithAKeyOrAValueThatIsWrongAreFound) {
  const ScratchFolder scratch;
  const std::string right = read_file(docker / "kubernetes/job.yaml");
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"runAsNonRoot: true", "runAsNoRoot: true"},
                                 {"backoffLimit: 0", "backoffLimit: none"}}) {
    std::string wrong = right;
    wrong.replace(wrong.find(from), from.size(), to);
    write_file(scratch / "wrong.yaml", wrong);
    const Ended checked = check(scratch / "wrong.yaml");
    EXPECT_EQ(checked.exit_code, 1) << to;
    EXPECT_NE(checked.out.find(to.substr(0, to.find(':'))), std::string::npos) << checked.out << checked.err;
  }
}

}  // namespace
}  // namespace cohort::test
