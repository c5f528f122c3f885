// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/worlds/small_world.hpp"

namespace cohort::test {
namespace {

using description::Joint;
using description::JointType;
using Eigen::Vector3d;

// Returns a bob on a massless rod of length 1 m, attached at the origin of the model.
description::Model pendulum(JointType type, double mass = 2.0) {
  description::Model model;
  model.name = "pendulum";
  description::Inertial bob = solid_sphere(mass, 1e-3);
  bob.X_LI.position = {0, 0, -1.0};
  model.links.push_back({"rod", {}, bob, {}});
  Joint joint;
  joint.name = "pivot";
  joint.type = type;
  joint.parent = Joint::world;
  joint.child = 0;
  joint.axis.direction = Vector3d::UnitY();
  joint.second_axis.direction = Vector3d::UnitX();
  model.joints.push_back(joint);
  return model;
}

// Returns the mean period over `count` zero crossings of x from negative to positive.
double period(SmallWorld& small, const std::function<double()>& x, int count) {
  const double step = std::chrono::duration<double>(small.description.step).count();
  double first = -1.0;
  int seen = 0;
  double before = x();
  for (int i = 1; i < 100000; ++i) {
    small.world().step();
    const double now = x();
    if (before < 0.0 && now >= 0.0) {
      const double when = (i - now / (now - before)) * step;
      if (first < 0.0) {
        first = when;
      } else if (++seen == count) {
        return (when - first) / count;
      }
    }
    before = now;
  }
  return -1.0;
}

Vector3d bob_of(SmallWorld& small, BodyId body) {
  return small.world().link_pose(body, LinkId{0}) * Vector3d(0, 0, -1.0);
}

TEST(Joints, APendulumHasThePeriodOfItsLength) {
  for (const JointType type : {JointType::revolute, JointType::ball, JointType::universal}) {
    SmallWorld small(empty_world(std::chrono::milliseconds(1)));
    const auto body = small.add(pendulum(type), turned(0, 0, 0, Vector3d::UnitY(), 0.1));
    // 2 pi sqrt(l / g) (1 + a^2 / 16) for a small amplitude a.
    const double expected = 2.0 * M_PI * std::sqrt(1.0 / g) * (1.0 + 0.01 / 16.0);
    EXPECT_NEAR(period(
                    small, [&] { return bob_of(small, body).x(); }, 5),
                expected, 1e-3);
    EXPECT_NEAR(bob_of(small, body).norm(), 1.0, 1e-9) << "length of the rod";
  }
}

TEST(Joints, AConicalPendulumOnABallJointKeepsItsHeight) {
  SmallWorld small(empty_world(std::chrono::milliseconds(1)));
  const double angle = 0.5;
  const auto body = small.add(pendulum(JointType::ball), turned(0, 0, 0, Vector3d::UnitY(), -angle));
  // Velocity on a circle of radius sin(angle): v^2 = g r tan(angle).
  const double r = std::sin(angle);
  const double v = std::sqrt(g * r * std::tan(angle));
  const Vector3d rate_L = small.world().link_pose(body, LinkId{0}).orientation.conjugate() * Vector3d(0, 0, v / r);
  small.world().set_joint_state(body, JointId{0}, std::array{0.0, 0.0, 0.0, 1.0}, {rate_L.data(), 3});
  const double height = bob_of(small, body).z();
  for (int i = 0; i < 2000; ++i) {
    small.world().step();
    ASSERT_NEAR(bob_of(small, body).z(), height, 5e-3) << "at step " << i;
  }
}

TEST(Joints, AUniversalJointTurnsAboutTwoAxesAndNotAboutTheThird) {
  SmallWorld small(empty_world());
  const auto body = small.add(pendulum(JointType::universal), turned(0, 0, 0, Vector3d(1, 1, 0), 0.3));
  for (int i = 0; i < 500; ++i) {
    small.world().step();
    // The second axis, x of the child, turns about the first, y of the model; the two stay perpendicular.
    const Pose X_WL = small.world().link_pose(body, LinkId{0});
    const Eigen::Quaterniond q_ML =
        Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Vector3d(1, 1, 0).normalized())).conjugate() * X_WL.orientation;
    ASSERT_NEAR((q_ML * Vector3d::UnitX()).y(), 0.0, 1e-9) << "at step " << i;
  }
}

