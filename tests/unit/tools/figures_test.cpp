// SPDX-License-Identifier: Apache-2.0
#include "tests/figures/figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/support/process.hpp"

/// The figures of docs/sbot.md: what they show is measured, and agrees with the lines beside it.
namespace cohort::figures {
namespace {

const std::vector<Page>& pages() {
  static const std::vector<Page> all = all_pages();
  return all;
}

TEST(Figures, MeasuredPointsAgreeWithTheClosedForms) {
  for (const Page& page : pages())
    for (const Panel& panel : page.panels) {
      std::size_t compared = 0;
      for (const Series& series : panel.series) {
        if (!series.closed_form) continue;
        double worst = 0.0;
        for (const Eigen::Vector2d& point : series.measured) {
          EXPECT_TRUE(point.allFinite());
          worst = std::max(worst, std::abs(point.y() - series.closed_form(point.x())));
          ++compared;
        }
        EXPECT_LE(worst, series.tolerance) << panel.title << " " << series.name;
      }
      EXPECT_TRUE(compared >= 10 || panel.image.width > 0) << panel.title;
    }
}

// A panel whose readings never change would agree with anything that is flat.
TEST(Figures, EveryReadingResponds) {
  for (const Page& page : pages())
    for (const Panel& panel : page.panels)
      for (const Series& series : panel.series) {
        std::set<double> values;
        for (const Eigen::Vector2d& point : series.measured) values.insert(point.y());
        EXPECT_GE(values.size(), 2u) << panel.title << " " << series.name;
      }
}

TEST(Figures, APictureHasADotForEachMeasuredPoint) {
  for (const Page& page : pages()) {
    std::size_t points = 0;
    for (const Panel& panel : page.panels)
      for (const Series& series : panel.series) points += series.measured.size();
    const std::string svg = draw(page);
    std::size_t dots = 0;
    for (std::size_t at = svg.find("h0"); at != std::string::npos; at = svg.find("h0", at + 1)) ++dots;
    EXPECT_EQ(dots, points) << page.name;
  }
}

TEST(Figures, InTheDocumentsAreUpToDate) {
  const test::ScratchFolder folder;
  const test::Ended ended = test::run_to_end({COHORT_BUILD_DIR "/bin/cohort_figures", (folder / "").string()});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  for (const Page& page : pages()) {
    const std::string file = page.name + ".svg";
    EXPECT_TRUE(test::read_file(folder / file) == test::read_file(COHORT_SOURCE_DIR "/docs/images/sbot/" + file))
        << file << " is not what cohort_figures draws now: cohort_figures docs/images/sbot draws it again";
  }
}

}  // namespace
}  // namespace cohort::figures
