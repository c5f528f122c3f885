// SPDX-License-Identifier: Apache-2.0
#include "tools/common/drawing/plot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/files.hpp"
#include "tests/support/robots.hpp"
#include "tools/cli/common/output_file.hpp"
#include "tools/common/drawing/outline.hpp"
#include "tools/common/drawing/svg.hpp"

namespace cohort::tool {
namespace {

using cohort::test::at;
using cohort::test::place;
using cohort::test::static_shape;
using cohort::test::tracked_robot;
using cohort::test::world_with_floor;

constexpr double robot_radius = 0.058;  // tracked_robot()

struct PastRun {
  RunTrace trace;
  PlotCaption caption;
  std::vector<Pose> ends;
  std::string plot() const { return draw_plot(trace, caption); }
};

// Every robot drives straight ahead at 0.1 m/s.
PastRun run(const description::World& world, int ticks, bool recorded = true, Viewpoint viewpoint = Viewpoint::above) {
  description::Experiment experiment;
  experiment.world = world;
  description::Team team{"team", {}, "none", {}};
  for (std::uint32_t robot = 0; robot < world.robots.size(); ++robot) team.robots.push_back(robot);
  experiment.teams.push_back(team);
  Simulation simulation(experiment, 1);
  std::optional<TraceRecorder> recorder;
  if (recorded) recorder.emplace(experiment.world, simulation, viewpoint);
  for (int tick = 0; tick < ticks; ++tick) {
    if (recorder) recorder->boundary();
    for (std::uint32_t robot = 0; robot < simulation.robot_count(); ++robot)
      simulation.set_command(robot, std::vector<double>{0.1, 0.1, 0.0});
    simulation.step();
  }
  PastRun result;
  if (recorder) {
    recorder->boundary();
    result.trace = recorder->finish();
  }
  result.caption = {"straight ahead", simulation.time(), simulation.state_hash()};
  for (std::uint32_t robot = 0; robot < simulation.robot_count(); ++robot)
    result.ends.push_back(simulation.robot_pose(robot));
  return result;
}

// Two posts, a block and two robots, far from the origin.
description::World arena() {
  description::World world = world_with_floor();
  place(world, static_shape("west_post", description::Cylinder{0.05, 0.2}), "west_post", at(100.0, 50.0, 0.1));
  place(world, static_shape("east_post", description::Cylinder{0.05, 0.2}), "east_post", at(102.0, 51.0, 0.1));
  place(world, static_shape("block", description::Box{{0.4, 0.2, 0.2}}), "block", at(101.5, 50.2, 0.1, M_PI / 6.0));
  place(world, tracked_robot(), "first", at(100.3, 50.8, 0.0, 0.3));
  place(world, tracked_robot(), "second", at(101.0, 50.6, 0.0, 2.0));
  return world;
}

std::size_t count(std::string_view text, std::string_view part) {
  std::size_t found = 0;
  for (std::size_t i = text.find(part); i != std::string::npos; i = text.find(part, i + part.size())) ++found;
  return found;
}

// Returns the content of the group of this id.
std::string group(const std::string& plot, const std::string& id) {
  const std::size_t begin = plot.find("<g id=\"" + id + "\"");
  if (begin == std::string::npos) return {};
  std::size_t end = begin;
  for (int depth = 0;;) {
    const std::size_t opened = plot.find("<g", end);
    const std::size_t closed = plot.find("</g>", end);
    if (closed == std::string::npos) return {};
    depth += opened < closed ? 1 : -1;
    end = std::min(opened, closed) + 2;
    if (depth == 0) return plot.substr(begin, closed - begin);
  }
}

// Returns the values of the attribute in each tag that has it, in order.
std::vector<double> values(const std::string& text, const std::string& attribute) {
  std::vector<double> result;
  const std::string start = " " + attribute + "=\"";
  for (std::size_t i = text.find(start); i != std::string::npos; i = text.find(start, i + 1))
    result.push_back(std::stod(text.substr(i + start.size())));
  return result;
}

// The first thing that is no XML, or nothing.
std::string fault_in_xml(const std::string& text) {
  std::vector<std::string> open;
  std::size_t roots = 0;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] != '<') {
      const std::size_t end = std::min(text.find('<', i), text.size());
      const std::string between = text.substr(i, end - i);
      if (count(between, "&") > count(between, "&amp;") + count(between, "&lt;") + count(between, "&gt;") +
                                    count(between, "&quot;") + count(between, "&#39;"))
        return "a bare & in " + between;
      if (open.empty() && between.find_first_not_of(" \n") != std::string::npos)
        return "outside of the root: " + between;
      i = end;
      continue;
    }
    const std::size_t end = text.find('>', i);
    if (end == std::string::npos) return "a tag without an end";
    const std::string tag = text.substr(i + 1, end - i - 1);
    i = end + 1;
    if (tag.find('<') != std::string::npos || count(tag, "\"") % 2 != 0) return "a malformed tag: " + tag;
    const std::string name = tag.substr(0, tag.find_first_of(" /", 1));
    if (name.starts_with('/')) {
      if (open.empty() || "/" + open.back() != name) return "closes what is not open: " + tag;
      open.pop_back();
    } else {
      if (open.empty()) ++roots;
      if (!tag.ends_with('/')) open.push_back(name);
    }
  }
  if (!open.empty()) return "is never closed: " + open.back();
  return roots == 1 ? "" : "has not one root";
}

