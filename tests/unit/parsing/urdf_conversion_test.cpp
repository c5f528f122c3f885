// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <variant>

#include "tests/support/worlds/written_worlds.hpp"

// Tests of the conversion of a URDF: links that are merged over fixed joints, <gazebo> blocks, and mistakes whose
// meaning is clear.
namespace cohort::description {
namespace {

class UrdfConversion : public Description {
 protected:
  World read_urdf(const std::string& content) const {
    return parsing::read_world_or_model(write("r.urdf", "<robot name=\"r\">\n" + content + "\n</robot>\n"), 1);
  }
  std::string problems_of(const std::string& content) const {
    try {
      read_urdf(content);
      return "";
    } catch (const InputError& error) {
      return texts_of(error.problems());
    }
  }
};

std::string mass_element(const std::string& mass, const std::string& moment, const std::string& origin = "") {
  return "<inertial>" + origin + "<mass value=\"" + mass + "\"/><inertia ixx=\"" + moment + "\" iyy=\"" + moment +
         "\" izz=\"" + moment + "\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>";
}
std::string link_element(const std::string& name, const std::string& content) {
  return "<link name=\"" + name + "\">" + content + "</link>\n";
}
std::string collision_element(const std::string& shape, const std::string& attributes = "") {
  return "<collision" + attributes + "><geometry>" + shape + "</geometry></collision>";
}
std::string joint_element(const std::string& name, const std::string& type, const std::string& parent,
                          const std::string& child, const std::string& content = "<origin xyz=\"0 0 1\"/>") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/><axis xyz=\"0 1 0\"/>" + content + "</joint>\n";
}
// A base, and a tip that is merged into it, 1 m higher.
std::string merged(const std::string& of_tip, const std::string& of_base = mass_element("1", "0.01")) {
  return link_element("base", of_base) + link_element("tip", of_tip) + joint_element("glue", "fixed", "base", "tip");
}
const Link& find_link(const World& world, const std::string& name) {
  const std::vector<Link>& links = world.models.at(0).links;
  const auto found = std::ranges::find(links, name, &Link::name);
  if (found == links.end()) throw std::runtime_error("no link " + name);
  return *found;
}

TEST_F(UrdfConversion, AddsMassesOfMergedLinksInFullPrecision) {
  const Inertial& sum = find_link(read_urdf(merged(mass_element("0.3333333333333333", "0.02"))), "base").inertial;
  EXPECT_EQ(sum.mass, 1.0 + 0.3333333333333333);
  EXPECT_DOUBLE_EQ(sum.X_LI.position.z(), 0.25);
  EXPECT_NEAR(sum.inertia(0, 0), 0.03 + 0.25 * 0.25 + 0.75 * 0.75 / 3.0, 1e-15);
  EXPECT_NEAR(sum.inertia(2, 2), 0.03, 1e-15);
}

TEST_F(UrdfConversion, KeepsMassesOfANanogram) {
  const World world = read_urdf(merged(mass_element("1e-9", "0"), mass_element("0.027", "1.4e-5")));
  EXPECT_NEAR(find_link(world, "base").inertial.mass, 0.027000001, 1e-16);
  EXPECT_EQ(texts_of(world.warnings), "");
}

TEST_F(UrdfConversion, KeepsCapsulesAndSurfacesOfNamedCollisionsInMergedLinks) {
  const World world = read_urdf(merged(collision_element("<capsule radius=\"0.1\" length=\"0.5\"/>", " name=\"cap\"") +
                                       "<contact><lateral_friction value=\"0.25\"/></contact>"));
  const std::vector<Collision>& collisions = find_link(world, "base").collisions;
  ASSERT_EQ(collisions.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<Capsule>(collisions[0].shape));
  EXPECT_EQ(collisions[0].surface.friction, 0.25);
  EXPECT_EQ(collisions[0].X_LC.position.z(), 1.0);
}

TEST_F(UrdfConversion, KeepsThePitchOfCollisionsNear90Degrees) {
  const World world = read_urdf(link_element(
      "base", mass_element("1", "1") + "<collision><origin rpy=\"0 1.57 0\"/><geometry><box size=\"1 1 1\"/>"
                                       "</geometry></collision>"));
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.57, Eigen::Vector3d::UnitY()));
  EXPECT_LT(find_link(world, "base").collisions[0].X_LC.orientation.angularDistance(turn), 1e-7);
}

TEST_F(UrdfConversion, MergesUnlessAFlagOfTheJointIsTrue) {
  const auto links = [&](const std::string& flag) {
    return read_urdf(merged(mass_element("1", "0.01")) + "<gazebo reference=\"glue\">" + flag + "</gazebo>")
        .models.at(0)
        .links.size();
  };
  EXPECT_EQ(links("<preserveFixedJoint>true</preserveFixedJoint>"), 2u);
  EXPECT_EQ(links("<preserveFixedJoint>false</preserveFixedJoint>"), 1u);
  EXPECT_EQ(links("<disableFixedJointLumping value=\"true\"/>"), 2u);
  EXPECT_EQ(links("<disableFixedJointLumping>0</disableFixedJointLumping>"), 1u);
}

TEST_F(UrdfConversion, MovesSensorsAndDevicesWithMergedLinks) {
  const World world = read_urdf(
      merged("") +
      "<gazebo reference=\"tip\"><sensor name=\"s\" type=\"imu\"><pose>0.1 0.2 0.30000000000000004 0 0 0</pose>"
      "</sensor></gazebo>");
  const auto& devices = world.models.at(0).devices;
  ASSERT_EQ(devices.size(), 1u);
  const Eigen::Vector3d position = std::get<Imu>(devices[0]).X_LS.position;
  EXPECT_LT((position - Eigen::Vector3d(0.1, 0.2, 1.3)).norm(), 1e-15) << position;
}

