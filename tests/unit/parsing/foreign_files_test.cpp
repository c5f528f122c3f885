// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "server/parsing/experiment/read_experiment.hpp"
#include "server/parsing/world/read_world.hpp"
#include "tests/support/worlds/written_worlds.hpp"

// Tests of files that were not written for Cohort: what affects motion is used or reported, and the rest never prevents
// reading them.
namespace cohort::description {
namespace {

class ForeignFiles : public Description {
 protected:
  /// The content of <world> starts on line 2 and has no `cohort:` elements.
  World read_foreign(const std::string& content, const std::string& version = "1.9") const {
    return parsing::read_world(
        write("world.sdf", "<sdf version=\"" + version + "\"><world name=\"w\">\n" + content + "\n</world></sdf>\n"),
        1);
  }
  World read_urdf(const std::string& content) const {
    return parsing::read_world_or_model(write("r.urdf", "<robot name=\"r\">\n" + content + "\n</robot>\n"), 1);
  }
};

std::string weighing(const std::string& name, const std::string& more = "") {
  return "<link name=\"" + name +
         "\"><inertial><mass value=\"2\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/>"
         "</inertial>" +
         more + "</link>";
}
std::string joined(const std::string& name, const std::string& type, const std::string& parent,
                   const std::string& child, const std::string& more = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/><origin xyz=\"0 0 1\"/><axis xyz=\"0 1 0\"/>" + more + "</joint>";
}

void expect_warning(const World& world, const std::string& part) {
  EXPECT_NE(texts_of(world.warnings).find(part), std::string::npos) << "expected " << part << "\ngot\n"
                                                                    << texts_of(world.warnings);
}

TEST_F(ForeignFiles, ReportEachUnknownNameOnce) {
  const World world =
      read_foreign("<model name=\"m\" odd=\"1\"><static>1</static>\n" +
                   collision("<sphere><radius>1</radius></sphere>\n<new_word>1</new_word>") + "<new_word/></model>");
  EXPECT_EQ(world.warnings.size(), 2u) << texts_of(world.warnings);
  expect_warning(world, "world.sdf:2: world/model[m]: ignored the unknown attribute 'odd'");
  expect_warning(
      world,
      "world.sdf:4: world/model[m]/link[l]/collision[c]/geometry/new_word: ignored the unknown element <new_word>");
  expect_warning(world, "2 times");
}

TEST_F(ForeignFiles, ReportUnknownNamesOfOldVersionsWithLines) {
  const World world = read_foreign(
      "<model name=\"m\"><static>1</static>\n<link name=\"l\" visualise=\"1\">\n<velocity_dekay/></link></model>",
      "1.5");
  expect_warning(world, "world.sdf:3: world/model[m]/link[l]: ignored the unknown attribute 'visualise'");
  expect_warning(world,
                 "world.sdf:4: world/model[m]/link[l]/velocity_dekay: ignored the unknown element <velocity_dekay>");
  expect_warning(world, "did you mean 'velocity_decay'?");
}

TEST_F(ForeignFiles, AreNotFilesThatDeclareThePrefixOfCohort) {
  expect_only_flaw({"<model name=\"m\"><static>1</static><link name=\"l\"/><new_word/></model>", 2,
                    "world/model[m]/new_word", "unknown element"},
                   write_world("<model name=\"m\"><static>1</static><link name=\"l\"/><new_word/></model>"));
}

TEST_F(ForeignFiles, ReplaceImpossibleInertiaByTheNearestPossible) {
  const std::string heavy =
      "<model name=\"m\"><link name=\"l\"><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>5</izz>"
      "</inertia></inertial></link></model>";
  const World world = read_foreign(heavy);
  EXPECT_LT((world.models[0].links[0].inertial.inertia.diagonal() - Eigen::Vector3d(2, 2, 4)).norm(), 1e-12)
      << world.models[0].links[0].inertial.inertia;
  expect_warning(world, "the nearest physically possible inertia");
  EXPECT_EQ(problems_of([&] { read(heavy); }).size(), 1u);
}

TEST_F(ForeignFiles, RaiseAMomentOfInertiaOf0ToAThousandthOfThatOfTheCollisions) {
  const std::string flat =
      "<model name=\"m\"><link name=\"l\"><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>0</izz>"
      "</inertia></inertial><collision name=\"c\"><geometry><box><size>0.3 0.6 0.1</size></box></geometry></collision>"
      "</link></model>";
  const World world = read_foreign(flat);
  const double of_box = 1.0 / 12.0 * (0.3 * 0.3 + 0.6 * 0.6);
  EXPECT_LT((world.models[0].links[0].inertial.inertia.diagonal() - Eigen::Vector3d(1, 1, 1e-3 * of_box)).norm(), 1e-12)
      << world.models[0].links[0].inertial.inertia;
  expect_warning(world, "the nearest physically possible inertia");
}

TEST_F(ForeignFiles, MakeEachFreeRootASeparateBody) {
  const World world = read("<model name=\"m\"><pose>1 0 0 0 0 0</pose>" + links("abc") + joint("j", "a", "c") +
                           "<model name=\"n\"><pose>0 0 2 0 0 0</pose>" + links("de") + joint("k", "d", "e") +
                           "<cohort:joint_encoder name=\"i\"><cohort:joint>k</cohort:joint></cohort:joint_encoder>"
                           "</model></model>");
  ASSERT_EQ(world.instances.size(), 3u);
  EXPECT_EQ(world.instances[0].name, "m");
  EXPECT_EQ(world.instances[1].name, "m/b");
  EXPECT_EQ(world.instances[2].name, "m/n.d");
  EXPECT_EQ(world.models[0].links.size(), 2u);
  EXPECT_EQ(world.models[0].joints.size(), 1u);
  EXPECT_TRUE(world.models[0].devices.empty());
  EXPECT_EQ(world.models[2].links[0].X_ML.position, Eigen::Vector3d(0, 0, 2));
  EXPECT_EQ(world.models[2].devices.size(), 1u);
  EXPECT_EQ(world.robots, (std::vector<std::size_t>{2}));
}

TEST_F(ForeignFiles, ReverseJointsFromARootToAnotherTree) {
  const World world =
      read("<model name=\"m\">" + links("abc") + joint("j", "a", "c") + joint("k", "b", "c") + "</model>");
  ASSERT_EQ(world.instances.size(), 1u);
  const Model& model = world.models[0];
  ASSERT_EQ(model.joints.size(), 2u);
  EXPECT_EQ(model.links[model.joints[1].child].name, "b");
  EXPECT_EQ(model.links[model.joints[1].parent].name, "c");
  EXPECT_EQ(model.joints[1].axis.direction, Eigen::Vector3d(0, 0, -1));
}

TEST_F(ForeignFiles, ReadSurfacesFromContactOfBullet) {
  const World world = read_urdf(weighing(
      "a",
      "<contact><lateral_friction value=\"0.3\"/><rolling_friction value=\"0.01\"/><spinning_friction value=\"0.02\"/>"
      "<restitution value=\"0.5\"/><stiffness value=\"30000\"/><damping value=\"1000\"/><inertia_scaling value=\"3\"/>"
      "</contact><collision><geometry><sphere radius=\"1\"/></geometry></collision>"));
  const Surface& surface = world.models[0].links[0].collisions[0].surface;
  EXPECT_EQ(surface.friction, 0.3);
  EXPECT_EQ(surface.rolling_resistance, 0.01);
  EXPECT_NEAR(surface.spinning_resistance, 0.02, 1e-12);
  EXPECT_EQ(surface.restitution, 0.5);
  EXPECT_EQ(surface.stiffness, 30000.0);
  EXPECT_EQ(surface.damping, 1000.0);
  expect_warning(world, "inertia_scaling");
}

TEST_F(ForeignFiles, IgnoreCollisionsOfZeroSizeInAUrdf) {
  const auto shaped = [](const std::string& shape) {
    return "<collision><geometry>" + shape + "</geometry></collision>";
  };
  const World world =
      read_urdf(weighing("a", shaped("<box size=\"0 0 0\"/>") + shaped("<sphere radius=\"0.0\"/>") +
                                  shaped("<box size=\"1 2 3\"/>") + shaped("<cylinder radius=\"1\" length=\"0\"/>")));
  ASSERT_EQ(world.models[0].links[0].collisions.size(), 1u);
  EXPECT_EQ(std::get<Box>(world.models[0].links[0].collisions[0].shape).size, Eigen::Vector3d(1, 2, 3));
  ASSERT_EQ(world.warnings.size(), 1u) << texts_of(world.warnings);
  expect_warning(world, "r.urdf:2: robot/link[a]/collision/geometry: a collision of size 0 is ignored; it occurs 3");
}

TEST_F(ForeignFiles, FindTheSunAndTheGroundOfGazebo) {
  const auto file = write("world.sdf",
                          "<sdf version=\"1.6\"><world name=\"w\"><include><uri>model://sun</uri></include>\n"
                          "<include><uri>model://ground_plane</uri></include></world></sdf>");
  const std::vector<std::filesystem::path> shipped = {source / "worlds/robots", source / "worlds/objects"};
  const Experiment experiment = parsing::read_experiment(file, {}, {}, shipped);
  ASSERT_EQ(experiment.world.instances.size(), 1u);
  EXPECT_EQ(experiment.world.instances[0].name, "ground_plane");
  EXPECT_TRUE(experiment.world.warnings.empty()) << texts_of(experiment.world.warnings);
  const Experiment again = parsing::read_experiment(experiment.inputs, {}, {});
  EXPECT_EQ(again.world.instances.size(), 1u);
}

TEST_F(ForeignFiles, ReadCapsulesOfAUrdf) {
  const World world =
      read_urdf(weighing("a",
                         "<collision><geometry><sphere radius=\"1\"/></geometry></collision>"
                         "<collision><geometry><capsule radius=\"0.1\" length=\"2\"/></geometry></collision>"));
  const auto& collisions = world.models[0].links[0].collisions;
  ASSERT_EQ(collisions.size(), 2u);
  const auto* const capsule = std::get_if<Capsule>(&collisions[1].shape);
  ASSERT_NE(capsule, nullptr);
  EXPECT_EQ(capsule->length, 2.0);
}

TEST_F(ForeignFiles, FixARootWithoutMassInAUrdfToTheWorld) {
  const World world = read_urdf("<link name=\"base\"/>" + weighing("a") + joined("j", "continuous", "base", "a"));
  const Model& model = world.models[0];
  ASSERT_EQ(model.links.size(), 2u);
  EXPECT_STREQ(model.why_fixed(), "is attached to the world by a joint");
  expect_warning(world, "robot/link[base]: is a root link without mass and is fixed to the world");
}

TEST_F(ForeignFiles, MergeARootWithoutMassIntoALinkFixedToIt) {
  const World world = read_urdf("<link name=\"footprint\"/>" + weighing("a") + joined("j", "fixed", "footprint", "a"));
  EXPECT_EQ(world.models[0].links.size(), 1u);
  EXPECT_EQ(world.models[0].why_fixed(), nullptr);
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
}

TEST_F(ForeignFiles, AcceptJointsOfAUrdfWithoutLimits) {
  const World world = read_urdf(weighing("a") + weighing("b") + weighing("c") + joined("j", "revolute", "a", "b") +
                                joined("k", "prismatic", "b", "c") + "\n");
  for (const Joint& joint : world.models[0].joints) EXPECT_FALSE(std::isfinite(joint.axis.upper)) << joint.name;
  EXPECT_EQ(world.models[0].joints[1].type, JointType::prismatic);
}

TEST_F(ForeignFiles, ReleaseTheChildOfAFloatingJoint) {
  const World world = read_urdf(weighing("a") + weighing("b") + joined("j", "floating", "a", "b"));
  ASSERT_EQ(world.instances.size(), 2u);
  EXPECT_LT((world.models[1].links[0].X_ML.position - Eigen::Vector3d(0, 0, 1)).norm(), 1e-12);
  const World alone = read_urdf("<link name=\"world\"/>" + weighing("b") + joined("j", "floating", "world", "b"));
  ASSERT_EQ(alone.instances.size(), 1u);
  EXPECT_EQ(alone.models[0].why_fixed(), nullptr);
}

TEST_F(ForeignFiles, IgnoreErrorsInVisualsOfAUrdf) {
  EXPECT_NO_THROW(
      read_urdf("<material name=\"m\"><color rgba=\"1 0 0 1\"/></material><material name=\"m\"><color rgba=\"1 0 "
                "0\"/></material>" +
                weighing("a",
                         "<visual/><visual><geometry><mesh filename=\"none.obj\" scale=\"1 1 1 1\"/></geometry>"
                         "<material name=\"nowhere\"/></visual>")));
}

TEST_F(ForeignFiles, MayHaveCollisionsWithoutAShape) {
  const auto with = [](const std::string& collisions) {
    std::string link = links("l");
    return "<model name=\"m\">" + link.insert(link.find("</link>"), collisions) + "</model>";
  };
  const std::string ball = "<collision name=\"b\"><geometry><sphere><radius>1</radius></sphere></geometry></collision>";
  const World empty = read_foreign(with(ball + "<collision name=\"c\"><geometry><empty/></geometry></collision>"));
  EXPECT_TRUE(empty.warnings.empty()) << texts_of(empty.warnings);
  EXPECT_EQ(empty.models[0].links[0].collisions.size(), 1u);
  const World without = read_foreign(with(ball + "<collision name=\"c\"/>"));
  EXPECT_EQ(without.models[0].links[0].collisions.size(), 1u);
  expect_warning(without, "world/model[m]/link[l]/collision[c]: missing: <geometry>; the collision is left out");
}

TEST_F(ForeignFiles, MayHaveLightsWithoutADirection) {
  const World world = read_foreign(
      "<model name=\"m\"><static>1</static><link name=\"l\"><light type=\"spot\" name=\"s\"><direction>0 0 0"
      "</direction></light></link></model>");
  expect_warning(world, "expected a direction that is not zero; the default direction is used");
  EXPECT_EQ(std::get<Light>(world.models[0].emitters.at(0).what).direction_E, -Eigen::Vector3d::UnitZ());
}

TEST_F(ForeignFiles, FindPackagesByPackageXml) {
  write("arms/my_arm/package.xml", "<package><name>arm_description</name></package>");
  write("arms/my_arm/meshes/tip.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  for (const char* const name : {"arm_description", "my_arm"}) {
    const auto file = write("arms/my_arm/urdf/arm.urdf",
                            "<robot name=\"r\">" +
                                weighing("a", "<collision><geometry><mesh filename=\"package://" + std::string(name) +
                                                  "/meshes/tip.obj\"/></geometry></collision>") +
                                "</robot>");
    EXPECT_EQ(parsing::read_world_or_model(file, 1).models[0].links[0].collisions.size(), 1u);
  }
}

/// Tests with a program `xacro` that leaves a trace when it runs.
class XacroFiles : public ForeignFiles {
 protected:
  XacroFiles() {
    write_program("#!/bin/sh\ntouch '" + trace_.string() +
                  "'\necho '<robot name=\"made\">'\ngrep '<link' \"$1\"\necho '</robot>'\n");
    setenv("VIRTUAL_ENV", (folder_ / "env").c_str(), 1);
  }
  ~XacroFiles() override { unsetenv("VIRTUAL_ENV"); }

