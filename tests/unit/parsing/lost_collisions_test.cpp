// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "server/parsing/experiment/read_experiment.hpp"
#include "tests/support/worlds/written_worlds.hpp"

// Tests that every collision of a moving model is read, or that an error gives the reason and a remedy.
namespace cohort::description {
namespace {

class LostCollisions : public Description {
 protected:
  std::filesystem::path write_urdf(const std::string& mesh, const std::string& name = "urdf/r.urdf") const {
    return write(name,
                 "<robot name=\"r\">\n<link name=\"a\"><inertial><mass value=\"2\"/><inertia ixx=\"1\" iyy=\"1\" "
                 "izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>\n<collision><geometry>\n<mesh filename=\"" +
                     mesh + "\"/></geometry></collision></link></robot>\n");
  }
  void write_tip(const std::string& name) const {
    write(name, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  }
  static void expect_one_collision(const std::filesystem::path& file) {
    const World world = parsing::read_world_or_model(file, 1);
    EXPECT_EQ(world.models[0].links[0].collisions.size(), 1u);
    EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  }
  static void expect_error(const std::filesystem::path& file, int line, const std::vector<std::string>& parts) {
    const auto problems = problems_of([&] { parsing::read_world_or_model(file, 1); });
    ASSERT_EQ(problems.size(), 1u) << texts_of(problems);
    EXPECT_EQ(problems[0].line, line);
    EXPECT_EQ(problems[0].file, file);
    for (const std::string& part : parts)
      EXPECT_NE(problems[0].message.find(part), std::string::npos) << part << "\nnot in\n" << problems[0].text();
  }
};

TEST_F(LostCollisions, IgnoreSlashesBeforeAPackage) {
  write("arm/package.xml", "<package><name>arm</name></package>");
  write_tip("arm/parts/tip.obj");
  for (const char* const uri : {"package://arm/parts/tip.obj", "package:///arm/parts/tip.obj",
                                "package:////arm/parts/tip.obj", "model:///arm/parts/tip.obj"})
    expect_one_collision(write_urdf(uri, "arm/urdf/r.urdf"));
}

TEST_F(LostCollisions, FindPackagesAboveTheFile) {
  write_tip("arm/meshes/tip.obj");
  expect_one_collision(write_urdf("package://arm/meshes/tip.obj", "arm/urdf/r.urdf"));
  expect_one_collision(write_urdf("package://arm/meshes/tip.obj", "arm/models/one/r.urdf"));
  write_tip("models/hand/tip.obj");
  expect_one_collision(write_urdf("package://hand/tip.obj", "arm/urdf/r.urdf"));
}

TEST_F(LostCollisions, UseTheFirstFolderThatHasTheFile) {
  write("arm/arm/model.config", "<model/>");
  write_tip("arm/meshes/tip.obj");
  expect_one_collision(write_urdf("package://arm/meshes/tip.obj", "arm/arm/urdf/r.urdf"));
}

TEST_F(LostCollisions, SuggestARemedyForMissingMeshes) {
  expect_error(write_urdf("package://pkg/meshes/tip.stl"), 4,
               {"there is no 'pkg/meshes/tip.stl'", (folder_ / "urdf").string(), "--allow-files DIR"});
  expect_error(write_urdf("meshes/tip.stl"), 4,
               {"there is no such file", (folder_ / "urdf/meshes/tip.stl").string(), "--missing-meshes box or skip"});
}

// The working directory is another one.
TEST_F(LostCollisions, FindFilesOfRelativeAddressesBesideTheFileAndInItsPackage) {
  write_tip("urdf/meshes/tip.obj");
  write_tip("parts/models/hand/tip.obj");
  for (const char* const uri : {"meshes/tip.obj", "file://meshes/tip.obj"}) expect_one_collision(write_urdf(uri));
  for (const char* const uri : {"hand/tip.obj", "file://hand/tip.obj"})
    expect_one_collision(write_urdf(uri, "parts/urdf/r.urdf"));
  expect_one_collision(write_urdf("file://" + (folder_ / "urdf/meshes/tip.obj").string()));
}

TEST_F(LostCollisions, AreReplacedOrLeftOutOnRequestAlsoWhenReadAgain) {
  const auto collisions_of = [](const World& world) { return world.models.at(0).links.at(0).collisions; };
  for (const auto& [uri, shown] : {std::pair("package://pkg/meshes/tip.stl", "there is no 'pkg/meshes/tip.stl'"),
                                   std::pair("meshes/tip.stl", "there is no such file")}) {
    const auto file = write_urdf(uri);
    setenv("COHORT_MISSING_MESHES", "box", 1);
    const Experiment with_box = parsing::read_experiment(file);
    setenv("COHORT_MISSING_MESHES", "skip", 1);
    const Experiment without = parsing::read_experiment(file);
    unsetenv("COHORT_MISSING_MESHES");

    EXPECT_EQ(with_box.world.replaced_meshes, 1u);
    ASSERT_FALSE(with_box.world.warnings.empty());
    const std::string& warning = with_box.world.warnings[0].message;
    EXPECT_NE(warning.find(shown), std::string::npos) << warning;
    EXPECT_NE(warning.find("a cube of 0.1 m replaces it"), std::string::npos) << warning;
    EXPECT_EQ(without.world.replaced_meshes, 1u);
    for (const World& world : {with_box.world, parsing::read_experiment(with_box.inputs, {}, {}).world}) {
      ASSERT_EQ(collisions_of(world).size(), 1u);
      EXPECT_EQ(std::get<Box>(collisions_of(world)[0].shape).size, Eigen::Vector3d::Constant(0.1));
    }
    for (const World& world : {without.world, parsing::read_experiment(without.inputs, {}, {}).world})
      EXPECT_TRUE(collisions_of(world).empty());
    EXPECT_THROW(parsing::read_experiment(file), InputError);
  }
  write("urdf/damaged.obj", "v 0 0 0");
  setenv("COHORT_MISSING_MESHES", "box", 1);
  EXPECT_THROW(parsing::read_experiment(write_urdf("damaged.obj")), InputError);
  unsetenv("COHORT_MISSING_MESHES");
}

TEST_F(LostCollisions, RejectMeshesOutsideOfTrustedFolders) {
  write_tip("arm/parts/tip.obj");
  const std::string parts = (folder_ / "arm/parts").string();
  const auto file = write_urdf("package://arm/parts/tip.obj", "arm/urdf/r.urdf");
  expect_error(file, 4, {"--allow-files " + parts, parts + "/tip.obj"});
  setenv("COHORT_ALLOW_FILES", (folder_ / "arm").c_str(), 1);
  expect_one_collision(file);
  unsetenv("COHORT_ALLOW_FILES");
}

TEST_F(LostCollisions, FindPackagesInAllowedFolders) {
  write_tip("elsewhere/arm/parts/tip.obj");
  const auto file = write_urdf("package://arm/parts/tip.obj");
  for (const char* const allowed : {"elsewhere", "elsewhere/arm"}) {
    setenv("COHORT_ALLOW_FILES", (folder_ / allowed).c_str(), 1);
    expect_one_collision(file);
  }
  unsetenv("COHORT_ALLOW_FILES");
}

TEST_F(LostCollisions, RejectUnsupportedShapes) {
  const auto file = write("w.sdf", "<sdf version=\"1.9\"><world name=\"w\">\n<model name=\"m\">" + links("a") +
                                       joint("j", "a", "l") + collision("<plane/>") + "</model></world></sdf>");
  expect_error(file, 2, {"a plane requires <static>true</static>"});
}

TEST_F(LostCollisions, MakeFlatMeshesAMillimetreThick) {
  write("meshes/plate.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
  expect_one_collision(write_urdf("package://meshes/plate.obj"));
}

TEST_F(LostCollisions, AreWarningsInStaticModels) {
  const World world = parsing::read_world(
      write("w.sdf", "<sdf version=\"1.9\"><world name=\"w\">\n<model name=\"m\"><static>1</static>" +
                         collision("<mesh><uri>meshes/none.stl</uri></mesh>") + "</model></world></sdf>"),
      1);
  EXPECT_EQ(world.warnings.size(), 1u);
}

TEST_F(LostCollisions, UseTheFirstOfTwoShapes) {
  const auto file = write(
      "r.urdf",
      "<robot name=\"r\"><link name=\"a\"><inertial><mass value=\"2\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" "
      "ixy=\"0\" "
      "ixz=\"0\" iyz=\"0\"/></inertial><collision><geometry><box size=\"1 1 1\"/><sphere radius=\"1\"/></geometry>"
      "</collision></link></robot>");
  const World world = parsing::read_world_or_model(file, 1);
  ASSERT_EQ(world.models[0].links[0].collisions.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<Box>(world.models[0].links[0].collisions[0].shape));
  EXPECT_EQ(world.warnings.size(), 1u);
}

}  // namespace
}  // namespace cohort::description
