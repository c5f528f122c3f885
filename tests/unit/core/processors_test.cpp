// SPDX-License-Identifier: Apache-2.0
#include "server/core/processors.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "tests/support/files.hpp"

namespace cohort {
namespace {

namespace fs = std::filesystem;

// A machine as the kernel shows it. The quotas are of less than one core, so that any machine has more.
class Machine {
 public:
  void write(const fs::path& file, const std::string& text) const {
    fs::create_directories((root_.path() / file).parent_path());
    test::write_file(root_.path() / file, text);
  }
  unsigned processors() const { return available_processors(root_.path()); }

 private:
  test::ScratchFolder root_;
};

const unsigned cores = std::max(1u, std::thread::hardware_concurrency());

class AvailableProcessors : public ::testing::Test {
 protected:
  void SetUp() override {
    if (cores < 2) GTEST_SKIP() << "there is one core: no quota makes it fewer";
  }
  Machine machine;
};

TEST_F(AvailableProcessors, EqualTheCoresWithoutControlGroups) { EXPECT_EQ(machine.processors(), cores); }

TEST_F(AvailableProcessors, FollowTheQuotaOfVersion2InAContainer) {
  machine.write("proc/self/mountinfo", "30 29 0:26 / /sys/fs/cgroup ro,nosuid - cgroup2 cgroup rw\n");
  machine.write("proc/self/cgroup", "0::/\n");
  machine.write("sys/fs/cgroup/cpu.max", "max 100000\n");
  EXPECT_EQ(machine.processors(), cores);
  machine.write("sys/fs/cgroup/cpu.max", "190000 100000\n");
  EXPECT_EQ(machine.processors(), 1u);
  machine.write("sys/fs/cgroup/cpu.max", "20000 100000\n");
  EXPECT_EQ(machine.processors(), 1u);
  machine.write("sys/fs/cgroup/cpu.max", "6400000 100000\n");
  EXPECT_EQ(machine.processors(), std::min(cores, 64u));
}

TEST_F(AvailableProcessors, FollowTheQuotaOfAParentGroup) {
  machine.write("proc/self/mountinfo", "30 29 0:26 / /sys/fs/cgroup ro,nosuid shared:9 - cgroup2 cgroup rw\n");
  machine.write("proc/self/cgroup", "0::/machine.slice/cohort.service\n");
  machine.write("sys/fs/cgroup/machine.slice/cohort.service/cpu.max", "max 100000\n");
  EXPECT_EQ(machine.processors(), cores);
  machine.write("sys/fs/cgroup/machine.slice/cpu.max", "100000 100000\n");
  EXPECT_EQ(machine.processors(), 1u);
}

TEST_F(AvailableProcessors, FollowTheQuotaOfVersion1AlsoIfTheGroupIsMountedAsRoot) {
  machine.write("proc/self/mountinfo",
                "92 78 0:50 / /sys/fs/cgroup rw - tmpfs tmpfs rw,mode=755\n"
                "93 92 0:29 /pod/box /sys/fs/cgroup/cpu,cpuacct ro - cgroup cgroup rw,cpu,cpuacct\n"
                "95 92 0:31 /pod/box /sys/fs/cgroup/cpuset ro - cgroup cgroup rw,cpuset\n");
  machine.write("proc/self/cgroup", "3:cpuset:/pod/box\n1:cpu,cpuacct:/pod/box\n0::/pod/box\n");
  machine.write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "-1\n");
  machine.write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(machine.processors(), cores);
  machine.write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "150000\n");
  EXPECT_EQ(machine.processors(), 1u);
}

TEST_F(AvailableProcessors, EqualTheCoresIfTheKernelFilesAreNotUnderstood) {
  machine.write("proc/self/mountinfo", "cgroup2\n - \n30 29 0:26 / /sys/fs/cgroup - cgroup2 cgroup rw\n");
  machine.write("proc/self/cgroup", ":\n0::\n");
  machine.write("sys/fs/cgroup/cpu.max", "a lot\n");
  EXPECT_EQ(machine.processors(), cores);
}

}  // namespace
}  // namespace cohort
