// SPDX-License-Identifier: Apache-2.0

// Scenes that users build in their first week, at default settings and a step of 10 ms, with both dynamics.

#include <gtest/gtest.h>

#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using description::Box;
using description::JointType;
using Eigen::Vector3d;

class FirstWeek : public EveryPhysics {
 protected:
  // Sleep is off, because it would hide creep.
  static description::World awake(const Physics& physics, double friction = 1.0) {
    description::World world = physics.world(friction);
    world.physics.sleeping = false;
    return world;
  }
  // A stack of boxes of 100 mm with these masses [kg].
  struct Stack {
    SmallWorld small;
    std::vector<BodyId> boxes;

    Stack(const Physics& physics, const std::vector<double>& masses) : small(awake(physics)) {
      const Vector3d size = Vector3d::Constant(0.1);
      for (const double mass : masses)
        boxes.push_back(small.add(loose("box", Box{size}, solid_box(mass, size)),
                                  at(0, 0, 0.05 + 0.1 * static_cast<double>(boxes.size()))));
    }
    double furthest_aside() {
      double furthest = 0.0;
      for (const BodyId box : boxes) furthest = std::max(furthest, small.position(box).head<2>().norm());
      return furthest;
    }
    double top() { return small.position(boxes.back()).z(); }
  };
};
INSTANTIATE_TEST_SUITE_P(Every, FirstWeek, ::testing::Values(treel, by_bullet(treel)), name_of);

TEST_P(FirstWeek, StacksStand) {
  for (const std::size_t count : {10, 20, 40}) {
    SCOPED_TRACE(std::to_string(count) + " boxes");
    Stack stack(GetParam(), std::vector<double>(count, 1.0));
    const double top = stack.top();
    stack.small.run(30.0);
    EXPECT_LT(stack.furthest_aside(), 1e-3);
    EXPECT_NEAR(stack.top(), top, 2e-3);
  }
}

// Walls of rows that are offset by a third of a brick, and pyramids of rows that become shorter.
TEST_P(FirstWeek, WallsAndPyramidsStand) {
  const Vector3d brick(0.2, 0.1, 0.1);
  struct Heap {
    int rows;
    bool is_pyramid;
  };
  for (const Heap& heap : {Heap{7, true}, Heap{5, false}, Heap{10, false}}) {
    SCOPED_TRACE((heap.is_pyramid ? "pyramid of " : "wall of ") + std::to_string(heap.rows) + " rows");
    SmallWorld small(awake(GetParam()));
    std::vector<std::pair<BodyId, Vector3d>> bricks;
    for (int row = 0; row < heap.rows; ++row)
      for (int i = 0; i < (heap.is_pyramid ? heap.rows - row : heap.rows); ++i) {
        const double x = heap.is_pyramid ? 0.22 * (i + 0.5 * row) : 0.2 * i + 0.06 * (row % 2);
        const Vector3d place(x, 0, 0.05 + 0.1 * row);
        bricks.emplace_back(small.add(loose("brick", Box{brick}, solid_box(2.0, brick)), {place}), place);
      }
    small.run(30.0);
    for (const auto& [body, place] : bricks) {
      const Vector3d way = small.position(body) - place;
      EXPECT_LT(way.head<2>().norm(), 1e-4);
      EXPECT_NEAR(way.z(), 0.0, 1e-4);
    }
  }
}

TEST_P(FirstWeek, HeavyBoxesStandOnLightOnes) {
  for (const double mass : {20.0, 100.0}) {
    SCOPED_TRACE(std::to_string(mass) + " kg on 1 kg");
    Stack stack(GetParam(), {1.0, mass});
    stack.small.run(30.0);
    EXPECT_LT(stack.furthest_aside(), 1e-3);
    EXPECT_NEAR(stack.top(), 0.15, 2e-3);
  }
}

// A foot of 1 kg stands on a floor. A carriage on a rail allows it to slide along the rail and vertically.
TEST_P(FirstWeek, AFootOnARailSticksToTheFloor) {
  for (const double heading : {0.0, M_PI / 4, 1.0, M_PI / 2}) {
    SCOPED_TRACE("a rail that turns by " + std::to_string(heading) + " rad");
    description::Model hopper;
    hopper.name = "hopper";
    hopper.links.push_back({"carriage", {{0, 0, 0.05}}, solid_box(0.01, Vector3d::Constant(0.02)), {}});
    hopper.links.push_back({"foot",
                            {{0, 0, 0.05}},
                            solid_box(1.0, Vector3d::Constant(0.1)),
                            {{"sole", {}, Box{Vector3d::Constant(0.1)}, {1.0, 0.0}}}});
    for (std::size_t link = 0; link < 2; ++link) {
      description::Joint joint;
      joint.name = link == 0 ? "rail" : "leg";
      joint.type = JointType::prismatic;
      joint.parent = link == 0 ? description::Joint::world : 0;
      joint.child = link;
      joint.axis.direction = link == 0 ? Vector3d::UnitX() : Vector3d::UnitZ();
      hopper.joints.push_back(joint);
    }
    SmallWorld small(awake(GetParam()));
    const auto body = small.add(hopper, at(0, 0, 0, heading));
    const Vector3d along(std::cos(heading), std::sin(heading), 0);
    for (int tick = 0; tick < 100; ++tick) {
      small.world().push_body(body, LinkId{1}, {3.0 * along, Vector3d::Zero()});
      small.world().step();
    }
    EXPECT_LT(small.position(body, 1).head<2>().norm(), 1e-3) << "held by at most 10 N";

    const double speed[] = {1.0};
    const double place[] = {0.0};
    small.world().set_joint_state(body, JointId{0}, place, speed);
    small.run(1.0);
    EXPECT_LT(small.velocity(body, 1).norm(), 1e-6) << "friction stops it";
    EXPECT_NEAR(small.position(body, 1).head<2>().norm(), 1.0 / (2.0 * 9.81), 0.007);
  }
}

