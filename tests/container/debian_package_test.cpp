// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <iostream>
#include <regex>

#include "tests/container/base.hpp"
#include "tests/container/clean_debian.hpp"
#include "tests/pages/page.hpp"
#include "tests/support/http.hpp"

namespace cohort::test {
namespace {

namespace fs = std::filesystem;

// Without node or a way to npm's registry, the page was not built.
void expect_view(const CleanDebian& debian, const std::string& recording) {
  for (const char* file : {"index.html", "page.js", "page.css"})
    EXPECT_TRUE(fs::exists(debian / (std::string("usr/share/cohort/view/") + file))) << file;
  std::vector<std::string> command = debian.command("exec cohort view " + recording + " --port 0");
  command.insert(command.begin(), "/usr/bin/env");
  Process view(command, CleanDebian::environment);
  ASSERT_TRUE(view.wait_for_output("http://127.0.0.1:")) << view.output();
  expect_page(port_in(view.output()));
}

// Runs `action` and prints its wall time.
template <class Action>
auto timed(const std::string& what, const Action& action) {
  const auto begin = std::chrono::steady_clock::now();
  auto result = action();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  std::cout << what << ": " << seconds.count() << " s\n";
  return result;
}

std::vector<std::string> hashes_in(const std::string& text) {
  const std::regex line("state hash +([0-9a-f]{16})");
  std::vector<std::string> hashes;
  for (std::sregex_iterator match(text.begin(), text.end(), line), end; match != end; ++match)
    hashes.push_back((*match)[1]);
  return hashes;
}

/// A clean Debian for each test, with the packages in /tmp.
class DebianPackage : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const fs::path folder = COHORT_CONTAINER_DIR;
    missing_ = make_base(folder);
    if (missing_) return;
    packages_.emplace();
    const Ended packed =
        run_for_long({COHORT_CPACK, "--config", COHORT_BUILD_DIR "/CPackConfig.cmake", "-B", packages_->path()});
    ASSERT_EQ(packed.exit_code, 0) << packed.out;
  }
  static void TearDownTestSuite() { packages_.reset(); }

  void SetUp() override {
    if (missing_) GTEST_SKIP() << *missing_;
    debian_.emplace(fs::path(COHORT_CONTAINER_DIR) / "bookworm.tar");
    for (const auto& entry : fs::directory_iterator(packages_->path()))
      if (entry.path().extension() == ".deb")
        fs::copy_file(entry.path(), *debian_ / ("tmp/" + entry.path().filename().string()));
    const Ended updated = debian_->run("apt-get update -q");
    if (updated.exit_code != 0) GTEST_SKIP() << "no Debian mirror is reached: " << updated.out;
  }

  /// Installs packages, by name, or by file if their name has a slash.
  Ended install(const std::string& names, const std::string& options = "") const {
    return debian_->run("apt-get install -y -q --no-install-recommends " + options + " " + names);
  }
  static bool has_python() { return fs::exists(*packages_ / ("python3-cohort_" COHORT_VERSION "_amd64.deb")); }

  /// Runs the commands of a page as root, in an empty home and in a network of its own.
  Ended run_page(const std::string& page) const {
    write_file(*debian_ / "root/page.sh", "export HOME=/root\nip link set lo up\nsudo() { \"$@\"; }\ncd\n" +
                                              script_of(blocks_of(read_file(fs::path(COHORT_SOURCE_DIR) / page))));
    return timed(page, [&] { return debian_->run("exec unshare --net bash /root/page.sh"); });
  }

  static inline std::optional<std::string> missing_;
  static inline std::optional<ScratchFolder> packages_;
  std::optional<CleanDebian> debian_;
};

TEST_F(DebianPackage, InstallsOnACleanDebianAndRunsTheDemoToTheSameBits) {
  const CleanDebian& debian = *debian_;
  const Ended installed = install("/tmp/cohort_" COHORT_VERSION "_*.deb");
  ASSERT_EQ(installed.exit_code, 0) << installed.out;

  const std::string worlds = "/usr/share/cohort/worlds";
  const Ended run = debian.run("su nobody -s /bin/sh -c 'cohort run " + worlds +
                               "/experiments/obstacle_avoidance.yaml --duration 5 --record /tmp/run.mcap'");
  EXPECT_EQ(run.exit_code, 0) << run.out;
  EXPECT_NE(run.out.find(reference_hash(5)), std::string::npos) << run.out;

  const Ended version = debian.run("cohort --version");
  EXPECT_NE(version.out.find("cohort " COHORT_VERSION), std::string::npos) << version.out;
  EXPECT_NE(version.out.find("mathematics   portable"), std::string::npos) << version.out;
  for (const char* file : {"usr/share/man/man1/cohort.1", "usr/share/bash-completion/completions/cohort",
                           "usr/lib/systemd/system/cohort@.service", "usr/share/doc/cohort/docs/install.md"})
    EXPECT_TRUE(fs::exists(debian / file)) << file;
  if (fs::exists(COHORT_BUILD_DIR "/share/cohort/view/page.js")) expect_view(debian, "/tmp/run.mcap");
  EXPECT_NE(read_file(debian / "usr/lib/systemd/system/cohort@.service").find("ExecStart=/usr/bin/cohort serve"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(debian / "usr/include/cohort")) << "that is for cohort-dev";

  const Ended development = install("/tmp/cohort-dev_*.deb", "-s");
  EXPECT_EQ(development.exit_code, 0) << development.out;
  EXPECT_NE(development.out.find("Inst cyclonedds-dev"), std::string::npos) << development.out;

  if (has_python()) {
    const Ended python = install("/tmp/python3-cohort_*.deb");
    ASSERT_EQ(python.exit_code, 0) << python.out;
    const Ended hash = debian.run(hash_in_python("python3"));
    EXPECT_EQ(hash.out, reference_hash(5) + "\n");
    debian.run("apt-get purge -y -q python3-cohort");
  }

  const Ended removed = debian.run("apt-get purge -y -q cohort");
  EXPECT_EQ(removed.exit_code, 0) << removed.out;
  EXPECT_FALSE(fs::exists(debian / "usr/share/cohort"));
}

// The controller of the README is in Python, and its server runs in the background.
TEST_F(DebianPackage, RunsTheCommandsOfTheReadme) {
  if (!has_python()) GTEST_SKIP() << "there is no Python package: COHORT_PYTHON is off";
  const Ended installed = timed("installing cohort and python3-cohort",
                                [&] { return install("/tmp/cohort_*.deb /tmp/python3-cohort_*.deb iproute2"); });
  ASSERT_EQ(installed.exit_code, 0) << installed.out;
  const Ended ended = run_page("README.md");
  EXPECT_EQ(ended.exit_code, 0) << ended.out;
}

TEST_F(DebianPackage, RunsTheCommandsOfTheTutorialToItsHash) {
  const Ended installed = timed("installing cohort and cohort-dev",
                                [&] { return install("/tmp/cohort_*.deb /tmp/cohort-dev_*.deb iproute2"); });
  ASSERT_EQ(installed.exit_code, 0) << installed.out;
  const Ended ended = run_page("docs/tutorial.md");
  EXPECT_EQ(ended.exit_code, 0) << ended.out;
  const std::vector<std::string> told = hashes_in(read_file(COHORT_SOURCE_DIR "/docs/tutorial.md"));
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(hashes_in(ended.out), std::vector<std::string>(4, told.front())) << ended.out;
}

}  // namespace
}  // namespace cohort::test