  void write_program(const std::string& text) const {
    std::filesystem::permissions(write("env/bin/xacro", text), std::filesystem::perms::owner_all);
  }
  bool has_run() const { return std::filesystem::exists(trace_); }
  std::filesystem::path write_macros(const std::string& name) const {
    return write(name,
                 "<robot name=\"r\">\n<xacro:property name=\"m\" value=\"1\"/>\n" + weighing("a") + "\n</robot>\n");
  }
  static World read_expanded(const std::filesystem::path& file) {
    return parsing::read_world_or_model(file, 1, {}, parsing::Xacro::run);
  }

  std::filesystem::path trace_ = folder_ / "trace";
};

TEST_F(XacroFiles, AreExpandedOnRequest) {
  EXPECT_EQ(read_expanded(write_macros("r.urdf.xacro")).models[0].name, "made");
  EXPECT_TRUE(has_run());
}

TEST_F(XacroFiles, AreRejectedWithARemedyOtherwise) {
  for (const char* const name : {"r.urdf.xacro", "r.urdf"}) {
    const auto file = write_macros(name);
    const auto problems = problems_of([&] { parsing::read_world_or_model(file, 1); });
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].line, 2);
    EXPECT_NE(problems[0].message.find("`xacro " + std::string(name) + " > robot.urdf`"), std::string::npos)
        << problems[0].text();
    EXPECT_NE(problems[0].message.find("--xacro"), std::string::npos) << problems[0].text();
  }
  EXPECT_FALSE(has_run());
}