description::Model cart(double stiffness, double damping) {
  description::Model model;
  model.name = "cart";
  model.links.push_back({"cart", {}, solid_box(2.0, {0.1, 0.1, 0.1}), {}});
  Joint joint;
  joint.name = "rail";
  joint.type = JointType::prismatic;
  joint.parent = Joint::world;
  joint.child = 0;
  joint.axis.direction = Vector3d::UnitX();
  joint.axis.spring_stiffness = stiffness;
  joint.axis.spring_reference = 0.1;
  joint.axis.damping = damping;
  model.joints.push_back(joint);
  return model;
}

TEST(Joints, ASpringOscillatesAtTheFrequencyOfItsStiffness) {
  SmallWorld small(empty_world(std::chrono::milliseconds(1)));
  const auto body = small.add(cart(50.0, 0.0), at(0, 0, 0));
  EXPECT_NEAR(period(
                  small, [&] { return small.position(body).x() - 0.1; }, 5),
              2.0 * M_PI * std::sqrt(2.0 / 50.0), 2e-3);
}

TEST(Joints, ASpringFarStifferThanTheStepAllowsStaysAtRest) {
  SmallWorld small(empty_world());
  const auto body = small.add(cart(1e8, 0.0), at(0, 0, 0));
  small.run(2.0);
  EXPECT_NEAR(small.position(body).x(), 0.1, 1e-3);
}

TEST(Joints, DampingSlowsDownExponentially) {
  SmallWorld small(empty_world(std::chrono::milliseconds(1)));
  const auto body = small.add(cart(0.0, 3.0), at(0, 0, 0));
  small.world().set_joint_state(body, JointId{0}, std::array{0.0}, std::array{1.0});
  small.run(1.0);
  EXPECT_NEAR(small.world().joint_state(body, JointId{0}).velocity, std::exp(-3.0 / 2.0), 1e-3);
}

TEST(Joints, FrictionBringsAJointToRestAndHoldsIt) {
  SmallWorld small(empty_world(std::chrono::milliseconds(1)));
  description::Model model = cart(0.0, 0.0);
  model.joints[0].axis.friction = 4.0;
  const auto body = small.add(model, at(0, 0, 0));
  small.world().set_joint_state(body, JointId{0}, std::array{0.0}, std::array{1.0});
  small.run(1.0);
  // a = F / m = 2 m/s^2: it stops after v^2 / 2a.
  EXPECT_NEAR(small.world().joint_state(body, JointId{0}).position, 0.25, 1e-3);
  EXPECT_NEAR(small.world().joint_state(body, JointId{0}).velocity, 0.0, 1e-9);
}

TEST(Joints, AMotorGivesNoMoreThanItsEffortAndKeepsItsVelocity) {
  SmallWorld small(empty_world());
  description::Model model = cart(0.0, 0.0);
  model.devices.push_back(description::VelocityMotor{"motor", 0, 1.0, 3.0});
  const auto body = small.add(model, at(0, 0, 0));
  small.world().set_joint_target(body, JointId{0}, physics::JointTarget::velocity(0.6));
  small.run(0.2);
  EXPECT_NEAR(small.world().joint_state(body, JointId{0}).velocity, 0.2 * 3.0 / 2.0, 1e-9) << "a = F / m";
  small.run(1.0);
  EXPECT_NEAR(small.world().joint_state(body, JointId{0}).velocity, 0.6, 1e-6);
}

