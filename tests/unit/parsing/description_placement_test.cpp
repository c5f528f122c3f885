// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <numbers>

#include "server/parsing/world/read_world.hpp"
#include "server/placement/occupancy.hpp"
#include "tests/support/worlds/written_worlds.hpp"

namespace cohort::description {
namespace {

constexpr double sbot_radius = 0.058;

class Populations : public Description {
 protected:
  static std::string population(int count, const std::string& placement, const std::string& more = "",
                                const std::string& uri = "model://sbot", const std::string& name = "p") {
    return "<cohort:population name=\"" + name + "\"><cohort:uri>" + uri + "</cohort:uri><cohort:count>" +
           std::to_string(count) + "</cohort:count>" + more + "<cohort:placement>" + placement +
           "</cohort:placement></cohort:population>";
  }
  static std::string key(const std::string& name, const std::string& value) {
    return "<cohort:" + name + ">" + value + "</cohort:" + name + ">";
  }
  static std::string box_model(const std::string& size, const std::string& pose, const std::string& name) {
    return static_model_sdf("<pose>" + pose + "</pose>" + collision("<box><size>" + size + "</size></box>"), name);
  }
};

double heading(const Pose& pose) { return 2.0 * std::atan2(pose.orientation.z(), pose.orientation.w()); }
Eigen::Vector2d place_of(const World& world, std::uint32_t robot) { return world.robot(robot).X_WM.position.head<2>(); }
// Returns the difference of two angles, in (-pi, pi].
double apart(double a, double b) { return std::remainder(a - b, 2.0 * std::numbers::pi); }

double nearest_pair(const World& world) {
  double nearest = 1e9;
  for (std::uint32_t a = 0; a < world.robots.size(); ++a)
    for (std::uint32_t b = a + 1; b < world.robots.size(); ++b)
      nearest = std::min(nearest, (place_of(world, a) - place_of(world, b)).norm());
  return nearest;
}

TEST_F(Populations, FormRowsAroundTheCentreOfAGrid) {
  const World world = read(population(
      6, key("grid", key("center", "1 2") + key("spacing", "0.5") + key("columns", "3")) + key("yaw", "0.25")));
  ASSERT_EQ(world.robots.size(), 6u);
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t row = i / 3;
    EXPECT_NEAR(place_of(world, i).x(), 1.0 + 0.5 * (i % 3) - 0.5, 1e-12);
    EXPECT_NEAR(place_of(world, i).y(), 2.0 + 0.5 * row - 0.25, 1e-12);
    EXPECT_NEAR(heading(world.robot(i).X_WM), 0.25, 1e-12);
  }
}

TEST_F(Populations, RotateWithTheirGrid) {
  const World world =
      read(population(4, key("grid", key("spacing", "1") + key("yaw", std::to_string(std::numbers::pi / 2)))));
  EXPECT_LT((place_of(world, 0) - Eigen::Vector2d(0.5, -0.5)).norm(), 1e-5);
  EXPECT_LT((place_of(world, 1) - Eigen::Vector2d(0.5, 0.5)).norm(), 1e-5);
}

TEST_F(Populations, AreEvenlySpacedOnARingWithAllHeadings) {
  const std::string ring = key("ring", key("center", "1 0") + key("radius", "2") + key("first_bearing", "0.3"));
  const World along = read(population(5, ring + key("heading", "along")));
  const World in = read(population(5, ring + key("heading", "towards") + key("point", "1 0")));
  const World out = read(population(5, ring + key("heading", "away") + key("point", "1 0") + key("yaw", "0.1")));
  for (std::uint32_t i = 0; i < 5; ++i) {
    const double bearing = 0.3 + 2.0 * std::numbers::pi * i / 5;
    const Eigen::Vector2d expected(1.0 + 2.0 * std::cos(bearing), 2.0 * std::sin(bearing));
    EXPECT_LT((place_of(along, i) - expected).norm(), 1e-12);
    EXPECT_NEAR(apart(heading(along.robot(i).X_WM), bearing + std::numbers::pi / 2), 0.0, 1e-12);
    EXPECT_NEAR(apart(heading(in.robot(i).X_WM), bearing + std::numbers::pi), 0.0, 1e-12);
    EXPECT_NEAR(apart(heading(out.robot(i).X_WM), bearing + 0.1), 0.0, 1e-12);
  }
}

TEST_F(Populations, IncludeBothEndsOfALine) {
  const World world = read(population(3, key("line", key("from", "0 0") + key("to", "1 1")) + key("heading", "along")));
  EXPECT_EQ(place_of(world, 0), Eigen::Vector2d(0, 0));
  EXPECT_EQ(place_of(world, 1), Eigen::Vector2d(0.5, 0.5));
  EXPECT_EQ(place_of(world, 2), Eigen::Vector2d(1, 1));
  EXPECT_NEAR(heading(world.robot(1).X_WM), std::numbers::pi / 4, 1e-12);
}

TEST_F(Populations, RotateWithTheirFormation) {
  const std::string quarter = key("yaw", std::to_string(std::numbers::pi / 2));
  const World listed = read(population(
      2, key("formation", key("center", "1 1") + key("member", "0 0 0") + key("member", "0.5 0.2 -0.5")) + quarter));
  EXPECT_LT((place_of(listed, 1) - Eigen::Vector2d(0.8, 1.5)).norm(), 1e-5);
  EXPECT_NEAR(heading(listed.robot(1).X_WM), std::numbers::pi / 2 - 0.5, 1e-5);
  const World wedge = read(population(3, key("formation", key("pattern", "wedge") + key("spacing", "0.3"))));
  EXPECT_LT((place_of(wedge, 1) - Eigen::Vector2d(-0.3, 0.3)).norm(), 1e-12);
  EXPECT_LT((place_of(wedge, 2) - Eigen::Vector2d(-0.3, -0.3)).norm(), 1e-12);
}

TEST_F(Populations, MayTouchInAFormationWithoutGap) {
  const World world =
      read(population(10, key("formation", key("pattern", "column") + key("spacing", std::to_string(2 * sbot_radius))) +
                              key("gap", "0")));
  EXPECT_EQ(world.robots.size(), 10u);
}

TEST_F(Populations, HaveTheMeanAndDeviationOfAGaussian) {
  constexpr int count = 2000;
  const World world = read(population(count, key("gaussian", key("center", "5 -3") + key("deviation", "4"))));
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), squares = Eigen::Vector2d::Zero();
  for (std::uint32_t i = 0; i < count; ++i) {
    const Eigen::Vector2d offset = place_of(world, i) - Eigen::Vector2d(5, -3);
    sum += offset;
    squares += offset.cwiseProduct(offset);
  }
  // Five standard errors of the mean, and of the deviation.
  EXPECT_LT((sum / count).cwiseAbs().maxCoeff(), 5.0 * 4.0 / std::sqrt(count));
  const Eigen::Vector2d deviation = (squares / count).cwiseSqrt();
  EXPECT_LT((deviation - Eigen::Vector2d::Constant(4.0)).cwiseAbs().maxCoeff(), 5.0 * 4.0 / std::sqrt(2.0 * count));
  EXPECT_GE(nearest_pair(world), 2 * sbot_radius + 0.01 - 1e-12);
}