TEST(RunTraces, HaveWhatHasComeIntoTheWorldInMidRun) {
  description::Experiment experiment;
  experiment.world = arena();
  experiment.teams.push_back({"team", {0, 1}, "none", {}});
  Simulation simulation(experiment, 1);
  TraceRecorder recorder(experiment.world, simulation, Viewpoint::above);
  const auto obstacles = [](const RunTrace& trace) {
    return std::ranges::count(trace.solids, TracedSolid::Kind::obstacle, &TracedSolid::kind);
  };
  simulation.act(SpawnObject{"another_block", "block", at(100.5, 50.85, 0.1)});  // in the way of the first
  for (int tick = 0; tick < 100; ++tick) {
    simulation.set_command(0, std::vector<double>{0.1, 0.1, 0.0});
    simulation.step();
    recorder.boundary();
  }
  const RunTrace trace = recorder.finish();
  EXPECT_EQ(obstacles(trace), 4);
  EXPECT_FALSE(trace.contacts.empty());
}

TEST(Plot, ColoursRobotsByTeamIfThereAreSeveral) {
  description::Experiment experiment;
  experiment.world = arena();
  experiment.teams = {{"reds", {0}, "none", {}}, {"blues & co", {1}, "none", {}}};
  const auto plot_of = [&] {
    Simulation simulation(experiment, 1);
    TraceRecorder recorder(experiment.world, simulation);
    recorder.boundary();
    return draw_plot(recorder.finish(), {});
  };
  const auto colour_in = [](const std::string& plot, const std::string& start) {
    const std::size_t at = plot.find(start, plot.find("id=\"paths\""));
    return at == std::string::npos ? std::string() : plot.substr(at + start.size(), 7);
  };
  const std::string plot = plot_of();
  EXPECT_EQ(fault_in_xml(plot), "");
  const std::string legend = plot.substr(plot.find("id=\"legend\""));
  const std::string first = colour_in(plot, "<path stroke=\"");
  EXPECT_NE(legend.find("fill=\"" + first), std::string::npos) << "the legend has its team's colour";
  EXPECT_NE(legend.find(">team reds</text>"), std::string::npos) << legend;
  EXPECT_NE(legend.find(">team blues &amp; co</text>"), std::string::npos) << legend;

  experiment.teams = {{"all", {0, 1}, "none", {}}};
  EXPECT_EQ(plot_of().find("team all"), std::string::npos) << "one team needs no colour of its own";
}

TEST(Plot, IsWellFormedXml) { EXPECT_EQ(fault_in_xml(run(arena(), 30).plot()), ""); }

TEST(Plot, EscapesNames) {
  PastRun done = run(arena(), 1);
  done.caption.experiment = "a < b & \"c\"";
  done.trace.robots[0].name = "<first>";
  const std::string plot = done.plot();
  EXPECT_EQ(fault_in_xml(plot), "");
  EXPECT_NE(plot.find("a &lt; b &amp; &quot;c&quot;"), std::string::npos);
  EXPECT_NE(plot.find("&lt;first&gt;"), std::string::npos);
}

