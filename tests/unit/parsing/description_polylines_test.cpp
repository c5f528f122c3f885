// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "tests/support/worlds/written_worlds.hpp"

// Tests of reading polylines.
namespace cohort::description {
namespace {

using Eigen::Vector3d;

const std::string geometry_path = "world/model[m]/link[l]/collision[c]/geometry";

std::string polyline(const std::vector<std::string>& points, const std::string& height = "0.5") {
  std::string text = "\n<polyline>";
  for (const std::string& point : points) text += "<point>" + point + "</point>";
  return text + "<height>" + height + "</height></polyline>";
}

const std::string corner = polyline({"0 0", "2 0", "2 1", "1 1", "1 2", "0 2"});

std::string falling(const std::string& geometry) {
  std::string link = links("l");
  return "<model name=\"m\">" +
         link.insert(link.find("</link>"), "<collision name=\"c\"><geometry>" + geometry + "</geometry></collision>") +
         "</model>";
}

const Mesh& read_mesh_of(const World& world) { return std::get<Mesh>(world.models[0].links[0].collisions[0].shape); }

using Polylines = Description;

TEST_F(Polylines, AreExactInStaticModelsAndConvexInThoseThatMove) {
  const World still = read(static_model_sdf(collision(corner)));
  EXPECT_TRUE(still.warnings.empty()) << texts_of(still.warnings);
  EXPECT_FALSE(read_mesh_of(still).convex);
  EXPECT_EQ(read_mesh_of(still).triangles->vertices.size(), 12u);
  EXPECT_EQ(read_mesh_of(still).triangles->vertices.front().z(), 0.0);
  EXPECT_EQ(read_mesh_of(still).triangles->vertices.back().z(), 0.5);
  const World loose = read(falling(corner));
  EXPECT_TRUE(read_mesh_of(loose).convex);
  EXPECT_EQ(read_mesh_of(loose).triangles->vertices.size(), 10u);
}

TEST_F(Polylines, AreShownByVisuals) {
  const World world =
      read(static_model_sdf("<link name=\"l\"><visual name=\"v\"><geometry>" + corner + "</geometry></visual></link>"));
  ASSERT_EQ(world.models[0].links[0].visuals.size(), 1u);
  EXPECT_FALSE(std::get<Mesh>(world.models[0].links[0].visuals[0].shape).convex);
}

TEST_F(Polylines, OfOneGeometryAreOneMeshWithHoles) {
  const auto volume_of = [&](const std::string& content) {
    const World world = read(static_model_sdf(collision(content)));
    EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
    const Mesh& mesh = read_mesh_of(world);
    double sixfold = 0.0;
    for (const auto& [a, b, c] : mesh.triangles->triangles)
      sixfold += mesh.triangles->vertices[a].dot(mesh.triangles->vertices[b].cross(mesh.triangles->vertices[c]));
    return sixfold / 6.0;
  };
  const std::string square = polyline({"5 0", "6 0", "6 1", "5 1"});
  EXPECT_NEAR(volume_of(corner + square), 0.5 * (3.0 + 1.0), 1e-12);
  const std::string hole = polyline({"5.2 0.2", "5.8 0.2", "5.8 0.8", "5.2 0.8"});
  const std::string island = polyline({"5.4 0.4", "5.6 0.4", "5.6 0.6", "5.4 0.6"});
  for (const std::string& content : {square + hole, hole + square})
    EXPECT_NEAR(volume_of(content), 0.5 * (1.0 - 0.36), 1e-12);
  for (const std::string& content : {square + hole + island, island + square + hole})
    EXPECT_NEAR(volume_of(content), 0.5 * (1.0 - 0.36 + 0.04), 1e-12);
}

TEST_F(Polylines, GiveHolesTheHeightOfTheOuterOne) {
  const World world = read(static_model_sdf(
      collision(polyline({"5 0", "6 0", "6 1", "5 1"}) + polyline({"5.2 0.2", "5.8 0.2", "5.5 0.8"}, "0.1"))));
  ASSERT_EQ(world.warnings.size(), 1u) << texts_of(world.warnings);
  EXPECT_EQ(world.warnings[0].line, 4);
  EXPECT_NE(world.warnings[0].message.find("it has the height of that one"), std::string::npos);
}

class FlawOfAPolyline : public Polylines, public testing::WithParamInterface<Flaw> {};

TEST_P(FlawOfAPolyline, IsReportedAloneWithFileLineAndElement) {
  expect_only_flaw(GetParam(), write_world(GetParam().content));
}

const std::string bow = polyline({"0 0", "2 0", "0 2", "2 2"});

INSTANTIATE_TEST_SUITE_P(
    Polylines, FlawOfAPolyline,
    testing::Values(Flaw{static_model_sdf(collision(bow)), 3, geometry_path + "/polyline", "cross or touch each other"},
                    Flaw{falling(bow), 3, geometry_path + "/polyline", "cross or touch each other"},
                    Flaw{static_model_sdf(collision(polyline({"0 0", "1 0"}))), 3, geometry_path + "/polyline",
                         "has no area; expected three points that are not on a line"},
                    Flaw{static_model_sdf(collision(polyline({"0 0", "1 0", "0 1"}, "0"))), 3,
                         geometry_path + "/polyline/height", "expected a size > 0 m"},
                    Flaw{static_model_sdf(collision(corner + polyline({"1 1", "4 4", "4 1"}))), 4,
                         geometry_path + "/polyline", "crosses or touches another <polyline>"}));

}  // namespace
}  // namespace cohort::description