TEST(Joints, ALimitStopsAJointThatFallsOnIt) {
  SmallWorld small(empty_world());
  description::Model model = pendulum(JointType::revolute);
  model.joints[0].axis.lower = -0.5;
  model.joints[0].axis.upper = 0.2;
  const auto body = small.add(model, turned(0, 0, 0, Vector3d::UnitY(), 1.2));
  double least = 0.0;
  for (int i = 0; i < 500; ++i) {
    small.world().step();
    least = std::min(least, small.world().joint_state(body, JointId{0}).position);
    ASSERT_LT(small.world().joint_state(body, JointId{0}).position, 0.205);
  }
  EXPECT_GT(least, -0.52);
  EXPECT_NEAR(small.world().joint_state(body, JointId{0}).position, -0.5, 1e-3) << "it hangs against its limit";
}

// A body repeatedly flips over while it rotates about the axis of its intermediate moment of inertia.
TEST(Bodies, ATumblingBoxKeepsItsAngularMomentumAndItsEnergy) {
  SmallWorld small;
  small.description.gravity.setZero();
  const Vector3d size(0.3, 0.2, 0.1);
  const description::Inertial inertial = solid_box(1.0, size);
  const BodyId box = small.add(loose("box", description::Box{size}, inertial), at(0, 0, 5));
  small.world().set_root_twist(box, {Vector3d(0.1, 5.0, 0.1), Vector3d::Zero()});
  const auto momentum = [&]() -> Vector3d {
    const Eigen::Matrix3d R = small.world().link_pose(box, LinkId{0}).orientation.toRotationMatrix();
    return R * (inertial.inertia * (R.transpose() * small.world().link_twist(box, LinkId{0}).angular_W));
  };
  const auto energy = [&] { return 0.5 * momentum().dot(small.world().link_twist(box, LinkId{0}).angular_W); };
  const Vector3d momentum_before = momentum();
  const double energy_before = energy();
  double turned_over = 1.0;
  for (int second = 0; second < 60; ++second) {
    small.run(1.0);
    turned_over = std::min(turned_over, small.world().link_pose(box, LinkId{0}).orientation.toRotationMatrix()(1, 1));
  }
  EXPECT_LT(turned_over, 0.0);
  EXPECT_LT((momentum() - momentum_before).norm(), 1e-9 * momentum_before.norm());
  EXPECT_NEAR(energy(), energy_before, 1e-4 * energy_before);
}

// Two links on two hinges, released sideways: without damping, the energy stays constant.
// Thin rods of 1 kg that hang from each other by hinges without friction.
description::Model chain_of_rods(std::size_t count, double length) {
  description::Model model;
  model.name = "chain";
  description::Inertial rod;
  rod.mass = 1.0;
  rod.X_LI.position = {0, 0, -0.5 * length};
  const double across = length * length / 12.0;
  rod.inertia = Vector3d(across, across, 1e-3 * across).asDiagonal();
  for (std::size_t i = 0; i < count; ++i) {
    model.links.push_back({"rod" + std::to_string(i), {{0, 0, -length * static_cast<double>(i)}}, rod, {}});
    Joint hinge;
    hinge.name = "hinge" + std::to_string(i);
    hinge.type = JointType::revolute;
    hinge.parent = i == 0 ? Joint::world : i - 1;
    hinge.child = i;
    hinge.axis.direction = Vector3d::UnitY();
    model.joints.push_back(hinge);
  }
  return model;
}

struct SwingingChain {
  std::size_t rods;
  double length;
  std::chrono::milliseconds step;
  double tolerance;
};
class SwingingChains : public ::testing::TestWithParam<std::tuple<SwingingChain, description::Dynamics>> {};