TEST_F(XacroFiles, AreNeverExpandedInIncludes) {
  write_macros("robots/evil/evil.urdf");
  write("robots/evil/model.config", "<model><name>evil</name><sdf version=\"1.9\">evil.urdf</sdf></model>");
  const auto in_yaml = write("world.yaml", "world:\n  name: w\n  include: {uri: robots/evil/evil.urdf}\n");
  const auto in_sdf = write_world("<include><uri>model://evil</uri></include>");
  const auto experiment =
      write("e.yaml", "world: robots/evil/evil.urdf\nduration: 1\nteams: [{name: t, robots: all, controller: c}]\n");
  for (const auto& file : {in_yaml, in_sdf, experiment}) {
    const auto problems = problems_of([&] { parsing::read_experiment(file, {}, {}, {}, parsing::Xacro::run); });
    ASSERT_EQ(problems.size(), 1u) << file;
    EXPECT_EQ(problems[0].file.filename(), "evil.urdf");
    EXPECT_EQ(problems[0].line, 2);
  }
  EXPECT_FALSE(has_run());
}

TEST_F(XacroFiles, PassOnErrorsOfXacro) {
  const auto file = write_macros("r.urdf.xacro");
  write_program("#!/bin/sh\nprintf 'no such \\033[1mproperty:\\n  size\\n' >&2\nexit 2\n");
  const auto problems = problems_of([&] { read_expanded(file); });
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].message, "xacro cannot expand this file: no such \xef\xbf\xbd[1mproperty: size");
  write_program("#!/bin/sh\nyes 'on and on' | head -c 9000000 >&2\necho the end >&2\nexit 2\n");
  const auto long_ones = problems_of([&] { read_expanded(file); });
  ASSERT_EQ(long_ones.size(), 1u);
  EXPECT_LT(long_ones[0].message.size(), 1100u);
  EXPECT_TRUE(long_ones[0].message.ends_with("the end")) << long_ones[0].text();
}

