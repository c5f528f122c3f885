// SPDX-License-Identifier: Apache-2.0

// Properties of surfaces and links that third-party models use.

#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using description::Box;
using description::JointType;
using description::Sphere;
using description::Surface;
using Eigen::Vector3d;

class Surfaces : public EveryPhysics {};
INSTANTIATE_TEST_SUITE_P(Every, Surfaces,
                         ::testing::Values(articulated, by_bullet(articulated), treel, by_bullet(treel), direct),
                         name_of);

Surface with_bitmask(std::uint16_t bits) {
  Surface surface;
  surface.category_bitmask = surface.collide_bitmask = bits;
  return surface;
}

TEST_P(Surfaces, CollideOnlyWithMatchingBitmasks) {
  SmallWorld small(GetParam().world());
  const auto ball = [&](double x, double z, const Surface& surface) {
    return small.add(loose("ball", Sphere{0.05}, solid_sphere(1.0, 0.05), surface), at(x, 0, z));
  };
  ball(0, 0.05, with_bitmask(1));
  const auto through = ball(0, 0.25, with_bitmask(2));
  ball(1, 0.05, with_bitmask(1));
  const auto on_top = ball(1, 0.25, with_bitmask(3));
  Surface one_sided = with_bitmask(0);
  one_sided.category_bitmask = 4;  // enough that the floor collides with it
  const auto seen_by_the_floor = ball(2, 0.1, one_sided);
  const auto by_nothing = ball(3, 0.1, with_bitmask(0));
  small.run(0.6);
  EXPECT_NEAR(small.position(through).z(), 0.05, 1e-3);
  EXPECT_NEAR(small.position(on_top).z(), 0.15, 2e-3);
  EXPECT_NEAR(small.position(seen_by_the_floor).z(), 0.05, 1e-3);
  EXPECT_LT(small.position(by_nothing).z(), -1.0);
}

// A body without any freedom: its only link is fixed to the world.
TEST_P(Surfaces, AFixedBodyCarriesLoadsAndMayOverlapOthers) {
  SmallWorld small(GetParam().world());
  description::Model held = loose("held", Box{{1, 1, 1}}, solid_box(1.0, {1, 1, 1}));
  description::Joint joint;
  joint.name = "bolt";
  joint.parent = description::Joint::world;
  held.joints.push_back(joint);
  small.add(static_shape("block", Box{{1, 1, 1}}), at(0, 0, 0));
  const auto lower = small.add(held, at(0, 0, 1.0));
  const auto upper = small.add(held, at(0.5, 0, 1.9));
  const auto load = small.add(loose("load", Box{{0.2, 0.2, 0.2}}, solid_box(1.0, {0.2, 0.2, 0.2})), at(-0.3, 0, 1.6));
  small.run(1.0);
  EXPECT_EQ(small.position(lower), Vector3d(0, 0, 1.0));
  EXPECT_EQ(small.position(upper), Vector3d(0.5, 0, 1.9));
  EXPECT_NEAR(small.position(load).z(), 1.6, 2e-3);
}

// At 100 m/s the ball is a fast body.
TEST_P(Surfaces, FastBodiesPassThroughOtherBitmasks) {
  SmallWorld small(GetParam().world());
  small.add(static_shape("wall", Box{{0.02, 4, 4}}, with_bitmask(1)), at(1, 0, 1));
  const auto through = small.add(loose("ball", Sphere{0.02}, solid_sphere(1.0, 0.02), with_bitmask(2)), at(0, 0, 1));
  const auto stopped = small.add(loose("ball", Sphere{0.02}, solid_sphere(1.0, 0.02), with_bitmask(3)), at(0, 1, 1));
  for (const auto ball : {through, stopped})
    small.world().set_root_twist(ball, {Vector3d::Zero(), Vector3d(100, 0, 0)});
  small.run(0.1);
  EXPECT_GT(small.position(through).x(), 9.0);
  EXPECT_LT(small.position(stopped).x(), 1.0);
}

