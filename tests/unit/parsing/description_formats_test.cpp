// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "server/geometry/shapes/convex_hull.hpp"
#include "server/geometry/shapes/mass_properties.hpp"
#include "server/parsing/model/terrain.hpp"
#include "server/parsing/world/read_world.hpp"
#include "tests/support/worlds/written_worlds.hpp"

// Tests of nested models, URDF, older versions, mass from density, and ground from functions.
namespace cohort::description {
namespace {

constexpr double near = 1e-12;

class Formats : public Description {
 protected:
  /// Writes a folder robots/arm: two links, an elbow, a frame `tip` 2 m above, and a motor.
  void write_arm() const {
    write_model("arm",
                links("u") +
                    "<link name=\"l\"><pose>0 0 1 0 0 0</pose><inertial><mass>1</mass><inertia><ixx>1</ixx>"
                    "<iyy>1</iyy><izz>1</izz></inertia></inertial></link>" +
                    joint("elbow", "u", "l", "<xyz>0 1 0</xyz>") +
                    "<frame name=\"tip\" attached_to=\"l\"><pose>0 0 1 0 0 0</pose></frame>"
                    "<cohort:velocity_motor name=\"motor\"><cohort:joint>elbow</cohort:joint><cohort:max_velocity>"
                    "1</cohort:max_velocity><cohort:max_effort>1</cohort:max_effort></cohort:velocity_motor>");
  }
  World read_urdf(const std::string& content) const {
    return parsing::read_world_or_model(write("r.urdf", "<robot name=\"r\">\n" + content + "\n</robot>\n"), 1);
  }
};

void expect_near(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  EXPECT_LT((a - b).norm(), 1e-9) << a.transpose();
}

std::string include(const std::string& uri, const std::string& more = "") {
  return "<include><uri>" + uri + "</uri>" + more + "</include>";
}

// ---- Nested models ----

TEST_F(Formats, FlattenNestedModelsWithScopedNames) {
  write_arm();
  const World world = read(
      "<model name=\"m\">" + links("b") + "<model name=\"n\"><pose>0 2 0 0 0 " + std::to_string(std::numbers::pi / 2) +
      "</pose><link name=\"k\"><pose>1 0 0 0 0 0</pose><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1"
      "</izz></inertia></inertial></link></model>" +
      include("model://arm", "<name>a</name><pose relative_to=\"n::k\">0 0 1 0 0 0</pose>") + joint("i", "b", "n::k") +
      joint("j", "n::k", "a::u") + "</model>");
  const Model& model = world.models[0];
  ASSERT_EQ(model.links.size(), 4u);
  EXPECT_EQ(model.links[1].name, "n::k");
  EXPECT_LT((model.links[1].X_ML.position - Eigen::Vector3d(0, 3, 0)).norm(), 1e-5);
  EXPECT_EQ(model.links[3].name, "a::l");
  EXPECT_LT((model.links[3].X_ML.position - Eigen::Vector3d(0, 3, 2)).norm(), 1e-5);
  ASSERT_EQ(model.joints.size(), 3u);
  EXPECT_EQ(model.joints[2].name, "a::elbow");
  ASSERT_EQ(model.devices.size(), 1u);
  const auto& motor = std::get<VelocityMotor>(model.devices[0]);
  EXPECT_EQ(motor.name, "a::motor");
  EXPECT_EQ(motor.joint, 2u);
}

TEST_F(Formats, SeparateStaticModelsThatAreNestedInMovingOnes) {
  const std::string wall =
      "<model name=\"wall\"><pose>0 0 2 0 0 0</pose><static>true</static><link name=\"w\"><collision "
      "name=\"c\"><geometry>"
      "<plane><normal>0 0 1</normal></plane></geometry></collision></link><link name=\"v\"/>" +
      joint("bolt", "w", "v") + "</model>";
  const World apart =
      read("<model name=\"room\">" + wall + "</model><model name=\"m\">" + links("a") + wall + "</model>");
  EXPECT_TRUE(apart.warnings.empty()) << texts_of(apart.warnings);
  ASSERT_EQ(apart.models.size(), 5u);
  EXPECT_FALSE(apart.models[2].is_static);
  for (const std::size_t fixed : {0, 1, 3, 4}) {
    EXPECT_TRUE(apart.models[fixed].is_static);
    EXPECT_TRUE(apart.models[fixed].joints.empty());
    ASSERT_EQ(apart.models[fixed].links.size(), 1u);
    EXPECT_EQ(apart.models[fixed].links[0].X_ML.position, Eigen::Vector3d(0, 0, 2));
  }
  EXPECT_TRUE(std::holds_alternative<Plane>(apart.models[0].links[0].collisions.at(0).shape));

  for (const bool is_parent : {true, false}) {
    const std::string axis = "<xyz>0 1 0</xyz><limit><lower>-1</lower><upper>2</upper></limit>";
    const std::string hinge = is_parent ? joint("j", "wall::w", "a", axis) : joint("j", "a", "wall::w", axis);
    const World world = read("<model name=\"m\">" + links("a") + wall + hinge + "</model>");
    EXPECT_FALSE(world.models[0].is_static);
    ASSERT_EQ(world.models[0].joints.size(), 1u);
    const Joint& read_joint = world.models[0].joints[0];
    EXPECT_EQ(read_joint.parent, Joint::world);
    EXPECT_EQ(world.models[0].links[read_joint.child].name, "a");
    EXPECT_EQ(read_joint.X_LJ.position, Eigen::Vector3d(0, 0, is_parent ? 0 : 2));
    EXPECT_EQ(read_joint.axis.direction, Eigen::Vector3d(0, is_parent ? 1 : -1, 0));
    EXPECT_EQ(read_joint.axis.lower, -1.0);
    EXPECT_TRUE(world.models[1].is_static);
  }
}

TEST_F(Formats, KeepTheFrameOfAMergedModel) {
  write_arm();
  const World world =
      read("<model name=\"m\">" + std::string("<include merge=\"true\"><uri>model://arm</uri><placement_frame>tip"
                                              "</placement_frame><pose>0 0 5 0 0 0</pose></include></model>"));
  expect_near(world.models[0].links[0].X_ML.position, {0, 0, 3});
  expect_near(world.models[0].links[1].X_ML.position, {0, 0, 4});
}

TEST_F(Formats, PlaceIncludesRelativeToEachOther) {
  write_arm();
  const World world = read(include("model://arm", "<placement_frame>tip</placement_frame><pose>0 0 5 0 0 0</pose>") +
                           include("model://arm", "<name>b</name><pose relative_to=\"arm::tip\">1 0 0 0 0 0</pose>") +
                           include("model://arm", "<name>c</name><pose relative_to=\"b\">1 0 0 0 0 0</pose>") +
                           include("model://arm", "<name>d</name><pose degrees=\"true\">1 2 3 0 0 90</pose>"));
  ASSERT_EQ(world.instances.size(), 4u);
  expect_near(world.instances[0].X_WM.position, {0, 0, 3});
  expect_near(world.instances[1].X_WM.position, {1, 0, 5});
  expect_near(world.instances[2].X_WM.position, {2, 0, 5});
  expect_near(world.instances[3].X_WM.position, {1, 2, 3});
  expect_near(world.instances[3].X_WM.orientation * Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY());
  EXPECT_EQ(world.models.size(), 1u);
}

TEST_F(Formats, KeepTheOrderOfModelsAndIncludes) {
  write_arm();
  const World world = read(include("model://arm", "<name>a</name>") + static_model_sdf(links("l"), "b") +
                           include("model://arm", "<name>c</name><pose relative_to=\"a\"/>") +
                           include("model://arm", "<name>d</name>") + static_model_sdf(links("l"), "e"));
  std::string names;
  for (const Instance& instance : world.instances) names += instance.name;
  EXPECT_EQ(names, "abcde");
}

TEST_F(Formats, ResolvePathsRelativeToTheIncludedFile) {
  write_arm();
  write("parts/inner.sdf", "<sdf version=\"1.9\"><model name=\"i\">" + links("l") + "</model></sdf>");
  write("parts/outer.sdf", "<sdf version=\"1.9\"><model name=\"o\">" + include("inner.sdf") + "</model></sdf>");
  EXPECT_EQ(read(include("parts/outer.sdf")).models[0].links[0].name, "i::l");
}

TEST_F(Formats, TransformAxesOfOldFilesIntoTheFrameOfTheJoint) {
  const World world = parsing::read_world(
      write("world.sdf",
            "<sdf version=\"1.5\"><world name=\"w\"><model name=\"m\">" + links("p") +
                "<link name=\"c\"><pose>0 0 1 0 0 1.5707963267948966</pose></link>" +
                joint("j", "p", "c", "<xyz>1 0 0</xyz><use_parent_model_frame>1</use_parent_model_frame>") +
                "</model></world></sdf>"),
      1);
  expect_near(world.models[0].joints[0].axis.direction, {0, -1, 0});
}

// ---- URDF ----

std::string urdf_link(const std::string& name, const std::string& more = "") {
  return "<link name=\"" + name +
         "\"><inertial><mass value=\"2\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/>"
         "</inertial>" +
         more + "</link>";
}
std::string urdf_joint(const std::string& name, const std::string& type, const std::string& parent,
                       const std::string& child, const std::string& more = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/><origin xyz=\"0 0 1\"/><axis xyz=\"0 1 0\"/>" + more + "</joint>";
}

TEST_F(Formats, ReadLinksJointsAndLimitsOfAUrdf) {
  const World world = read_urdf(
      urdf_link("a") + urdf_link("b", "<collision><geometry><sphere radius=\"0.5\"/></geometry></collision>") +
      urdf_joint("j", "revolute", "a", "b",
                 "<limit lower=\"-1\" upper=\"2\" effort=\"3\" velocity=\"4\"/><dynamics damping=\"0.1\"/>"));
  const Model& model = world.models[0];
  ASSERT_EQ(model.links.size(), 2u);
  expect_near(model.links[1].X_ML.position, {0, 0, 1});
  EXPECT_EQ(model.links[1].inertial.mass, 2.0);
  EXPECT_EQ(std::get<Sphere>(model.links[1].collisions[0].shape).radius, 0.5);
  EXPECT_EQ(model.joints[0].axis.lower, -1.0);
  EXPECT_EQ(model.joints[0].axis.upper, 2.0);
  EXPECT_EQ(model.joints[0].axis.damping, 0.1);
  expect_near(model.joints[0].axis.direction, {0, 1, 0});
}

TEST_F(Formats, ReadDevicesAndSensorsOfAUrdf) {
  const std::string ns = "xmlns:cohort=\"https://cohort-sim.org/sdf/1\"";
  const std::string text =
      "<robot name=\"r\" " + ns + ">" + urdf_link("a") + urdf_link("b") + urdf_joint("j", "continuous", "a", "b") +
      "<gazebo><cohort:velocity_motor name=\"m\"><cohort:joint>j</cohort:joint><cohort:max_velocity>1.5"
      "</cohort:max_velocity><cohort:max_effort>2</cohort:max_effort></cohort:velocity_motor></gazebo>"
      "<gazebo reference=\"b\"><cohort:grip_ring name=\"ring\"><cohort:radius>0.1</cohort:radius></cohort:grip_ring>"
      "<sensor name=\"s\" type=\"imu\"><update_rate>10</update_rate></sensor></gazebo></robot>";
  const World world = parsing::read_world_or_model(write("r.urdf", text), 1);
  const Model& model = world.models[0];
  ASSERT_EQ(model.devices.size(), 2u);
  const auto& motor = std::get<VelocityMotor>(model.devices[0]);
  EXPECT_EQ(motor.joint, 0u);
  EXPECT_EQ(motor.max_velocity, 1.5);
  EXPECT_EQ(motor.max_effort, 2.0);
  EXPECT_TRUE(std::holds_alternative<Imu>(model.devices[1]));
  ASSERT_EQ(model.grip_rings.size(), 1u);
  EXPECT_EQ(model.grip_rings[0].link, 1u);
  EXPECT_EQ(model.grip_rings[0].radius, 0.1);
}

TEST_F(Formats, ReadSurfacesAndGravityOfAUrdf) {
  write("r.urdf",
        "<robot name=\"r\"><link name=\"a\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" "
        "ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial><collision><geometry><box size=\"1 1 1\"/></geometry></collision>"
        "</link><gazebo reference=\"a\"><mu1>0.2</mu1><mu2>0.5</mu2><fdir1>1 0 0</fdir1><kp>1e5</kp><kd>10</kd>"
        "<turnGravityOff>true</turnGravityOff></gazebo></robot>");
  const World world = read("<include><uri>r.urdf</uri></include>");
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  const Link& link = world.models[0].links[0];
  EXPECT_FALSE(link.feels_gravity);
  const Surface& surface = link.collisions[0].surface;
  EXPECT_EQ(surface.friction, 0.2);
  EXPECT_EQ(surface.second_friction, 0.5);
  EXPECT_EQ(surface.friction_direction, Eigen::Vector3d::UnitX());
  EXPECT_EQ(surface.stiffness, 1e5);
  EXPECT_EQ(surface.damping, 10.0);
}

TEST_F(Formats, WarnOfUnsupportedElementsOfAUrdf) {
  const World world =
      read_urdf(urdf_link("a") + urdf_link("b") + urdf_link("c") + urdf_joint("j", "continuous", "a", "b") + "\n" +
                urdf_joint("k", "continuous", "a", "c", "<mimic joint=\"j\" multiplier=\"-0.5\"/>") +
                "\n<transmission name=\"t\"/>\n<link name=\"ghost\"/>\n" + urdf_joint("g", "continuous", "a", "ghost"));
  const std::string warnings = texts_of(world.warnings);
  EXPECT_EQ(warnings.find("mimic"), std::string::npos) << warnings;
  ASSERT_EQ(world.models[0].couplings.size(), 1u);
  EXPECT_EQ(world.models[0].joints[world.models[0].couplings[0].follower].name, "k");
  EXPECT_EQ(world.models[0].joints[world.models[0].couplings[0].leader].name, "j");
  EXPECT_EQ(world.models[0].couplings[0].multiplier, -0.5);
  EXPECT_NE(warnings.find("r.urdf:4: robot/transmission[t]"), std::string::npos) << warnings;
  EXPECT_NE(warnings.find("r.urdf:5: model[r]: links without mass: 'ghost'"), std::string::npos) << warnings;
  EXPECT_EQ(world.models[0].links.size(), 4u);
}

TEST_F(Formats, ReportProblemsWithLinesOfTheUrdf) {
  const auto problems = problems_of([&] {
    read_urdf(
        urdf_link("a") + "\n" +
        urdf_link("b", "\n<collision><geometry>\n<mesh filename=\"package://r/none.stl\"/></geometry></collision>") +
        urdf_joint("j", "continuous", "a", "b"));
  });
  ASSERT_EQ(problems.size(), 1u) << texts_of(problems);
  EXPECT_EQ(problems[0].line, 5) << problems[0].text();
}

TEST_F(Formats, UseTheFirstOfRepeatedElements) {
  const World world = read(
      "<model name=\"m\"><link name=\"l\"><inertial><mass>3</mass>\n<mass>4</mass><inertia/>"
      "</inertial></link></model>");
  EXPECT_EQ(world.models[0].links[0].inertial.mass, 3.0);
  ASSERT_EQ(world.warnings.size(), 1u);
  EXPECT_EQ(world.warnings[0].line, 3);
  EXPECT_EQ(world.warnings[0].element, "world/model[m]/link[l]/inertial/mass");
}

// ---- Mass from density ----

TEST_F(Formats, ComputeTheMassOfALinkFromDensity) {
  const World world = read(
      "<model name=\"m\"><link name=\"l\"><cohort:density>2</cohort:density>"
      "<collision name=\"a\"><pose>1 0 0 0 0 0</pose><geometry><box><size>1 1 1</size></box></geometry></collision>"
      "<collision name=\"b\"><pose>-1 0 0 0 0 0</pose><cohort:density>6</cohort:density><geometry><box><size>1 1 1"
      "</size></box></geometry></collision></link></model>");
  const Inertial& inertial = world.models[0].links[0].inertial;
  EXPECT_NEAR(inertial.mass, 8.0, near);
  expect_near(inertial.X_LI.position, {-0.5, 0, 0});
  EXPECT_NEAR(inertial.inertia(0, 0), 8.0 / 6.0, near);
  EXPECT_NEAR(inertial.inertia(1, 1), 8.0 / 6.0 + 2.0 * 1.5 * 1.5 + 6.0 * 0.5 * 0.5, near);
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
}

// The properties of two halves together equal those of the whole, for any shape.
TEST(MassProperties, AddUp) {
  const geometry::MassProperties half = geometry::mass_properties(Box{{1.0, 2.0, 1.5}}, 3.0);
  const geometry::MassProperties whole = geometry::mass_properties(Box{{1.0, 2.0, 3.0}}, 3.0);
  const geometry::MassProperties both =
      geometry::together({geometry::moved(half, {{0, 0, 0.75}, Eigen::Quaterniond::Identity()}),
                          geometry::moved(half, {{0, 0, -0.75}, Eigen::Quaterniond(0, 1, 0, 0)})});
  EXPECT_NEAR(both.mass, whole.mass, near);
  EXPECT_LT((both.inertia - whole.inertia).norm(), near);
}

// Compares with the sum over many thin discs along z, each pi r(z)^2 dz.
void expect_body_of_revolution(const Shape& shape, double half_length, const std::function<double(double)>& radius) {
  constexpr int count = 20000;
  const double dz = 2.0 * half_length / count;
  double mass = 0.0, about_z = 0.0, across = 0.0;
  for (int i = 0; i < count; ++i) {
    const double z = -half_length + (i + 0.5) * dz;
    const double r2 = radius(z) * radius(z);
    const double disc = std::numbers::pi * r2 * dz;
    mass += disc;
    about_z += disc * r2 / 2.0;
    across += disc * (r2 / 4.0 + z * z);
  }
  const geometry::MassProperties found = geometry::mass_properties(shape, 1.0);
  EXPECT_NEAR(found.mass, mass, 1e-6 * mass);
  EXPECT_NEAR(found.inertia(2, 2), about_z, 1e-6 * about_z);
  EXPECT_NEAR(found.inertia(0, 0), across, 1e-6 * across);
  EXPECT_NEAR(found.inertia(1, 1), across, 1e-6 * across);
}

TEST(MassProperties, EqualIntegralsOverDiscs) {
  expect_body_of_revolution(Cylinder{0.5, 2.0}, 1.0, [](double) { return 0.5; });
  expect_body_of_revolution(Sphere{0.7}, 0.7, [](double z) { return std::sqrt(0.49 - z * z); });
  expect_body_of_revolution(Ellipsoid{{0.3, 0.3, 1.2}}, 1.2,
                            [](double z) { return 0.3 * std::sqrt(1.0 - z * z / 1.44); });
  expect_body_of_revolution(Capsule{0.4, 1.0}, 0.9, [](double z) {
    const double beyond = std::max(0.0, std::abs(z) - 0.5);
    return std::sqrt(0.16 - beyond * beyond);
  });
}

TEST(MassProperties, AreTheSameForABoxAndItsMesh) {
  const Eigen::Vector3d offset(3.0, -2.0, 5.0);
  std::vector<Eigen::Vector3d> corners;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.5, 1.5}) corners.emplace_back(offset + Eigen::Vector3d(x, y, z));
  const Mesh mesh{std::make_shared<const TriangleMesh>(geometry::convex_hull(corners)), true};
  const geometry::MassProperties found = geometry::mass_properties(mesh, 2.0);
  const geometry::MassProperties box = geometry::mass_properties(Box{{1.0, 2.0, 3.0}}, 2.0);
  EXPECT_NEAR(found.mass, box.mass, near);
  expect_near(found.centre, offset);
  EXPECT_LT((found.inertia - box.inertia).norm(), 1e-10);
}