TEST_F(UrdfConversion, AttachesJointsOfGazeboBlocksToTheLinkThatCarriesAMergedOne) {
  const World world = read_urdf(merged(mass_element("1", "0.01")) + link_element("arm", mass_element("1", "0.01")) +
                                joint_element("j", "continuous", "base", "arm") +
                                "<gazebo><joint name=\"loop\" type=\"revolute\"><parent>arm</parent><child>tip</child>"
                                "<axis><xyz>0 0 1</xyz></axis></joint></gazebo>");
  EXPECT_EQ(world.models.at(0).links.size(), 2u);
  EXPECT_EQ(texts_of(world.warnings), "");
}

TEST_F(UrdfConversion, IgnoresJointsOfGazeboBlocksWithTheNameOfAnotherJoint) {
  const World world =
      read_urdf(link_element("base", mass_element("1", "1")) + link_element("arm", mass_element("1", "1")) +
                joint_element("j", "continuous", "base", "arm") +
                "<gazebo><joint name=\"j\" type=\"fixed\"><parent>base</parent><child>arm</child></joint>"
                "</gazebo>");
  ASSERT_EQ(world.models.at(0).joints.size(), 1u);
  EXPECT_EQ(world.models[0].joints[0].type, JointType::revolute);
  EXPECT_NE(texts_of(world.warnings).find("gazebo/joint[j]: another joint has this name"), std::string::npos);
}

TEST_F(UrdfConversion, FindsCollisionsOfContactSensorsInMergedLinks) {
  const std::string box = "<box size=\"1 1 1\"/>";
  const World world = read_urdf(merged(collision_element(box) + collision_element(box, " name=\"c\"")) +
                                "<gazebo reference=\"tip\"><sensor name=\"s\" type=\"contact\"><contact><collision>"
                                "tip_fixed_joint_lump__c_collision_1</collision></contact></sensor></gazebo>");
  ASSERT_EQ(world.models.at(0).devices.size(), 1u) << texts_of(world.warnings);
  EXPECT_EQ(std::get<ContactSensor>(world.models[0].devices[0]).collision, 1u);
}

TEST_F(UrdfConversion, AcceptsCfmDampingAsAFlag) {
  const std::string robot = link_element("base", mass_element("1", "1")) + link_element("arm", mass_element("1", "1")) +
                            joint_element("j", "continuous", "base", "arm") + "<gazebo reference=\"j\">";
  EXPECT_EQ(problems_of(robot + "<cfmDamping>true</cfmDamping></gazebo>"), "");
  EXPECT_NE(problems_of(robot + "<stopCfm>true</stopCfm></gazebo>").find("expected a number for 'stopCfm'"),
            std::string::npos);
}

TEST_F(UrdfConversion, AcceptsInertialsWithoutMassOrInertia) {
  const World heavy = read_urdf(link_element(
      "base", "<inertial><mass value=\"3.5\"/></inertial>" + collision_element("<sphere radius=\"0.1\"/>")));
  EXPECT_EQ(find_link(heavy, "base").inertial.mass, 3.5);
  EXPECT_NEAR(find_link(heavy, "base").inertial.inertia(0, 0), 0.4 * 3.5 * 0.01, 1e-12);
  EXPECT_NE(texts_of(heavy.warnings).find("has no <inertia>"), std::string::npos) << texts_of(heavy.warnings);
  const World light =
      read_urdf(merged("<inertial><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>"));
  EXPECT_EQ(find_link(light, "base").inertial.mass, 1.0);
  EXPECT_NE(texts_of(light.warnings).find("has no <mass>"), std::string::npos) << texts_of(light.warnings);
}

TEST_F(UrdfConversion, ReadsTheValidPartOfNumbers) {
  const World world =
      read_urdf(link_element("base", mass_element("1", "1")) + link_element("arm", mass_element("1", "1")) +
                joint_element("j", "continuous", "base", "arm", "<origin xyz=\"0 0 1\" rpy=\"0 0.5 0 0\"/>") +
                link_element("tip", mass_element("2.5&quot;", "1")) + joint_element("k", "continuous", "arm", "tip"));
  EXPECT_EQ(find_link(world, "tip").inertial.mass, 2.5);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()));
  EXPECT_LT(find_link(world, "arm").X_ML.orientation.angularDistance(turn), 1e-7);
  const std::string warnings = texts_of(world.warnings);
  EXPECT_NE(warnings.find("expected a number, not '2.5\"'; read as '2.5'"), std::string::npos) << warnings;
  EXPECT_NE(warnings.find("expected 3 numbers separated by spaces, not '0 0.5 0 0'; read as '0 0.5 0'"),
            std::string::npos)
      << warnings;
  EXPECT_NE(problems_of(link_element("base", mass_element("1,5", "1"))).find("not '1,5'"), std::string::npos);
}

TEST_F(UrdfConversion, IgnoresMimicOfAMissingJoint) {
  const World world =
      read_urdf(link_element("base", mass_element("1", "1")) + link_element("arm", mass_element("1", "1")) +
                joint_element("j", "continuous", "base", "arm", "<mimic joint=\"none\"/>"));
  EXPECT_EQ(world.models.at(0).joints.size(), 1u);
  EXPECT_NE(texts_of(world.warnings).find("the robot has no joint 'none'"), std::string::npos);
}

TEST_F(UrdfConversion, SaysThatAFileIsAnSrdf) {
  EXPECT_NE(problems_of("<group name=\"arm\"/>").find("this is an SRDF"), std::string::npos);
}

}  // namespace
}  // namespace cohort::description
