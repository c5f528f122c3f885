// SPDX-License-Identifier: Apache-2.0

// Spinning bodies on a joint to the world or on the ground, at default settings.

#include <gtest/gtest.h>

#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using description::JointType;
using Eigen::Vector3d;

constexpr double radius = 0.05;    // radius of the discs [m]
constexpr double height = 0.05;    // height of their centres above the foot [m]
constexpr double disc_mass = 0.5;  // [kg]

description::Inertial disc(double above) {
  description::Inertial inertial;
  inertial.mass = disc_mass;
  inertial.inertia = disc_mass * radius * radius * Vector3d(0.25, 0.25, 0.5).asDiagonal();
  inertial.X_LI.position = {0, 0, above};
  return inertial;
}
constexpr double disc_moment = 0.5 * disc_mass * radius * radius;  // about its axis

struct Gyroscope {
  SmallWorld small;
  BodyId body;

  explicit Gyroscope(const description::World& world) : small(world) {}
  double energy() {
    const WholeMotion whole = whole_motion(small, body);
    return whole.kinetic_energy + whole.potential_energy;
  }
  double tilt() { return std::acos(small.up(body).z()); }
  // Returns the mean precession rate over `seconds` [rad/s].
  double precession(double seconds) {
    double turned = 0.0;
    for (double time = 0.0; time < seconds; time += 0.1) {
      const Vector3d before = small.up(body);
      small.run(0.1);
      const Vector3d after = small.up(body);
      turned += std::atan2(before.x() * after.y() - before.y() * after.x(), before.head<2>().dot(after.head<2>()));
    }
    return turned / seconds;
  }
};

// A top: a disc whose foot is held by a ball joint, released at a tilt.
struct Top : Gyroscope {
  Top(const description::World& world, double spin) : Gyroscope(world) {
    description::Model model;
    model.name = "top";
    model.links.push_back({"top", {}, disc(height), {}});
    model.joints.push_back(joint_of("foot", JointType::ball, description::Joint::world, 0, Vector3d::UnitZ()));
    body = small.add(model, at(0, 0, 1));
    const Eigen::Quaterniond tilted(Eigen::AngleAxisd(0.5, Vector3d::UnitX()));
    small.world().set_joint_state(body, JointId{0}, {tilted.coeffs().data(), 4}, std::vector{0.0, 0.0, spin});
  }
};

// A gyroscope: a disc on the axle of a frame, which stands on a small ball.
struct OnTheGround : Gyroscope {
  static constexpr double frame_mass = 0.1;

  OnTheGround(const description::World& world, double spin) : Gyroscope(world) {
    constexpr double foot = 0.005;
    description::Model model;
    model.name = "gyroscope";
    description::Inertial frame;
    frame.mass = frame_mass;
    frame.inertia = 1e-4 * Eigen::Matrix3d::Identity();
    frame.X_LI.position = {0, 0, height};
    model.links.push_back({"frame", {}, frame, {{"foot", {}, description::Sphere{foot}, {}}}});
    model.links.push_back({"disc", at(0, 0, height), disc(0.0), {}});
    model.joints.push_back(joint_of("axle", JointType::revolute, 0, 1, Vector3d::UnitZ()));
    body = small.add(model, {{0, 0, foot}, Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Vector3d::UnitX()))});
    small.world().set_joint_state(body, JointId{0}, std::vector{0.0}, std::vector{spin});
  }
};

class Gyroscopes : public EveryPhysics {};
INSTANTIATE_TEST_SUITE_P(Every, Gyroscopes, ::testing::Values(treel, by_bullet(treel), direct, by_bullet(direct)),
                         name_of);

// Returns the slower rate of steady precession (Goldstein, "Classical mechanics", 3rd edition, 2002, equation 5.76).
// `across`: the moment of inertia about the foot, perpendicular to the axis [kg m^2].
double rate_of(double mass, double spin, double across, double tilt) {
  const double along = disc_moment * spin;
  const double difference = (across - disc_moment) * std::cos(tilt);
  return (along - std::sqrt(along * along - 4.0 * difference * mass * g * height)) / (2.0 * difference);
}
constexpr double disc_across = disc_mass * (0.25 * radius * radius + height * height);

