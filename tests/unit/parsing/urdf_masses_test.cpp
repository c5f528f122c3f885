// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>

#include "tests/support/worlds/written_worlds.hpp"

// Tests of links without mass in a URDF: their joints are kept, and they get the mass of their shapes.
namespace cohort::description {
namespace {

class UrdfMasses : public Description {
 protected:
  World read_urdf(const std::string& content) const {
    return parsing::read_world_or_model(write("r.urdf", "<robot name=\"r\">\n" + content + "\n</robot>\n"), 1);
  }
  void write_cube() const {  // with an edge of 0.2 m
    write("meshes/cube.obj",
          "v -0.1 -0.1 -0.1\nv 0.1 -0.1 -0.1\nv -0.1 0.1 -0.1\nv 0.1 0.1 -0.1\nv -0.1 -0.1 0.1\nv 0.1 -0.1 0.1\nv -0.1 "
          "0.1 0.1\nv 0.1 0.1 0.1\n"
          "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
  }
};

std::string part(const std::string& name, const std::string& content = "") {
  return "<link name=\"" + name + "\">" + content + "</link>\n";
}
std::string shown(const std::string& geometry) { return "<visual><geometry>" + geometry + "</geometry></visual>"; }
std::string solid(const std::string& geometry, const std::string& origin = "") {
  return "<collision>" + origin + "<geometry>" + geometry + "</geometry></collision>";
}
std::string of_mass(const std::string& value) {
  return "<inertial><mass value=\"" + value +
         "\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>";
}
std::string hung(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                 const std::string& origin = "xyz=\"0 0 0.3\"") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/><origin " + origin + "/><axis xyz=\"0 1 0\"/></joint>\n";
}
const Link& link_of(const Model& model, const std::string& name) {
  const auto found = std::ranges::find(model.links, name, &Link::name);
  if (found == model.links.end()) throw std::runtime_error("no link " + name);
  return *found;
}

TEST_F(UrdfMasses, KeepTheJointsOfAnArmWithoutInertials) {
  write_cube();
  const std::string cube = "<mesh filename=\"meshes/cube.obj\"/>";
  std::string arm = part("base_link", shown(cube) + solid(cube));
  std::string last = "base_link";
  for (int i = 1; i <= 6; ++i) {
    const std::string name = "link_" + std::to_string(i);
    arm += part(name, shown(cube) + solid(cube)) + hung("joint_" + std::to_string(i), "revolute", last, name);
    last = name;
  }
  arm += part("flange") + hung("to_flange", "fixed", last, "flange") + part("tool0") +
         hung("to_tool", "fixed", "flange", "tool0") + part("base") + hung("to_base", "fixed", "base_link", "base");
  const World world = read_urdf(arm);
  ASSERT_EQ(world.instances.size(), 1u);
  const Model& model = world.models[0];
  EXPECT_EQ(std::ranges::count(model.joints, JointType::revolute, &Joint::type), 6);
  EXPECT_EQ(model.links.size(), 7u);
  EXPECT_STREQ(model.why_fixed(), "is attached to the world by a joint");
  for (std::size_t i = 1; i < model.links.size(); ++i) {
    EXPECT_NEAR(model.links[i].inertial.mass, 8.0, 1e-5) << model.links[i].name;
    EXPECT_NEAR(model.links[i].inertial.inertia(0, 0), 8.0 * 0.08 / 12.0, 1e-5);
  }
  const auto says = [](const Problem& warning) { return warning.message.find("'link_1'") != std::string::npos; };
  ASSERT_EQ(std::ranges::count_if(world.warnings, says), 1) << texts_of(world.warnings);
  const Problem& warning = *std::ranges::find_if(world.warnings, says);
  for (int i = 1; i <= 6; ++i)
    EXPECT_NE(warning.message.find("'link_" + std::to_string(i) + "'"), std::string::npos) << warning.message;
  EXPECT_NE(warning.message.find("1000 kg/m^3"), std::string::npos) << warning.message;
  EXPECT_EQ(warning.line, 3);
}

TEST_F(UrdfMasses, ComeFromCollisionsOrVisualsOrAreOneGram) {
  const World world = read_urdf(
      part("base", of_mass("1")) + part("a", shown("<box size=\"9 9 9\"/>") + solid("<box size=\"1 2 3\"/>")) +
      hung("i", "revolute", "base", "a") + part("b", shown("<sphere radius=\"0.5\"/>") + of_mass("0")) +
      hung("j", "prismatic", "a", "b") + part("c") + hung("k", "continuous", "b", "c"));
  const Model& model = world.models[0];
  ASSERT_EQ(model.joints.size(), 3u);
  EXPECT_NEAR(link_of(model, "a").inertial.mass, 6000.0, 1e-9);
  EXPECT_NEAR(link_of(model, "b").inertial.mass, 1000.0 * std::numbers::pi / 6.0, 1e-9);
  EXPECT_EQ(link_of(model, "c").inertial.mass, 1e-3);
}

TEST_F(UrdfMasses, UseTheConvexHullOfVisualMeshes) {
  write_cube();
  const World world = read_urdf(part("base", of_mass("1")) + part("a", shown("<mesh filename=\"meshes/cube.obj\"/>")) +
                                hung("i", "revolute", "base", "a"));
  EXPECT_NEAR(link_of(world.models[0], "a").inertial.mass, 8.0, 1e-5);
}

TEST_F(UrdfMasses, NeedOneLinkWithMassAmongFixedJoints) {
  const World world = read_urdf(part("base", of_mass("1")) + part("a", solid("<box size=\"1 1 1\"/>")) +
                                hung("i", "revolute", "base", "a") + part("tip", of_mass("2")) +
                                hung("k", "fixed", "a", "tip", "xyz=\"0 0 1\""));
  EXPECT_EQ(link_of(world.models[0], "a").inertial.mass, 2.0);
  EXPECT_EQ(texts_of(world.warnings).find("without mass"), std::string::npos) << texts_of(world.warnings);
}

TEST_F(UrdfMasses, KeepJointsBelowAFlangeWithoutMass) {
  const World world =
      read_urdf(part("base", of_mass("1")) + part("flange", solid("<box size=\"1 1 1\"/>")) +
                hung("f", "fixed", "base", "flange", "xyz=\"1 0 0\" rpy=\"0 0 1.5707963267948966\"") + part("plate") +
                hung("g", "fixed", "flange", "plate", "xyz=\"1 0 0\"") + part("tool", of_mass("2")) +
                hung("j", "continuous", "plate", "tool", "xyz=\"0 1 0.5\" rpy=\"0.1 0.2 0.3\""));
  const Model& model = world.models[0];
  ASSERT_EQ(model.joints.size(), 1u);
  EXPECT_EQ(model.joints[0].name, "j");
  const Link& tool = link_of(model, "tool");
  EXPECT_LT((tool.X_ML.position - Eigen::Vector3d(0, 1, 0.5)).norm(), 1e-6) << tool.X_ML.position;
  const Eigen::Quaterniond turn = Eigen::AngleAxisd(0.3 + std::numbers::pi / 2, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX());
  EXPECT_LT(tool.X_ML.orientation.angularDistance(turn), 1e-5);
  EXPECT_EQ(link_of(model, "base").inertial.mass, 1.0);
  EXPECT_EQ(link_of(model, "base").collisions.size(), 1u);
}

TEST_F(UrdfMasses, KeepJointsThatGazeboPreserves) {
  const World world =
      read_urdf(part("base", of_mass("1")) + part("a", solid("<box size=\"1 1 1\"/>")) +
                hung("f", "fixed", "base", "a") + part("b", of_mass("1")) + hung("j", "continuous", "a", "b") +
                "<gazebo reference=\"f\"><preserveFixedJoint>true</preserveFixedJoint></gazebo>");
  EXPECT_EQ(world.models[0].joints.size(), 2u);
  EXPECT_NEAR(link_of(world.models[0], "a").inertial.mass, 1000.0, 1e-9);
}

TEST_F(UrdfMasses, AreKeptBelowAMilligram) {
  const World world =
      read_urdf(part("base", of_mass("1")) + part("a", of_mass("1e-7")) + hung("j", "continuous", "base", "a"));
  ASSERT_EQ(world.models[0].joints.size(), 1u);
  EXPECT_LT(link_of(world.models[0], "a").inertial.mass, 1e-5);
}

}  // namespace
}  // namespace cohort::description
