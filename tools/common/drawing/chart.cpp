// SPDX-License-Identifier: Apache-2.0
#include "tools/common/drawing/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tools/common/drawing/chart_groups.hpp"
#include "tools/common/drawing/plot_view.hpp"
#include "tools/common/drawing/svg.hpp"

namespace cohort::figures {
namespace {

using Eigen::Vector2d;
using tool::svg::escaped;
using tool::svg::number;

// Lengths on the page; a unit is a CSS pixel when the picture is shown at its own size.
constexpr std::size_t columns = 3;
constexpr double margin = 16.0;
constexpr double header = 50.0;
const Vector2d cell{300.0, 272.0};
const Vector2d plot_at{54.0, 44.0};  // origin of the plot in its cell
const Vector2d plot_size{230.0, 166.0};
constexpr double row_height = 15.0;  // height of a row of the legend
constexpr double dot_diameter = 4.4;
constexpr double image_height = 80.0;
constexpr std::size_t line_parts = 400;
constexpr double line_tolerance = 0.1;

constexpr std::string_view ink = "#1f2328";
constexpr std::string_view soft_ink = "#59636e";
constexpr std::string_view frame_colour = "#c8ced6";
constexpr std::string_view grid_colour = "#e6e9ed";

bool is_log(const Panel& panel, int axis) { return axis == 0 ? panel.is_log_x : panel.is_log_y; }

// Returns the logarithm of each coordinate whose axis is logarithmic.
Vector2d on_axes(const Panel& panel, const Vector2d& point) {
  return {panel.is_log_x ? std::log10(point.x()) : point.x(), panel.is_log_y ? std::log10(point.y()) : point.y()};
}

tool::Range range_of(const Panel& panel) {
  tool::Range range;
  for (const Series& series : panel.series)
    for (const Vector2d& point : series.measured) range.add(on_axes(panel, point));
  constexpr double around = 0.15;  // margin as a fraction of a power of ten
  if (panel.is_log_x) {
    range.lower.x() -= around;
    range.upper.x() += around;
  }
  if (panel.is_log_y) {
    range.lower.y() -= around;
    range.upper.y() += around;
    return range;
  }
  // Includes zero if it is near, and leaves a margin at the upper edge.
  for (const int axis : {0, 1}) {
    if (is_log(panel, axis)) continue;
    const double size = range.upper[axis] - range.lower[axis];
    if (range.lower[axis] > 0.0 && range.lower[axis] < 0.5 * size) range.lower[axis] = 0.0;
    if (range.upper[axis] < 0.0 && range.upper[axis] > -0.5 * size) range.upper[axis] = 0.0;
  }
  double height = range.upper.y() - range.lower.y();
  if (height == 0.0) height = std::max(1.0, std::abs(range.upper.y()));
  range.upper.y() += 0.06 * height;
  range.lower.y() -= range.lower.y() == 0.0 ? 0.02 * height : 0.06 * height;
  return range;
}

class PanelDrawing {
 public:
  PanelDrawing(const Page& page, const Panel& panel, const Vector2d& corner, std::string& text)
      : panel_(panel), styles_(styles_of(page, panel)), corner_(corner), text_(text), out_(text_) {
    has_legend_ = !has_groups(page);
  }

  void draw() {
    fmt::format_to(out_, "<text x=\"{}\" y=\"{}\" font-size=\"14\" font-weight=\"bold\">{}</text>\n",
                   number(corner_.x() + plot_at.x()), number(corner_.y() + 16.0), escaped(panel_.title));
    fmt::format_to(out_, "<text x=\"{}\" y=\"{}\" fill=\"{}\">{}</text>\n", number(corner_.x() + plot_at.x()),
                   number(corner_.y() + 33.0), soft_ink, escaped(panel_.line));
    if (panel_.image.width > 0) {
      range_.lower = {0.0, 0.0};
      range_.upper = {360.0, 1.0};
      height_ = image_height;
      draw_image();
      draw_x_axis(60.0);
      return;
    }
    range_ = range_of(panel_);
    draw_x_axis(step_of(0));
    draw_y_axis(step_of(1));
    for (std::size_t i = 0; i < panel_.series.size(); ++i) draw_line(panel_.series[i], styles_[i]);
    for (std::size_t i = 0; i < panel_.series.size(); ++i) draw_dots(panel_.series[i], styles_[i]);
    if (has_legend_) draw_legend();
  }

 private:
  Vector2d on_page(const Vector2d& at) const {
    const Vector2d share = (on_axes(panel_, at) - range_.lower).cwiseQuotient(range_.upper - range_.lower);
    return corner_ + plot_at + Vector2d(share.x() * plot_size.x(), (1.0 - share.y()) * height_);
  }