TEST_F(Populations, SkipOccupiedPositionsIfTheyMayBeFewer) {
  const std::string places = key("line", key("from", "0 0") + key("to", "4 0"));
  const std::string pillar = box_model("0.2 0.2 1", "2 0 0.5 0 0 0", "pillar");
  const auto problems = problems_of([&] { read(pillar + population(5, places)); });
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].message.find("only 4 of 5 fit"), std::string::npos) << problems[0].message;
  const World world = read(pillar + population(5, places, key("may_be_fewer", "true")));
  ASSERT_EQ(world.robots.size(), 4u);
  EXPECT_EQ(world.robot(2).name, "p/sbot_3");
  EXPECT_EQ(place_of(world, 2).x(), 3.0);
  ASSERT_EQ(world.warnings.size(), 1u);
  EXPECT_NE(world.warnings[0].message.find("only 4 of 5 fit"), std::string::npos) << world.warnings[0].text();
}

TEST_F(Populations, HandleExtremeDistances) {
  for (const std::string& layout :
       {key("uniform", key("min", "-1e308 -1e308") + key("max", "1e308 1e308")),
        key("gaussian", key("deviation", "1e308")), key("grid", key("spacing", "1e308")),
        key("ring", key("radius", "1e308")), key("line", key("from", "-1e308 0") + key("to", "1e308 0"))}) {
    const auto problems = problems_of([&] { read(population(9, layout)); });
    EXPECT_LE(problems.size(), 1u) << texts_of(problems);
    for (const Problem& problem : problems)
      EXPECT_NE(problem.message.find(" of 9 fit"), std::string::npos) << problem.text();
  }
}

