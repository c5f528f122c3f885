// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "tests/support/worlds/written_worlds.hpp"

// Tests of files that violate SDF or URDF, and of their repair.
namespace cohort::description {
namespace {

class MendedFiles : public Description {
 protected:
  static World read_file(const std::string& name) {
    return parsing::read_world_or_model(source / "tests/data/corpus/valid" / name, 1);
  }
  /// Expects each of `parts` in a warning.
  static void expect_warnings(const World& world, const std::vector<std::string>& parts) {
    for (const std::string& part : parts)
      EXPECT_NE(texts_of(world.warnings).find(part), std::string::npos) << part << "\nnot in\n"
                                                                        << texts_of(world.warnings);
  }
};

TEST_F(MendedFiles, TreatALinkCalledWorldAsTheWorld) {
  const World world = read_file("link_called_world.sdf");
  ASSERT_EQ(world.models[0].links.size(), 1u);
  EXPECT_STREQ(world.models[0].why_fixed(), "is attached to the world by a joint");
  EXPECT_EQ(world.models[0].joints[0].parent, Joint::world);
  expect_warnings(world, {"link_called_world.sdf:2: model[m]/link[world]: a link called 'world'"});
}

TEST_F(MendedFiles, FixARootWithoutMassAndGiveOtherLinksAGram) {
  const World world = read_file("links_without_mass.sdf");
  const Model& model = world.models[0];
  ASSERT_EQ(model.links.size(), 3u);
  EXPECT_STREQ(model.why_fixed(), "is attached to the world by a joint");
  EXPECT_EQ(model.links[2].inertial.mass, 1e-3);
  expect_warnings(world,
                  {":2: model[m]/link[base]: a root link without mass", ":4: model[m]: links without mass: 'tip'"});
}

TEST_F(MendedFiles, IgnoreUnknownSensors) {
  expect_warnings(read_file("sensor_of_an_unknown_type.sdf"),
                  {"sensor[air]: the sensor type 'air_speed' is not supported; the sensor is ignored"});
}

TEST_F(MendedFiles, KeepRaySensorsOfEitherName) {
  for (const std::string file : {"ray_sensors.sdf", "ray_sensors.urdf"}) {
    const World world = read_file(file);
    ASSERT_EQ(world.models.at(0).devices.size(), 2u) << file;
    for (const Device& device : world.models[0].devices) EXPECT_EQ(std::get<Lidar>(device).columns, 7u) << file;
  }
}

TEST_F(MendedFiles, NumberCollisionsOfTheSameName) {
  const auto& collisions = read_file("collisions_of_one_name.sdf").models[0].links[0].collisions;
  ASSERT_EQ(collisions.size(), 3u);
  EXPECT_EQ(collisions[1].name, "c_1");
  EXPECT_EQ(collisions[2].name, "c_2");
}

TEST_F(MendedFiles, IgnoreCollisionsOfZeroSize) {
  const World world = read_file("collision_without_a_size.sdf");
  EXPECT_EQ(world.models[0].links[0].collisions.size(), 1u);
  expect_warnings(world, {"collision[e]/geometry/sphere/radius: expected a size > 0 m"});
}

TEST_F(MendedFiles, AcceptAModelWithoutLinks) {
  const World world = read_file("nothing_in_a_model.sdf");
  ASSERT_EQ(world.models.size(), 1u);
  EXPECT_TRUE(world.models[0].links[0].collisions.empty());
}

TEST_F(MendedFiles, ReplaceMissingInertiaByThatOfCollisions) {
  const World world = read_file("no_inertia.urdf");
  const Eigen::Matrix3d& inertia = world.models[0].links[0].inertial.inertia;
  EXPECT_LT((inertia.diagonal() - Eigen::Vector3d(25.0, 10.0, 25.0)).norm(), 1e-9) << inertia;
  expect_warnings(world, {"the inertia of the collisions is used instead"});
}

TEST_F(MendedFiles, UseDefaultAxesForMissingDirections) {
  const World world = read_file("axis_without_a_direction.sdf");
  EXPECT_EQ(world.models[0].joints[0].axis.direction, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(world.models[0].joints[0].second_axis.direction, Eigen::Vector3d(0, 1, 0));
}

TEST_F(MendedFiles, TreatNegativeFrictionAsUnlimited) {
  EXPECT_EQ(read_file("friction_below_zero.sdf").models[0].links[0].collisions[0].surface.friction, 1000.0);
}

TEST_F(MendedFiles, IgnoreInvalidPlugins) {
  const World world = read_file("plugins_with_flaws.sdf");
  EXPECT_FALSE(world.models[0].is_robot());
  expect_warnings(world, {"link_name: missing: the link on which the plugin acts; the plugin is ignored",
                          "left_joint: the model has no joint 'nowhere'"});
}

TEST_F(MendedFiles, TreatASingleLightAsAWorld) {
  const World world = read_file("light_alone.sdf");
  ASSERT_EQ(world.instances.size(), 1u);
  EXPECT_EQ(world.instances[0].name, "sun");
}

TEST_F(MendedFiles, ReadJointTypesOfBullet) {
  const World world = read_file("joints_of_bullet.urdf");
  ASSERT_EQ(world.instances.size(), 2u);
  EXPECT_EQ(world.models[0].joints[0].type, JointType::ball);
  expect_warnings(world, {"robot/joint[k]: planar joints are not supported"});
}

TEST_F(MendedFiles, ReadPlanesOfBullet) {
  const World world = read_file("plane_of_bullet.urdf");
  EXPECT_TRUE(world.models[0].is_static);
  EXPECT_TRUE(std::holds_alternative<Plane>(world.models[0].links[0].collisions.at(0).shape));
}

TEST_F(MendedFiles, UseDefaultsOfOptionalVariables) {
  const World world = read_file("words_of_xacro_in_a_urdf.urdf");
  expect_warnings(world, {"robot/joint[j]/origin: $(optenv …)"});
  EXPECT_LT((world.models[0].links[0].inertial.X_LI.position - Eigen::Vector3d(0.5, 1.0, 1.5)).norm(), 1e-9);
}

TEST_F(MendedFiles, ReadNumbersAndNamesOfAUrdfLikeOtherReaders) {
  const World world = read_file("numbers_with_commas.urdf");
  const Model& model = world.models[0];
  EXPECT_EQ(model.joints[0].name, "b_joint");
  EXPECT_EQ(model.joints[0].axis.lower, -1.57);
  EXPECT_EQ(model.joints[0].axis.direction, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(model.links[1].X_ML.position, Eigen::Vector3d(1, 0, 2));
}

TEST_F(MendedFiles, RejectTextAfterTheRootInFilesForCohort) {
  const auto file = write("w.sdf",
                          "<sdf version=\"1.9\" xmlns:cohort=\"https://cohort-sim.org/sdf/1\"><world "
                          "name=\"w\"/></sdf>\nend\n");
  const auto problems = problems_of([&] { parsing::read_world(file, 1); });
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].message.find("text outside of the root"), std::string::npos);
}

TEST_F(MendedFiles, NumberIncludesOfTheSameName) {
  write_model("crate", links("l"));
  const std::string include = "<include><uri>model://crate</uri></include>\n";
  const World world = parsing::read_world(
      write("w.sdf", "<sdf version=\"1.6\"><world name=\"w\">\n" + include + include + "</world></sdf>\n"), 1);
  ASSERT_EQ(world.instances.size(), 2u);
  EXPECT_EQ(world.instances[1].name, "crate_1");
  expect_warnings(world, {"w.sdf:3: world/include: another model has the name 'crate'"});
}

TEST_F(MendedFiles, ReportOnlyThatAnIncludeIsMissing) {
  const auto problems = problems_of([&] {
    parsing::read_world_or_model(
        write("m.sdf", "<sdf version=\"1.6\"><model name=\"m\"><include>\n<uri>model://nowhere</uri></include>" +
                           links("l") + joint("j", "l", "nowhere::l") + "</model></sdf>\n"),
        1);
  });
  ASSERT_EQ(problems.size(), 1u) << texts_of(problems);
  EXPECT_EQ(problems[0].line, 2);
  EXPECT_EQ(problems[0].element, "model[m]/include/uri");
}

std::string crate(const std::string& name, double x, const std::string& more = "") {
  return "<model name=\"" + name + "\"><pose>" + std::to_string(x) + " 0 0 0 0 0</pose>" + links("a") + more +
         "</model>\n";
}

TEST_F(MendedFiles, ReadEqualModelsOnce) {
  for (const std::string version : {"1.6", "1.9"}) {
    std::string text = "<sdf version=\"" + version + "\"><world name=\"w\">\n";
    for (int i = 0; i < 40; ++i) text += crate("m" + std::to_string(i), i, i % 3 == 2 ? links("b") : "");
    const World world = parsing::read_world(write("w.sdf", text + "</world></sdf>\n"), 1);
    ASSERT_EQ(world.models.size(), 53u);
    EXPECT_EQ(world.instances.back().name, "m39");
    EXPECT_EQ(world.instances.back().X_WM.position.x(), 39.0);
    EXPECT_EQ(world.models[world.instances.back().model].name, "m39");
    EXPECT_EQ(world.instances[3].name, "m2/b");
    EXPECT_EQ(world.models[world.instances[7].model].name, "m5/b");
  }
}

TEST_F(MendedFiles, ReportInvalidNamesWithARemedy) {
  expect_only_flaw({"", 2, "world/model[m]/joint[j]", "there is no link or frame 'z' in the model"},
                   write_world("<model name=\"m\">" + links("ab") + joint("j", "a", "z") + "</model>"));
  expect_only_flaw({"", 2, "world/model[m]/link[a]", "the name 'a' is already used"},
                   write_world("<model name=\"m\">" + links("aa") + "</model>"));
}

TEST_F(MendedFiles, ReportProblemsOfNestedModelsWithPosition) {
  const Flaw flaw{
      "<model name=\"m\"><link name=\"l\"/></model>\n<model name=\"n\">\n<link name=\"l\"><inertial><mass>x"
      "</mass></inertial></link></model>",
      4, "world/model[n]/link[l]/inertial/mass", "cannot have the value 'x'"};
  expect_only_flaw(flaw, write_world(flaw.content));
}

// A folder `robots` with a model `box` is beside the files of these tests.
class IncludedByThirdParties : public MendedFiles {
 protected:
  IncludedByThirdParties() {
    write("robots/box/model.config", "<model><name>Box & more</name><sdf>model.sdf</sdf></model>");
    write("robots/box/model.sdf", in_sdf("<model name=\"box\"><link name=\"l\"/></model>"));
  }
  static std::string in_sdf(const std::string& content, const std::string& version = "1.9") {
    return "<sdf version=\"" + version + "\">\n" + content + "\n</sdf>";
  }
};

TEST_F(IncludedByThirdParties, ABareAmpersandInModelConfigIsRead) {
  const auto file = write("world.sdf", in_sdf("<world name=\"w\"><include><uri>models://box</uri></include></world>"));
  EXPECT_EQ(parsing::read_world(file, 1).instances.at(0).name, "box");
}

TEST_F(IncludedByThirdParties, AFileWithOnlyAnIncludeIsAWorldAndAModel) {
  const auto file = write("only.sdf", in_sdf("<include><uri>model://box</uri><name>crate</name></include>"));
  EXPECT_EQ(parsing::read_world(file, 1).instances.at(0).name, "crate");
  const auto world = write("world.sdf", in_sdf("<world name=\"w\"><include><uri>only.sdf</uri></include></world>"));
  EXPECT_EQ(parsing::read_world(world, 1).instances.at(0).name, "crate");
}

TEST_F(IncludedByThirdParties, NamespacesAreNamed) {
  const auto file =
      write("world.sdf", in_sdf("<world name=\"w\"><include><uri>model://box</uri><namespace>n</namespace></include>"
                                "</world>"));
  expect_warnings(parsing::read_world(file, 1), {"world.sdf:2: world/include/namespace: <namespace> is not supported"});
}

TEST_F(MendedFiles, RenameJointsAndFramesThatHaveTheNameOfALink) {
  const auto file = write("m.sdf",
                          "<sdf version=\"1.6\"><model name=\"m\"><link name=\"a\"/><link name=\"b\"/>\n"
                          "<joint name=\"b\" type=\"fixed\"><parent>a</parent><child>b</child></joint>\n"
                          "<frame name=\"a\"><pose>1 0 0 0 0 0</pose></frame></model></sdf>");
  const World world = parsing::read_world_or_model(file, 1);
  EXPECT_EQ(world.models[0].joints.at(0).name, "b_joint");
  expect_warnings(world, {"m.sdf:2: model[m]/joint[b]: another element of the model has this name; this one is renamed "
                          "to 'b_joint'",
                          "m.sdf:3: model[m]/frame[a]: another element of the model has this name"});
}

TEST_F(MendedFiles, IgnoreAGearboxWithoutItsReference) {
  const auto file =
      write("m.sdf",
            "<sdf version=\"1.9\"><model name=\"m\"><link name=\"a\"/><link name=\"b\"/>\n"
            "<joint name=\"j\" type=\"gearbox\"><parent>a</parent><child>b</child></joint></model></sdf>");
  expect_warnings(parsing::read_world_or_model(file, 1),
                  {"m.sdf:2: model[m]/joint[j]: missing: <gearbox_reference_body>; the gearbox is ignored"});
}

TEST_F(MendedFiles, IgnoreVisualsWhosePoseCannotBeRead) {
  const auto file =
      write("m.sdf",
            "<sdf version=\"1.9\"><model name=\"m\"><link name=\"a\"><visual name=\"v\"><pose>1 2 3 4 5"
            "</pose><geometry><sphere><radius>1</radius></sphere></geometry></visual></link></model></sdf>");
  EXPECT_TRUE(parsing::read_world_or_model(file, 1).models[0].links[0].visuals.empty());
}

TEST_F(MendedFiles, PassOverStatesOfModels) {
  const auto file = write("w.sdf",
                          "<sdf version=\"1.6\"><world name=\"w\"><state world_name=\"w\"><sim_time>none</sim_time>"
                          "<model name=\"m\"/></state></world></sdf>");
  const World world = parsing::read_world(file, 1);
  ASSERT_EQ(world.warnings.size(), 1u) << texts_of(world.warnings);
  expect_warnings(world, {"<state> is not supported"});
}

TEST_F(MendedFiles, ReadTheEncodingAscii) {
  const auto file = write("m.sdf",
                          "<?xml version=\"1.0\" encoding=\"ASCII\"?>\n<sdf version=\"1.9\"><model name=\"m\">"
                          "<link name=\"a\"/></model></sdf>");
  EXPECT_EQ(parsing::read_world_or_model(file, 1).models[0].name, "m");
}

TEST_F(MendedFiles, UseTheWholeMeshForASubmeshThatItsFileDoesNotName) {
  write("tip.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const auto file = write("m.sdf",
                          "<sdf version=\"1.9\"><model name=\"m\"><link name=\"a\"><collision name=\"c\"><geometry>\n"
                          "<mesh><uri>tip.obj</uri><submesh><name>lost</name></submesh></mesh></geometry></collision>"
                          "</link></model></sdf>");
  const World world = parsing::read_world_or_model(file, 1);
  EXPECT_EQ(world.models[0].links[0].collisions.size(), 1u);
  expect_warnings(world, {"has no submesh 'lost'", "the whole mesh is used"});
}

}  // namespace
}  // namespace cohort::description