  double step_of(int axis) const {
    return is_log(panel_, axis) ? 1.0 : tool::round_length((range_.upper[axis] - range_.lower[axis]) / 2.5);
  }
  // Returns the value of a tick, and its label.
  double value_at(const tool::Ticks& ticks, std::int64_t i, int axis) const {
    return is_log(panel_, axis) ? std::pow(10.0, static_cast<double>(i)) : ticks.at(i);
  }
  std::string label_at(const tool::Ticks& ticks, std::int64_t i, int axis) const {
    return is_log(panel_, axis) ? fmt::format("{:g}", value_at(ticks, i, axis)) : ticks.label(i);
  }

  void draw_x_axis(double step) {
    const double bottom = corner_.y() + plot_at.y() + height_;
    const tool::Ticks ticks(range_.lower.x(), range_.upper.x(), step);
    for (std::int64_t i = ticks.first; i <= ticks.last; ++i) {
      const double x = on_page({value_at(ticks, i, 0), 1.0}).x();
      if (panel_.image.width == 0)
        fmt::format_to(out_, "<path d=\"M{} {}v{}\" stroke=\"{}\"/>\n", number(x), number(bottom), number(-height_),
                       grid_colour);
      fmt::format_to(out_, "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" fill=\"{}\">{}</text>\n", number(x),
                     number(bottom + 15.0), soft_ink, label_at(ticks, i, 0));
    }
    fmt::format_to(out_, "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
                   number(corner_.x() + plot_at.x() + 0.5 * plot_size.x()), number(bottom + 32.0),
                   escaped(panel_.x_label));
  }