class FlawOfAFormat : public Formats, public ::testing::WithParamInterface<Flaw> {};

TEST_P(FlawOfAFormat, IsReportedAlone) { expect_only_flaw(GetParam(), write_world(GetParam().content)); }

std::string heightmap(const std::string& terrain, const std::string& size = "1 1 1") {
  return static_model_sdf("<link name=\"l\"><collision name=\"c\"><geometry><heightmap><size>" + size +
                          "</size><cohort:terrain>\n" + terrain +
                          "</cohort:terrain></heightmap></geometry></collision></link>");
}

INSTANTIATE_TEST_SUITE_P(
    Formats, FlawOfAFormat,
    ::testing::Values(
        Flaw{"<model name=\"m\"><link name=\"l\"><cohort:density>1</cohort:density></link></model>", 2,
             "world/model[m]/link[l]", "requires a <collision> with a volume"},
        Flaw{"<model name=\"m\"><link name=\"l\">\n<cohort:density>-1</cohort:density><inertial/></link></model>", 3,
             "world/model[m]/link[l]/cohort:density", "expected a number > 0"},
        Flaw{"<model name=\"m\"><link name=\"l\"><cohort:density>1</cohort:density>\n<inertial/><collision name=\"c\">"
             "<geometry><sphere><radius>1</radius></sphere></geometry></collision></link></model>",
             3, "world/model[m]/link[l]/inertial", "not both"},
        Flaw{heightmap("<cohort:kind>sinus</cohort:kind>"), 3,
             "world/model[m]/link[l]/collision[c]/geometry/heightmap/cohort:terrain/cohort:kind",
             "did you mean 'sine'?"},
        Flaw{heightmap("<cohort:kind>sine</cohort:kind><cohort:spacing>1e-6</cohort:spacing>"), 3,
             "world/model[m]/link[l]/collision[c]/geometry/heightmap/cohort:terrain/cohort:spacing",
             "at most 4097 height samples"}));

