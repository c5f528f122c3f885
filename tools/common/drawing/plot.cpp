// SPDX-License-Identifier: Apache-2.0
#include "tools/common/drawing/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>
#include <utility>

#include "server/geometry/shapes/convex_hull_2d.hpp"
#include "tools/common/drawing/outline.hpp"
#include "tools/common/drawing/plot_view.hpp"
#include "tools/common/drawing/svg.hpp"

namespace cohort::tool {
namespace {

using Eigen::Vector2d;
using svg::number;
using Output = std::back_insert_iterator<std::string>;

// Lengths on the page; a unit is a CSS pixel when the picture is shown at its own size.
constexpr double header = 66.0;
constexpr double footer = 36.0;
constexpr double legend_width = 230.0;
constexpr double legend_row = 25.0;
constexpr double margin = 16.0;
constexpr double digit_width = 7.5;
constexpr std::size_t longest_title = 64;

constexpr double path_tolerance = 0.3;   // 2 mm in an arena of 4 m
constexpr double smallest_radius = 2.2;  // minimum radius of a robot, so that it is visible in any arena
constexpr double mark_spacing = 3.0;     // closer marks would hide each other
constexpr double mark_radius = 3.2;

constexpr std::string_view ink = "#1f2328";
constexpr std::string_view soft_ink = "#59636e";
constexpr std::string_view frame_colour = "#c8ced6";
constexpr std::string_view grid_colour = "#e6e9ed";
constexpr std::string_view floor_colour = "#f1f1ec";
constexpr std::string_view obstacle_style = R"(fill="#b4bac2" stroke="#7d8690" stroke-width=".8")";
constexpr std::string_view object_style = R"(fill="#e8d9b8" stroke="#a08a55" stroke-width=".8")";
constexpr std::string_view obstacle_contact_colour = "#c4001d";
constexpr std::string_view robot_contact_colour = "#1f2328";
constexpr std::string_view lamp_colour = "#a06a00";
constexpr std::string_view lamp_light = "#ffd54a";
constexpr int lamp_rays = 8;

class Drawing {
 public:
  Drawing(const RunTrace& trace, const PlotCaption& caption)
      : trace_(trace), caption_(caption), view_(range_of(trace)), out_(text_) {
    const double grid = round_length(std::max(view_.range_V.size().maxCoeff() / 4.0, 1e-9));
    x_ticks_ = {view_.range_V.lower.x(), view_.range_V.upper.x(), grid};
    y_ticks_ = {view_.range_V.lower.y(), view_.range_V.upper.y(), grid};
    const std::size_t digits = std::max(y_ticks_.label(y_ticks_.first).size(), y_ticks_.label(y_ticks_.last).size());
    view_.origin = {margin + 10.0 + digit_width * static_cast<double>(digits), header};
  }

  std::string draw() {
    const double width = view_.origin.x() + view_.size.x() + legend_width + margin;
    const double height = header + view_.size.y() + footer;
    fmt::format_to(out_,
                   "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
                   "font-family=\"sans-serif\" font-size=\"14\" fill=\"{2}\">\n",
                   number(width), number(height), ink);
    fmt::format_to(out_, "<rect width=\"{}\" height=\"{}\" rx=\"6\" fill=\"#ffffff\"/>\n", number(width),
                   number(height));
    draw_definitions();
    draw_caption();
    draw_grid();
    text_ += "<g clip-path=\"url(#map)\">\n";
    draw_solids();
    draw_paths();
    draw_starts();
    draw_ends();
    draw_contacts();
    draw_lamps();
    text_ += "</g>\n";
    draw_frame();
    draw_legend();
    text_ += "</svg>\n";
    return std::move(text_);
  }

 private:
  std::string map_rectangle(std::string_view style) const {
    return fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" {}/>", number(view_.origin.x()),
                       number(view_.origin.y()), number(view_.size.x()), number(view_.size.y()), style);
  }