TEST_P(Gyroscopes, ATopOnAJointKeepsItsEnergy) {
  for (const double spin : {50.0, 200.0}) {
    SCOPED_TRACE(spin);
    Top top(GetParam().world(), spin);
    const double energy = top.energy();
    top.small.run(60.0);
    EXPECT_NEAR(top.energy(), energy, 2e-3 * energy);
  }
}

// A pendulum on a ball joint swings and spins slowly about its axis. The bound was set after 1.1 % was measured.
TEST_P(Gyroscopes, ASlowPendulumOnABallJointKeepsItsEnergy) {
  for (const double spin : {0.0, 1.0, 2.0, 4.0, 8.0}) {
    SCOPED_TRACE(spin);
    Gyroscope pendulum(GetParam().world());
    description::Model model;
    model.name = "pendulum";
    model.links.push_back({"bob", {}, disc(-0.3), {}});
    model.joints.push_back(joint_of("pivot", JointType::ball, description::Joint::world, 0, Vector3d::UnitZ()));
    pendulum.body = pendulum.small.add(model, at(0, 0, 1));
    const Eigen::Quaterniond tilted(Eigen::AngleAxisd(0.5, Vector3d::UnitX()));
    pendulum.small.world().set_joint_state(pendulum.body, JointId{0}, {tilted.coeffs().data(), 4},
                                           std::vector{0.0, 2.0, spin});
    const double before = pendulum.energy();
    const double above_the_lowest = before - disc_mass * g * 0.7;
    for (int second = 0; second < 60; ++second) {
      pendulum.small.run(1.0);
      ASSERT_NEAR(pendulum.energy(), before, 0.02 * above_the_lowest) << "at " << second << " s";
    }
  }
}

// A ball in a frame that turns about the vertical spins about a perpendicular axis; the frame exerts no torque on it.
TEST_P(Gyroscopes, ABallInATurningFrameKeepsItsSpin) {
  Gyroscope mount(GetParam().world());
  description::Model model;
  model.name = "mount";
  model.links.push_back({"frame", {}, disc(0.0), {}});
  description::Inertial ball;
  ball.mass = 0.2;
  ball.inertia = 2e-4 * Eigen::Matrix3d::Identity();
  model.links.push_back({"ball", at(0.1, 0, 0), ball, {}});
  model.joints.push_back(joint_of("pivot", JointType::revolute, description::Joint::world, 0, Vector3d::UnitZ()));
  model.joints.push_back(joint_of("socket", JointType::ball, 0, 1, Vector3d::UnitZ()));
  mount.body = mount.small.add(model, at(0, 0, 1));
  mount.small.world().set_joint_state(mount.body, JointId{0}, std::vector{0.0}, std::vector{1.0});
  const Eigen::Quaterniond upright = Eigen::Quaterniond::Identity();
  mount.small.world().set_joint_state(mount.body, JointId{1}, {upright.coeffs().data(), 4},
                                      std::vector{5.0, 0.0, -1.0});
  mount.small.run(60.0);
  const Vector3d spin_W = mount.small.world().link_twist(mount.body, LinkId{1}).angular_W;
  EXPECT_NEAR((spin_W - Vector3d(5.0, 0.0, 0.0)).norm(), 0.0, 0.05);
}

// It turns by 0.2 rad in a step; a top that turns by 2 rad precesses a third too slowly.
TEST_P(Gyroscopes, ATopOnAJointPrecessesAtTheRateOfItsWeight) {
  description::World world = GetParam().world();
  world.step = std::chrono::milliseconds(1);
  Top top(world, 200.0);
  const double rate = rate_of(disc_mass, 200.0, disc_across, 0.5);
  EXPECT_NEAR(top.precession(10.0), rate, 0.02 * rate);
}

TEST_P(Gyroscopes, AGyroscopePrecessesOnItsFoot) {
  OnTheGround gyroscope(GetParam().world(), 200.0);
  const double energy = gyroscope.energy();
  const double rate = rate_of(disc_mass + OnTheGround::frame_mass, 200.0,
                              disc_across + OnTheGround::frame_mass * height * height + 1e-4, 0.3);
  EXPECT_NEAR(gyroscope.precession(10.0), rate, 0.03 * rate);
  gyroscope.small.run(20.0);
  EXPECT_NEAR(gyroscope.tilt(), 0.32, 0.03);
  EXPECT_NEAR(gyroscope.energy(), energy, 1e-3 * energy);
}

}  // namespace
}  // namespace cohort::test