  void draw_y_axis(double step) {
    const Vector2d at = corner_ + plot_at;
    const tool::Ticks ticks(range_.lower.y(), range_.upper.y(), step);
    for (std::int64_t i = ticks.first; i <= ticks.last; ++i) {
      const double y = on_page({1.0, value_at(ticks, i, 1)}).y();
      fmt::format_to(out_, "<path d=\"M{} {}h{}\" stroke=\"{}\"/>\n", number(at.x()), number(y), number(plot_size.x()),
                     grid_colour);
      fmt::format_to(out_, "<text x=\"{}\" y=\"{}\" text-anchor=\"end\" fill=\"{}\">{}</text>\n", number(at.x() - 6.0),
                     number(y + 4.0), soft_ink, label_at(ticks, i, 1));
    }
    fmt::format_to(out_, "<text transform=\"translate({} {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                   number(corner_.x() + 12.0), number(at.y() + 0.5 * height_), escaped(panel_.y_label));
    fmt::format_to(out_, "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"{}\"/>\n",
                   number(at.x()), number(at.y()), number(plot_size.x()), number(height_), frame_colour);
  }

  void draw_line(const Series& series, const LineStyle& style) {
    if (!series.closed_form || series.measured.empty()) return;
    tool::svg::Points points;
    for (const double x : evenly(series.measured.front().x(), series.measured.back().x(), line_parts + 1)) {
      const double y = std::clamp(series.closed_form(x), range_.lower.y(), range_.upper.y());
      points.push_back(on_page({x, y}));
    }
    fmt::format_to(out_, "<path fill=\"none\" {} d=\"{}\"/>\n", style.attributes(),
                   tool::svg::path_data(tool::svg::simplified(points, line_tolerance)));
  }

  // Draws dots as lines of zero length with round ends.
  void draw_dots(const Series& series, const LineStyle& style) {
    std::string data;
    if (series.is_joined) {
      tool::svg::Points points;
      for (const Vector2d& point : series.measured) points.push_back(on_page(point));
      fmt::format_to(out_, "<path fill=\"none\" {} d=\"{}\"/>\n", style.attributes(), tool::svg::path_data(points));
    }
    if (!series.has_dots) return;
    for (const Vector2d& point : series.measured) {
      const Vector2d at = on_page(point);
      data += fmt::format("M{:.1f} {:.1f}h0", at.x(), at.y());
    }
    fmt::format_to(out_,
                   "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\" "
                   "stroke-opacity=\".75\" d=\"{}\"/>\n",
                   style.colour, number(dot_diameter), data);
  }

  // Draws the legend in the corner where it covers the fewest marks.
  void draw_legend() {
    std::size_t longest = 0;
    std::size_t rows = 0;
    for (const Series& series : panel_.series) {
      if (series.name.empty()) continue;
      longest = std::max(longest, series.name.size());
      ++rows;
    }
    if (rows == 0) return;
    const Vector2d size(22.0 + 6.6 * static_cast<double>(longest), row_height * static_cast<double>(rows) + 5.0);
    Vector2d best = corner_ + plot_at;
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    for (const Vector2d& share : {Vector2d(1, 0), Vector2d(0, 0), Vector2d(1, 1), Vector2d(0, 1)}) {
      const Vector2d room = Vector2d(plot_size.x(), height_) - size - Vector2d(6.0, 6.0);
      const Vector2d at = corner_ + plot_at + Vector2d(3.0, 3.0) + share.cwiseProduct(room);
      const std::size_t covered = marks_within(at, at + size);
      if (covered >= fewest) continue;
      fewest = covered;
      best = at;
    }
    fmt::format_to(out_, "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"#fff\" fill-opacity=\".85\"/>\n",
                   number(best.x()), number(best.y()), number(size.x()), number(size.y()));
    double y = best.y() + row_height;
    for (std::size_t i = 0; i < panel_.series.size(); ++i) {
      if (panel_.series[i].name.empty()) continue;
      fmt::format_to(out_, "<circle cx=\"{}\" cy=\"{}\" r=\"3\" fill=\"{}\"/><text x=\"{}\" y=\"{}\">{}</text>\n",
                     number(best.x() + 8.0), number(y - 4.0), styles_[i].colour, number(best.x() + 16.0), number(y),
                     escaped(panel_.series[i].name));
      y += row_height;
    }
  }

  // Returns the number of dots and points of lines in a rectangle.
  std::size_t marks_within(const Vector2d& lower, const Vector2d& upper) const {
    const auto is_within = [&](const Vector2d& point) {
      const Vector2d at = on_page(point);
      return (at.array() >= lower.array()).all() && (at.array() <= upper.array()).all();
    };
    std::size_t count = 0;
    for (const Series& series : panel_.series) {
      count += static_cast<std::size_t>(std::ranges::count_if(series.measured, is_within));
      if (!series.closed_form || series.measured.empty()) continue;
      for (const double x : evenly(series.measured.front().x(), series.measured.back().x(), line_parts + 1))
        if (is_within({x, series.closed_form(x)})) ++count;
    }
    return count;
  }

  // Draws neighbouring cells of the same colour as one rectangle.
  void draw_image() {
    const Image& image = panel_.image;
    const Vector2d at = corner_ + plot_at;
    const Vector2d pixel(plot_size.x() / static_cast<double>(image.width),
                         image_height / static_cast<double>(image.height));
    fmt::format_to(out_, "<g shape-rendering=\"crispEdges\">\n");
    for (std::size_t row = 0; row < image.height; ++row)
      for (std::size_t column = 0; column < image.width;) {
        const std::string colour = colour_of(row, column);
        std::size_t end = column + 1;
        while (end < image.width && colour_of(row, end) == colour) ++end;
        fmt::format_to(out_, "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n",
                       number(at.x() + pixel.x() * static_cast<double>(column)),
                       number(at.y() + pixel.y() * static_cast<double>(row)),
                       number(pixel.x() * static_cast<double>(end - column)), number(pixel.y()), colour);
        column = end;
      }
    text_ += "</g>\n";
  }

  // Returns the colour of a cell, rounded to 16 levels per channel.
  std::string colour_of(std::size_t row, std::size_t column) const {
    std::string text = "#";
    for (std::size_t i = 0; i < 3; ++i) {
      const double value = panel_.image.pixels[3 * (row * panel_.image.width + column) + i];
      text += fmt::format("{:x}", std::clamp(std::lround(15.0 * value), 0L, 15L));
    }
    return text;
  }

  const Panel& panel_;
  std::vector<LineStyle> styles_;  // one for each series
  bool has_legend_ = true;
  Vector2d corner_;
  std::string& text_;
  std::back_insert_iterator<std::string> out_;
  tool::Range range_;
  double height_ = plot_size.y();
};

}  // namespace

std::string draw(const Page& page) {
  const std::size_t rows = (page.panels.size() + columns - 1) / columns;
  const double width = 2.0 * margin + static_cast<double>(std::min(columns, page.panels.size())) * cell.x();
  const double panels_end = header + static_cast<double>(rows) * cell.y();
  const GroupLegend legend = draw_group_legend(page, {margin + 10.0, panels_end + 8.0}, width - 2.0 * (margin + 10.0));
  const double height = panels_end + (legend.height > 0.0 ? legend.height + 16.0 : 4.0);
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"12\" fill=\"{2}\">\n"
      "<rect width=\"{0}\" height=\"{1}\" rx=\"6\" fill=\"#ffffff\"/>\n"
      "<text x=\"{3}\" y=\"30\" font-size=\"19\" font-weight=\"bold\">{4}</text>\n",
      number(width), number(height), ink, number(margin + 10.0), escaped(page.title));
  for (std::size_t i = 0; i < page.panels.size(); ++i) {
    const std::size_t row = i / columns;
    const Vector2d place(static_cast<double>(i % columns), static_cast<double>(row));
    PanelDrawing(page, page.panels[i], Vector2d(margin, header) + place.cwiseProduct(cell), text).draw();
  }
  return text + legend.text + "</svg>\n";
}

std::vector<double> evenly(double first, double last, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i)
    values.push_back(first + (last - first) * static_cast<double>(i) / static_cast<double>(count - 1));
  return values;
}

}  // namespace cohort::figures