TEST_F(ForeignFiles, AcceptNamesWithColonsInOldVersions) {
  const std::string parts = "<model name=\"m\">" + links("c") + "<link name=\"a\"/><link name=\"a::b\"/>" +
                            joint("a::j", "c", "a::b") + joint("a::k", "a", "a::b") +
                            "<frame name=\"a::f\" attached_to=\"c\"/></model>";
  for (const char* const version : {"1.4", "1.6", "1.7"}) {
    const World world = read_foreign(parts, version);
    EXPECT_EQ(world.models[0].links.size(), 3u) << version;
    EXPECT_TRUE(std::ranges::any_of(world.models[0].links, [](const Link& link) { return link.name == "a.b"; }));
    EXPECT_EQ(world.models[0].joints[0].name, "a.j");
  }
}

TEST_F(ForeignFiles, ReplaceColonsInNamesOfNewVersions) {
  const World world = read_foreign("<model name=\"m\">" + links("a") + "<link name=\"x::b\"/><link name=\"x::c\"/>" +
                                   joint("j", "a", "x::b") + joint("k", "a", "x::c") +
                                   "<frame name=\"f\" attached_to=\"x::c\"/></model>");
  EXPECT_EQ(world.models[0].links.size(), 3u);
  expect_warning(world, "world.sdf:2: world/model[m]/link[x::b]: a name cannot contain '::'");
  expect_warning(world, "2 times");
}

