// SPDX-License-Identifier: Apache-2.0
#include "tools/common/drawing/chart_groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "tools/common/drawing/svg.hpp"

namespace cohort::figures {
namespace {

using tool::svg::escaped;
using tool::svg::number;

constexpr std::array<std::string_view, 5> colours = {"#0b62c4", "#c4480b", "#0a7d55", "#8a3ab9", "#8a6d00"};
constexpr std::array<std::string_view, 4> dashes = {"", "6 3", "2 2.5", "9 3 2 3"};
constexpr std::array<double, 3> shades = {0.0, -0.14, 0.12};  // added to the lightness
constexpr double legend_row_height = 18.0;
constexpr double letter_width = 6.8;
constexpr double sample_width = 26.0;  // width of a piece of a line in the legend
constexpr double gap = 16.0;           // space between entries

double width_of(std::string_view text) { return letter_width * static_cast<double>(text.size()); }

}  // namespace

std::string LineStyle::attributes() const {
  return fmt::format("stroke=\"{}\"", colour) + (dashes.empty() ? "" : fmt::format(" stroke-dasharray=\"{}\"", dashes));
}

bool has_groups(const Page& page) {
  std::set<std::size_t> groups;
  for (const Panel& panel : page.panels)
    for (const Series& series : panel.series) groups.insert(series.group);
  return groups.size() > 1;
}

std::vector<LineStyle> styles_of(const Page& page, const Panel& panel) {
  const bool is_grouped = has_groups(page);
  std::vector<std::size_t> drawn(page.groups.size());
  std::vector<LineStyle> styles;
  for (const Series& series : panel.series) {
    if (!is_grouped) {
      styles.push_back({std::string(colours[styles.size() % colours.size()])});
      continue;
    }
    const std::size_t i = drawn.at(series.group)++;
    const double shade = shades[i / dashes.size() % shades.size()];
    styles.push_back(
        {tool::svg::colour_of(series.group, page.groups.size(), shade), std::string(dashes[i % dashes.size()])});
  }
  return styles;
}

GroupLegend draw_group_legend(const Page& page, const Eigen::Vector2d& corner, double width) {
  if (!has_groups(page)) return {};
  const Panel& panel = page.panels.front();
  const std::vector<LineStyle> styles = styles_of(page, panel);
  double indent = 0.0;
  for (const std::string& group : page.groups) indent = std::max(indent, 1.15 * width_of(group) + gap);
  GroupLegend legend{"<g id=\"legend\">\n", 0.0};
  for (std::size_t group = 0; group < page.groups.size(); ++group) {
    if (std::ranges::count(panel.series, group, &Series::group) == 0) continue;
    double x = indent;
    double y = legend.height + 12.0;
    legend.text += fmt::format("<text x=\"{}\" y=\"{}\" font-weight=\"bold\" fill=\"{}\">{}</text>\n",
                               number(corner.x()), number(corner.y() + y),
                               tool::svg::colour_of(group, page.groups.size()), escaped(page.groups[group]));
    for (std::size_t i = 0; i < panel.series.size(); ++i) {
      if (panel.series[i].group != group) continue;
      const double entry = sample_width + 6.0 + width_of(panel.series[i].name);
      if (x + entry > width && x > indent) {
        x = indent;
        y += legend_row_height;
      }
      legend.text += fmt::format("<path d=\"M{} {}h{}\" fill=\"none\" {}/><text x=\"{}\" y=\"{}\">{}</text>\n",
                                 number(corner.x() + x), number(corner.y() + y - 4.0), number(sample_width),
                                 styles[i].attributes(), number(corner.x() + x + sample_width + 6.0),
                                 number(corner.y() + y), escaped(panel.series[i].name));
      x += entry + gap;
    }
    legend.height = y + legend_row_height - 12.0;
  }
  legend.text += "</g>\n";
  return legend;
}

}  // namespace cohort::figures