// ---- Ground from functions ----

TEST_F(Formats, ReadTerrainInsteadOfAnImage) {
  const World world = read(heightmap("<cohort:kind>ramp</cohort:kind><cohort:spacing>0.5</cohort:spacing>", "2 1 0.4"));
  const HeightGrid& grid = *std::get<Heightmap>(world.models[0].links[0].collisions[0].shape).grid;
  EXPECT_EQ(grid.columns, 5u);
  EXPECT_EQ(grid.rows, 3u);
  EXPECT_DOUBLE_EQ(grid.height(0, 1), 0.0);
  EXPECT_DOUBLE_EQ(grid.height(1, 2), 0.1);
  EXPECT_DOUBLE_EQ(grid.height(4, 0), 0.4);
}

TEST(Terrain, HasLevelStepsThatReachTheTop) {
  const HeightGrid grid = parsing::terrain_heights({"steps", {1.0, 0.1, 0.3}, 0.05, 0.25, 0});
  EXPECT_DOUBLE_EQ(grid.height(0, 0), 0.0);
  EXPECT_DOUBLE_EQ(grid.height(4, 0), 0.0);
  EXPECT_DOUBLE_EQ(grid.height(5, 0), 0.1);
  EXPECT_DOUBLE_EQ(grid.height(20, 0), 0.3);
}