// Returns a boom on a hinge about y with a weight on a hinge at its end. Nothing collides.
description::Model boom(bool feels_gravity) {
  description::Model model;
  model.name = "boom";
  description::Inertial arm = solid_box(0.2, {0.3, 0.02, 0.03});
  arm.X_LI.position = {0.15, 0.01, 0.0};
  model.links.push_back({"arm", {}, arm, {}});
  model.links.push_back({"weight", {{0.3, 0, 0}}, solid_box(0.5, {0.02, 0.03, 0.04}), {}});
  description::Joint joint;
  joint.name = "hinge";
  joint.type = description::JointType::revolute;
  joint.parent = description::Joint::world;
  joint.axis.direction = Vector3d::UnitY();
  model.joints.push_back(joint);
  joint.name = "wrist";
  joint.parent = 0;
  joint.child = 1;
  model.joints.push_back(joint);
  for (description::Link& link : model.links) link.feels_gravity = feels_gravity;
  return model;
}

TEST_P(Surfaces, ALinkWithoutGravityFloatsAndMovesStraight) {
  SmallWorld small(GetParam().world());
  description::Model box = loose("box", Box{{0.1, 0.1, 0.1}}, solid_box(2.0, {0.1, 0.1, 0.1}));
  box.links[0].inertial.X_LI.position = {0.02, 0, 0};
  const auto falls = small.add(box, at(1, 0, 1));
  box.links[0].feels_gravity = false;
  const auto floats = small.add(box, at(0, 0, 1));
  small.world().record(floats);
  small.world().record(falls);
  small.world().set_root_twist(floats, {Vector3d::Zero(), Vector3d(0.1, 0, 0)});
  small.run(0.4);
  EXPECT_TRUE(small.position(floats).isApprox(Vector3d(0.04, 0, 1), 1e-12)) << small.position(floats).transpose();
  EXPECT_LT(small.position(falls).z(), 0.3);
  // The acceleration that an accelerometer adds to gravity.
  EXPECT_LT(small.world().link_acceleration(floats, LinkId{0}, Vector3d::Zero()).norm(), 1e-9);
  EXPECT_NEAR(small.world().link_acceleration(falls, LinkId{0}, Vector3d::Zero()).z(), -g, 1e-9);
}

TEST_P(Surfaces, APendulumWithoutGravityStaysInPlace) {
  SmallWorld small(GetParam().world());
  const auto body = small.add(boom(false), at(0, 0, 2));
  small.world().record(body);
  small.run(1.0);
  EXPECT_LT(std::abs(small.world().joint_state(body, JointId{0}).position), 1e-12);
  EXPECT_LT(small.world().joint_wrench(body, JointId{0}).force_W.norm(), 1e-9);
  EXPECT_LT(small.world().joint_wrench(body, JointId{0}).torque_W.norm(), 1e-9);
}

// A free root, whose momentum is conserved: half of the weight is missing.
TEST_P(Surfaces, ABodyFallsByTheWeightOfItsLinksWithGravity) {
  SmallWorld small(GetParam().world());
  description::Model model = boom(true);
  model.joints.erase(model.joints.begin());
  model.links[0].inertial = model.links[1].inertial;
  model.links[0].inertial.X_LI.position = {0.3, 0, 0};
  model.links[1].feels_gravity = false;
  const auto body = small.add(model, at(0, 0, 5));
  small.run(0.5);
  EXPECT_NEAR(small.velocity(body, 1).z(), -0.5 * g * 0.5, 1e-6);
}