  void draw_definitions() {
    const double r = mark_radius;
    fmt::format_to(out_, "<defs>\n<clipPath id=\"map\">{}</clipPath>\n", map_rectangle(""));
    const auto mark = [&](std::string_view id, std::string_view shape, std::string_view colour) {
      fmt::format_to(out_,
                     "<g id=\"{0}\" stroke-linecap=\"round\"><path d=\"{1}\" fill=\"#ffffff\" stroke=\"#ffffff\" "
                     "stroke-width=\"3.6\"/><path d=\"{1}\" fill=\"none\" stroke=\"{2}\" stroke-width=\"1.7\"/></g>\n",
                     id, shape, colour);
    };
    mark("touches-obstacle", fmt::format("M{1} {1}L{0} {0}M{1} {0}L{0} {1}", number(r), number(-r)),
         obstacle_contact_colour);
    mark("touches-robot", fmt::format("M0 {1}L{0} 0L0 {0}L{1} 0Z", number(1.2 * r), number(-1.2 * r)),
         robot_contact_colour);
    text_ += "</defs>\n";
  }

  void draw_caption() {
    std::string title = caption_.experiment;
    if (title.size() > longest_title) {
      title.resize(longest_title);
      while (!title.empty() && (title.back() & 0xc0) == 0x80) title.pop_back();  // do not cut within a character
      if (!title.empty() && (title.back() & 0x80)) title.pop_back();
      title += "…";
    }
    const std::size_t robots = trace_.robots.size();
    fmt::format_to(out_, "<text x=\"{}\" y=\"30\" font-size=\"19\" font-weight=\"bold\">{}</text>\n",
                   number(view_.origin.x()), svg::escaped(title));
    fmt::format_to(out_,
                   "<text x=\"{}\" y=\"52\" fill=\"{}\">{:.2f} s simulated · {} robot{} · state hash {:016x}</text>\n",
                   number(view_.origin.x()), soft_ink, std::chrono::duration<double>(caption_.time).count(), robots,
                   robots == 1 ? "" : "s", caption_.state_hash);
  }