TEST(Plot, HasOnePathOneStartAndOneEndForEachRobot) {
  const std::string plot = run(arena(), 30).plot();
  EXPECT_EQ(count(group(plot, "paths"), "<path"), 2u);
  EXPECT_EQ(count(group(plot, "starts"), "<circle"), 2u);
  EXPECT_EQ(count(group(plot, "ends"), "<circle"), 2u);
  EXPECT_EQ(count(group(plot, "ends"), "<title>first</title>"), 1u);
}

TEST(Plot, HasEveryObstacleAndNoPlane) {
  const std::string obstacles = group(run(arena(), 0).plot(), "obstacles");
  EXPECT_EQ(count(obstacles, "<circle"), 2u);
  EXPECT_EQ(count(obstacles, "<polygon"), 1u);
}

TEST(Plot, DrawsABoxByItsFourCornersTurnedByItsYaw) {
  const std::string plot = run(arena(), 0).plot();
  const std::string obstacles = group(plot, "obstacles");
  const double scale = values(obstacles, "r")[0] / 0.05;
  const std::size_t begin = obstacles.find("points=\"") + 8;
  std::string points = obstacles.substr(begin, obstacles.find('"', begin) - begin);
  std::replace(points.begin(), points.end(), ',', ' ');
  std::istringstream in(points);
  std::vector<Eigen::Vector2d> corners;
  for (double x = 0.0, y = 0.0; in >> x >> y;) corners.emplace_back(x, y);
  ASSERT_EQ(corners.size(), 4u);
  std::vector<double> edges;
  bool turned = false;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d edge = corners[(i + 1) % 4] - corners[i];
    edges.push_back(edge.norm() / scale);
    if (edges.back() > 0.3) turned = std::abs(-edge.y() / edge.x() - std::tan(M_PI / 6.0)) < 1e-2;
  }
  std::sort(edges.begin(), edges.end());
  EXPECT_NEAR(edges[0], 0.2, 1e-3);
  EXPECT_NEAR(edges[3], 0.4, 1e-3);
  EXPECT_TRUE(turned) << points;
}

// Size of the least upright rectangle around an outline.
Eigen::Vector2d extent_of(const geometry::Shape& shape, const Pose& X_WC) {
  const Outline outline = outline_of({TracedSolid::Kind::obstacle, shape, X_WC});
  if (outline.corners_V.empty()) return Eigen::Vector2d::Constant(2.0 * outline.radius);
  Eigen::Vector2d lower = outline.corners_V[0], upper = outline.corners_V[0];
  for (const Eigen::Vector2d& corner : outline.corners_V) {
    lower = lower.cwiseMin(corner);
    upper = upper.cwiseMax(corner);
  }
  return upper - lower;
}

TEST(Plot, OutlinesShapesAsTheyAreSeenFromAbove) {
  const Pose lying{{0, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2.0, Eigen::Vector3d::UnitY()))};
  EXPECT_TRUE(extent_of(description::Capsule{0.5, 2.0}, {}).isApprox(Eigen::Vector2d(1, 1), 1e-12));
  EXPECT_TRUE(extent_of(description::Capsule{0.5, 2.0}, lying).isApprox(Eigen::Vector2d(3, 1), 1e-12));
  EXPECT_TRUE(extent_of(description::Ellipsoid{{1, 2, 3}}, {}).isApprox(Eigen::Vector2d(2, 4), 1e-12));
  EXPECT_TRUE(extent_of(description::Ellipsoid{{1, 2, 3}}, lying).isApprox(Eigen::Vector2d(6, 4), 1e-12));
  const description::TriangleMesh wedge{{{0, 0, 0}, {3, 0, 0}, {0, 2, 0}, {0, 0, 1}}, {}};
  const description::Mesh mesh{std::make_shared<const description::TriangleMesh>(wedge)};
  EXPECT_TRUE(extent_of(mesh, {}).isApprox(Eigen::Vector2d(3, 2), 1e-12));
  EXPECT_TRUE(extent_of(mesh, lying).isApprox(Eigen::Vector2d(1, 2), 1e-12));
}

