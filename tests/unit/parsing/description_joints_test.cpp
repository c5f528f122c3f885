// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "server/core/infinity.hpp"
#include "tests/support/worlds/written_worlds.hpp"

// Tests of reading joints, and devices on them.
namespace cohort::description {
namespace {

std::string model(const std::string& content) { return "<model name=\"m\">" + content + "</model>"; }
std::string universal(const std::string& second) {
  return "<joint name=\"j\" type=\"universal\"><parent>a</parent><child>b</child><axis><xyz>1 0 0</xyz></axis>\n" +
         second + "</joint>";
}

using Joints = Description;

// A joint k to a link b that follows another one.
std::string mimic(const std::string& keys, const std::string& leader) {
  return "\n<joint name=\"k\" type=\"revolute\"><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis>"
         "<cohort:mimic>\n<cohort:joint>" +
         leader + "</cohort:joint>" + keys + "</cohort:mimic></joint>";
}
std::string gearbox(double ratio, const std::string& parent, const std::string& child, const std::string& reference) {
  return "\n<joint name=\"gears\" type=\"gearbox\"><parent>" + parent + "</parent><child>" + child +
         "</child><gearbox_ratio>" + std::to_string(ratio) + "</gearbox_ratio><gearbox_reference_body>" + reference +
         "</gearbox_reference_body><axis><xyz>0 0 1</xyz></axis><axis2><xyz>0 0 1</xyz></axis2></joint>";
}
const std::string in_mimic = "world/model[m]/joint[k]/cohort:mimic";

TEST_F(Joints, ReadBothAxesOfAUniversalJoint) {
  const World world = read(model(
      links("ab") + universal("<axis2><xyz>0 2 0</xyz><limit><lower>-1</lower><upper>0.5</upper></limit><dynamics>"
                              "<damping>0.1</damping><friction>0.2</friction><spring_stiffness>3</spring_stiffness>"
                              "<spring_reference>-0.4</spring_reference></dynamics></axis2>")));
  const Joint& found = world.models[0].joints[0];
  EXPECT_EQ(found.type, JointType::universal);
  EXPECT_EQ(found.axis.direction, Eigen::Vector3d::UnitX());
  EXPECT_EQ(found.axis.upper, infinity);
  EXPECT_EQ(found.axis.spring_stiffness, 0.0);
  EXPECT_EQ(found.second_axis.direction, Eigen::Vector3d::UnitY());
  EXPECT_EQ(found.second_axis.lower, -1.0);
  EXPECT_EQ(found.second_axis.upper, 0.5);
  EXPECT_EQ(found.second_axis.damping, 0.1);
  EXPECT_EQ(found.second_axis.friction, 0.2);
  EXPECT_EQ(found.second_axis.spring_stiffness, 3.0);
  EXPECT_EQ(found.second_axis.spring_reference, -0.4);
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
}

TEST_F(Joints, HaveRigidLimitsByDefault) {
  const auto with = [](const std::string& give) {
    return model(links("ab") + joint("j", "a", "b",
                                     "<xyz>0 0 1</xyz><limit><lower>-1</lower><upper>1</upper>" + give + "</limit>",
                                     "revolute"));
  };
  for (const char* rigid :
       {"", "<stiffness>1e8</stiffness><dissipation>1</dissipation>", "<stiffness>1e9</stiffness>"}) {
    const World world = read(with(rigid));
    EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
    EXPECT_EQ(world.models[0].joints[0].axis.limit_stiffness, infinity) << rigid;
  }
  const JointAxis axis = read(with("<stiffness>200</stiffness><dissipation>3</dissipation>")).models[0].joints[0].axis;
  EXPECT_EQ(axis.limit_stiffness, 200.0);
  EXPECT_EQ(axis.limit_damping, 3.0);
  EXPECT_NE(texts_of(read(with("<dissipation>3</dissipation>")).warnings).find("<dissipation> is ignored"),
            std::string::npos);
}

TEST_F(Joints, ReadDampingAndFrictionOfABallJoint) {
  const World world =
      read(model(links("abc") +
                 joint("j", "a", "b",
                       "<xyz>0 0 1</xyz><dynamics><damping>0.1</damping><friction>0.2</friction></dynamics>", "ball") +
                 "<joint name=\"k\" type=\"ball\"><parent>b</parent><child>c</child></joint>"));
  const Joint& found = world.models[0].joints[0];
  EXPECT_EQ(found.type, JointType::ball);
  EXPECT_EQ(found.axis.damping, 0.1);
  EXPECT_EQ(found.axis.friction, 0.2);
  EXPECT_EQ(world.models[0].joints[1].axis.damping, 0.0);
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
}

TEST_F(Joints, WarnOfLimitsAndSpringsOfABallJoint) {
  const World world =
      read(model(links("ab") + joint("j", "a", "b",
                                     "<xyz>0 0 1</xyz>\n<limit><lower>-1</lower><upper>1</upper></limit>\n<dynamics>"
                                     "<spring_stiffness>1</spring_stiffness></dynamics>",
                                     "ball")));
  EXPECT_EQ(world.models[0].joints[0].axis.upper, infinity);
  EXPECT_EQ(world.models[0].joints[0].axis.spring_stiffness, 0.0);
  const std::string all = texts_of(world.warnings);
  EXPECT_EQ(world.warnings.size(), 2u) << all;
  EXPECT_NE(all.find(":3: world/model[m]/joint[j]/axis/limit: "), std::string::npos) << all;
  EXPECT_NE(all.find(":4: world/model[m]/joint[j]/axis/dynamics/spring_stiffness: "), std::string::npos) << all;
}

TEST_F(Joints, FixTheRootToTheWorld) {
  const World world =
      read(model(links("cab") + joint("one", "a", "b") + joint("hinge", "world", "a") + joint("two", "b", "c")));
  const Model& found = world.models[0];
  EXPECT_EQ(found.links[0].name, "a");
  EXPECT_EQ(found.joints[1].parent, Joint::world);
  EXPECT_EQ(found.joints[1].child, 0u);
  EXPECT_EQ(found.joints[0].parent, 0u);
  EXPECT_EQ(found.joints[2].child, 2u);
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
}

TEST_F(Joints, ReadSelfCollision) {
  EXPECT_FALSE(read(model(links("a"))).models[0].self_collide);
  const World world = read(model("<self_collide>true</self_collide>" + links("a")));
  EXPECT_TRUE(world.models[0].self_collide);
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
}

TEST_F(Joints, LimitTheirMotors) {
  const std::string limit = "<xyz>0 0 1</xyz><limit><effort>3</effort><velocity>2</velocity></limit>";
  const auto motor_of = [](double effort) {
    return "\n<cohort:velocity_motor "
           "name=\"d\"><cohort:joint>j</cohort:joint><cohort:max_velocity>1</cohort:max_velocity>"
           "\n<cohort:max_effort>" +
           std::to_string(effort) + "</cohort:max_effort></cohort:velocity_motor>";
  };
  for (const double effort : {1.0, 5.0}) {
    const World world = read(model(links("ab") + joint("j", "a", "b", limit) + motor_of(effort)));
    EXPECT_EQ(world.models[0].joints[0].axis.max_effort, 3.0);
    EXPECT_EQ(world.models[0].joints[0].axis.max_velocity, 2.0);
    const auto& motor = std::get<VelocityMotor>(world.models[0].devices[0]);
    EXPECT_EQ(motor.max_effort, std::min(effort, 3.0));
    EXPECT_EQ(motor.max_velocity, 1.0);
    EXPECT_EQ(texts_of(world.warnings).find("exceeds the <limit><effort> of its joint") != std::string::npos,
              effort > 3.0);
  }
}

TEST_F(Joints, IgnoreMotorLimitsOfZero) {
  const World world = read(model(
      links("ab") + joint("j", "a", "b", "<xyz>0 0 1</xyz><limit><effort>0</effort><velocity>0</velocity></limit>")));
  EXPECT_EQ(world.models[0].joints[0].axis.max_effort, infinity);
  EXPECT_EQ(world.models[0].joints[0].axis.max_velocity, infinity);
}

TEST_F(Joints, CloseLoops) {
  const World world = read(model(links("abc") + joint("i", "a", "b") + joint("j", "a", "c") + joint("k", "b", "c") +
                                 joint("l", "world", "a") + joint("m", "world", "b")));
  const Model& found = world.models[0];
  ASSERT_EQ(found.joints.size(), 3u);
  ASSERT_EQ(found.loop_joints.size(), 2u);
  EXPECT_EQ(found.loop_joints[0].name, "k");
  EXPECT_EQ(found.loop_joints[0].parent, 1u);
  EXPECT_EQ(found.loop_joints[0].child, 2u);
  EXPECT_EQ(found.loop_joints[1].parent, Joint::world);
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
}

TEST_F(Joints, WarnOfLimitsInLoops) {
  const World world = read(model(links("ab") + joint("i", "a", "b") + joint("j", "world", "a") + "\n" +
                                 joint("k", "world", "b", "<xyz>0 0 1</xyz><limit><lower>0</lower></limit>")));
  EXPECT_NE(texts_of(world.warnings).find(":3: world/model[m]/joint[k]: the joint 'k' closes a loop"),
            std::string::npos)
      << texts_of(world.warnings);
}

TEST_F(Joints, ReadScrewsAndRevolute2) {
  const World world =
      read(model(links("abc") +
                 "<joint name=\"s\" type=\"screw\"><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis>"
                 "<thread_pitch>-100</thread_pitch></joint>"
                 "<joint name=\"r\" type=\"revolute2\"><parent>a</parent><child>c</child><axis><xyz>1 0 0</xyz></axis>"
                 "<axis2><xyz>0 1 0</xyz></axis2></joint>"));
  EXPECT_EQ(world.models[0].joints[0].type, JointType::screw);
  EXPECT_NEAR(world.models[0].joints[0].thread_pitch, 2.0 * M_PI / 100.0, 1e-15) << "metres a turn, right-handed";
  EXPECT_EQ(world.models[0].joints[1].type, JointType::universal);
}

TEST_F(Joints, FollowOtherJointsByMimicAndGearbox) {
  const World followed =
      read(model(links("abc") + joint("j", "a", "c") +
                 mimic("<cohort:multiplier>-2</cohort:multiplier><cohort:offset>0.5</cohort:offset>", "j")));
  ASSERT_EQ(followed.models[0].couplings.size(), 1u);
  EXPECT_EQ(followed.models[0].couplings[0].follower, 1u);
  EXPECT_EQ(followed.models[0].couplings[0].leader, 0u);
  EXPECT_EQ(followed.models[0].couplings[0].multiplier, -2.0);
  EXPECT_EQ(followed.models[0].couplings[0].offset, 0.5);

  // The second joint turns in the opposite direction, against the axis of the gearbox.
  for (const double along : {1.0, -1.0}) {
    const World geared = read(model(links("abc") + joint("i", "a", "b") +
                                    joint("j", "a", "c", along > 0.0 ? "<xyz>0 0 1</xyz>" : "<xyz>0 0 -1</xyz>") +
                                    gearbox(3.0, "b", "c", "a")));
    ASSERT_EQ(geared.models[0].joints.size(), 2u);
    ASSERT_EQ(geared.models[0].couplings.size(), 1u);
    EXPECT_EQ(geared.models[0].couplings[0].follower, 1u);
    EXPECT_EQ(geared.models[0].couplings[0].multiplier, -3.0 * along);
  }
}

TEST_F(Joints, ThatFollowEachOtherBelongToOneBodyAlsoOnTheWorld) {
  const std::string followed = joint("j", "world", "b");
  const std::string follower =
      "<joint name=\"k\" type=\"revolute\"><parent>world</parent><child>c</child><axis><xyz>0 0 "
      "1</xyz><mimic joint=\"j\"/></axis></joint>";
  for (const std::string& joints : {followed + follower, follower + followed}) {
    const World world = read(model(links("abc") + joints));
    ASSERT_EQ(world.models.size(), 2u) << "the link 'a' is free";
    const Model& fingers = world.models[1];
    ASSERT_EQ(fingers.couplings.size(), 1u);
    EXPECT_EQ(fingers.joints.at(fingers.couplings[0].leader).name, "j");
    EXPECT_EQ(fingers.joints.at(fingers.couplings[0].follower).name, "k");
  }
}

TEST_F(Joints, FollowByEitherAxisAndWithOneOfThem) {
  const auto coupled = [](const std::string& on_first, const std::string& on_second) {
    return model(links("abc") + joint("i", "a", "b") +
                 "<joint name=\"j\" type=\"universal\"><parent>a</parent><child>c</child><axis><xyz>1 0 0</xyz>" +
                 on_first + "</axis><axis2><xyz>0 1 0</xyz>" + on_second + "</axis2></joint>");
  };
  const auto expect_axes = [&](const std::string& content, bool moves_second, bool follows_second) {
    const World world = read(content);
    EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
    ASSERT_EQ(world.models[0].couplings.size(), 1u);
    EXPECT_EQ(world.models[0].couplings[0].moves_second_axis, moves_second);
    EXPECT_EQ(world.models[0].couplings[0].follows_second_axis, follows_second);
  };
  expect_axes(coupled("<mimic joint=\"i\"/>", ""), false, false);
  expect_axes(coupled("<mimic joint=\"i\" axis=\"axis\"/>", ""), false, false);
  expect_axes(coupled("", "<mimic joint=\"i\"/>"), true, false);
  expect_axes(model(links("abc") + joint("i", "a", "b", "<xyz>0 0 1</xyz><mimic joint=\"j\" axis=\"axis2\"/>") +
                    "<joint name=\"j\" type=\"universal\"><parent>a</parent><child>c</child><axis><xyz>1 0 0</xyz>"
                    "</axis><axis2><xyz>0 1 0</xyz></axis2></joint>"),
              false, true);

  const World both = read(coupled("<mimic joint=\"i\"/>", "<mimic joint=\"i\"/>"));
  ASSERT_EQ(both.models[0].couplings.size(), 1u);
  EXPECT_FALSE(both.models[0].couplings[0].moves_second_axis);
  ASSERT_EQ(both.warnings.size(), 1u) << texts_of(both.warnings);
  EXPECT_EQ(both.warnings[0].element, "world/model[m]/joint[j]/axis2/mimic");
  EXPECT_NE(both.warnings[0].message.find("only one of its axes can follow"), std::string::npos);

  const std::vector<Problem> problems = problems_of([&] { read(coupled("<mimic joint=\"i\" axis=\"axis2\"/>", "")); });
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].message.find("the joint 'i' has one axis, and no 'axis2'"), std::string::npos)
      << problems[0].message;
}

