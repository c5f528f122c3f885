#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

/// Pages of charts as SVG: what was measured as dots, what it should be as thin lines. Pure functions; the same
/// arguments give the same text.
namespace cohort::figures {

/// One quantity over another.
struct Series {
  std::string name;                             ///< empty if it is alone on its panel
  std::vector<Eigen::Vector2d> measured;        ///< ascending in x
  std::function<double(double)> closed_form{};  ///< what theory says at x; empty if there is nothing to compare with
  double tolerance = 0.0;                       ///< how far the measured may be off it, of y
  bool is_joined = false;                       ///< a line goes from each point to the next
  bool has_dots = true;                         ///< of what is measured
};

struct Image {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<double> pixels;  ///< red, green and blue of each from 0 to 1, row by row from the top
};

struct Panel {
  std::string title;
  std::string line;  ///< what the thin line is, or what else is to be known
  std::string x_label;
  std::string y_label;
  std::vector<Series> series;
  Image image{};          ///< drawn in the place of series, with x from 0 to 360 degrees
  bool is_log_x = false;  ///< logarithmic: all that is measured is above zero, and there is no closed form
  bool is_log_y = false;  ///< the same
};

struct Page {
  std::string name;  ///< of its file, without the extension
  std::string title;
  std::vector<Panel> panels;
};

/// An SVG document that depends on nothing outside of itself.
std::string draw(const Page& page);

/// `count` numbers, evenly from `first` to `last`.
std::vector<double> evenly(double first, double last, std::size_t count);

}  // namespace cohort::figures
