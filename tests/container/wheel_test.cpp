// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/container/base.hpp"
#include "tests/container/clean_debian.hpp"

namespace cohort::test {
namespace {

namespace fs = std::filesystem;

TEST(Wheel, InstallsInAnEmptyEnvironmentOfACleanDebianAndRunsToTheSameBits) {
  const fs::path folder = COHORT_CONTAINER_DIR;
  if (const auto reason = make_base(folder)) GTEST_SKIP() << *reason;
  const Ended made = run_for_long({COHORT_SOURCE_DIR "/tools/dev/wheel"});
  ASSERT_EQ(made.exit_code, 0) << made.out;
  // The dependencies, in the version that is tested.
  const ScratchFolder wheels;
  const std::string script =
      "cd " COHORT_SOURCE_DIR
      " && cp build/wheels/*.whl \"$1\" && build/python-wheel/bin/pip freeze | grep '^numpy==' > "
      "\"$1/needed\" && build/python-wheel/bin/pip download -q --no-deps -r \"$1/needed\" -d \"$1\"";
  const Ended gathered = run_for_long({"sh", "-ec", script, "sh", wheels.path()});
  ASSERT_EQ(gathered.exit_code, 0) << gathered.out;

  const CleanDebian debian(folder / "bookworm.tar");
  for (const auto& entry : fs::directory_iterator(wheels.path()))
    fs::copy_file(entry.path(), debian / ("tmp/" + entry.path().filename().string()));
  const Ended python = debian.run("apt-get update -q && apt-get install -y -q --no-install-recommends python3-venv");
  if (python.exit_code != 0) GTEST_SKIP() << "no Debian mirror is reached: " << python.out;
  const Ended installed =
      debian.run("python3 -m venv /opt/env && /opt/env/bin/pip install -q --no-index --find-links /tmp cohort");
  ASSERT_EQ(installed.exit_code, 0) << installed.out;

  EXPECT_EQ(debian.run(hash_in_python("/opt/env/bin/python")).out, reference_hash(5) + "\n");
  const Ended run = debian.run("/opt/env/bin/cohort run obstacle_avoidance --duration 5");
  EXPECT_NE(run.out.find(reference_hash(5)), std::string::npos) << run.out;
  const Ended chain = debian.run("/opt/env/bin/cohort run chain --duration 2 --quiet && /opt/env/bin/cohort --version");
  EXPECT_NE(chain.out.find("mathematics   portable"), std::string::npos) << chain.out;
  EXPECT_TRUE(fs::exists(debian / "opt/env/lib/python3.11/site-packages/cohort/share/cohort/view/page.js"));
}

}  // namespace
}  // namespace cohort::test
