// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include "tests/support/worlds/written_worlds.hpp"

// Tests of reading the frames in which directions of friction are written.
namespace cohort::description {
namespace {

using FrictionFrames = Description;

std::string directed(const std::string& attribute, const std::string& frame) {
  return "<pose>0 0 0 0 0 1.5707963267948966</pose><geometry><sphere><radius>0.1</radius></sphere></geometry>"
         "<surface><friction><ode><mu2>0</mu2>\n<fdir1 " +
         attribute + "=\"" + frame + "\">1 0 0</fdir1></ode></friction></surface>";
}

std::string wheeled(const std::string& attribute, const std::string& frame) {
  std::string wheel = links("b");
  wheel.insert(wheel.find("</link>"), "<collision name=\"c\">" + directed(attribute, frame) + "</collision>");
  return "<model name=\"m\">" + wheel + links("a") +
         "<frame name=\"on_wheel\" attached_to=\"b\"/><frame name=\"on_chassis\" attached_to=\"a\"><pose>0 0 0 0 0 "
         "0.5</pose></frame>" +
         joint("j", "a", "b", "<xyz>0 1 0</xyz>") + "</model>";
}

TEST_F(FrictionFrames, KeepTheFrameOfAnotherLinkForTheDirectionOfFriction) {
  for (const char* const attribute : {"gz:expressed_in", "ignition:expressed_in"}) {
    const World world = read(wheeled(attribute, "on_chassis"));
    EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
    const Model& model = world.models[0];
    ASSERT_EQ(model.links[1].name, "b") << "the root is first";
    const Surface& surface = model.links[1].collisions[0].surface;
    EXPECT_EQ(surface.friction_link, 0u);
    EXPECT_LT((surface.friction_direction - Eigen::Vector3d(std::cos(0.5), std::sin(0.5), 0.0)).norm(), 1e-12);
  }
}

TEST_F(FrictionFrames, ConvertTheDirectionOfFrictionFromAFrameThatMovesWithTheCollision) {
  const World wheels = read(wheeled("gz:expressed_in", "on_wheel"));
  const Surface& surface = wheels.models[0].links[1].collisions[0].surface;
  EXPECT_FALSE(surface.friction_link);
  EXPECT_LT((surface.friction_direction - Eigen::Vector3d(0, -1, 0)).norm(), 1e-12);
  const World still =
      read(static_model_sdf("<link name=\"l\"><collision name=\"c\">" + directed("gz:expressed_in", "f") +
                            "</collision></link><frame name=\"f\"><pose>0 0 0 0 0 3.141592653589793"
                            "</pose></frame>"));
  EXPECT_LT((still.models[0].links[0].collisions[0].surface.friction_direction - Eigen::Vector3d(0, 1, 0)).norm(),
            1e-12);
}

TEST_F(FrictionFrames, ReportAnUnknownFrameOfTheDirectionOfFriction) {
  expect_only_flaw(
      {wheeled("gz:expressed_in", "x"), 3, "world/model[m]/link[b]/collision[c]/surface/friction/ode/fdir1",
       "expressed_in refers to a frame 'x' that does not exist"},
      write_world(wheeled("gz:expressed_in", "x")));
  const World world = parsing::read_world(write("foreign.sdf", "<sdf version=\"1.9\"><world name=\"w\">" +
                                                                   wheeled("gz:expressed_in", "x") + "</world></sdf>"),
                                          1);
  EXPECT_NE(texts_of(world.warnings).find("does not exist; the direction is used in the frame of the collision"),
            std::string::npos)
      << texts_of(world.warnings);
  EXPECT_EQ(world.models[0].links[1].collisions[0].surface.friction_direction, Eigen::Vector3d::UnitX());
}

}  // namespace
}  // namespace cohort::description