std::string device(const std::string& kind, const std::string& keys) {
  return "<cohort:" + kind + " name=\"d\">\n" + keys + "</cohort:" + kind + ">";
}
std::string key(const std::string& name, const std::string& value) {
  return "<cohort:" + name + ">" + value + "</cohort:" + name + ">";
}
std::string motor_of(const std::string& joint_name) {
  return key("joint", joint_name) + key("max_velocity", "1") + key("max_effort", "1");
}
std::string drive_with(const std::string& wheels) {
  return device("treel_drive", key("link", "a") + key("half_gauge", "0.1") + key("half_contact_length", "0.1") +
                                   key("ground_height", "0") + key("wheel_radius", "0.1") + key("max_torque", "1") +
                                   key("max_velocity", "1") + key("friction", "1") + "\n" + wheels);
}
std::string cart() {
  return links("abcde") + joint("to_b", "a", "b") + joint("to_c", "a", "c") + joint("to_d", "a", "d") +
         joint("to_e", "b", "e") + "\n";
}

TEST_F(Joints, DriveAndMeasureTheFirstAxisOfAUniversalJoint) {
  const World world = read(model(links("ab") + universal("<axis2><xyz>0 1 0</xyz></axis2>") +
                                 device("velocity_motor", motor_of("j")) + device("joint_encoder", key("joint", "j"))));
  EXPECT_EQ(std::get<VelocityMotor>(world.models[0].devices[0]).joint, 0u);
  EXPECT_EQ(std::get<JointEncoder>(world.models[0].devices[1]).joint, 0u);
}

