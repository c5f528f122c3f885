// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "server/parsing/sdf/urdf/urdf_forms.hpp"
#include "tests/support/worlds/written_worlds.hpp"

// Tests of the warnings about elements without an effect. The test of all elements compares them with their marks.
namespace cohort::description {
namespace {

class MissingEffects : public Description {
 protected:
  std::string messages_of_robot(const std::string& content) const {
    const auto file =
        write("r.urdf", "<robot name=\"r\">\n<link name=\"a\"/><link name=\"b\"/>\n" + content + "</robot>");
    return texts_of(parsing::read_world_or_model(file, 1).warnings);
  }
};

std::string slipping(const std::string& name, const std::string& slip) {
  return static_model_sdf(collision("<sphere/>", "<surface><friction><ode>\n" + slip + "</ode></friction></surface>"),
                          name);
}

void expect_warning(const Problem& warning, int line, const std::string& element, const std::string& message) {
  EXPECT_EQ(warning.line, line);
  EXPECT_EQ(warning.element, element);
  EXPECT_EQ(warning.message, message);
}

TEST_F(MissingEffects, OnMotionAreToldOnceForEachNameWithTheFirstPlaceAndTheNumber) {
  const World world = read(slipping("m", "<slip1>0.1</slip1>") + slipping("n", "<slip2>1</slip2><slip1>0.2</slip1>"));
  ASSERT_EQ(world.warnings.size(), 2u) << texts_of(world.warnings);
  const std::string below = "/link[l]/collision[c]/surface/friction/ode/";
  expect_warning(world.warnings[0], 3, "world/model[m]" + below + "slip1",
                 "<slip1> is not supported and is ignored; it occurs 2 times in this file");
  expect_warning(world.warnings[1], 4, "world/model[n]" + below + "slip2", "<slip2> is not supported and is ignored");
}

TEST_F(MissingEffects, OfAttributesNameTheirElement) {
  const World world = read("<model name=\"m\" namespace=\"n\">" + links("a") + "</model>");
  ASSERT_EQ(world.warnings.size(), 1u) << texts_of(world.warnings);
  expect_warning(world.warnings[0], 2, "world/model[m]",
                 "'namespace' of <model> is not supported and is ignored; topics have the name of the robot");
}

TEST_F(MissingEffects, OnOtherSimulatorsAreToldInOneWarningInTheirOrder) {
  const World world = read(
      "<physics type=\"ode\">\n<real_time_factor>2</real_time_factor>\n<ode><solver><iters>9</iters></solver></ode>\n"
      "</physics><audio><device>d</device></audio>\n"
      "<physics type=\"ode\"><real_time_factor>3</real_time_factor></physics>");
  ASSERT_EQ(world.warnings.size(), 1u) << texts_of(world.warnings);
  expect_warning(world.warnings[0], 3, "world/physics/real_time_factor",
                 "no effect in Cohort: <real_time_factor>, <ode>, <audio>");
}

TEST_F(MissingEffects, OfStandardValuesAndOnAppearanceAreNotTold) {
  const World world = read(
      "<physics type=\"ode\"><real_time_factor>1</real_time_factor><ode><solver><iters>50</iters></solver></ode>"
      "</physics><scene><grid>false</grid></scene>" +
      slipping("m", "<slip1>0</slip1><slip2>0.00</slip2>"));
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
}

TEST_F(MissingEffects, ThatDependOnOtherElementsAreLookedForInUnknownOnesToo) {
  const std::vector<Problem> problems = problems_of([&] {
    return read("<model name=\"m\"><link name=\"a\"><ode/><bullet><friction>3</friction></bullet></link></model>");
  });
  ASSERT_EQ(problems.size(), 2u) << texts_of(problems);
  EXPECT_TRUE(problems[0].message.starts_with("unknown element")) << texts_of(problems);
  EXPECT_TRUE(problems[1].message.starts_with("unknown element")) << texts_of(problems);
}

TEST_F(MissingEffects, OfUrdfAreTold) {
  const std::string joint =
      "<joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/>\n<axis xyz=\"0 0 1\"/>\n";
  for (const parsing::UrdfForm& form : parsing::urdf_forms()) {
    if (form.has_effect) continue;
    const std::string name(form.name);
    const bool is_of_joint = form.parent == "joint";
    const std::string messages =
        messages_of_robot(joint + (is_of_joint ? "<" + name + "/></joint>" : "</joint>\n<" + name + "/>"));
    const std::string place =
        is_of_joint ? "r.urdf:5: robot/joint[j]/" + name + ": " : "r.urdf:6: robot/" + name + ": ";
    EXPECT_NE(messages.find(place + "<" + name + "> is not supported and is ignored"), std::string::npos) << messages;
  }
}

}  // namespace
}  // namespace cohort::description