// An arm of 50 g is driven by 1 N m towards its limit; its tip starts 2 mm before it.
TEST_P(FirstWeek, AnArmStopsAtItsLimit) {
  for (const bool has_motor : {true, false}) {
    SCOPED_TRACE(has_motor ? "by a motor's velocity" : "by an effort");
    description::Model arm;
    arm.name = "arm";
    const Vector3d size(0.1, 0.01, 0.01);
    arm.links.push_back({"arm", {}, solid_box(0.05, size), {}});
    arm.links[0].inertial.X_LI.position.x() = 0.05;
    description::Joint hinge;
    hinge.name = "hinge";
    hinge.type = JointType::revolute;
    hinge.parent = description::Joint::world;
    hinge.child = 0;
    hinge.axis.upper = 0.5;
    arm.joints.push_back(hinge);
    if (has_motor)
      arm.devices.emplace_back(description::VelocityMotor{"motor", 0, 100.0, 1.0, 0.0});
    else
      arm.devices.emplace_back(description::EffortMotor{"motor", 0, 1.0, 0.0});
    SmallWorld small(awake(GetParam()));
    const auto body = small.add(arm, at(0, 0, 0.5));
    const double place[] = {0.5 - 0.02};
    const double rest[] = {0.0};
    small.world().set_joint_state(body, JointId{0}, place, rest);
    if (has_motor)
      small.world().set_joint_target(body, JointId{0}, physics::JointTarget::velocity(100.0));
    else
      small.world().set_joint_target(body, JointId{0}, physics::JointTarget::effort(1.0));
    double furthest = 0.0;
    for (int tick = 0; tick < 100; ++tick) {
      small.world().step();
      furthest = std::max(furthest, small.world().joint_state(body, JointId{0}).position);
    }
    EXPECT_LT(furthest, 0.5 + 0.002);
    EXPECT_NEAR(small.world().joint_state(body, JointId{0}).position, 0.5, 0.002);
  }
}

// Two fingers that slide along y press with 5 N each on a box of 200 g between them, in the air.
TEST_P(FirstWeek, FingersHoldABox) {
  const Vector3d pad(0.03, 0.01, 0.03);
  description::Model gripper;
  gripper.name = "gripper";
  gripper.links.push_back({"palm", {{0, 0, 0.5}}, solid_box(1.0, Vector3d::Constant(0.05)), {}});
  description::Joint& held = gripper.joints.emplace_back();
  held.name = "held";
  held.parent = description::Joint::world;
  for (const double side : {-1.0, 1.0}) {
    const std::string name = side < 0.0 ? "right" : "left";
    gripper.links.push_back({name, {{0, 0.03 * side, 0.4}}, solid_box(0.05, pad), {{"pad", {}, Box{pad}, {1.0, 0.0}}}});
    description::Joint slide;
    slide.name = name + "_slide";
    slide.type = JointType::prismatic;
    slide.parent = 0;
    slide.child = gripper.links.size() - 1;
    slide.axis.direction = -side * Vector3d::UnitY();
    gripper.joints.push_back(slide);
    gripper.devices.emplace_back(description::EffortMotor{name + "_motor", gripper.joints.size() - 1, 5.0, 0.0});
  }
  SmallWorld small(awake(GetParam()));
  const auto body = small.add(gripper, at(0, 0, 0));
  const Vector3d size = Vector3d::Constant(0.05);
  const auto box = small.add(loose("box", Box{size}, solid_box(0.2, size)), at(0, 0, 0.4));
  for (const std::size_t joint : {1, 2})
    small.world().set_joint_target(body, JointId{joint}, physics::JointTarget::effort(5.0));
  small.run(0.5);
  const Vector3d before = small.position(box);
  small.run(10.0);
  EXPECT_LT((small.position(box) - before).norm(), 1e-4);
}