TEST_F(Populations, AreNotMovedByLaterPopulations) {
  const std::string area = key("uniform", key("min", "-1 -1") + key("max", "1 1"));
  const World alone = read(population(20, area));
  const World both = read(population(20, area) + population(20, area, "", "model://sbot", "q"));
  ASSERT_EQ(both.robots.size(), 40u);
  for (std::uint32_t i = 0; i < 20; ++i) {
    EXPECT_EQ(alone.robot(i).X_WM.position, both.robot(i).X_WM.position);
    EXPECT_EQ(alone.robot(i).X_WM.orientation.coeffs(), both.robot(i).X_WM.orientation.coeffs());
  }
  EXPECT_GE(nearest_pair(both), 2 * sbot_radius + 0.01 - 1e-12);
}

TEST_F(Populations, TouchTheGroundWithTheirLowestPoint) {
  write_model("ball",
              "<link name=\"l\"><inertial><mass>1</mass><inertia/></inertial><collision name=\"c\"><geometry>"
              "<sphere><radius>0.2</radius></sphere></geometry></collision></link>");
  const World world = read(static_model_sdf(collision("<plane/>"), "floor") +
                           population(1, key("line", key("from", "0 0") + key("to", "1 0")), "", "model://ball"));
  EXPECT_DOUBLE_EQ(world.instances.back().X_WM.position.z(), 0.2);
}

TEST_F(Populations, DoNotPenetrateASlope) {
  const double slope = 0.3;
  const World world =
      read(static_model_sdf("<pose>0 0 0 0 " + std::to_string(slope) + " 0</pose>" + collision("<plane/>"), "floor") +
           population(1, key("line", key("from", "-2 1") + key("to", "-2 1"))));
  EXPECT_NEAR(world.robot(0).X_WM.position.z(), (2.0 + sbot_radius) * std::tan(slope), 1e-5);
}

TEST_F(Populations, UsePlatformsUpToTheLevelAsGround) {
  const std::string platform = box_model("2 2 0.5", "0 0 0.25 0 0 0", "platform");
  const std::string place = key("line", key("from", "0 0") + key("to", "0 0"));
  EXPECT_EQ(problems_of([&] { read(platform + population(1, place)); }).size(), 1u);
  const World world = read(platform + population(1, place + key("level", "0.5")));
  EXPECT_DOUBLE_EQ(world.robot(0).X_WM.position.z(), 0.5);
}

