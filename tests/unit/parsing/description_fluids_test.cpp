// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "server/parsing/world/read_world.hpp"
#include "tests/support/worlds/written_worlds.hpp"

/// Tests of reading rotors, fins, drag, air, water and wind.
namespace cohort::description {
namespace {

using Fluids = Description;

std::string vessel(const std::string& device, const std::string& in_model = "", const std::string& in_link = "") {
  std::string text = links("ab");
  text.insert(text.find("</link><link name=\"b\">"), in_link);
  return "<model name=\"m\">" + in_model + text + joint("j", "a", "b") + "\n" + device + "\n</model>";
}
std::string rotor(const std::string& keys) {
  return "<cohort:rotor name=\"r\"><cohort:link>b</cohort:link><cohort:max_velocity>900</cohort:max_velocity>"
         "<cohort:motor_constant>8e-6</cohort:motor_constant>" +
         keys + "</cohort:rotor>";
}

TEST_F(Fluids, ReadRotorsWithDefaults) {
  const auto read_rotor = [&](const std::string& keys) {
    return std::get<Rotor>(read(vessel(rotor(keys))).models[0].devices.at(0));
  };
  const Rotor plain = read_rotor("");
  EXPECT_EQ(plain.link, 1u);
  EXPECT_EQ(plain.direction, Rotor::Direction::ccw);
  EXPECT_EQ(plain.max_velocity, 900.0);
  EXPECT_EQ(plain.min_velocity, 0.0);
  EXPECT_EQ(plain.motor_constant, 8e-6);
  EXPECT_EQ(plain.density, 0.0);
  EXPECT_EQ(plain.time_constant_up, 0.0);
  const Rotor other = read_rotor(
      "<cohort:pose>0 0 0.1 0 0 0</cohort:pose><cohort:direction>cw</cohort:direction>"
      "<cohort:min_velocity>-300</cohort:min_velocity><cohort:moment_constant>0.016</cohort:moment_constant>"
      "<cohort:drag_coefficient>8e-5</cohort:drag_coefficient><cohort:density>1025</cohort:density>"
      "<cohort:rolling_moment_coefficient>1e-6</cohort:rolling_moment_coefficient><cohort:noise>0.1</cohort:noise>"
      "<cohort:time_constant_up>0.0125</cohort:time_constant_up><cohort:time_constant_down>0.025"
      "</cohort:time_constant_down>");
  EXPECT_EQ(other.X_LR.position.z(), 0.1);
  EXPECT_EQ(other.direction, Rotor::Direction::cw);
  EXPECT_EQ(other.min_velocity, -300.0);
  EXPECT_EQ(other.moment_constant, 0.016);
  EXPECT_EQ(other.drag_coefficient, 8e-5);
  EXPECT_EQ(other.rolling_moment_coefficient, 1e-6);
  EXPECT_EQ(other.time_constant_up, 0.0125);
  EXPECT_EQ(other.time_constant_down, 0.025);
  EXPECT_EQ(other.density, 1025.0);
  EXPECT_EQ(other.readout.noises.at(0).deviation, 0.1);
}

TEST_F(Fluids, ReadFinsAndDragWhichMakeNoRobot) {
  const World world =
      read(vessel("", "",
                  "<cohort:fin name=\"wing\"><cohort:area>0.2</cohort:area><cohort:cla>5</cohort:cla></cohort:fin>"
                  "<cohort:drag name=\"hull\"><cohort:pose>0 0 -0.1 0 0 0</cohort:pose>"
                  "<cohort:quadratic_damping>8 40 60</cohort:quadratic_damping></cohort:drag>"));
  EXPECT_TRUE(world.robots.empty());
  const Model& model = world.models[0];
  ASSERT_EQ(model.fins.size(), 1u);
  EXPECT_EQ(model.fins[0].name, "wing");
  EXPECT_EQ(model.fins[0].link, 0u);
  EXPECT_EQ(model.fins[0].area, 0.2);
  EXPECT_EQ(model.fins[0].cla, 5.0);
  EXPECT_EQ(model.fins[0].cda, 0.01);
  EXPECT_EQ(model.fins[0].cda_stall, 1.0);
  EXPECT_EQ(model.fins[0].alpha_stall, std::numbers::pi / 2);
  ASSERT_EQ(model.drags.size(), 1u);
  EXPECT_EQ(model.drags[0].X_LD.position.z(), -0.1);
  EXPECT_EQ(model.drags[0].quadratic_damping, Eigen::Vector3d(8, 40, 60));
  EXPECT_EQ(model.drags[0].damping, Eigen::Vector3d::Zero());
}

std::string hull_with(const std::string& added_mass) {
  return "<model name=\"m\"><link name=\"a\"><inertial><mass>2</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz>"
         "</inertia><fluid_added_mass>" +
         added_mass + "</fluid_added_mass></inertial></link></model>";
}

TEST_F(Fluids, ReadAddedMassInTheOrderOfSdf) {
  const World world =
      read(hull_with("<xx>5</xx><yy>6</yy><zz>7</zz><pp>8</pp><qq>9</qq><rr>10</rr><xy>0.1</xy>"
                     "<yr>0.2</yr><zq>-0.3</zq><pr>0.4</pr>"));
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  ASSERT_TRUE(world.models[0].links[0].inertial.added_mass);
  SpatialMatrix expected = SpatialMatrix::Zero();  // p, q, r, x, y, z
  expected.diagonal() << 8, 9, 10, 5, 6, 7;
  expected(3, 4) = expected(4, 3) = 0.1;
  expected(4, 2) = expected(2, 4) = 0.2;
  expected(5, 1) = expected(1, 5) = -0.3;
  expected(0, 2) = expected(2, 0) = 0.4;
  EXPECT_EQ(*world.models[0].links[0].inertial.added_mass, expected);
  EXPECT_FALSE(read(hull_with("<xx>0</xx>")).models[0].links[0].inertial.added_mass);
}

TEST_F(Fluids, RefuseAddedMassThatMakesInertiaNegative) {
  const std::string reason = "expected a matrix that makes the inertia of the link positive definite";
  const auto problems = [&](const std::string& added_mass) {
    return problems_of([&] { read(hull_with(added_mass)); });
  };
  for (const std::string bad : {"<xx>-2.1</xx>", "<xq>3</xq>"}) {
    ASSERT_EQ(problems(bad).size(), 1u) << bad;
    EXPECT_EQ(problems(bad)[0].message, reason);
  }
  EXPECT_EQ(problems("<yy>inf</yy>").size(), 1u);
  EXPECT_EQ(problems("<yy>x</yy>").size(), 1u);
  EXPECT_TRUE(problems("<xx>-1.9</xx>").empty());
}

TEST_F(Fluids, ReadAirWindAndWater) {
  const World dry = read(vessel(""));
  EXPECT_FALSE(dry.water);
  EXPECT_EQ(dry.air.density, 1.225);
  EXPECT_EQ(dry.air.wind, Eigen::Vector3d::Zero());
  const World wet = read(
      "<wind><linear_velocity>3 -1 0.5</linear_velocity></wind><cohort:air><cohort:density>1.1</cohort:density>"
      "<cohort:force_approximation_scaling_factor>0</cohort:force_approximation_scaling_factor></cohort:air>"
      "<cohort:water><cohort:level>0.5</cohort:level><cohort:current>0.1 0 0</cohort:current></cohort:water>");
  EXPECT_TRUE(wet.warnings.empty()) << texts_of(wet.warnings);
  EXPECT_EQ(wet.air.density, 1.1);
  EXPECT_EQ(wet.air.wind, Eigen::Vector3d(3, -1, 0.5));
  EXPECT_EQ(wet.air.wind_force, 0.0);
  ASSERT_TRUE(wet.water);
  EXPECT_EQ(wet.water->level, 0.5);
  EXPECT_EQ(wet.water->density, 1000.0);
  EXPECT_EQ(wet.water->current, Eigen::Vector3d(0.1, 0, 0));
}

TEST_F(Fluids, AcceptVectorsAsListsInYaml) {
  const auto read_yaml = [&](const std::string& devices) {
    return parsing::read_world(write("world.yaml",
                                     "world:\n  cohort:water: {current: [0.1, 0.2, 0]}\n  model:\n    name: m\n"
                                     "    link: {name: a, cohort:density: 1, collision: {geometry: "
                                     "{sphere: {radius: 1}}}}\n" +
                                         devices),
                               1);
  };
  EXPECT_EQ(read_yaml("").water->current, Eigen::Vector3d(0.1, 0.2, 0));
  for (const std::string places : {"[[1, 2, 3], [4, 5, 6]]", "['1 2 3', '4 5 6']"}) {
    const World world = read_yaml("    cohort:ground_sensors: {name: s, link: a, range: 1, place: " + places + "}\n");
    const auto& sensors = std::get<GroundSensors>(world.models[0].devices.at(0));
    ASSERT_EQ(sensors.places_L.size(), 2u);
    EXPECT_EQ(sensors.places_L[1], Eigen::Vector3d(4, 5, 6));
  }
}

TEST_F(Fluids, InheritEnableWindFromTheModel) {
  const auto who_feels = [&](const std::string& in_model, const std::string& in_link) {
    const World world = read(vessel("", in_model, in_link));
    EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
    return std::pair(world.models[0].links[0].feels_wind, world.models[0].links[1].feels_wind);
  };
  const std::string on = "<enable_wind>true</enable_wind>", off = "<enable_wind>false</enable_wind>";
  EXPECT_EQ(who_feels("", ""), std::pair(false, false));
  EXPECT_EQ(who_feels(on, ""), std::pair(true, true));
  EXPECT_EQ(who_feels("", on), std::pair(true, false));
  EXPECT_EQ(who_feels(on, off), std::pair(false, true));
}

TEST_F(Fluids, ReportProblemsWithPosition) {
  const std::string model = "world/model[m]";
  const auto expect_rotor_flaw = [&](const std::string& keys, const std::string& child, const std::string& message) {
    SCOPED_TRACE(keys);
    expect_only_flaw({"", 3, model + "/cohort:rotor[r]" + child, message}, write_world(vessel(rotor(keys))));
  };
  expect_rotor_flaw("<cohort:direction>left</cohort:direction>", "/cohort:direction", "known: ccw, cw");
  expect_rotor_flaw("<cohort:min_velocity>1</cohort:min_velocity>", "/cohort:min_velocity", "at most 0 rad/s");
  expect_rotor_flaw("<cohort:moment_constant>-1</cohort:moment_constant>", "/cohort:moment_constant", "a number >= 0");
  expect_rotor_flaw("<cohort:density>0</cohort:density>", "/cohort:density", "a number > 0");
  expect_rotor_flaw("<cohort:time_constant>1</cohort:time_constant>", "/cohort:time_constant", "time_constant_up");
  expect_only_flaw({"", 3, model + "/cohort:rotor[r]/cohort:link", "has no link 'c'"},
                   write_world(vessel("<cohort:rotor name=\"r\"><cohort:link>c</cohort:link><cohort:max_velocity>1"
                                      "</cohort:max_velocity><cohort:motor_constant>1</cohort:motor_constant>"
                                      "</cohort:rotor>")));
  expect_only_flaw({"", 3, model + "/cohort:rotor[r]/cohort:motor_constant", "missing"},
                   write_world(vessel("<cohort:rotor name=\"r\"><cohort:link>a</cohort:link><cohort:max_velocity>1"
                                      "</cohort:max_velocity></cohort:rotor>")));
  const auto expect_link_flaw = [&](const std::string& part, const std::string& where, const std::string& message) {
    SCOPED_TRACE(part);
    expect_only_flaw({"", 2, model + "/link[a]/" + where, message}, write_world(vessel("", "", part)));
  };
  const std::string fin = "<cohort:fin name=\"f\"><cohort:cla>5</cohort:cla>";
  expect_link_flaw(fin + "</cohort:fin>", "cohort:fin[f]/cohort:area", "missing");
  expect_link_flaw(fin + "<cohort:area>1</cohort:area><cohort:alpha_stall>1.7</cohort:alpha_stall></cohort:fin>",
                   "cohort:fin[f]/cohort:alpha_stall", "a quarter turn");
  expect_link_flaw("<cohort:drag name=\"d\"><cohort:damping>1 -1 0</cohort:damping></cohort:drag>",
                   "cohort:drag[d]/cohort:damping", "three numbers >= 0");
  expect_link_flaw("<cohort:drag><cohort:damping>1 1 0</cohort:damping></cohort:drag>", "cohort:drag", "name");
  expect_only_flaw({"", 3, "world/cohort:water", "given twice"}, write_world("<cohort:water/>\n<cohort:water/>"));
  expect_only_flaw({"", 2, "world/cohort:air/cohort:density", "a number >= 0"},
                   write_world("<cohort:air><cohort:density>-1</cohort:density></cohort:air>"));
  expect_only_flaw({"", 2, "world/wind/linear_velocity", "cannot have the value"},
                   write_world("<wind><linear_velocity>1 x 0</linear_velocity></wind>"));
}

}  // namespace
}  // namespace cohort::description
