// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "tests/view/viewing.hpp"

namespace cohort::view {
namespace {

using namespace test;

// The page around the picture, for a recording of the demo's first four seconds.
class Layout : public InABrowser {
 protected:
  void check(const std::string& scenario) {
    run_demo({"--duration", "4", "--record", scratch / "run.mcap", "--record-snapshots", "1"});
    const View view({scratch / "run.mcap"});
    run_script("layout.mjs", {scenario, view.address()});
  }
  ScratchFolder scratch;
};

TEST_F(Layout, NoPanelOverlapsThePictureOrAnotherPanel) { check("nothing_overlaps"); }

TEST_F(Layout, SizesOfPanelsAreKept) { check("panels_are_kept"); }

TEST_F(Layout, FitsAPhone) { check("works_on_a_phone"); }

TEST_F(Layout, TheTreeSelectsIsolatesAndHides) { check("shows_the_world_as_a_tree"); }

TEST_F(Layout, StatisticsOfSelectedRobotsAreTheirs) { check("tells_of_many"); }

TEST_F(Layout, ValuesOfARobotUseTheHeightOfThePanel) { check("uses_the_height"); }

TEST_F(Layout, AxeFindsNothingInAnyState) { check("is_accessible"); }

TEST_F(Layout, ARunIsRepeatedFromThePage) {
  Process run({cohort_program(), "run", demo_experiment(), "--view", "--control", "--paused", "--duration", "2"});
  ASSERT_TRUE(run.wait_for_output("http://127.0.0.1:")) << run.output();
  const std::string output = run.output();
  const std::size_t begin = output.find("http://");
  run_script("layout.mjs", {"runs_again", output.substr(begin, output.find('\n', begin) - begin)});
  EXPECT_EQ(run.wait_for_exit(), 0) << "it ends when its page is closed\n" << run.output();
}

}  // namespace
}  // namespace cohort::view
