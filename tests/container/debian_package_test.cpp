#include <gtest/gtest.h>

#include "tests/container/base.hpp"
#include "tests/container/clean_debian.hpp"
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

TEST(DebianPackage, InstallsOnACleanDebianAndRunsTheDemoToTheSameBits) {
  const fs::path folder = COHORT_CONTAINER_DIR;
  if (const auto reason = make_base(folder)) GTEST_SKIP() << *reason;
  const ScratchFolder packages;
  const Ended packed =
      run_for_long({COHORT_CPACK, "--config", COHORT_BUILD_DIR "/CPackConfig.cmake", "-B", packages.path()});
  ASSERT_EQ(packed.exit_code, 0) << packed.out;

  const CleanDebian debian(folder / "bookworm.tar");
  for (const auto& entry : fs::directory_iterator(packages.path()))
    if (entry.path().extension() == ".deb")
      fs::copy_file(entry.path(), debian / ("tmp/" + entry.path().filename().string()));
  const Ended updated = debian.run("apt-get update -q");
  if (updated.exit_code != 0) GTEST_SKIP() << "no Debian mirror is reached: " << updated.out;
  const Ended installed =
      debian.run("apt-get install -y -q --no-install-recommends /tmp/cohort_" COHORT_VERSION "_*.deb");
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

  const Ended development = debian.run("apt-get install -y -s --no-install-recommends /tmp/cohort-dev_*.deb");
  EXPECT_EQ(development.exit_code, 0) << development.out;
  EXPECT_NE(development.out.find("Inst cyclonedds-dev"), std::string::npos) << development.out;

  if (fs::exists(packages / ("python3-cohort_" COHORT_VERSION "_amd64.deb"))) {
    const Ended python = debian.run("apt-get install -y -q --no-install-recommends /tmp/python3-cohort_*.deb");
    ASSERT_EQ(python.exit_code, 0) << python.out;
    const Ended hash = debian.run(hash_in_python("python3"));
    EXPECT_EQ(hash.out, reference_hash(5) + "\n");
    debian.run("apt-get purge -y -q python3-cohort");
  }

  const Ended removed = debian.run("apt-get purge -y -q cohort");
  EXPECT_EQ(removed.exit_code, 0) << removed.out;
  EXPECT_FALSE(fs::exists(debian / "usr/share/cohort"));
}

}  // namespace
}  // namespace cohort::test
