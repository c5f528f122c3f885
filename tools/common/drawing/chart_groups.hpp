// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/common/drawing/chart_page.hpp"

/// The styles of a chart's lines, and the legend of a page with groups of series.
namespace cohort::figures {

struct LineStyle {
  std::string colour;
  std::string dashes{};  ///< as `stroke-dasharray`; empty for a solid line

  /// Returns the attributes of a path.
  std::string attributes() const;
};

/// Returns true if the series of the page belong to several of its groups.
bool has_groups(const Page& page);

/// Returns the style of each series of a panel.
std::vector<LineStyle> styles_of(const Page& page, const Panel& panel);

/// The legend of a page with groups: a row for each group, with its name followed by its series.
struct GroupLegend {
  std::string text;     ///< SVG
  double height = 0.0;  ///< 0 without groups
};
/// Draws the legend with its upper left corner at `corner`, in rows that wrap at `width`.
GroupLegend draw_group_legend(const Page& page, const Eigen::Vector2d& corner, double width);

}  // namespace cohort::figures