  void draw_grid() {
    const double left = view_.origin.x();
    const double bottom = view_.origin.y() + view_.size.y();
    std::string lines;
    std::string labels;
    for (std::int64_t i = x_ticks_.first; i <= x_ticks_.last; ++i) {
      const double x = view_({x_ticks_.at(i), 0.0}).x();
      lines += fmt::format("M{} {}v{}", number(x), number(view_.origin.y()), number(view_.size.y()));
      labels += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}{}</text>\n", number(x),
                            number(bottom + 19.0), x_ticks_.label(i), i == x_ticks_.last ? " m" : "");
    }
    for (std::int64_t i = y_ticks_.first; i <= y_ticks_.last; ++i) {
      const double y = view_({0.0, y_ticks_.at(i)}).y();
      lines += fmt::format("M{} {}h{}", number(left), number(y), number(view_.size.x()));
      labels += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>\n", number(left - 8.0),
                            number(y + 4.5), y_ticks_.label(i));
    }
    fmt::format_to(out_, "<g fill=\"{}\" font-size=\"13\">\n{}</g>\n", soft_ink, labels);
    fmt::format_to(out_, "<path d=\"{}\" fill=\"none\" stroke=\"{}\"/>\n", lines, grid_colour);
  }

  void draw_frame() { text_ += map_rectangle(fmt::format("fill=\"none\" stroke=\"{}\"", frame_colour)) + "\n"; }

  void draw_outline(const TracedSolid& solid) {
    const Outline outline = outline_of(solid);
    if (outline.corners_V.empty()) {
      const Vector2d centre = view_(outline.centre_V);
      fmt::format_to(out_, "<circle cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", number(centre.x()), number(centre.y()),
                     number(view_.scale * outline.radius));
      return;
    }
    svg::Points points;
    // Corners are rounded as in the output, so that corners above each other coincide.
    for (const Vector2d& corner_V : outline.corners_V)
      points.push_back((100.0 * view_(corner_V)).array().round() / 100.0);
    fmt::format_to(out_, "<polygon points=\"{}\"/>\n",
                   svg::polygon_points(geometry::convex_hull_2d(std::move(points))));
  }

  bool is_from_the_side() const { return trace_.viewpoint == Viewpoint::side; }
  void draw_parts(const std::vector<TracedSolid>& parts, std::string_view style) {
    fmt::format_to(out_, "<g {}>\n", style);
    for (const TracedSolid& part : parts) draw_outline(part);
    text_ += "</g>\n";
  }

  void draw_solids() {
    const auto draw_all = [&](TracedSolid::Kind kind, std::string_view id, std::string_view style) {
      fmt::format_to(out_, "<g id=\"{}\" {}>\n", id, style);
      for (const TracedSolid& solid : trace_.solids)
        if (solid.kind == kind) draw_outline(solid);
      text_ += "</g>\n";
    };
    draw_all(TracedSolid::Kind::floor, "floors", fmt::format("fill=\"{}\"", floor_colour));
    draw_all(TracedSolid::Kind::obstacle, "obstacles", obstacle_style);
    draw_all(TracedSolid::Kind::object, "objects", object_style);
  }

  bool has_teams() const { return trace_.teams.size() > 1; }

  // Returns a hue that advances from team to team.
  std::string colour_of_team(std::size_t team) const { return svg::colour_of(team, trace_.teams.size()); }

  // Returns the colour of the robot's team if there are several teams. Otherwise returns a hue that advances with the
  // id; every other robot is darker, so that similar hues can be told apart.
  std::string colour(std::size_t robot) const {
    if (has_teams()) return colour_of_team(trace_.robots[robot].team);
    return svg::colour_of(robot, trace_.robots.size());
  }

  // Returns the factor of line widths: 1 up to about 16 robots, then decreasing.
  double crowd_factor() const {
    return std::pow(std::max(1.0, static_cast<double>(trace_.robots.size()) / 16.0), -0.25);
  }

  double shown_radius(const RobotTrace& robot) const { return std::max(smallest_radius, view_.scale * robot.radius); }

  void draw_paths() {
    fmt::format_to(out_,
                   "<g id=\"paths\" fill=\"none\" stroke-width=\"{}\" stroke-opacity=\"{}\" stroke-linejoin=\"round\" "
                   "stroke-linecap=\"round\">\n",
                   number(path_width()), number(0.85 * crowd_factor()));
    for (std::size_t i = 0; i < trace_.robots.size(); ++i) {
      svg::Points points;
      for (const Eigen::Vector2d& point_V : trace_.robots[i].path_V) points.push_back(view_(point_V));
      fmt::format_to(out_, "<path stroke=\"{}\" d=\"{}\"/>\n", colour(i),
                     svg::path_data(svg::simplified(points, path_tolerance)));
    }
    text_ += "</g>\n";
  }
  double path_width() const { return 1.8 * crowd_factor(); }

  void draw_starts() {
    fmt::format_to(out_, "<g id=\"starts\" fill=\"none\" stroke-width=\"{}\">\n", number(1.3 * crowd_factor()));
    for (std::size_t i = 0; i < trace_.robots.size(); ++i) {
      const RobotTrace& robot = trace_.robots[i];
      if (robot.path_V.empty()) continue;
      if (is_from_the_side()) {
        draw_parts(robot.at_start, fmt::format("stroke=\"{}\"", colour(i)));
        continue;
      }
      const Vector2d at = view_(robot.path_V.front());
      fmt::format_to(out_, "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" stroke=\"{}\"/>\n", number(at.x()), number(at.y()),
                     number(shown_radius(robot)), colour(i));
    }
    text_ += "</g>\n";
  }

  void draw_ends() {
    fmt::format_to(out_, "<g id=\"ends\" stroke=\"#ffffff\" stroke-width=\".6\" stroke-linecap=\"round\">\n");
    for (std::size_t i = 0; i < trace_.robots.size(); ++i) {
      const RobotTrace& robot = trace_.robots[i];
      if (robot.path_V.empty()) continue;
      if (is_from_the_side())
        draw_parts(robot.at_end, fmt::format("fill=\"{}\"", colour(i)));
      else
        draw_robot(view_(robot.path_V.back()), shown_radius(robot), robot.end_heading, colour(i), robot.name);
    }
    text_ += "</g>\n";
  }

  void draw_robot(const Vector2d& at, double radius, double heading, std::string_view fill, const std::string& name) {
    text_ += "<g>";
    if (!name.empty()) fmt::format_to(out_, "<title>{}</title>", svg::escaped(name));
    fmt::format_to(out_, "<circle cx=\"{0}\" cy=\"{1}\" r=\"{2}\" fill=\"{3}\"/><path d=\"M{0} {1}l{4} {5}\"",
                   number(at.x()), number(at.y()), number(radius), fill, number(radius * std::cos(heading)),
                   number(-radius * std::sin(heading)));
    fmt::format_to(out_, " stroke-width=\"{}\"/></g>\n", number(std::clamp(0.25 * radius, 0.6, 2.0)));
  }

  void draw_contacts() {
    text_ += "<g id=\"contacts\">\n";
    std::set<std::pair<ContactMark::Kind, std::pair<long, long>>> taken;
    for (const ContactMark& contact : trace_.contacts) {
      const Vector2d at = view_(contact.position_V);
      const std::pair cell(std::lround(at.x() / mark_spacing), std::lround(at.y() / mark_spacing));
      if (taken.insert({contact.kind, cell}).second) draw_mark(contact.kind, at);
    }
    text_ += "</g>\n";
  }

  void draw_mark(ContactMark::Kind kind, const Vector2d& at) {
    fmt::format_to(out_, "<use href=\"#touches-{}\" x=\"{}\" y=\"{}\"/>\n",
                   kind == ContactMark::Kind::obstacle ? "obstacle" : "robot", number(at.x()), number(at.y()));
  }

  void draw_lamps() {
    text_ += "<g id=\"lamps\">\n";
    for (const TracedLamp& lamp : trace_.lamps) draw_lamp(view_(lamp.position_V), lamp.is_on);
    text_ += "</g>\n";
  }

  // Draws a lamp as a sun, filled if it is on.
  void draw_lamp(const Vector2d& at, bool is_on) {
    fmt::format_to(out_, "<path d=\"");
    for (int ray = 0; ray < lamp_rays; ++ray) {
      const double angle = 2.0 * std::numbers::pi * ray / lamp_rays;
      fmt::format_to(out_, "M{} {}l{} {}", number(at.x() + 8.0 * std::cos(angle)),
                     number(at.y() + 8.0 * std::sin(angle)), number(4.0 * std::cos(angle)),
                     number(4.0 * std::sin(angle)));
    }
    fmt::format_to(out_,
                   "\" stroke=\"{0}\" stroke-width=\"1.6\"/><circle cx=\"{1}\" cy=\"{2}\" r=\"5.5\" fill=\"{3}\" "
                   "stroke=\"{0}\" stroke-width=\"1.6\"/>\n",
                   lamp_colour, number(at.x()), number(at.y()), is_on ? lamp_light : "#ffffff");
  }

  bool has_lamp(bool is_on) const {
    return std::any_of(trace_.lamps.begin(), trace_.lamps.end(),
                       [&](const TracedLamp& lamp) { return lamp.is_on == is_on; });
  }
  bool has_object() const {
    return std::any_of(trace_.solids.begin(), trace_.solids.end(),
                       [](const TracedSolid& solid) { return solid.kind == TracedSolid::Kind::object; });
  }
  bool has_contact(ContactMark::Kind kind) const {
    return std::any_of(trace_.contacts.begin(), trace_.contacts.end(),
                       [&](const ContactMark& contact) { return contact.kind == kind; });
  }

  void draw_legend() {
    const double left = view_.origin.x() + view_.size.x() + 20.0;
    Vector2d at(left + 12.0, view_.origin.y() + 13.0);
    const auto add = [&](std::string_view text) {
      fmt::format_to(out_, "<text x=\"{}\" y=\"{}\">{}</text>\n", number(left + 34.0), number(at.y() + 5.0), text);
      at.y() += legend_row;
    };
    constexpr double radius = 7.5;
    text_ += "<g id=\"legend\" font-size=\"13\">\n";
    fmt::format_to(out_, "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"/>\n",
                   number(at.x()), number(at.y()), number(radius), soft_ink);
    add("start");
    if (is_from_the_side()) {
      fmt::format_to(out_, "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\"/>\n", number(at.x()), number(at.y()),
                     number(radius), soft_ink);
    } else {
      text_ += "<g stroke=\"#ffffff\" stroke-linecap=\"round\">";
      draw_robot(at, radius, 0.5, soft_ink, "");
      text_ += "</g>\n";
    }
    add(is_from_the_side() ? "end" : "end and heading");
    fmt::format_to(out_, "<path d=\"M{} {}q7 -9 12 -3t12 -3\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\"/>\n",
                   number(at.x() - 12.0), number(at.y() + 4.0), soft_ink);
    add("path");
    const auto add_box = [&](std::string_view style, std::string_view text) {
      fmt::format_to(out_, "<rect x=\"{}\" y=\"{}\" width=\"18\" height=\"12\" {}/>\n", number(at.x() - 9.0),
                     number(at.y() - 6.0), style);
      add(text);
    };
    add_box(obstacle_style, "obstacle");
    if (has_object()) add_box(object_style, "object, at the end");
    for (const bool is_on : {true, false}) {
      if (!has_lamp(is_on)) continue;
      draw_lamp(at, is_on);
      add(is_on ? "lamp, on at the end" : "lamp, off at the end");
    }
    for (const ContactMark::Kind kind : {ContactMark::Kind::obstacle, ContactMark::Kind::robot}) {
      draw_mark(kind, at);
      add(fmt::format("contact with {}{}", kind == ContactMark::Kind::obstacle ? "obstacle" : "robot",
                      has_contact(kind) ? "" : ": none"));
    }
    const double bottom = view_.origin.y() + view_.size.y() - 2.0 * legend_row;  // the scale bar is below
    for (std::size_t team = 0; has_teams() && team < trace_.teams.size(); ++team) {
      const bool is_full = at.y() + legend_row > bottom && team + 1 < trace_.teams.size();
      if (is_full) {
        add(fmt::format("and {} more teams", trace_.teams.size() - team));
        break;
      }
      fmt::format_to(out_, "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\"/>\n", number(at.x()), number(at.y()),
                     number(radius), colour_of_team(team));
      add(svg::escaped("team " + trace_.teams[team]));
    }
    draw_scale_bar(left);
    text_ += "</g>\n";
  }

  void draw_scale_bar(double left) {
    const double length = round_length((legend_width - 60.0) / view_.scale);
    const double y = view_.origin.y() + view_.size.y() - 6.0;
    const double end = left + view_.scale * length;
    const bool small = length < 1.0 - 1e-9;
    fmt::format_to(out_,
                   "<path d=\"M{0} {1}v8H{2}v-8\" fill=\"none\" stroke=\"{3}\" stroke-width=\"1.5\"/>\n"
                   "<text x=\"{4}\" y=\"{5}\" text-anchor=\"middle\">{6} {7}</text>\n",
                   number(left), number(y - 4.0), number(end), ink, number((left + end) / 2.0), number(y - 5.0),
                   number(small ? 100.0 * length : length), small ? "cm" : "m");
  }

  const RunTrace& trace_;
  const PlotCaption& caption_;
  View view_;
  Ticks x_ticks_{0.0, 0.0, 1.0};
  Ticks y_ticks_{0.0, 0.0, 1.0};
  std::string text_;
  Output out_;
};

}  // namespace

std::string draw_plot(const RunTrace& trace, const PlotCaption& caption) { return Drawing(trace, caption).draw(); }

}  // namespace cohort::tool