TEST_F(ForeignFiles, AcceptAnyNamesInUnknownSensors) {
  const World world = read_foreign(
      "<model name=\"m\"><link name=\"l\"><sensor name=\"s\" type=\"smell\"><nose name=\"a::b\"/></sensor>"
      "<sensor name=\"c\" type=\"custom\"><foo:nose name=\"a::b\" xmlns:foo=\"x\"/><nose name=\"a::b\"/></sensor>"
      "</link></model>");
  EXPECT_EQ(world.models.size(), 1u);
}

TEST_F(ForeignFiles, TreatABareNameAsAModel) {
  write_model("x500", links("l"));
  EXPECT_EQ(read_foreign("<include><uri>x500</uri></include>").instances[0].name, "x500");
}

TEST_F(ForeignFiles, SuggestTheCommandThatDownloadsAFuelModel) {
  const std::string uri = "https://fuel.gazebosim.org/1.0/OpenRobotics/models/Depot";
  const auto problems = problems_of([&] { read_foreign("<include><uri>" + uri + "</uri></include>"); });
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].message.find("gz fuel download -u"), std::string::npos) << problems[0].text();
}

TEST_F(ForeignFiles, ReadInertiaByDensityAndMimicJointsOfNewerVersions) {
  const World world = read_foreign(
      "<model name=\"m\"><link name=\"l\"><inertial auto=\"true\"><density>500</density></inertial>" +
          std::string("<collision name=\"c\"><geometry><box><size>1 1 1</size></box></geometry></collision>") +
          "<collision name=\"d\"><density>100</density><geometry><box><size>1 1 1</size></box></geometry></collision>"
          "</link>" +
          links("ab") + joint("i", "l", "a") +
          joint("j", "l", "b",
                "<xyz>0 0 1</xyz><mimic joint=\"i\"><multiplier>2</multiplier><offset>1</offset><reference>3"
                "</reference></mimic>") +
          "</model>",
      "1.11");
  const Model& model = world.models[0];
  EXPECT_NEAR(model.links[0].inertial.mass, 600.0, 1e-9);
  ASSERT_EQ(model.couplings.size(), 1u);
  EXPECT_EQ(model.couplings[0].multiplier, 2.0);
  EXPECT_EQ(model.couplings[0].offset, -5.0);
}