// Velocities belong to the middle of steps: in a pose, they are the means of those before and after it.
TEST_P(SwingingChains, KeepTheirEnergyForAMinute) {
  const SwingingChain& chain = std::get<0>(GetParam());
  description::World world = empty_world(chain.step);
  world.physics.dynamics = std::get<1>(GetParam());
  SmallWorld small(world);
  const description::Model model = chain_of_rods(chain.rods, chain.length);
  const auto body = small.add(model, turned(0, 0, 0, Vector3d::UnitY(), 1.5));
  const description::Inertial& rod = model.links[0].inertial;
  const auto turns = [&] {
    std::vector<Vector3d> angular;
    for (std::size_t link = 0; link < chain.rods; ++link)
      angular.push_back(small.world().link_twist(body, LinkId{link}).angular_W);
    return angular;
  };
  double first = 0.0;
  double worst = 0.0;
  const auto steps = std::chrono::minutes(1) / chain.step;
  for (int i = 0; i <= steps; ++i) {
    const std::vector<Vector3d> before = turns();
    std::vector<Pose> X_WL;
    for (std::size_t link = 0; link < chain.rods; ++link) X_WL.push_back(small.world().link_pose(body, LinkId{link}));
    small.world().step();
    const std::vector<Vector3d> after = turns();
    double energy = 0.0;
    Vector3d linear = Vector3d::Zero();  // the velocity of the hinge
    for (std::size_t link = 0; link < chain.rods; ++link) {
      const Vector3d angular = 0.5 * (before[link] + after[link]);
      const Vector3d arm = X_WL[link].orientation * rod.X_LI.position;
      energy += 0.5 * rod.mass * (linear + angular.cross(arm)).squaredNorm() +
                0.5 * rod.inertia(0, 0) * angular.squaredNorm() + rod.mass * g * (X_WL[link].position + arm).z();
      linear += angular.cross(2.0 * arm);
    }
    if (i == 0) first = energy;
    worst = std::max(worst, std::abs(energy - first));
  }
  const auto count = static_cast<double>(chain.rods);
  EXPECT_LT(worst, chain.tolerance * g * rod.mass * chain.length * count * count) << "of what they gain and lose";
}

INSTANTIATE_TEST_SUITE_P(Each, SwingingChains,
                         testing::Combine(testing::Values(SwingingChain{2, 1.0, std::chrono::milliseconds(10), 0.01},
                                                          SwingingChain{3, 0.3, std::chrono::milliseconds(2), 0.01},
                                                          SwingingChain{7, 0.3, std::chrono::milliseconds(1), 0.02}),
                                          testing::Values(description::Dynamics::bullet,
                                                          description::Dynamics::cohort)),
                         [](const auto& its) {
                           return std::to_string(std::get<0>(its.param).rods) + "_rods_" +
                                  (std::get<1>(its.param) == description::Dynamics::bullet ? "bullet" : "cohort");
                         });

// 2 kg on a rail.
description::Model load_on_a_rail(const Vector3d& axis) {
  description::Model model;
  model.name = "buffer";
  model.links.push_back({"load", {}, solid_box(2.0, {0.1, 0.1, 0.1}), {}});
  model.joints.push_back(joint_of("rail", JointType::prismatic, Joint::world, 0, axis));
  return model;
}

// It comes to rest where the spring carries its weight, on either side of the joint, with any damping.
TEST(Joints, ASoftLimitDeflectsByItsStiffness) {
  constexpr double weight = 2.0 * g, stiffness = 500.0;
  for (const double damping : {5.0, 50.0}) {
    for (const double sense : {1.0, -1.0}) {
      SmallWorld small(empty_world());
      description::Model model = load_on_a_rail(sense * Vector3d::UnitZ());
      description::JointAxis& axis = model.joints[0].axis;
      axis.lower = -0.1;
      axis.upper = 0.1;
      axis.limit_stiffness = stiffness;
      axis.limit_damping = damping;
      const auto body = small.add(model, at(0, 0, 1));
      small.run(30.0);
      EXPECT_NEAR(small.position(body).z(), 1.0 - 0.1 - weight / stiffness, 1e-6);
    }
  }
}