TEST(Plot, ShowsRobotsWhereTheyStartAndEndInTheirRealSize) {
  const PastRun done = run(arena(), 200);
  const std::string plot = done.plot();
  // The two posts give the scale: 2 m apart along x, 1 m along y, which goes down on a page.
  const std::string posts = group(plot, "obstacles");
  const std::vector<double> x = values(posts, "cx"), y = values(posts, "cy");
  const double scale = (x[1] - x[0]) / 2.0;
  EXPECT_NEAR(y[0] - y[1], scale, 0.02);
  const auto expect_at = [&](const std::string& circles, std::size_t robot, const Eigen::Vector3d& position_W) {
    EXPECT_NEAR((values(circles, "cx")[robot] - x[0]) / scale, position_W.x() - 100.0, 2e-4);
    EXPECT_NEAR((y[0] - values(circles, "cy")[robot]) / scale, position_W.y() - 50.0, 2e-4);
    EXPECT_NEAR(values(circles, "r")[robot] / scale, robot_radius, 2e-4);
  };
  expect_at(group(plot, "starts"), 0, {100.3, 50.8, 0.0});
  expect_at(group(plot, "starts"), 1, {101.0, 50.6, 0.0});
  for (std::size_t robot : {0u, 1u}) expect_at(group(plot, "ends"), robot, done.ends[robot].position);
  EXPECT_GT((done.ends[0].position - Eigen::Vector3d(100.3, 50.8, 0.0)).norm(), 0.1) << "they did move";
  EXPECT_NEAR(done.trace.robots[1].end_heading, 2.0, 0.05);
}

TEST(Plot, FromTheSideShowsHeightsAndWhatRobotsAreMadeOf) {
  description::World world = world_with_floor();
  place(world, static_shape("block", description::Box{{0.4, 0.2, 0.3}}), "block", at(1.0, 0.5, 0.15));
  place(world, tracked_robot(), "robot", at(0.0, 0.0, 0.0));
  const PastRun done = run(world, 100, true, Viewpoint::side);
  ASSERT_EQ(done.trace.solids.size(), 1u);
  EXPECT_TRUE(done.trace.solids[0].X_VC.position.isApprox(Eigen::Vector3d(1.0, 0.15, -0.5)));
  const RobotTrace& robot = done.trace.robots[0];
  EXPECT_NEAR(robot.path_V.back().x(), done.ends[0].position.x(), 1e-12);
  EXPECT_NEAR(robot.path_V.back().y(), done.ends[0].position.z(), 1e-12);
  // Its tracks, and each of its collisions.
  ASSERT_EQ(robot.at_end.size(), robot.at_start.size());
  double lowest = 1e9, highest = -1e9;
  for (const TracedSolid& solid : robot.at_end) {
    const geometry::Bounds bounds = geometry::bounds_of(solid.shape, solid.X_VC);
    lowest = std::min(lowest, bounds.lower.y());
    highest = std::max(highest, bounds.upper.y());
  }
  EXPECT_NEAR(lowest, 0.0, 1e-3) << "the tracks are on the ground";
  EXPECT_NEAR(highest, 0.095, 1e-3) << "the turret ends here";
  const std::string plot = done.plot();
  EXPECT_EQ(count(group(plot, "ends"), "<polygon"), robot.at_end.size());
  EXPECT_EQ(count(group(plot, "starts"), "<polygon"), robot.at_start.size());
  EXPECT_EQ(count(group(plot, "obstacles"), "<polygon"), 1u);
}