TEST_P(Surfaces, AJointCarriesNoWeightOfALinkWithoutGravity) {
  SmallWorld small(GetParam().world());
  description::Model model = boom(true);
  for (description::Joint& joint : model.joints) joint.type = description::JointType::fixed;
  model.links[1].feels_gravity = false;
  const auto body = small.add(model, at(0, 0, 2));
  small.world().record(body);
  small.run(0.1);
  EXPECT_LT(small.world().joint_wrench(body, JointId{1}).force_W.norm(), 1e-9);
  EXPECT_TRUE(small.world().joint_wrench(body, JointId{0}).force_W.isApprox(Vector3d(0, 0, 0.2 * g), 1e-9));
  EXPECT_TRUE(small.world().joint_wrench(body, JointId{0}).torque_W.isApprox(Vector3d(0.01, -0.15, 0) * 0.2 * g, 1e-9));
}

// Boxes with low friction along x and high friction along y, at several headings; one rotates while it slides.
TEST_P(Surfaces, FrictionHasItsCoefficientsAlongAndAcrossItsDirection) {
  constexpr double along = 0.1, across = 0.4, speed = 1.0;
  for (const double yaw : {0.0, 0.4, 1.3}) {
    SmallWorld small(GetParam().world());
    Surface surface;
    surface.friction = along;
    surface.second_friction = across;
    surface.friction_direction = Vector3d::UnitX();
    const Vector3d size(0.2, 0.2, 0.04);
    const auto one = small.add(loose("box", Box{size}, solid_box(1.0, size), surface), at(0, 0, 0.02, yaw));
    const auto two = small.add(loose("box", Box{size}, solid_box(1.0, size), surface), at(0, 3, 0.02, yaw));
    small.run(0.2);
    const Vector3d x(std::cos(yaw), std::sin(yaw), 0), y(-std::sin(yaw), std::cos(yaw), 0);
    small.world().set_root_twist(one, {Vector3d::Zero(), speed * x});
    small.world().set_root_twist(two, {Vector3d::Zero(), speed * y});
    const Vector3d before = small.position(two);
    small.run(2.0);
    EXPECT_NEAR(small.position(one).dot(x), speed * speed / (2.0 * along * g), 0.01);
    EXPECT_NEAR(small.position(one).dot(y), 0.0, 0.01);
    EXPECT_NEAR((small.position(two) - before).dot(y), speed * speed / (2.0 * across * g), 0.01);
  }
}

// Mecanum wheels as spheres that slide without friction along their rollers, which do not turn with the wheels.
TEST_P(Surfaces, ADirectionOfFrictionTurnsWithTheLinkThatItNames) {
  constexpr double radius = 0.1, speed = 0.2, seconds = 3.0;
  SmallWorld small(GetParam().world());
  description::Model robot;
  robot.name = "robot";
  robot.links.push_back({"chassis", {}, solid_box(4.0, {0.6, 0.5, 0.1}), {}});
  for (const Vector3d& corner : {Vector3d(0.3, 0.25, 0), {0.3, -0.25, 0}, {-0.3, 0.25, 0}, {-0.3, -0.25, 0}}) {
    Surface surface;
    surface.second_friction = 0.0;
    surface.friction_direction = Vector3d(1.0, corner.x() * corner.y() > 0.0 ? -1.0 : 1.0, 0.0).normalized();
    surface.friction_link = 0;
    robot.joints.push_back(joint_of("j", JointType::revolute, 0, robot.links.size(), Vector3d::UnitY()));
    robot.links.push_back({"wheel", {corner}, solid_sphere(0.5, radius), {{"c", {}, Sphere{radius}, surface}}});
    robot.devices.push_back(description::VelocityMotor{"motor", robot.joints.size() - 1, 10.0, 10.0});
  }
  const auto body = small.add(robot, at(0, 0, radius));
  for (const std::uint32_t wheel : {0u, 1u, 2u, 3u})
    small.world().set_joint_target(
        body, JointId{wheel}, physics::JointTarget::velocity((wheel == 0 || wheel == 3 ? -1.0 : 1.0) * speed / radius));
  small.run(seconds);
  EXPECT_NEAR(small.position(body).y(), speed * seconds, 0.02) << "the wheels have turned by almost a whole turn";
  EXPECT_NEAR(small.position(body).x(), 0.0, 0.02);
}

