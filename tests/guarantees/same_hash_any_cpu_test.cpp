#include <gtest/gtest.h>

#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

// Makes the C library believe that the CPU has no fused multiply-add.
const Process::Environment without_fma = {{"GLIBC_TUNABLES", "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2"}};

TEST(SameHashAnyCpu, TheCLibraryWithAndWithoutFmaGivesTheSameBits) {
  Process with({COHORT_BUILD_DIR "/bin/print_sines"});
  Process without({COHORT_BUILD_DIR "/bin/print_sines"}, without_fma);
  ASSERT_EQ(with.wait_for_exit(), 0);
  ASSERT_EQ(without.wait_for_exit(), 0);
  if (with.output() == without.output())
    GTEST_SKIP() << "this CPU or C library has only one variant of sin, cos and atan2";

  const auto summary = run_demo({"--controllers", "inprocess", "--duration", "10"}, without_fma);
  EXPECT_EQ(summary["state_hash"], reference_hash(10));
}

}  // namespace
}  // namespace cohort::test