// It is twice as high as wide: its centre is above the rim at a slope of atan(1/2), 26.57 degrees.
TEST_P(FirstWeek, ACylinderTipsWhenItsCentrePassesItsRim) {
  const auto falls = [&](double degrees, double yaw, bool on_a_box) {
    const double slope = degrees * M_PI / 180.0;
    SmallWorld small(awake(GetParam()));
    small.description.models.clear();
    small.description.instances.clear();
    const Vector3d normal(std::sin(slope), 0, std::cos(slope));
    const Eigen::Quaterniond along(Eigen::AngleAxisd(slope, Vector3d::UnitY()));
    if (on_a_box)
      small.add(static_shape("slope", description::Box{{1.0, 1.0, 0.1}}, {1.0, 0.0}), {-0.05 * normal, along});
    else
      small.add(static_shape("slope", description::Plane{normal}, {1.0, 0.0}), at(0, 0, 0));
    description::Model standing = loose("cylinder", description::Cylinder{0.05, 0.2},
                                        description::solid_cylinder(1.0, 0.05, 0.2, 0.0), {1.0, 0.0});
    const Eigen::Quaterniond upright(along * Eigen::AngleAxisd(yaw, Vector3d::UnitZ()));
    const auto body = small.add(standing, {0.1 * normal, upright});
    small.run(5.0);
    return small.up(body).dot(normal) < 0.9;
  };
  for (const bool on_a_box : {false, true})
    for (const double yaw : {0.0, 0.2, 22.0 * M_PI / 180.0, M_PI / 4, 1.0}) {
      SCOPED_TRACE((on_a_box ? "box, yaw " : "plane, yaw ") + std::to_string(yaw));
      EXPECT_FALSE(falls(26.57 - 0.5, yaw, on_a_box));
      EXPECT_TRUE(falls(26.57 + 0.5, yaw, on_a_box));
    }
}

// The pair of materials has little friction, which overrides the friction of the tracks themselves.
TEST_P(FirstWeek, TracksUseTheFrictionOfTheirMaterialPair) {
  for (const Physics& physics : {GetParam(), planar}) {
    SCOPED_TRACE(physics.name());
    SmallWorld small(physics.world());
    small.description.materials = {"", "ice", "rubber"};
    small.description.material_pairs = {{2, 1, 0.05, 0.0, 0.0}};
    small.description.models.edit(0).links[0].collisions[0].surface.material = 1;
    description::Model robot = physics.robot();
    const auto slippery = small.add(robot, at(0, 1, 0));
    for (description::Link& link : robot.links)
      for (description::Collision& collision : link.collisions) collision.surface.material = 2;
    const auto on_rubber = small.add(robot, at(0, 0, 0));
    for (const BodyId body : {slippery, on_rubber}) small.drive(body, 0.2, 0.2);
    small.run(0.2);
    EXPECT_NEAR(small.velocity(slippery).x(), 0.2, 0.01) << "no pair of its material";
    EXPECT_NEAR(small.velocity(on_rubber).x(), 0.05 * 9.81 * 0.2, 0.01);
  }
}

// No gap remains between bodies at rest: hulls, boxes and meshes on planes.
TEST_P(FirstWeek, HullsTouchTheirSupport) {
  const Vector3d size(0.2, 0.2, 0.1);
  description::Mesh surface = box_mesh({1.0, 1.0, 0.1});
  surface.convex = false;
  const std::vector<description::Shape> tables{Box{{1.0, 1.0, 0.1}}, box_mesh({1.0, 1.0, 0.1}), surface};
  for (std::size_t table = 0; table < tables.size(); ++table) {
    SCOPED_TRACE("table " + std::to_string(table));
    SmallWorld small(awake(GetParam()));
    small.add(static_shape("table", tables[table]), at(0, 0, 0.05));
    const auto hull = small.add(loose("hull", box_mesh(size), solid_box(1.0, size)), at(0, 0, 0.155));
    small.run(5.0);
    EXPECT_NEAR(small.position(hull).z(), 0.15, 5e-5);
  }
}

// A world in which robots grip and release for days keeps only the connections that hold.
TEST_P(FirstWeek, ReleasedConnectionsAreForgotten) {
  SmallWorld small(awake(GetParam()));
  const Vector3d size = Vector3d::Constant(0.1);
  const auto one = small.add(loose("box", Box{size}, solid_box(1.0, size)), at(0, 0, 0.05));
  const auto other = small.add(loose("box", Box{size}, solid_box(1.0, size)), at(0.11, 0, 0.05));
  const auto bytes_after = [&](int grips) {
    for (int i = 0; i < grips; ++i) {
      const ConnectionId grip =
          small.world().connections().connect({one, LinkId{0}}, {{0.055, 0, 0}}, {other, LinkId{0}});
      small.world().step();
      EXPECT_TRUE(small.world().connections().holds(grip));
      small.world().connections().disconnect(grip);
      EXPECT_FALSE(small.world().connections().holds(grip));
      if (i % 100 == 0) small.world().step();
    }
    small.world().step();
    SnapshotWriter writer;
    small.world().save(writer);
    return writer.bytes().size();
  };
  const std::size_t few = bytes_after(10);
  EXPECT_EQ(bytes_after(10'000), few);
}

}  // namespace
}  // namespace cohort::test