TEST_P(Surfaces, ABoxOnASlopeStaysOnlyAcrossItsLowFrictionDirection) {
  constexpr double slope = 0.3;
  for (const bool is_across : {false, true}) {
    description::World world = GetParam().world();
    world.instances[0].X_WM = turned(0, 0, 0, Vector3d::UnitY(), slope);
    SmallWorld small(std::move(world));
    Surface surface;
    surface.friction = 0.1;
    surface.friction_direction = is_across ? Vector3d::UnitY() : Vector3d::UnitX();
    const Vector3d size(0.2, 0.2, 0.1);
    const Eigen::Quaterniond lying(Eigen::AngleAxisd(slope, Vector3d::UnitY()));
    const auto box =
        small.add(loose("box", Box{size}, solid_box(1.0, size), surface), {lying * Vector3d(0, 0, 0.05), lying});
    small.world().record(box);
    small.run(0.5);
    const Vector3d before = small.position(box);
    const Vector3d velocity = small.velocity(box);
    small.run(1.0);
    if (is_across)
      EXPECT_LT((small.position(box) - before).norm(), 0.4e-3);
    else
      EXPECT_NEAR((small.velocity(box) - velocity).norm(), g * (std::sin(slope) - 0.1 * std::cos(slope)), 0.01);
  }
}

// Each of the four points is a spring.
TEST_P(Surfaces, ABoxOnSoftGroundSinksByItsStiffness) {
  const Vector3d size(0.2, 0.2, 0.1);
  for (const double of_ground : {description::Surface{}.stiffness, 2e4}) {
    description::World world = GetParam().world();
    world.models.edit(0).links[0].collisions[0].surface.stiffness = of_ground;
    SmallWorld small(std::move(world));
    Surface surface;
    surface.stiffness = 1e4;
    surface.damping = 50.0;
    const auto box = small.add(loose("box", Box{size}, solid_box(2.0, size), surface), at(0, 0, 0.05));
    small.run(3.0);
    const double stiffness = 4.0 / (1.0 / 1e4 + 1.0 / of_ground);
    EXPECT_NEAR(small.position(box).z(), 0.05 - 2.0 * g / stiffness, 1e-6);
    EXPECT_LT(small.velocity(box).norm(), 1e-6);
  }
}

// A ball oscillates on one spring without damping; implicit integration removes a part of its energy in each step.
TEST_P(Surfaces, ABallOnASpringOscillatesAtItsPeriod) {
  description::World world = GetParam().world();
  world.step = std::chrono::microseconds(100);
  world.models.edit(0).links[0].collisions[0].surface.damping = 0.0;
  SmallWorld small(std::move(world));
  Surface surface;
  surface.stiffness = 2e3;
  surface.damping = 0.0;
  constexpr double mass = 2.0, radius = 0.1;
  const double rest = radius - mass * g / surface.stiffness;
  const auto ball =
      small.add(loose("ball", Sphere{radius}, solid_sphere(mass, radius), surface), at(0, 0, rest - 0.005));
  const double half = M_PI * std::sqrt(mass / surface.stiffness);
  small.run(0.5 * half);
  EXPECT_NEAR(small.position(ball).z(), rest, 1e-4);
  small.run(0.5 * half);
  EXPECT_NEAR(small.position(ball).z(), rest + 0.005, 2e-4);
}