TEST(Plot, ShowsWhichLampsShineAtTheEnd) {
  description::World world = arena();
  const auto add_lamp = [&](const std::string& name, double x, bool is_on) {
    description::Model lamp;
    lamp.name = name;
    lamp.is_static = true;
    lamp.links.push_back({"link", {}, {}, {}});
    lamp.emitters.push_back({name, 0, {}, is_on, description::Light{}});
    test::place(world, lamp, name, test::at(x, 0, 0.3));
  };
  EXPECT_EQ(count(run(world, 1).plot(), "lamp, o"), 0u);
  add_lamp("shining", -0.5, true);
  add_lamp("dark", 0.5, false);
  const std::string plot = run(world, 1).plot();
  EXPECT_EQ(count(plot, "lamp, on at the end"), 1u);
  EXPECT_EQ(count(plot, "lamp, off at the end"), 1u);
  const std::size_t lamps = plot.find("<g id=\"lamps\">");
  ASSERT_NE(lamps, std::string::npos);
  EXPECT_EQ(count(plot.substr(lamps, plot.find("</g>", lamps) - lamps), "<circle"), 2u);
}

TEST(Plot, IsTheSameBytesForTheSameRun) { EXPECT_EQ(run(arena(), 100).plot(), run(arena(), 100).plot()); }

TEST(Plot, ChangesNothingInTheRun) {
  EXPECT_EQ(run(arena(), 100, true).caption.state_hash, run(arena(), 100, false).caption.state_hash);
}

TEST(Plot, SaysWhatWasRun) {
  PastRun done = run(arena(), 50);
  done.caption.state_hash = 0xabcdef;
  const std::string plot = done.plot();
  for (const std::string part : {"straight ahead", "0.50 s simulated", "2 robots", "0000000000abcdef"})
    EXPECT_NE(plot.find(part), std::string::npos) << part;
}

TEST(Plot, OfARunWithoutTicksShowsRobotsAtTheirStart) {
  const std::string plot = run(arena(), 0).plot();
  EXPECT_EQ(fault_in_xml(plot), "");
  EXPECT_EQ(values(group(plot, "starts"), "cx"), values(group(plot, "ends"), "cx"));
  EXPECT_EQ(values(group(plot, "starts"), "cy"), values(group(plot, "ends"), "cy"));
}

TEST(Plot, OfOneRobotWithoutWallsShowsSomeOfTheWorldAroundIt) {
  description::World world = world_with_floor();
  place(world, tracked_robot(), "alone", at(-7.0, 3.0, 0.0));
  const std::string plot = run(world, 0).plot();
  EXPECT_EQ(fault_in_xml(plot), "");
  EXPECT_EQ(plot.find("nan"), std::string::npos);
  EXPECT_EQ(plot.find("inf"), std::string::npos);
  const double radius = values(group(plot, "ends"), "r").at(0);
  EXPECT_GT(radius, 5.0);
  EXPECT_LT(radius, 100.0);
}

TEST(Plot, OfAWorldWithoutRobotsShowsItsObstacles) {
  description::World world = world_with_floor();
  place(world, static_shape("post", description::Cylinder{0.05, 0.2}), "post", at(0, 0, 0.1));
  const std::string plot = run(world, 0).plot();
  EXPECT_EQ(fault_in_xml(plot), "");
  EXPECT_EQ(count(group(plot, "obstacles"), "<circle"), 1u);
}

TEST(Plot, DrawsAFloorMadeOfABoxBeneathEverythingAndDoesNotWidenForIt) {
  description::World world;
  place(world, tracked_robot(), "robot", at(0, 0, 0));
  place(world, static_shape("slab", description::Box{{500.0, 500.0, 1.0}}), "slab", at(0, 0, -0.5));
  const std::string plot = run(world, 10).plot();
  EXPECT_EQ(count(group(plot, "floors"), "<polygon"), 1u);
  EXPECT_EQ(count(group(plot, "obstacles"), "<polygon"), 0u);
  EXPECT_EQ(count(group(plot, "contacts"), "<use"), 0u);
  EXPECT_GT(values(group(plot, "ends"), "r").at(0), 5.0);
}

TEST(Plot, MarksARobotThatLeansOnAWallOnce) {
  description::World world = world_with_floor();
  place(world, tracked_robot(), "robot", at(0, 0, 0));
  place(world, static_shape("wall", description::Box{{0.1, 1.0, 0.2}}), "wall", at(0.16, 0.02, 0.1));
  const PastRun done = run(world, 300);
  ASSERT_GE(done.trace.contacts.size(), 1u);
  EXPECT_LE(done.trace.contacts.size(), 2u) << "at the most one in a square of 5 cm, or a neighbour";
  EXPECT_EQ(done.trace.contacts[0].kind, ContactMark::Kind::obstacle);
  EXPECT_NEAR(done.trace.contacts[0].position_V.x(), 0.11, 0.01);
  EXPECT_GE(count(group(done.plot(), "contacts"), "#touches-obstacle"), 1u);
}

