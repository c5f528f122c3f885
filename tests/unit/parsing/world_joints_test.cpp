// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "tests/support/worlds/written_worlds.hpp"

// Tests of joints between the models of a world, and of models that are merged into it.
namespace cohort::description {
namespace {

class WorldJoints : public Description {
 protected:
  WorldJoints() {
    write("two.sdf", "<sdf version=\"1.9\"><model name=\"two\">" + links("ab") + joint("j", "a", "b") +
                         "<frame name=\"f\" attached_to=\"b\"/></model></sdf>");
  }
};

std::string fixed(const std::string& parent, const std::string& child, const std::string& type = "fixed") {
  return "\n<joint name=\"bolt\" type=\"" + type + "\"><parent>" + parent + "</parent><child>" + child +
         "</child></joint>";
}

std::string model(const std::string& name, const std::string& pose = "") {
  return "<model name=\"" + name + "\"><pose>" + pose + "</pose>" + links("a") + "</model>";
}

std::string include(const std::string& name) {
  return "<include><uri>two.sdf</uri><name>" + name + "</name></include>";
}

// Returns the links that are fixed to the world.
std::string held_links(const World& world, std::size_t instance) {
  std::string names;
  const Model& model = world.models[world.instances[instance].model];
  for (const std::vector<Joint>* const joints : {&model.joints, &model.loop_joints})
    for (const Joint& joint : *joints)
      if (joint.parent == Joint::world && joint.type == JointType::fixed) names += model.links[joint.child].name;
  return names;
}

TEST_F(WorldJoints, HoldTheCanonicalLinkOfAModel) {
  for (const std::string& joint : {fixed("world", "m"), fixed("world", "m::a"), fixed("m", "world")}) {
    const World world = read(model("m", "1 2 3 0 0 0") + model("n", "2 2 3 0 0 0") + joint);
    EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
    ASSERT_EQ(world.instances.size(), 2u);
    EXPECT_EQ(held_links(world, 0), "a");
    EXPECT_EQ(held_links(world, 1), "");
    EXPECT_EQ(world.instances[0].X_WM.position, Eigen::Vector3d(1, 2, 3));
  }
}

TEST_F(WorldJoints, HoldOneOfSeveralIncludesOfAModel) {
  const World world = read(include("m") + include("n") + include("o") + fixed("world", "n::f"));
  ASSERT_EQ(world.instances.size(), 3u);
  EXPECT_EQ(held_links(world, 0), "");
  EXPECT_EQ(held_links(world, 2), "");
  std::size_t held = 0;
  while (world.instances[held].name != "n") ++held;
  EXPECT_EQ(held_links(world, held), "b");
}

TEST_F(WorldJoints, FollowFramesOfTheWorld) {
  const World world = read(model("m") + model("n") +
                           "<frame name=\"wall\"/><frame name=\"hook\" attached_to=\"m::a\"/>" + fixed("wall", "hook"));
  EXPECT_EQ(held_links(world, 0), "a");
  const World tied = read(model("m") + model("n") + "<frame name=\"hook\" attached_to=\"m::a\"/>" + fixed("hook", "n"));
  ASSERT_EQ(tied.breakable_joints.size(), 1u);
  EXPECT_EQ(tied.instances[tied.breakable_joints[0].second].name, "m");
}

std::string hinge(const std::string& parent, const std::string& child, const std::string& content) {
  std::string joint = fixed(parent, child, "revolute");
  return joint.insert(joint.rfind("</joint>"), content);
}

TEST_F(WorldJoints, ToTheWorldAreJointsOfTheModel) {
  const World world = read(model("m", "1 2 3 0 0 0") + model("n") +
                           hinge("world", "m::a",
                                 "<pose>0 0 0.5 0 0 0</pose><axis><xyz>0 1 0</xyz><limit><lower>-1</lower><upper>2"
                                 "</upper></limit></axis>"));
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  const Model& model = world.models[world.instances[0].model];
  ASSERT_EQ(model.joints.size(), 1u);
  EXPECT_EQ(model.joints[0].parent, Joint::world);
  EXPECT_EQ(model.joints[0].type, JointType::revolute);
  EXPECT_EQ(model.joints[0].X_LJ.position.z(), 0.5);
  EXPECT_EQ(model.joints[0].axis.direction, Eigen::Vector3d::UnitY());
  EXPECT_EQ(model.joints[0].axis.upper, 2.0);
}

TEST_F(WorldJoints, BetweenTwoModelsMayTurn) {
  const World world = read(model("m") + model("n") +
                           hinge("m::a", "n",
                                 "<pose>0 0 0.5 0 0 0</pose><axis><xyz>0 2 0</xyz><dynamics><damping>0.3</damping>"
                                 "</dynamics></axis>"));
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  ASSERT_EQ(world.breakable_joints.size(), 1u);
  const BreakableJoint& joint = world.breakable_joints[0];
  EXPECT_EQ(world.instances[joint.first].name, "n");
  EXPECT_EQ(world.instances[joint.second].name, "m");
  EXPECT_EQ(joint.type, JointType::revolute);
  EXPECT_EQ(joint.axis_P, Eigen::Vector3d::UnitY());
  EXPECT_EQ(joint.damping, 0.3);
  ASSERT_TRUE(joint.X_LP);
  EXPECT_EQ(joint.X_LP->position.z(), 0.5);
  const World ball = read(model("m") + model("n") + fixed("m", "n", "ball"));
  EXPECT_EQ(ball.breakable_joints.at(0).type, JointType::ball);
  const World limited =
      read(model("m") + model("n") + hinge("m", "n", "<axis><limit><lower>-1</lower></limit></axis>"));
  ASSERT_EQ(limited.warnings.size(), 1u) << texts_of(limited.warnings);
  EXPECT_EQ(limited.warnings[0].message, "a joint between two models has no limits, and turns freely");
}

TEST_F(WorldJoints, ThatAreFixedNeedNoLimits) {
  std::string bolt = fixed("m", "n");
  bolt.insert(bolt.rfind("</joint>"), "<axis><xyz>0 1 0</xyz><limit><lower>0</lower><upper>0</upper></limit></axis>");
  const World world = read(model("m") + model("n") + bolt);
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  EXPECT_EQ(world.breakable_joints.at(0).type, JointType::fixed);
}

TEST_F(WorldJoints, OfOtherKindsAreIgnoredWithAWarning) {
  const auto expect_warning = [&](const std::string& joint, const std::string& message) {
    const World world = read(model("m") + model("n") + joint);
    ASSERT_EQ(world.warnings.size(), 1u) << texts_of(world.warnings);
    EXPECT_EQ(world.warnings[0].element, "world/joint[bolt]");
    EXPECT_EQ(world.warnings[0].line, 3);
    EXPECT_NE(world.warnings[0].message.find(message), std::string::npos) << world.warnings[0].message;
    EXPECT_EQ(held_links(world, 0), "");
  };
  expect_warning(fixed("m", "n", "universal"), "only if they are fixed, revolute, continuous or ball");
  expect_warning(fixed("m", "world", "revolute"), "expected the world as its parent");
  expect_warning(hinge("m", "f", "") + "<frame name=\"f\" attached_to=\"n\"/>",
                 "expected a model or a link as its child");
  expect_warning(hinge("m", "n", "<pose relative_to=\"m\"/>"),
                 "relative_to=\"m\" is supported only in joints of a model");
  expect_warning(hinge("m", "n", "<axis><xyz expressed_in=\"m\">0 1 0</xyz></axis>"), "expressed_in=\"m\"");
  expect_warning("<frame name=\"f\"/>" + fixed("world", "f"), "connects the world to itself; expected a model");
}

TEST_F(WorldJoints, NameAModelOfTheWorld) {
  const std::string content = model("m") + fixed("world", "x::a");
  expect_only_flaw({content, 3, "world/joint[bolt]", "the world has no model 'x' that the joint could hold"},
                   write_world(content));
}

const std::string merging = "<include merge=\"true\"><uri>merged.sdf</uri><pose>10 0 0 0 0 0</pose></include>";

TEST_F(WorldJoints, ComeWithAModelThatIsMergedIntoTheWorld) {
  write("merged.sdf", "<sdf version=\"1.10\"><model name=\"merged\">" + include("one") + model("other", "0 5 0 0 0 0") +
                          model("third", "0 9 0 0 0 0") + fixed("one", "other") + "</model></sdf>");
  const World world = read(model("m") + merging +
                           "<joint name=\"nail\" type=\"fixed\"><parent>world</parent><child>third</child></joint>");
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  ASSERT_EQ(world.instances.size(), 4u);
  EXPECT_EQ(world.instances[1].name, "one");
  EXPECT_EQ(world.instances[1].X_WM.position, Eigen::Vector3d(10, 0, 0));
  EXPECT_EQ(world.instances[2].name, "other");
  EXPECT_EQ(world.instances[2].X_WM.position, Eigen::Vector3d(10, 5, 0));
  EXPECT_EQ(held_links(world, 3), "a");
  ASSERT_EQ(world.breakable_joints.size(), 1u);
  EXPECT_EQ(world.breakable_joints[0].first, 2u);
}

TEST_F(WorldJoints, CannotMergeAModelWithLinks) {
  write("merged.sdf", "<sdf version=\"1.10\">" + model("merged") + "</sdf>");
  expect_only_flaw(
      {merging, 2, "world/include", "the model 'merged' cannot be merged into a world, because it has a <link>"},
      write_world(merging));
}

}  // namespace
}  // namespace cohort::description