// Values of most Gazebo models: 1e6 N/m and little damping. On four contact points, a box would oscillate by 9 rad in a
// step of 10 ms.
TEST_P(Surfaces, BoxesWithTheStiffnessOfGazeboModelsStack) {
  SmallWorld small(GetParam().world());
  Surface surface;
  surface.stiffness = 1e6;
  const Vector3d size(0.2, 0.2, 0.2);
  std::vector<BodyId> boxes;
  for (int i = 0; i < 4; ++i)
    boxes.push_back(small.add(loose("box", Box{size}, solid_box(5.0, size), surface), at(0, 0, 0.1 + 0.2 * i)));
  small.run(10.0);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    EXPECT_NEAR(small.position(boxes[i]).z(), 0.1 + 0.2 * static_cast<double>(i), 1e-3);
    EXPECT_LT(small.position(boxes[i]).head<2>().norm(), 1e-3);
    EXPECT_LT(small.velocity(boxes[i]).norm(), 1e-4);
  }
}

// A ball spins on the spot: the torque is c m g, with the smaller resistance, that of the ground.
TEST_P(Surfaces, SpinningResistanceStopsASpinningBall) {
  SmallWorld small(GetParam().world());
  Surface surface;
  surface.spinning_resistance = 0.002;
  const auto ball = small.add(loose("ball", Sphere{0.1}, solid_sphere(2.0, 0.1), surface), at(0, 0, 0.1));
  const auto free = small.add(loose("ball", Sphere{0.1}, solid_sphere(2.0, 0.1)), at(1, 0, 0.1));
  small.run(0.2);
  for (const auto each : {ball, free}) small.world().set_root_twist(each, {Vector3d(0, 0, 10), Vector3d::Zero()});
  small.run(1.0);
  const double moment = 0.4 * 2.0 * 0.1 * 0.1;
  EXPECT_NEAR(small.world().link_twist(ball, LinkId{0}).angular_W.z(), 10.0 - 0.002 * 2.0 * g / moment, 0.05);
  EXPECT_NEAR(small.world().link_twist(free, LinkId{0}).angular_W.z(), 10.0, 1e-6);
  small.run(2.0);
  EXPECT_NEAR(small.world().link_twist(ball, LinkId{0}).angular_W.z(), 0.0, 1e-6);
  EXPECT_LT(small.position(ball).head<2>().norm(), 1e-6);
}

TEST_P(Surfaces, BounceOnlyAboveTheLargerThreshold) {
  description::World world = GetParam().world();
  Surface& ground = world.models.edit(0).links[0].collisions[0].surface;
  ground.restitution = 1.0;
  ground.bounce_threshold = 0.5;
  SmallWorld small(std::move(world));
  const auto ball = [&](double x, double height, std::optional<double> threshold) {
    Surface surface{1.0, 0.8};
    surface.bounce_threshold = threshold;
    return small.add(loose("ball", Sphere{0.05}, solid_sphere(1.0, 0.05), surface), at(x, 0, 0.05 + height));
  };
  const auto bounces = ball(0, 0.1, 0.2);    // arrives at 1.4 m/s
  const auto too_slow = ball(1, 0.01, 0.2);  // at 0.44 m/s
  const auto kept_down = ball(2, 0.1, 2.0);
  double highest[] = {0, 0, 0};
  for (int i = 0; i < 60; ++i) {
    small.world().step();
    int number = 0;
    for (const auto each : {bounces, too_slow, kept_down}) {
      double& high = highest[number++];
      high = std::max(high, small.velocity(each).z());
    }
  }
  EXPECT_GT(highest[0], 0.8);
  EXPECT_LT(highest[1], 0.01);
  EXPECT_LT(highest[2], 0.1);  // it is pushed out of the ground that it fell into
}