TEST(Terrain, HasHeightsWithinItsSizeThatDependOnTheSeed) {
  for (const std::string kind : {"sine", "hills", "rough"}) {
    const HeightGrid grid = parsing::terrain_heights({kind, {3.0, 2.0, 0.5}, 0.1, 0.7, 1});
    const auto [least, greatest] = std::minmax_element(grid.heights.begin(), grid.heights.end());
    EXPECT_GE(*least, 0.0) << kind;
    EXPECT_LE(*greatest, 0.5) << kind;
    EXPECT_GT(*greatest - *least, 0.3) << kind;
    EXPECT_EQ(parsing::terrain_heights({kind, {3.0, 2.0, 0.5}, 0.1, 0.7, 1}).heights, grid.heights) << kind;
    const bool has_seed = kind != "sine";
    EXPECT_EQ(parsing::terrain_heights({kind, {3.0, 2.0, 0.5}, 0.1, 0.7, 2}).heights != grid.heights, has_seed) << kind;
  }
}

// ---- Growth ----

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

TEST_F(Formats, ReadIncludesInLinearTime) {
  const auto time_for = [&](int count) {
    std::string content;
    for (int i = 0; i < count; ++i)
      content += include("model://sbot",
                         "<name>r" + std::to_string(i) + "</name><pose>" + std::to_string(i) + " 0 0 0 0 0</pose>\n");
    const std::filesystem::path file = write_world(content);
    const double before = cpu_seconds();
    EXPECT_EQ(parsing::read_world(file, 1).robots.size(), static_cast<std::size_t>(count));
    return cpu_seconds() - before;
  };
  const double few = time_for(2500);
  const double many = time_for(10000);
  EXPECT_LT(many, 8.0 * few);  // linear: 4 at the most; quadratic: 16
}

}  // namespace
}  // namespace cohort::description
