// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "server/parsing/experiment/read_experiment.hpp"
#include "server/parsing/sdf/schema/yaml_sdf.hpp"
#include "server/parsing/world/read_world.hpp"
#include "server/parsing/writing/write_world.hpp"
#include "server/simulation/simulation.hpp"
#include "tests/support/worlds/written_worlds.hpp"

namespace cohort::description {
namespace {

namespace fs = std::filesystem;

class ExportedWorlds : public Description {
 protected:
  // Exported worlds name the files of their source.
  ExportedWorlds() { setenv("COHORT_ALLOW_FILES", source.c_str(), 1); }
  ~ExportedWorlds() override { unsetenv("COHORT_ALLOW_FILES"); }
  fs::path write_back(const World& world, const std::string& name = "exported.sdf") const {
    return write(name, parsing::xml_text(parsing::sdf_of(world, folder_)));
  }
  // Returns every number of the world as text.
  std::string text_of(const World& world) const { return parsing::xml_text(parsing::sdf_of(world, folder_)); }

  static std::uint64_t hash_after(const World& world, std::uint64_t seed, int ticks) {
    Experiment experiment;
    experiment.world = world;
    experiment.seed = seed;
    Simulation simulation(experiment, 1);
    for (int tick = 0; tick < ticks; ++tick) {
      for (std::uint32_t robot = 0; robot < simulation.robot_count(); ++robot) {
        std::vector<double> values;
        for (const Channel& channel : simulation.kinds()[simulation.kind_of(robot)].command)
          for (std::uint32_t i = 0; i < channel.size; ++i)
            values.push_back(0.4 * channel.upper * std::sin(0.05 * tick + robot + static_cast<double>(values.size())));
        simulation.set_command(robot, values);
      }
      simulation.step();
    }
    return simulation.state_hash();
  }
  // Returns the hash of each boundary of an experiment without commands, beside which `world` is.
  std::vector<std::uint64_t> hashes_of(const std::string& world, const std::string& events, int ticks) const {
    const Experiment experiment = parsing::read_experiment(write(
        "course.yaml", "world: " + world +
                           "\nseed: 5\nduration: 9\nteams: [{name: t, robots: '*', controller: obstacle_avoidance}]\n" +
                           events));
    Simulation simulation(experiment, 1);
    std::vector<std::uint64_t> hashes;
    for (int tick = 0; tick < ticks; ++tick) {
      simulation.step();
      hashes.push_back(simulation.state_hash());
    }
    return hashes;
  }
  void expect_the_same_again(const World& world, std::uint64_t seed = 1) const {
    const World again = parsing::read_world(write_back(world), seed);
    EXPECT_TRUE(again.warnings.empty()) << texts_of(again.warnings);
    EXPECT_EQ(text_of(again), text_of(world));
    const World from_yaml =
        parsing::read_world(write("exported.yaml", parsing::yaml_of_sdf(parsing::sdf_of(world, folder_))), seed);
    EXPECT_EQ(text_of(from_yaml), text_of(world));
    // Objects that events add are not in the exported world.
    if (std::ranges::all_of(world.instances, &Instance::is_present)) {
      EXPECT_EQ(hash_after(again, seed, 100), hash_after(world, seed, 100));
    }
  }
};

TEST_F(ExportedWorlds, GiveTheSameHashForEveryShippedArena) {
  int arenas = 0;
  for (const auto& entry : fs::directory_iterator(source / "worlds/arenas")) {
    if (entry.path().extension() != ".sdf") continue;
    SCOPED_TRACE(entry.path().filename().string());
    expect_the_same_again(parsing::read_world(entry.path(), 5), 5);
    ++arenas;
  }
  EXPECT_GE(arenas, 12);
}

TEST_F(ExportedWorlds, KeepSeedStepAndPhysicsOfEveryShippedExperiment) {
  for (const auto& entry : fs::directory_iterator(source / "worlds/experiments")) {
    if (entry.path().extension() != ".yaml") continue;
    SCOPED_TRACE(entry.path().filename().string());
    const Experiment experiment = parsing::read_experiment(entry.path());
    expect_the_same_again(experiment.world, experiment.seed);
  }
}

TEST_F(ExportedWorlds, GiveTheSameHashWithFluids) {
  const std::string model =
      "<pose>0 0 0.1 0.01 0.02 0.7</pose><enable_wind>true</enable_wind>"
      "<link name=\"a\"><inertial><mass>3.1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia>"
      "<fluid_added_mass><xx>0.31</xx><yy>2.17</yy><zz>2.93</zz><qq>0.11</qq><rr>0.13</rr><yr>0.07</yr></"
      "fluid_added_mass>"
      "</inertial><collision "
      "name=\"c\"><geometry><capsule><radius>0.1</radius><length>0.3</length></capsule></geometry>"
      "</collision><cohort:fin name=\"keel\"><cohort:pose>0.01 0 -0.1 1.57 0 0</cohort:pose><cohort:area>0.02"
      "</cohort:area><cohort:cla>4.7</cohort:cla><cohort:alpha0>0.013</cohort:alpha0><cohort:alpha_stall>0.31"
      "</cohort:alpha_stall><cohort:cla_stall>-1.3</cohort:cla_stall></cohort:fin><cohort:drag name=\"hull\">"
      "<cohort:damping>1.1 2.3 3.7</cohort:damping><cohort:quadratic_damping>5.3 7.1 11.9</cohort:quadratic_damping>"
      "<cohort:quadratic_angular_damping>0.1 0.2 0.3</cohort:quadratic_angular_damping><cohort:density>1025"
      "</cohort:density></cohort:drag></link>"
      "<cohort:rotor name=\"screw\"><cohort:link>a</cohort:link><cohort:pose>-0.2 0 -0.1 0 1.57 0</cohort:pose>"
      "<cohort:direction>cw</cohort:direction><cohort:max_velocity>210.7</cohort:max_velocity><cohort:min_velocity>"
      "-100.3</cohort:min_velocity><cohort:motor_constant>1.3e-4</cohort:motor_constant><cohort:moment_constant>0.017"
      "</cohort:moment_constant><cohort:drag_coefficient>1e-4</cohort:drag_coefficient>"
      "<cohort:rolling_moment_coefficient>1e-5</cohort:rolling_moment_coefficient><cohort:time_constant_up>0.11"
      "</cohort:time_constant_up><cohort:density>1025</cohort:density><cohort:noise>0.3</cohort:noise></cohort:rotor>";
  const World world = read(
      "<wind><linear_velocity>1.1 -0.7 0.1</linear_velocity></wind><cohort:air><cohort:density>1.19</cohort:density>"
      "</cohort:air><cohort:water><cohort:level>0.07</cohort:level><cohort:density>1025</"
      "cohort:density><cohort:current>"
      "0.3 0.1 0</cohort:current></cohort:water><model name=\"boat\">" +
      model + "</model>");
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  expect_the_same_again(world);
}

// Rotations, axes and normals without short numbers; also frames, every shape, every joint, and materials.
TEST_F(ExportedWorlds, KeepUnusualNumbersExactly) {
  write("t.obj", "v 0.1 0 0\nv 0 0.3 0\nv 0 0 0.7\nv 0 0 0\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n");
  const std::string inertial =
      "<inertial><pose>0.013 -0.0071 0.003 0.31 -0.7 "
      "1.9</pose><mass>0.7300000000000001</mass><inertia><ixx>0.0123</ixx>"
      "<iyy>0.0234</iyy><izz>0.0171</izz><ixy>0.0011</ixy><ixz>-0.0007</ixz><iyz>0.0003</iyz></inertia></inertial>";
  const auto link = [&](const std::string& name, const std::string& pose, const std::string& shape) {
    return "<link name=\"" + name + "\"><pose>" + pose + "</pose>" + inertial +
           "<collision name=\"c\"><pose>0.01 0.02 0.03 0.1 0.2 0.3</pose><geometry>" + shape +
           "</geometry><surface><friction><ode><mu>0.37</mu></ode><bullet><rolling_friction>0.0013</rolling_friction>"
           "</bullet></friction><bounce><restitution_coefficient>0.21</restitution_coefficient></bounce></surface>"
           "<cohort:material>m_" +
           name + "</cohort:material></collision></link>";
  };
  const auto odd_joint = [](const std::string& name, const std::string& type, const std::string& parent,
                            const std::string& child, const std::string& axes) {
    return "<joint name=\"" + name + "\" type=\"" + type + "\"><pose>0.011 0.007 -0.005 0.4 0.5 0.6</pose><parent>" +
           parent + "</parent><child>" + child + "</child>" + axes + "</joint>";
  };
  const std::string axis =
      "<xyz>1 2 3</xyz><limit><lower>-0.7</lower><upper>1.3</upper><stiffness>310</stiffness><dissipation>0.7"
      "</dissipation></limit><dynamics><damping>0.013</damping>"
      "<friction>0.0017</friction><spring_stiffness>0.31</spring_stiffness><spring_reference>0.2</spring_reference>"
      "</dynamics>";
  const std::string model =
      "<model name=\"odd\"><self_collide>true</self_collide><pose>0.3 0.4 2.1 0.7 0.8 0.9</pose>" +
      link("e", "0.1 0.9 0 0.2 0.1 0.7", "<ellipsoid><radii>0.11 0.13 0.17</radii></ellipsoid>") +
      link("a", "0 0 0 0 0 0", "<box><size>0.31 0.17 0.13</size></box>") +
      link("b", "0.5 0 0 0.1 0 0.3", "<cylinder><radius>0.07</radius><length>0.19</length></cylinder>") +
      link("d", "0 0.5 0 0 0.1 0.5", "<capsule><radius>0.05</radius><length>0.23</length></capsule>") +
      link("f", "-0.6 0.1 0 0.3 0.3 0.3", "<mesh><uri>t.obj</uri><scale>0.9 0.8 0.7</scale></mesh>") +
      link("g", "-0.9 0.1 0.4 0.3 0.2 0.3", "<sphere><radius>0.09</radius></sphere>") +
      odd_joint("one", "revolute", "a", "b", "<axis>" + axis + "</axis>") +
      odd_joint("two", "universal", "a", "d",
                "<axis>" + axis + "</axis><axis2><xyz expressed_in=\"a\">-1 0.3 0.2</xyz></axis2>") +
      odd_joint("three", "ball", "a", "f",
                "<axis><xyz>0 0 1</xyz><dynamics><damping>0.02</damping></dynamics></axis>") +
      odd_joint("four", "prismatic", "d", "e", "<axis><xyz>0.3 -0.7 0.1</xyz></axis>") +
      odd_joint("five", "fixed", "f", "g", "") +
      odd_joint("six", "revolute", "g", "d", "<axis><xyz>0.2 0.7 0.1</xyz></axis>") +
      "<cohort:velocity_motor name=\"m\"><cohort:joint>one</cohort:joint><cohort:max_velocity>1.7</cohort:max_velocity>"
      "<cohort:max_effort>0.3</cohort:max_effort></cohort:velocity_motor>"
      "<cohort:effort_motor name=\"push\"><cohort:joint>four</cohort:joint><cohort:max_effort>0.7</cohort:max_effort>"
      "<cohort:rotor_inertia>0.013</cohort:rotor_inertia></cohort:effort_motor>"
      "<cohort:torque_sensor name=\"m_torque\"><cohort:joint>one</cohort:joint></cohort:torque_sensor>"
      "<cohort:traction_sensor name=\"two\"><cohort:joint>two</cohort:joint><cohort:noise>0.1</cohort:noise>"
      "</cohort:traction_sensor>"
      "<cohort:joint_encoder name=\"m\"><cohort:joint>four</cohort:joint></cohort:joint_encoder>"
      "<cohort:proximity_ring name=\"r\"><cohort:link>b</cohort:link><cohort:pose>0 0.1 0.2 0.3 0.4 0.5</cohort:pose>"
      "<cohort:count>5</cohort:count><cohort:first_bearing>0.1</cohort:first_bearing><cohort:spacing>1.1</"
      "cohort:spacing>"
      "<cohort:ring_radius>0.05</cohort:ring_radius><cohort:range>1.3</cohort:range><cohort:noise>0.07</cohort:noise>"
      "</cohort:proximity_ring></model>";
  const std::string content =
      "<gravity>0.1 -0.2 -9.7</gravity><physics type=\"ode\"><max_step_size>0.003</max_step_size></physics>"
      "<frame name=\"f\"><pose>0.1 0.2 0.3 0.4 0.5 0.6</pose></frame>" +
      static_model_sdf("<pose relative_to=\"f\">0.7 -0.1 -0.9 -0.4 -0.5 0.1</pose>" +
                           collision("<plane><normal>0.1 -0.2 0.97</normal></plane>"),
                       "slope") +
      static_model_sdf("<pose>5 5 0 0.1 0.2 0.3</pose>" + collision("<mesh><uri>t.obj</uri></mesh>"), "rock") + model +
      "<cohort:material_pair><cohort:first>m_a</cohort:first><cohort:second>m_b</cohort:second><cohort:friction>0.77"
      "</cohort:friction><cohort:restitution>0.1</cohort:restitution></cohort:material_pair>"
      "<cohort:physics><cohort:solver>hybrid</cohort:solver><cohort:fidelity>articulated</cohort:fidelity>"
      "<cohort:iterations>17</cohort:iterations><cohort:lowest>-33.3</cohort:lowest></cohort:physics>";
  expect_the_same_again(read(content));
}

TEST_F(ExportedWorlds, KeepSurfacesAndLinks) {
  const std::string surface =
      "<surface><friction><ode><mu>0.31</mu><mu2>0.7</mu2><fdir1>1 2 "
      "-0.3</fdir1></ode><torsional><coefficient>0.37</coefficient><patch_radius>0.013</patch_radius></torsional>"
      "</friction><bounce><restitution_coefficient>0.2</restitution_coefficient><threshold>0.07</threshold></"
      "bounce><contact><collide_bitmask>0x0F</collide_bitmask><category_bitmask>6</category_bitmask>"
      "<ode><kp>30000.1</kp><kd>7.1</kd></ode></contact>"
      "</surface>";
  const World world = read(
      "<model name=\"odd\"><pose>0 0 0.3 0.1 0.2 0</pose><link name=\"l\"><gravity>false</gravity>"
      "<inertial><mass>1.3</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>"
      "<collision name=\"c\"><geometry><sphere><radius>0.1</radius></sphere></geometry>" +
      surface + "</collision></link></model>" + static_model_sdf(collision("<plane/>"), "ground"));
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  expect_the_same_again(world);
}

TEST_F(ExportedWorlds, KeepColorsTechniquesCamerasAndSampleFiles) {
  write("data/s.csv", "distance [m],angle [rad],reading_0 [1],reading_1 [1]\n0.1,0,0.5,2\n0.2,0,0.25,1\n");
  const std::string link = "<cohort:link>a</cohort:link>";
  const std::string ring = link +
                           "<cohort:count>2</cohort:count><cohort:first_bearing>0.1</cohort:first_bearing>"
                           "<cohort:spacing>1.1</cohort:spacing>";
  const std::string rays = "<cohort:ring_radius>0.05</cohort:ring_radius><cohort:range>1.3</cohort:range>";
  const std::string samples = "<cohort:samples>data/s.csv</cohort:samples>";
  const World world = read(
      "<model name=\"m\"><pose>0 0 1 0 0 0</pose><link name=\"a\"><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1"
      "</iyy><izz>1</izz><ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia></inertial><visual name=\"v\"><geometry><sphere>"
      "<radius>1</radius></sphere></geometry><material><diffuse>0.1 0.7 0.3 1</diffuse></material></visual></link>"
      "<cohort:proximity_ring name=\"five\">" +
      ring + rays +
      "<cohort:technique>five_rays</cohort:technique><cohort:cone>0.3</cohort:cone></cohort:proximity_ring>"
      "<cohort:proximity_ring name=\"sampled\">" +
      ring + rays + "<cohort:technique>samples</cohort:technique>" + samples +
      "</cohort:proximity_ring>"
      "<cohort:light_sensors name=\"light\">" +
      ring + samples +
      "</cohort:light_sensors>"
      "<cohort:microphones name=\"ears\">" +
      link + "<cohort:place>0 0 0</cohort:place><cohort:place>0 0 1</cohort:place><cohort:band>0 100</cohort:band>" +
      samples + "</cohort:microphones><cohort:omnidirectional_camera name=\"camera\">" + link +
      "<cohort:range>2</cohort:range><cohort:min_elevation>-0.3</cohort:min_elevation><cohort:capacity>3"
      "</cohort:capacity><cohort:distance_noise>0.01</cohort:distance_noise><cohort:bearing_noise>0.02"
      "</cohort:bearing_noise></cohort:omnidirectional_camera><cohort:panorama name=\"film\">" +
      link +
      "<cohort:width>8</cohort:width><cohort:height>3</cohort:height><cohort:range>7</cohort:range><cohort:sky>0 0.1 1"
      "</cohort:sky></cohort:panorama></model>" +
      static_model_sdf(collision("<plane/>"), "floor"));
  EXPECT_NE(text_of(world).find("<diffuse>0.1 0.7 0.3 1</diffuse>"), std::string::npos);
  EXPECT_NE(text_of(world).find("<cohort:samples>data/s.csv</cohort:samples>"), std::string::npos);
  expect_the_same_again(world);
}

TEST_F(ExportedWorlds, KeepTheFrameOfTheDirectionOfFriction) {
  std::string wheel = links("b");
  wheel.insert(
      wheel.find("</link>"),
      "<collision name=\"c\"><geometry><sphere><radius>0.1</radius></sphere></geometry><surface><friction><ode>"
      "<mu2>0</mu2><fdir1 gz:expressed_in=\"a\">1 2 0</fdir1></ode></friction></surface></collision>");
  const World world =
      read(static_model_sdf(collision("<plane/>"), "floor") + "<model name=\"m\"><pose>0 0 0.1 0 0 0</pose>" +
           links("a") + wheel + joint("j", "a", "b", "<xyz>0 1 0</xyz>") + "</model>");
  EXPECT_NE(text_of(world).find("gz:expressed_in=\"a\""), std::string::npos);
  expect_the_same_again(world);
}

TEST_F(ExportedWorlds, KeepSubmeshes) {
  write("parts.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 4 0 0\nv 6 0 0\nv 4 2 0\no first\nf 1 2 3\no second\nf 4 5 6\n");
  const auto part = [](const std::string& submesh) {
    return static_model_sdf(collision("<mesh><uri>parts.obj</uri>" + submesh + "</mesh>"),
                            "m" + std::to_string(submesh.size()));
  };
  const World world = read(part("") + part("<submesh><name>second</name></submesh>") +
                           part("<submesh><name>second</name><center>1</center></submesh>"));
  EXPECT_NE(text_of(world).find("<center>true</center>"), std::string::npos);
  const World again = parsing::read_world(write_back(world), 1);
  for (std::size_t model = 0; model < 3; ++model)
    EXPECT_EQ(std::get<Mesh>(again.models[model].links[0].collisions[0].shape).triangles->vertices,
              std::get<Mesh>(world.models[model].links[0].collisions[0].shape).triangles->vertices);
  expect_the_same_again(world);
}

TEST_F(ExportedWorlds, KeepPolylines) {
  const std::string bracket =
      "<polyline><point>0 0</point><point>0.1 0.37</point><point>0.7 0</point><point>0.1 -0.1</point><height>0.31"
      "</height></polyline><polyline><point>2 0</point><point>3 0</point><point>2 "
      "1</point><height>1</height></polyline>";
  std::string falling = links("a");
  falling.insert(falling.find("</link>"), "<collision name=\"c\"><geometry>" + bracket + "</geometry></collision>");
  const World world = read(static_model_sdf(collision(bracket)) + "<model name=\"n\"><pose>0 0 1 0.1 0.2 0.3</pose>" +
                           falling + "</model>");
  EXPECT_NE(text_of(world).find("<point>0.1 0.37</point>"), std::string::npos);
  expect_the_same_again(world);
}

TEST_F(ExportedWorlds, KeepActionsAndBreakableJoints) {
  const auto hung = [](const std::string& name, const std::string& x) {
    return "<model name=\"" + name + "\"><pose>" + x + " 0 0.7 0.1 0.2 0.3</pose>" + links("ab") +
           joint("j", "a", "b") + "<cohort:action name=\"open_" + name + "\"/></model>";
  };
  const World world = read(
      static_model_sdf(collision("<plane/>"), "floor") + hung("one", "0.1") + hung("two", "0.7") +
      "<cohort:breakable_joint name=\"rope\"><cohort:first>one</cohort:first><cohort:first_link>b</cohort:first_link>"
      "<cohort:second>two</cohort:second><cohort:pose>0.1 0.2 0.3 0.4 0.5 0.6</cohort:pose><cohort:breaking_torque>0.37"
      "</cohort:breaking_torque></cohort:breakable_joint><cohort:breakable_joint name=\"hook\"><cohort:first>floor"
      "</cohort:first><cohort:second>two</cohort:second><cohort:second_link>b</cohort:second_link>"
      "<cohort:breaking_force>35.7</cohort:breaking_force></cohort:breakable_joint>");
  EXPECT_NE(text_of(world).find("<cohort:breaking_torque>0.37</cohort:breaking_torque>"), std::string::npos);
  expect_the_same_again(world);
}

// The exported world has other models in another order: those of the objects that events add come last.
TEST_F(ExportedWorlds, GiveTheSameHashWithEventsOfEachKind) {
  const std::string events =
      "events:\n"
      "  - {at: 0.1, add: {model: crate.yaml, name: added, pose: [3, 0, 1, 0, 0, 0]}}\n"
      "  - {at: 0.2, spawn: {model: model://sbot, name: r, area: [2, 2], every: 0.1, most: 4}}\n"
      "  - {at: 0.2, spawn: {model: crate.yaml, name: c, pose: 0 0 1 0 0 0, area: [2, 2], every: 0.05, most: 9}}\n"
      "  - {at: 0.3, remove: {objects: added}}\n"
      "  - {at: 0.3, disable: {objects: o1}}\n"
      "  - {at: 0.5, enable: {objects: o1}}\n"
      "  - {at: 0.4, move: {objects: o2, pose: [2, 2, 1, 0, 0, 0]}}\n"
      "  - {at: 0.4, set_velocity: {objects: o3, linear: [1, 0, 0]}}\n"
      "  - {at: 0.4, apply_force: {objects: o4, force: [2, 0, 0], for: 0.2}}\n";
  const auto box = [](int i) {
    return "<model name=\"o" + std::to_string(i) + "\"><pose>" + std::to_string(0.3 * i) +
           " -2 0.05 0 0 0</pose><link name=\"l\"><cohort:density>700</cohort:density><collision name=\"c\"><geometry>"
           "<box><size>0.1 0.12 0.08</size></box></geometry></collision></link></model>";
  };
  write("crate.yaml",
        "model: {name: crate, link: {'cohort:density': 700, collision: {geometry: {box: {size: [0.1, 0.12, 0.08]}}}}}");
  std::string content = static_model_sdf(collision("<plane/>"), "floor");
  for (int i = 0; i < 6; ++i) content += box(i);
  content += "<include><uri>model://sbot</uri><name>first</name></include>";
  const World world = read(content);
  write_back(world, "again.sdf");
  const std::vector<std::uint64_t> expected = hashes_of("world.sdf", events, 100);
  EXPECT_EQ(hashes_of("again.sdf", events, 100), expected);
  EXPECT_NE(hashes_of("again.sdf", "", 100), expected);
}

TEST_F(ExportedWorlds, FlattenNestedModels) {
  const World world =
      read("<model name=\"outer\">" + links("a") + "<model name=\"inner\"><pose>0.3 0.2 0.1 0.1 0.2 0.3</pose>" +
           links("b") + "<cohort:joint_encoder name=\"e\"><cohort:joint>k</cohort:joint></cohort:joint_encoder>" +
           links("c") + joint("k", "b", "c") + "</model>" + joint("j", "a", "inner::b") + "</model>");
  EXPECT_EQ(world.models[0].links[1].name, "inner::b");
  const World again = parsing::read_world(write_back(world), 1);
  EXPECT_EQ(again.models[0].links[1].name, "inner.b");
  EXPECT_EQ(text_of(again), text_of(world));
  EXPECT_EQ(hash_after(again, 1, 100), hash_after(world, 1, 100));
}

TEST_F(ExportedWorlds, NameHeightMapFilesByRelativePaths) {
  const World world = parsing::read_world(source / "worlds/arenas/rough_terrain.sdf", 1);
  const std::string text = text_of(world);
  EXPECT_NE(text.find("terrain/rough_terrain.png</uri>"), std::string::npos);
  EXPECT_NE(text.find("<size>4 4 0.25</size>"), std::string::npos);
}

TEST_F(ExportedWorlds, KeepTheFunctionOfTerrain) {
  expect_the_same_again(read(static_model_sdf(
      "<link name=\"l\"><collision name=\"c\"><geometry><heightmap><size>3 2 0.4</size><cohort:terrain>"
      "<cohort:kind>hills</cohort:kind><cohort:spacing>0.1</cohort:spacing><cohort:wavelength>0.7</cohort:wavelength>"
      "<cohort:seed>3</cohort:seed></cohort:terrain></heightmap></geometry></collision></link>")));
}

TEST_F(ExportedWorlds, EscapeSpecialCharactersInNames) {
  const World world = read(static_model_sdf(links("a"), "a&amp;b&lt;&quot;c"));
  EXPECT_EQ(world.instances[0].name, "a&b<\"c");
  expect_the_same_again(world);
}

TEST_F(ExportedWorlds, NormaliseQuaternions) {
  const World world = read(static_model_sdf("<pose rotation_format=\"quat_xyzw\">1 2 3 0 0 2 2</pose>" + links("a")));
  const Eigen::Quaterniond q = world.instances[0].X_WM.orientation;
  EXPECT_NEAR(q.z(), std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(q.w(), std::sqrt(0.5), 1e-15);
}

}  // namespace
}  // namespace cohort::description
