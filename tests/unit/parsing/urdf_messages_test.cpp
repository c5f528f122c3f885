// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/worlds/written_worlds.hpp"

// Tests of messages about parts of a URDF and of named materials. A message has the line and the link as written, also
// if the link is merged over a fixed joint.
namespace cohort::description {
namespace {

class UrdfParts : public Description {
 protected:
  std::filesystem::path write_urdf(const std::string& content) const {
    return write("r.urdf", "<robot name=\"r\">\n" + content + "</robot>\n");
  }
  /// Returns warnings and problems of the robot, one in each line.
  std::string messages_of(const std::string& content) const {
    const std::filesystem::path file = write_urdf(content);
    try {
      return texts_of(parsing::read_world_or_model(file, 1).warnings);
    } catch (const InputError& error) {
      return texts_of(error.problems());
    }
  }
  Model model_of(const std::string& content) const {
    return parsing::read_world_or_model(write_urdf(content), 1).models.at(0);
  }
};

using UrdfMessages = UrdfParts;
using UrdfMaterials = UrdfParts;

void expect_message(const std::string& messages, const std::string& part) {
  EXPECT_NE(messages.find("r.urdf:" + part), std::string::npos) << "expected " << part << "\ngot\n" << messages;
}

std::string inertial(const std::string& mass, const std::string& izz = "1") {
  return "<inertial>\n<mass value=\"" + mass + "\"/>\n<inertia ixx=\"1\" iyy=\"1\" izz=\"" + izz +
         "\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/>\n</inertial>\n";
}
std::string box(const std::string& kind, const std::string& attributes = "", const std::string& content = "") {
  return "<" + kind + attributes + ">\n<geometry><box size=\"1 1 1\"/></geometry>\n" + content + "</" + kind + ">\n";
}
// A base, and the links `mid` and `tip`, which are merged into it. The content of `mid` begins on line 10.
std::string chain(const std::string& of_mid, const std::string& of_tip = "") {
  return "<joint name=\"j2\" type=\"fixed\"><parent link=\"mid\"/><child link=\"tip\"/></joint>\n"
         "<joint name=\"j1\" type=\"fixed\"><parent link=\"base\"/><child link=\"mid\"/></joint>\n"
         "<link name=\"base\"><inertial><mass value=\"2\"/>\n"
         "<inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>\n"
         "<visual><geometry><sphere radius=\"1\"/></geometry></visual>\n"
         "<collision><geometry><sphere radius=\"1\"/></geometry></collision>\n"
         "</link>\n<link name=\"mid\">\n" +
         of_mid + "</link>\n<link name=\"tip\">\n" + of_tip + "</link>\n";
}

TEST_F(UrdfMessages, NameCollisionsThatABlockOfGazeboDoesNotReach) {
  const std::string friction = "<gazebo reference=\"mid\"><mu1>0.5</mu1></gazebo>\n";
  expect_message(messages_of(chain(inertial("1") + box("collision", " name=\"foot\"")) + friction),
                 "14: robot/link[mid]/collision[foot]: <gazebo reference=\"mid\"> has no effect on it, as in Gazebo");
  for (const std::string& content :
       {chain(inertial("1") + box("collision", " name=\"foot\"")), chain(inertial("1") + box("collision")) + friction})
    EXPECT_EQ(messages_of(content).find("has no effect on it"), std::string::npos);
}

TEST_F(UrdfMessages, BlameTheMergedLinkForItsMassAndInertia) {
  expect_message(messages_of(chain(inertial("-1"))),
                 "11: robot/link[mid]/inertial/mass: expected a mass > 0 kg, not -1");
  expect_message(messages_of(chain(inertial("1", "9"))),
                 "12: model[r]/link[mid]/inertial/inertia: no physical body has this inertia");
}

TEST_F(UrdfMessages, NameCollisionsOfMergedLinks) {
  const std::string bad = "<collision name=\"c\">\n<geometry><mesh filename=\"none.obj\"/></geometry>\n</collision>\n";
  expect_message(messages_of(chain(box("collision") + bad)), "14: model[r]/link[mid]/collision[c]/geometry/mesh/uri: ");
  expect_message(messages_of(chain(box("collision"), box("collision") + box("collision") + bad)),
                 "22: model[r]/link[tip]/collision[c]/geometry/mesh/uri: ");
  expect_message(messages_of(chain("<collision>\n<geometry>\n<box size=\"1 -1 1\"/></geometry></collision>\n")),
                 "12: robot/link[mid]/collision/geometry/box: expected 3 numbers > 0");
}

TEST_F(UrdfMessages, NameCollisionsInTheOrderOfTheFileAfterUnnamedOnesOfOtherLinks) {
  const std::string mesh = "<collision>\n<geometry><mesh filename=\"none.obj\"/></geometry>\n</collision>\n";
  const std::string messages = messages_of(chain(box("collision") + mesh, mesh));
  expect_message(messages, "14: model[r]/link[mid]/collision/geometry/mesh/uri: ");
  expect_message(messages, "19: model[r]/link[tip]/collision/geometry/mesh/uri: ");
}

TEST_F(UrdfMessages, NameSensorsAndExtensionsOfMergedLinks) {
  const std::string blocks =
      "<gazebo reference=\"tip\">\n<mu1>-2</mu1>\n"
      "<sensor name=\"odd\" type=\"nose\"/>\n"
      "<sensor name=\"lidar\" type=\"lidar\">\n<lidar>\n<smell>1</smell>\n</lidar>\n</sensor>\n"
      "<sensor name=\"camera\" type=\"camera\" kind=\"1\">\n<update_rate>30</update_rate>\n</sensor>\n"
      "<wind>\n</wind>\n</gazebo>\n";
  const std::string messages = messages_of(chain(box("visual"), box("collision")) + blocks);
  expect_message(messages, "20: model[r]/link[tip]/collision/surface/friction/ode/mu: expected a coefficient >= 0");
  expect_message(messages, "21: model[r]/link[tip]/sensor[odd]: the sensor type 'nose' is not supported");
  expect_message(messages, "24: model[r]/link[tip]/sensor[lidar]/lidar/smell: ignored the unknown element <smell>");
  expect_message(messages, "27: model[r]/link[tip]/sensor[camera]: ignored the unknown attribute 'kind'");
  expect_message(messages, "27: model[r]/link[tip]/sensor[camera]: a sensor of the type 'camera'");
  expect_message(messages, "30: model[r]/link[tip]/wind: ignored the unknown element <wind>");
}

TEST_F(UrdfMessages, NameLimitsAndExtensionsOfJoints) {
  const std::string joint = chain("") + "<link name=\"arm\">\n" + inertial("1") +
                            "</link>\n<joint name=\"j\" type=\"revolute\">\n<parent link=\"tip\"/>\n"
                            "<child link=\"arm\"/>\n<axis xyz=\"0 1 0\"/>\n";
  const std::string limit = "<limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/>\n";
  expect_message(messages_of(joint + limit + "<dynamics damping=\"-1\"/>\n</joint>\n"),
                 "24: model[r]/joint[j]/axis/dynamics/damping: ");
  expect_message(messages_of(joint + "<limit lower=\"x\" effort=\"1\" velocity=\"1\"/>\n</joint>\n"),
                 "23: robot/joint[j]/limit: expected a number for 'lower', not 'x'");
  expect_message(messages_of(joint + limit + "</joint>\n<gazebo reference=\"j\">\n<torque>\n</torque>\n</gazebo>\n"),
                 "26: model[r]/joint[j]/torque: ignored the unknown element <torque>");
}

std::string painted(const std::string& material) { return box("visual", "", material + "\n"); }
Eigen::Vector3d color_of(const Visual& visual) { return visual.color.head<3>(); }

TEST_F(UrdfMaterials, DefinedInALinkColourOthersThatNameThem) {
  const std::string red = "<material name=\"red\"><color rgba=\"0.8 0 0 1\"/></material>";
  const std::string named = "<material name=\"red\"/>";
  for (const auto& [of_mid, of_tip] : {std::pair{red, named}, std::pair{named, red}}) {
    const Model model = model_of(chain(painted(of_mid), painted(of_tip)));
    ASSERT_EQ(model.links[0].visuals.size(), 3u);
    for (const std::size_t i : {1u, 2u}) {
      EXPECT_TRUE(model.links[0].visuals[i].has_color);
      EXPECT_EQ(color_of(model.links[0].visuals[i]), Eigen::Vector3d(1, 0, 0));
    }
  }
}

TEST_F(UrdfMaterials, OfTheRobotComeFirstEvenAfterTheirUse) {
  const Model model = model_of(
      chain(painted("<material name=\"a\"><color rgba=\"0.8 0 0 1\"/></material>"), painted("<material name=\"a\"/>")) +
      "<material name=\"a\"><color rgba=\"0 0 0.8 1\"/></material>\n");
  ASSERT_EQ(model.links[0].visuals.size(), 3u);
  EXPECT_EQ(color_of(model.links[0].visuals[1]), Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(color_of(model.links[0].visuals[2]), Eigen::Vector3d(0, 0, 1));
}

TEST_F(UrdfMaterials, WithoutNamesKeepTheirOwnColours) {
  const Model model = model_of(chain(painted("<material><color rgba=\"0.8 0 0 1\"/></material>"),
                                     painted("<material><color rgba=\"0 0.8 0 1\"/></material>")));
  ASSERT_EQ(model.links[0].visuals.size(), 3u);
  EXPECT_EQ(color_of(model.links[0].visuals[1]), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(color_of(model.links[0].visuals[2]), Eigen::Vector3d(0, 1, 0));
}

}  // namespace
}  // namespace cohort::description
