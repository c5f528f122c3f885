// SPDX-License-Identifier: Apache-2.0
#include <csignal>

#include "tests/view/viewing.hpp"

// Guarantee 8: what a viewer does changes no run and holds none up.
namespace cohort::view {
namespace {

using namespace test;

class ObserversNeverCount : public InABrowser {
 protected:
  // Runs the demo while a browser looks at it in such a way; its hash is that of a run without a view.
  static void expect_same_hash_while(const std::string& scenario, bool is_killed) {
    const ReservedDomain domain;
    const ScratchFolder scratch;
    Process run({cohort_program(), "run", demo_experiment(), "--domain", domain.text(), "--paused", "--speed", "4",
                 "--duration", "20", "--summary", scratch / "summary.json"});
    View view({"--domain", domain.text(), "--control"});
    Process browser = start_script("browser.mjs", {scenario, view.address()});
    ASSERT_TRUE(browser.wait_for_output("looking")) << browser.output();
    ASSERT_EQ(
        run_to_end({cohort_program(), "ctl", "--domain", domain.text(), "--timeout", patience_in_seconds, "resume"})
            .exit_code,
        0);
    if (is_killed) {
      ASSERT_TRUE(browser.wait_for_output("seen")) << browser.output();
      browser.signal(SIGKILL);
    }
    ASSERT_EQ(run.wait_for_exit(), 0) << run.output();
    const auto summary = read_json(scratch / "summary.json");
    EXPECT_EQ(summary["state_hash"], reference_hash(20));
    EXPECT_TRUE(view.process().running());
  }
};

TEST_F(ObserversNeverCount, WithThePageOpen) { expect_same_hash_while("looks", false); }
TEST_F(ObserversNeverCount, WithItsTabSuspended) { expect_same_hash_while("is_suspended", false); }
TEST_F(ObserversNeverCount, WithTheBrowserKilled) { expect_same_hash_while("looks", true); }

}  // namespace
}  // namespace cohort::view