TEST(Plot, MarksAContactOfTwoRobotsOnce) {
  description::World world = world_with_floor();
  place(world, tracked_robot(), "left", at(-0.1, 0.02, 0));
  place(world, tracked_robot(), "right", at(0.1, 0.02, 0, M_PI));
  const PastRun done = run(world, 150);
  ASSERT_GE(done.trace.contacts.size(), 1u);
  EXPECT_LE(done.trace.contacts.size(), 2u);
  for (const ContactMark& contact : done.trace.contacts) EXPECT_EQ(contact.kind, ContactMark::Kind::robot);
}

TEST(Plot, KeepsAStraightPathShort) {
  description::World world = world_with_floor();
  place(world, tracked_robot(), "robot", at(0, 0, 0));
  const PastRun done = run(world, 500);
  EXPECT_GE(done.trace.robots[0].path_V.size(), 51u) << "a sample every 0.1 s";
  EXPECT_LT(group(done.plot(), "paths").size(), 300u);
}

TEST(Svg, SimplifiedPathsStayWithinTheTolerance) {
  svg::Points points;
  for (int i = 0; i <= 1000; ++i) points.emplace_back(0.5 * i, 40.0 * std::sin(0.02 * i));
  const svg::Points kept = svg::simplified(points, 0.3);
  EXPECT_LT(kept.size(), 100u);
  EXPECT_EQ(kept.front(), points.front());
  EXPECT_EQ(kept.back(), points.back());
  for (const svg::Points::value_type& point : points) {
    const auto next = std::find_if(kept.begin() + 1, kept.end(), [&](const auto& k) { return k.x() >= point.x(); });
    const Eigen::Vector2d along = (*next - *(next - 1)).normalized();
    const Eigen::Vector2d off = point - *(next - 1);
    EXPECT_LE(std::abs(along.x() * off.y() - along.y() * off.x()), 0.3 + 1e-9);
  }
}

TEST(Svg, PathDataIsRelativeAndDoesNotDrift) {
  EXPECT_EQ(svg::path_data({{1.0, 2.0}, {1.34, 1.96}, {1.38, 1.96}, {0.0, 12.0}}), "m1 2 .3 0 .1 0-1.4 10");
  EXPECT_EQ(svg::path_data({{5.0, -0.5}, {5.0, -0.5}}), "m5-.5");
}

TEST(Svg, ColoursStayInGamut) {
  EXPECT_EQ(svg::oklch(0.0, 0.0, 0.0), "#000000");
  // Red in OKLCH, by the inverse of the published matrices.
  EXPECT_EQ(svg::oklch(0.62796, 0.25768, 29.234 / 360.0), "#ff0000");
  for (int i = 0; i < 36; ++i) EXPECT_EQ(svg::oklch(0.7, 0.4, i / 36.0).size(), 7u);
}

TEST(OutputFile, IsRefusedBeforehandWhereItCannotBeWritten) {
  const std::filesystem::path folder = ::testing::TempDir();
  EXPECT_THROW(check_writable("the plot", folder), std::runtime_error);
  try {
    check_writable("the plot", folder / "no_such_folder" / "plot.svg");
    FAIL();
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("the plot cannot be written to"), std::string::npos);
    EXPECT_NE(text.find("No such file or directory"), std::string::npos);
  }
}

TEST(OutputFile, CheckingLeavesNoTrace) {
  const std::filesystem::path folder = ::testing::TempDir();
  const std::filesystem::path file = folder / "cohort_output_file_test";
  std::filesystem::remove(file);
  check_writable("the plot", file);
  EXPECT_FALSE(std::filesystem::exists(file));
  write_file("the plot", file, "kept");
  check_writable("the plot", file);
  EXPECT_EQ(test::read_file(file), "kept");
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace cohort::tool