TEST_F(Populations, FitIntoAHollowMeshButNotIntoASolidOne) {
  // Four walls of a room of 2 m by 2 m, 0.5 m high, as a skin, with a floor.
  write("room.obj",
        "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv -1 -1 0.5\nv 1 -1 0.5\nv 1 1 0.5\nv -1 1 0.5\n"
        "f 1 2 3 4\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  // A closed box of the same size.
  write("block.obj",
        "v -1 -1 -0.5\nv 1 -1 -0.5\nv 1 1 -0.5\nv -1 1 -0.5\nv -1 -1 0.5\nv 1 -1 0.5\nv 1 1 0.5\nv -1 1 0.5\n"
        "f 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 5 6 7 8\n");
  const std::string wide = key("uniform", key("min", "-1.5 -1.5") + key("max", "1.5 1.5"));
  const auto mesh = [](const std::string& file) {
    return static_model_sdf(collision("<mesh><uri>" + file + "</uri></mesh>"), "house");
  };
  const World room = read(mesh("room.obj") + population(60, wide));
  int inside = 0;
  for (std::uint32_t i = 0; i < 60; ++i) {
    const Eigen::Vector2d at = place_of(room, i).cwiseAbs();
    if (at.maxCoeff() < 1.0) ++inside;
    const double to_wall = at.maxCoeff() < 1.0 ? 1.0 - at.maxCoeff() : (at.array() - 1.0).max(0.0).matrix().norm();
    EXPECT_GE(to_wall, sbot_radius + 0.01 - 1e-9);
    EXPECT_EQ(room.robot(i).X_WM.position.z(), 0.0);
  }
  EXPECT_GT(inside, 10);
  const World solid = read(mesh("block.obj") + population(30, wide));
  for (std::uint32_t i = 0; i < 30; ++i) EXPECT_GT(place_of(solid, i).cwiseAbs().maxCoeff(), 1.0);
}

TEST_F(Populations, PlaceTenThousandInstancesInASecond) {
  const std::string world = static_model_sdf(collision("<plane/>"), "floor") +
                            population(10'000, key("uniform", key("min", "-20 -20") + key("max", "20 20")));
  const std::filesystem::path file = write_world(world);
  const std::clock_t before = std::clock();
  EXPECT_EQ(parsing::read_world(file, 1).robots.size(), 10'000u);
  const double seconds = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  std::printf("10,000 robots read and placed in %.3f s of CPU\n", seconds);
  RecordProperty("milliseconds", static_cast<int>(1000.0 * seconds));
}

TEST(Triangles, FindTheHighestPointOnADisc) {
  const placement::Triangle slope = {Eigen::Vector3d(-10, -10, -10), Eigen::Vector3d(10, -10, 10),
                                     Eigen::Vector3d(-10, 10, -10)};
  EXPECT_NEAR(*placement::highest_on_disc(slope, {-5, -5}, 1.0), -4.0, 1e-12);  // z is x: up the slope
  EXPECT_NEAR(*placement::highest_on_disc(slope, {10, -10}, 1.0), 10.0, 1e-12);
  EXPECT_NEAR(*placement::highest_on_disc(slope, {0, -10.5}, 1.0), std::sqrt(0.75),
              1e-12);  // where an edge leaves the disc
  EXPECT_FALSE(placement::highest_on_disc(slope, {20, 20}, 1.0));
}

TEST(Triangles, MeasureTheDistanceBetweenTwoHeights) {
  // A triangle that is inclined from the y axis at z = 0 to x = 1 at z = 1.
  const placement::Triangle leaning = {Eigen::Vector3d(0, -5, 0), Eigen::Vector3d(0, 5, 0), Eigen::Vector3d(1, 0, 1)};
  EXPECT_NEAR(placement::distance_between_heights(leaning, 0.0, 0.25, {2, 0}), 1.75, 1e-12);
  EXPECT_EQ(placement::distance_between_heights(leaning, 0.0, 0.25, {0.2, 0}), 0.0);
  EXPECT_NEAR(placement::distance_between_heights(leaning, 0.5, 0.75, {0, 0}), 0.5, 1e-12);
  EXPECT_EQ(placement::distance_between_heights(leaning, 2.0, 3.0, {0, 0}), std::numeric_limits<double>::infinity());
}

class FlawOfAPopulation : public Populations, public testing::WithParamInterface<Flaw> {};

TEST_P(FlawOfAPopulation, IsReportedAloneWithItsLine) {
  const Flaw& flaw = GetParam();
  expect_only_flaw(flaw, write_world(population(2, "\n" + flaw.content)));
}

const std::string in_placement = "world/cohort:population[p]/cohort:placement";
const std::string some_line = "<cohort:line><cohort:from>0 0</cohort:from><cohort:to>1 0</cohort:to></cohort:line>";
INSTANTIATE_TEST_SUITE_P(
    Placements, FlawOfAPopulation,
    testing::Values(
        Flaw{"", 2, in_placement, "one of <cohort:uniform>, <cohort:gaussian>, <cohort:grid>"},
        Flaw{some_line + "<cohort:grid><cohort:spacing>1</cohort:spacing></cohort:grid>", 3,
             in_placement + "/cohort:line", "second layout"},
        Flaw{"<cohort:gausian/>", 3, in_placement + "/cohort:gausian", "did you mean 'cohort:gaussian'?"},
        Flaw{some_line + "<cohort:heading>backwards</cohort:heading>", 3, in_placement + "/cohort:heading",
             "'backwards'"},
        Flaw{some_line + "<cohort:heading>towards</cohort:heading>", 3, in_placement + "/cohort:heading",
             "requires a <cohort:point>"},
        Flaw{some_line + "<cohort:point>0 0</cohort:point>", 3, in_placement + "/cohort:point", "'towards' and 'away'"},
        Flaw{"<cohort:grid><cohort:spacing>1</cohort:spacing></cohort:grid><cohort:heading>along</cohort:heading>", 3,
             in_placement + "/cohort:heading", "'along' can only be used with"},
        Flaw{"<cohort:formation/>", 3, in_placement + "/cohort:formation", "either a <cohort:pattern>"},
        Flaw{"<cohort:formation><cohort:pattern>row</cohort:pattern></cohort:formation>", 3,
             in_placement + "/cohort:formation/cohort:spacing", "missing"},
        Flaw{"<cohort:formation><cohort:member>0 0 0</cohort:member></cohort:formation>", 3,
             in_placement + "/cohort:formation", "has 1 members"},
        Flaw{"<cohort:formation><cohort:member>0 0 1e100</cohort:member></cohort:formation>", 3,
             in_placement + "/cohort:formation/cohort:member", "angles must be from -1e6 to 1e6 rad"},
        Flaw{"<cohort:grid><cohort:spacing>1</cohort:spacing></cohort:grid><cohort:yaw>1e100</cohort:yaw>", 3,
             in_placement + "/cohort:yaw", "expected a number, not '1e100'; angles must be from -1e6 to 1e6 rad"},
        Flaw{"<cohort:formation><cohort:member>0 0</cohort:member></cohort:formation>", 3,
             in_placement + "/cohort:formation/cohort:member", "three numbers 'x y heading'"}));

}  // namespace
}  // namespace cohort::description