// As in libsdformat 14, which reads every file by its newest specification.
TEST_F(ForeignFiles, ReadNewElementsWhateverVersionIsDeclared) {
  for (const std::string version : {"1.4", "1.6", "1.9", "1.12"}) {
    const World world = read_foreign(
        "<model name=\"m\"><link name=\"l\"><inertial auto=\"true\"><density>250</density></inertial>" +
            std::string(
                "<collision name=\"c\"><geometry><cone><radius>1</radius><length>2</length></cone></geometry>") +
            "</collision></link>" + links("ab") + joint("i", "l", "a") +
            joint("j", "l", "b", "<xyz>0 0 1</xyz><mimic joint=\"i\"><multiplier>3</multiplier></mimic>") + "</model>",
        version);
    const Model& model = world.models.at(0);
    EXPECT_NEAR(model.links.at(0).inertial.mass, 250.0 * 2.0 / 3.0 * M_PI, 1e-9) << version;
    ASSERT_EQ(model.couplings.size(), 1u) << version;
    EXPECT_EQ(model.couplings[0].multiplier, 3.0) << version;
  }
}

TEST_F(ForeignFiles, ScaleTheInertiaOfShapesToAGivenMass) {
  const auto inertial_of = [&](const std::string& mass) {
    return read_foreign("<model name=\"m\"><link name=\"l\"><inertial auto=\"true\">" + mass +
                            "<density>700</density></inertial><collision name=\"c\"><density>300</density><geometry>"
                            "<box><size>1 2 3</size></box></geometry></collision><collision name=\"d\"><geometry>"
                            "<box><size>1 1 1</size></box></geometry></collision></link></model>",
                        "1.11")
        .models.at(0)
        .links.at(0)
        .inertial;
  };
  const Inertial by_density = inertial_of("");
  const Inertial by_mass = inertial_of("<mass>6</mass>");
  EXPECT_NEAR(by_density.mass, 2500.0, 1e-9);
  EXPECT_EQ(by_mass.mass, 6.0);
  EXPECT_TRUE(by_mass.inertia.isApprox(by_density.inertia * (6.0 / 2500.0), 1e-12));
}

TEST_F(ForeignFiles, PreferThePitchOfAScrewInMetres) {
  for (const std::string older : {"", "<thread_pitch>-3</thread_pitch>"}) {
    const World world = read_foreign("<model name=\"m\">" + links("ab") +
                                         "<joint name=\"j\" type=\"screw\"><parent>a</parent><child>b</child><axis>"
                                         "<xyz>0 0 1</xyz></axis>" +
                                         older + "<screw_thread_pitch>0.02</screw_thread_pitch></joint></model>",
                                     "1.10");
    EXPECT_NEAR(world.models.at(0).joints.at(0).thread_pitch, 0.02, 1e-15) << older;
  }
}

TEST_F(ForeignFiles, ConnectTwoModelsByAFixedJointInAWorld) {
  const World world = read_foreign(
      "<model name=\"m\">" + links("a") + "</model><model name=\"n\"><pose>0 0 3 0 0 0</pose>" + links("b") +
          "</model><joint name=\"j\" type=\"fixed\"><parent>m::a</parent><child>n::b</child></joint>",
      "1.10");
  ASSERT_EQ(world.breakable_joints.size(), 1u);
  EXPECT_EQ(world.breakable_joints[0].name, "j");
}

}  // namespace
}  // namespace cohort::description