TEST_F(Joints, ReadTheWheelsOfATreelDrive) {
  const World world = read(
      model(cart() + drive_with(key("left_wheel", "to_d") + key("right_wheel", "to_c") + key("left_wheel", "to_b"))));
  const auto& drive = std::get<TreelDrive>(world.models[0].devices[0]);
  EXPECT_EQ(drive.left_wheels, (std::vector<std::size_t>{2, 0}));
  EXPECT_EQ(drive.right_wheels, std::vector<std::size_t>{1});
  EXPECT_TRUE(std::get<TreelDrive>(read(model(cart() + drive_with(""))).models[0].devices[0]).left_wheels.empty());
}

class FlawOfAJoint : public Joints, public testing::WithParamInterface<Flaw> {};

TEST_P(FlawOfAJoint, IsReportedAloneWithFileLineAndElement) {
  expect_only_flaw(GetParam(), write_world(GetParam().content));
}

const std::string in_joint = "world/model[m]/joint[j]";
const std::string in_drive = "world/model[m]/cohort:treel_drive[d]";

std::string with_dynamics(const std::string& dynamics) {
  return model(links("ab") + joint("j", "a", "b", "<xyz>0 0 1</xyz><dynamics>\n" + dynamics + "</dynamics>"));
}
std::string with_limit(const std::string& limit) {
  return model(links("ab") + joint("j", "a", "b", "<xyz>0 0 1</xyz><limit>\n" + limit + "</limit>"));
}
INSTANTIATE_TEST_SUITE_P(
    Joints, FlawOfAJoint,
    testing::Values(
        Flaw{with_limit("<stiffness>-1</stiffness>"), 3, in_joint + "/axis/limit/stiffness",
             "expected a stiffness > 0"},
        Flaw{with_limit("<stiffness>9</stiffness><dissipation>-3</dissipation>"), 3,
             in_joint + "/axis/limit/dissipation", "expected a dissipation >= 0"},
        Flaw{with_dynamics("<damping>-1</damping>"), 3, in_joint + "/axis/dynamics/damping", "expected a damping >= 0"},
        Flaw{with_dynamics("<friction>-1</friction>"), 3, in_joint + "/axis/dynamics/friction",
             "expected a friction >= 0"},
        Flaw{with_dynamics("<spring_stiffness>-1</spring_stiffness>"), 3, in_joint + "/axis/dynamics/spring_stiffness",
             "expected a stiffness >= 0"},
        Flaw{with_dynamics("<spring_reference>inf</spring_reference>"), 3, in_joint + "/axis/dynamics/spring_reference",
             "expected a position from -1e6 to 1e6"},
        Flaw{model(links("ab") + universal("<axis2><xyz>0 0 0</xyz></axis2>")), 3, in_joint + "/axis2/xyz", "not zero"},
        Flaw{model(links("ab") + universal("<axis2><xyz>-1 0 0</xyz></axis2>")), 3, in_joint + "/axis2",
             "a direction that is not parallel to <axis>"},
        Flaw{model(links("ab") +
                   universal("<axis2><xyz>0 1 0</xyz><limit><lower>1</lower><upper>0</upper></limit></axis2>")),
             3, in_joint + "/axis2/limit", "the lower limit exceeds"},
        Flaw{model(links("ab") + "\n" + universal("")), 3, in_joint + "/axis2", "missing"},
        Flaw{model(links("ab") + mimic("", "nobody")), 4, in_mimic + "/cohort:joint", "no joint 'nobody'"},
        Flaw{model(links("ab") + mimic("", "k")), 3, in_mimic, "cannot follow itself"},
        Flaw{model(links("abc") + joint("j", "a", "c", "<xyz>0 0 1</xyz>", "ball") + mimic("", "j")), 4,
             in_mimic + "/cohort:joint", "has no single axis"},
        Flaw{model(links("abc") + joint("j", "a", "c") + joint("l", "a", "c") + mimic("", "l")), 4,
             in_mimic + "/cohort:joint", "closes a kinematic loop"},
        Flaw{model(links("abc") + joint("i", "a", "b", "<xyz>0 0 1</xyz>", "prismatic") + joint("j", "a", "c") +
                   gearbox(1, "b", "c", "a")),
             3, "world/model[m]/joint[gears]",
             "expected a revolute joint between 'b' and the gearbox_reference_body 'a'"},
        Flaw{model(links("abc") + joint("i", "a", "b") + joint("j", "a", "c") + gearbox(1, "b", "c", "d")), 3,
             "world/model[m]/joint[gears]", "no link 'd'"},
        Flaw{model(links("ab") + "\n<joint name=\"j\" type=\"screw\"><parent>a</parent><child>b</child><axis>"
                                 "<xyz>0 0 1</xyz></axis><thread_pitch>0</thread_pitch></joint>"),
             3, in_joint + "/thread_pitch", "other than 0"},
        Flaw{model(links("abc") + joint("i", "a", "b") + joint("j", "a", "c") + joint("k", "b", "c") +
                   device("velocity_motor", motor_of("k"))),
             3, "world/model[m]/cohort:velocity_motor[d]/cohort:joint", "the joint 'k' closes a kinematic loop"},
        Flaw{model(links("ab") + joint("j", "a", "b", "<xyz>0 0 1</xyz>", "ball") +
                   device("velocity_motor", motor_of("j"))),
             3, "world/model[m]/cohort:velocity_motor[d]/cohort:joint", "has no single axis"},
        Flaw{model(links("ab") + joint("j", "a", "b", "<xyz>0 0 1</xyz>", "ball") +
                   device("joint_encoder", key("joint", "j"))),
             3, "world/model[m]/cohort:joint_encoder[d]/cohort:joint", "has no single axis"},
        Flaw{model(cart() + drive_with(key("left_wheel", "to_bb"))), 5, in_drive + "/cohort:left_wheel",
             "no joint 'to_bb'"},
        Flaw{model(cart() + drive_with(key("left_wheel", "to_e"))), 5, in_drive + "/cohort:left_wheel",
             "does not connect 'a' to a wheel"},
        Flaw{model(links("ab") + joint("j", "a", "b", "<xyz>0 0 1</xyz>", "prismatic") +
                   drive_with(key("right_wheel", "j"))),
             4, in_drive + "/cohort:right_wheel", "is not revolute"},
        Flaw{model(cart() + drive_with(key("left_wheel", "to_b") + "\n" + key("right_wheel", "to_b"))), 6,
             in_drive + "/cohort:right_wheel", "is already listed as the joint of a wheel"},
        Flaw{model(cart() + drive_with(key("left_wheel", "to_b") + "\n" + key("left_wheel", "to_c") + "\n" +
                                       key("left_wheel", "to_b"))),
             7, in_drive + "/cohort:left_wheel", "is already listed as the joint of a wheel"},
        Flaw{model(cart() + drive_with(key("left_wheel", "to_b")) + "<cohort:velocity_motor name=\"n\">\n" +
                   motor_of("to_b") + "</cohort:velocity_motor>"),
             6, "world/model[m]/cohort:velocity_motor[n]/cohort:joint", "is already driven by a treel_drive"},
        Flaw{model(cart() + "<cohort:velocity_motor name=\"n\">" + motor_of("to_b") + "</cohort:velocity_motor>" +
                   drive_with(key("left_wheel", "to_b"))),
             5, in_drive + "/cohort:left_wheel", "already has a motor"}));

}  // namespace
}  // namespace cohort::description
