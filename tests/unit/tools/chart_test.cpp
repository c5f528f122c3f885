// SPDX-License-Identifier: Apache-2.0
#include "tools/common/drawing/chart.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tools/common/drawing/chart_groups.hpp"
#include "tools/common/drawing/svg.hpp"

namespace cohort::figures {
namespace {

Page two_panels(const std::vector<std::size_t>& groups) {
  Page page{"", "chart", {}, {"team red", "team <idle>", "team blue"}};
  for (const char* const title : {"speed", "battery"}) {
    Panel panel{title, "", "time [s]", "", {}};
    for (const std::size_t group : groups) {
      const std::string name = "robot_" + std::to_string(panel.series.size());
      panel.series.push_back(
          {.name = name, .measured = {{0, 0}, {1, 1}}, .is_joined = true, .has_dots = false, .group = group});
    }
    page.panels.push_back(panel);
  }
  return page;
}

TEST(Chart, SeriesOfAGroupShareItsHueAndDifferInDashesOrShade) {
  const Page page = two_panels({0, 2, 0, 0, 0, 0, 2});
  const auto styles = styles_of(page, page.panels[1]);
  ASSERT_EQ(styles.size(), 7U);
  EXPECT_EQ(styles[0].colour, tool::svg::colour_of(0, 3));
  EXPECT_EQ(styles[1].colour, tool::svg::colour_of(2, 3)) << "also where a team is not drawn, as in the plot of paths";
  EXPECT_EQ(styles[2].colour, styles[0].colour);
  EXPECT_EQ(styles[6].colour, styles[1].colour);
  std::set<std::string> different;
  for (const LineStyle& style : styles) different.insert(style.attributes());
  EXPECT_EQ(different.size(), styles.size());
}

TEST(Chart, HasOneLegendByGroupBelowItsPanels) {
  const Page page = two_panels({0, 2, 0});
  const std::string drawn = draw(page);
  const std::size_t red = drawn.find(">team red<"), blue = drawn.find(">team blue<");
  ASSERT_NE(red, std::string::npos);
  ASSERT_NE(blue, std::string::npos);
  EXPECT_EQ(drawn.find("&lt;idle&gt;"), std::string::npos) << "none of its series is drawn";
  const auto count = [&](const std::string& name) {
    std::size_t found = 0;
    for (std::size_t at = drawn.find(name); at != std::string::npos; at = drawn.find(name, at + 1)) ++found;
    return found;
  };
  for (const char* const robot : {">robot_0<", ">robot_1<", ">robot_2<"}) EXPECT_EQ(count(robot), 1U) << robot;
  EXPECT_LT(red, drawn.find(">robot_0<"));
  EXPECT_LT(drawn.find(">robot_2<"), blue) << "robots follow the name of their team";
  EXPECT_LT(blue, drawn.find(">robot_1<"));
}

TEST(Chart, DrawsSeriesOfOneGroupInColoursOfTheirOwn) {
  const std::string drawn = draw(two_panels({2, 2, 2}));
  EXPECT_EQ(drawn.find("team blue"), std::string::npos);
  EXPECT_EQ(drawn.find("dasharray"), std::string::npos);
  EXPECT_EQ(drawn, draw([] {
              Page page = two_panels({0, 0, 0});
              page.groups.clear();
              return page;
            }()));
}

}  // namespace
}  // namespace cohort::figures
