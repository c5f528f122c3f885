// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

/// Pages of charts, as data.
namespace cohort::figures {

/// A quantity as a function of another.
struct Series {
  std::string name;                             ///< empty if it is the only series of its panel
  std::vector<Eigen::Vector2d> measured;        ///< ascending in x
  std::function<double(double)> closed_form{};  ///< theoretical value at x; empty if there is none
  double tolerance = 0.0;                       ///< allowed deviation of measured values, in units of y
  bool is_joined = false;                       ///< draw lines between consecutive points
  bool has_dots = true;                         ///< draw dots at measured points
  std::size_t group = 0;                        ///< index in `Page::groups`, if the page has groups
};

struct Image {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<double> pixels;  ///< red, green and blue of each pixel, 0 to 1, row by row from the top
};

struct Panel {
  std::string title;
  std::string line;  ///< explanation of the thin line, or another remark
  std::string x_label;
  std::string y_label;
  std::vector<Series> series;
  Image image{};          ///< drawn instead of series, with x from 0 to 360 degrees
  bool is_log_x = false;  ///< logarithmic axis: measured values are positive, and there is no closed form
  bool is_log_y = false;  ///< the same
};

struct Page {
  std::string name;  ///< file name without the extension
  std::string title;
  std::vector<Panel> panels;
  /// Names of groups of series, the same in each panel. If series belong to more than one group, each group has a
  /// colour, and its series differ in shade and dashes. One legend below the panels then has a row for each group.
  std::vector<std::string> groups{};
};

}  // namespace cohort::figures