TEST_P(Surfaces, BounceWithTheProductOfTheirRestitutions) {
  for (const auto& [of_ground, of_ball] : {std::pair(0.8, 0.5), std::pair(0.5, 0.8), std::pair(1.0, 0.4)}) {
    description::World world = GetParam().world();
    world.models.edit(0).links[0].collisions[0].surface.restitution = of_ground;
    SmallWorld small(std::move(world));
    const auto ball = small.add(loose("ball", Sphere{0.05}, solid_sphere(1.0, 0.05), {1.0, of_ball}), at(0, 0, 0.5));
    const auto dull = small.add(loose("ball", Sphere{0.05}, solid_sphere(1.0, 0.05), {1.0, 0.0}), at(1, 0, 0.5));
    double before = 0.0;
    for (int i = 0; i < 100 && small.velocity(ball).z() <= 0.0; ++i) {
      before = small.velocity(ball).z();
      small.world().step();
    }
    EXPECT_NEAR(small.velocity(ball).z(), -0.4 * before, 0.11) << "gravity acts in the steps around the impact";
    EXPECT_LT(small.velocity(dull).z(), -0.1 * before) << "it is pushed out of the ground that it fell into";
  }
}

// A heap with all of these properties.
TEST_P(Surfaces, ContinueFromASnapshotWithTheSameBits) {
  const auto fill = [](SmallWorld& small) {
    Surface surface{0.5, 0.3};
    surface.rolling_resistance = 0.001;
    surface.spinning_resistance = 0.003;
    surface.friction_direction = Vector3d::UnitX();
    surface.second_friction = 0.2;
    surface.stiffness = 1e5;
    surface.bounce_threshold = 0.1;
    for (int i = 0; i < 12; ++i) {
      surface.collide_bitmask = surface.category_bitmask = static_cast<std::uint16_t>(1 + i % 3);
      const description::Shape shape =
          i % 2 == 0 ? description::Shape(Box{{0.1, 0.1, 0.1}}) : description::Shape(Sphere{0.05});
      description::Model model = loose("thing", shape, solid_sphere(1.0, 0.05), surface);
      model.links[0].feels_gravity = i != 5;
      small.add(model, at(0.03 * (i % 2), 0.02 * (i % 3), 0.06 + 0.1 * i, 0.4 * i));
    }
    for (std::uint32_t body = 1; body <= 12; ++body)
      small.world().set_root_twist(BodyId{body}, {Vector3d(0, 0, 3), Vector3d::Zero()});
  };
  SmallWorld world(GetParam().world()), other(GetParam().world());
  fill(world);
  fill(other);
  world.run(0.7);
  restore_from(world.world(), other.world());
  EXPECT_EQ(hash_of(world.world()), hash_of(other.world()));
  world.run(0.7);
  other.run(0.7);
  EXPECT_EQ(hash_of(world.world()), hash_of(other.world()));
}

TEST(PlanarSurfaces, CollideOnlyWithMatchingBitmasks) {
  SmallWorld small(planar.world());
  const Vector3d size(0.1, 0.1, 0.1);
  small.add(static_shape("wall", Box{{0.02, 4, 1}}, with_bitmask(1)), at(0.3, 0, 0.5));
  const auto through = small.add(loose("box", Box{size}, solid_box(1.0, size), with_bitmask(2)), at(0, 0, 0.05));
  const auto stopped = small.add(loose("box", Box{size}, solid_box(1.0, size), with_bitmask(3)), at(0, 1, 0.05));
  for (const auto box : {through, stopped}) small.world().set_root_twist(box, {Vector3d::Zero(), Vector3d(5, 0, 0)});
  small.run(0.3);
  EXPECT_GT(small.position(through).x(), 0.5);
  EXPECT_LT(small.position(stopped).x(), 0.3);
}

TEST(TreelSurfaces, CarryTracksWithAnyBitmask) {
  description::World world = treel.world();
  world.models.edit(0).links[0].collisions[0].surface = with_bitmask(0);
  SmallWorld small(std::move(world));
  const auto robot = small.add(treel.robot(), at(0, 0, 0));
  small.drive(robot, 0.1, 0.1);
  small.run(2.0);
  EXPECT_NEAR(small.position(robot).z(), 0.0, 2e-3);
  EXPECT_NEAR(small.position(robot).x(), 0.2, 0.02);
}

}  // namespace
}  // namespace cohort::test