// A limit without damping gives back what it has taken, wherever within a step the joint meets it.
TEST(Joints, AnElasticLimitKeepsTheEnergy) {
  for (const auto dynamics : {description::Dynamics::cohort, description::Dynamics::bullet})
    for (const int step : {10, 5, 1})
      for (const double sense : {1.0, -1.0})
        for (const double frequency : {10.0, 50.0, 200.0, 700.0})  // [rad/s]
          for (int i = 0; i < 8; ++i) {
            description::World world = empty_world(std::chrono::milliseconds(step));
            world.gravity.setZero();
            world.physics.dynamics = dynamics;
            SmallWorld small(std::move(world));
            description::Model model = load_on_a_rail(sense * Vector3d::UnitX());
            description::JointAxis& axis = model.joints[0].axis;
            axis.lower = -0.1;
            axis.upper = 0.1 + 0.0012 * i;
            axis.limit_stiffness = 2.0 * frequency * frequency;
            const auto body = small.add(model, at(0, 0, 1));
            small.world().set_joint_state(body, JointId{0}, std::array{0.0}, std::array{1.0});
            double slowest = 1.0;
            double fastest = 1.0;
            int bounces = 0;
            double last = 1.0;
            for (int k = 0; k < 5000 / step; ++k) {
              small.world().step();
              const auto state = small.world().joint_state(body, JointId{0});
              if (std::abs(state.position) > 0.08) continue;
              if (state.velocity * last < 0.0) ++bounces;
              last = state.velocity;
              slowest = std::min(slowest, std::abs(state.velocity));
              fastest = std::max(fastest, std::abs(state.velocity));
            }
            EXPECT_NEAR(slowest, 1.0, 1e-3) << step << " ms, " << frequency << " rad/s, " << i;
            EXPECT_NEAR(fastest, 1.0, 1e-3) << step << " ms, " << frequency << " rad/s, " << i;
            EXPECT_GT(bounces, 8);
          }
}

// Returns a cart with four wheels as real links, which touch the ground.
description::Model four_wheels() {
  description::Model model;
  model.name = "rover";
  description::Inertial chassis = solid_box(2.0, {0.3, 0.2, 0.1});
  chassis.X_LI.position = {0, 0, 0.08};
  model.links.push_back({"chassis", {}, chassis, {}});
  for (const double x : {0.1, -0.1})
    for (const double y : {0.12, -0.12}) {
      const std::size_t wheel = add_wheel(model, {x, y, 0.05}, 0.05, 0.03, 0.2);
      model.devices.push_back(description::VelocityMotor{model.joints[wheel].name, wheel, 20.0, 0.5});
    }
  return model;
}

TEST(Joints, WheelsRollAtTheirRadiusTimesTheirRate) {
  SmallWorld small;
  const auto body = small.add(four_wheels(), at(0, 0, 0));
  for (std::size_t wheel = 0; wheel < 4; ++wheel)
    small.world().set_joint_target(body, JointId{wheel}, physics::JointTarget::velocity(4.0));
  small.run(2.0);
  EXPECT_NEAR(small.velocity(body).x(), 0.2, 0.001);
  const double before = small.position(body).x();
  small.run(5.0);
  EXPECT_NEAR(small.position(body).x() - before, 1.0, 0.005);
  EXPECT_NEAR(small.position(body).y(), 0.0, 1e-3) << "straight on";
  EXPECT_NEAR(small.position(body).z(), 0.0, 1e-3);
}

TEST(Joints, AWheelWithoutAMotorRollsDownASlopeWithItsInertia) {
  constexpr double slope = 0.1;
  SmallWorld small;
  small.description.instances.clear();
  small.description.models.clear();
  small.add(static_shape("ramp", description::Plane{}), turned(0, 0, 0, Vector3d::UnitY(), slope));
  const Eigen::Quaterniond lying(Eigen::AngleAxisd(-M_PI / 2, Vector3d::UnitX()));
  const Vector3d normal(std::sin(slope), 0, std::cos(slope));
  description::Model wheel =
      loose("wheel", description::Cylinder{0.1, 0.05}, solid_cylinder(1.0, 0.1, 0.05, 0.0), {1.0, 0.0});
  const auto body = small.add(wheel, {0.1 * normal, lying});
  small.run(2.0);
  // a = g sin(slope) / (1 + I / m r^2): for a solid cylinder, 2/3 of a slide.
  EXPECT_NEAR(small.velocity(body).norm(), 2.0 * g * std::sin(slope) * 2.0 / 3.0, 0.01);
}

}  // namespace
}  // namespace cohort::test
