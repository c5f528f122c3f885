// SPDX-License-Identifier: Apache-2.0

// Bodies in air and water, compared with closed forms.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <vector>

#include "server/physics/fluid/floating_shape.hpp"
#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using description::Box;
using description::Drag;
using description::Fin;
using description::Model;
using description::Rotor;
using Eigen::Vector3d;

constexpr double pi = std::numbers::pi;
constexpr double water_density = 1000.0;

class Fluids : public EveryPhysics {
 protected:
  static description::World air() {
    description::World world = empty_world();
    world.physics.fidelity = GetParam().fidelity;
    world.physics.dynamics = GetParam().dynamics;
    return world;
  }
  static description::World water(const Vector3d& current = Vector3d::Zero()) {
    description::World world = air();
    world.water = {0.0, water_density, current};
    return world;
  }
  // Returns a body with the density water_density times `density`, with the centre of mass in the middle.
  static Model floating(const description::Shape& shape, double volume, double density, const Vector3d& size) {
    return loose("floating", shape, solid_box(density * water_density * volume, size));
  }
  static Model crate(const Vector3d& size, double density) { return floating(Box{size}, size.prod(), density, size); }
};
INSTANTIATE_TEST_SUITE_P(Every, Fluids, ::testing::Values(articulated, by_bullet(articulated), treel, by_bullet(treel)),
                         name_of);

// ---- Rotors ----

constexpr double motor_constant = 8.5e-6, moment_constant = 0.016;

Rotor rotor_at(const Vector3d& p_LR, Rotor::Direction direction = Rotor::Direction::ccw) {
  Rotor rotor;
  rotor.name = "rotor";
  rotor.X_LR.position = p_LR;
  rotor.direction = direction;
  rotor.max_velocity = 1100.0;
  rotor.motor_constant = motor_constant;
  rotor.moment_constant = moment_constant;
  return rotor;
}

constexpr double copter_mass = 1.2;
Model quadcopter(double time_constant = 0.0) {
  const Vector3d size(0.4, 0.4, 0.1);
  Model model = loose("quadcopter", Box{size}, solid_box(copter_mass, size));
  for (const double x : {0.2, -0.2})
    for (const double y : {0.2, -0.2}) {
      Rotor rotor = rotor_at({x, y, 0.06}, x * y > 0.0 ? Rotor::Direction::cw : Rotor::Direction::ccw);
      rotor.name += std::to_string(model.devices.size());
      rotor.time_constant_up = rotor.time_constant_down = time_constant;
      model.devices.push_back(rotor);
    }
  return model;
}
const double hover = std::sqrt(copter_mass * g / (4.0 * motor_constant));

void spin(physics::World& world, BodyId body, double velocity) {
  for (std::size_t device = 0; device < 4; ++device) world.set_device_target(body, DeviceId{device}, 0, velocity);
}

TEST_P(Fluids, AQuadcopterHoversWhenThrustEqualsWeight) {
  SmallWorld small(air());
  const auto body = small.add(quadcopter(), at(1, 2, 3, 0.4));
  spin(small.world(), body, hover);
  small.run(5.0);
  EXPECT_LT((small.position(body) - Vector3d(1, 2, 3)).norm(), 1e-6);
  EXPECT_GT(small.up(body).z(), 1.0 - 1e-9);
  small.world().record(body);
  spin(small.world(), body, 1.005 * hover);
  small.run(1.0);
  const double climb = (1.005 * 1.005 - 1.0) * g;
  EXPECT_NEAR(small.velocity(body).z(), climb, 1e-6) << "one percent more thrust";
  EXPECT_LT((small.world().link_acceleration(body, LinkId{0}, {0.1, 0, 0}) - Vector3d(0, 0, climb)).norm(), 1e-6);
}

TEST_P(Fluids, ReactionTorquesOfRotorsCancelOrTurnTheBody) {
  SmallWorld small(air());
  const auto body = small.add(quadcopter(), at(0, 0, 3));
  physics::World& world = small.world();
  const double more = 1.1, less = std::sqrt(2.0 - more * more);
  for (const std::size_t cw : {0u, 3u}) world.set_device_target(body, DeviceId{cw}, 0, more * hover);
  for (const std::size_t ccw : {1u, 2u}) world.set_device_target(body, DeviceId{ccw}, 0, less * hover);
  small.run(0.5);
  const double thrust = copter_mass * g / 4.0;
  const double torque = 2.0 * moment_constant * thrust * (more * more - less * less);
  const double inertia = copter_mass / 12.0 * (0.16 + 0.16);
  EXPECT_NEAR(world.link_twist(body, LinkId{0}).angular_W.z(), torque / inertia * 0.5, 1e-6)
      << "what turns clockwise turns the body counter-clockwise";
  EXPECT_LT(small.velocity(body).norm(), 1e-9);
}

TEST_P(Fluids, ARotorReaches63PercentAfterItsTimeConstant) {
  SmallWorld small(air());
  small.description.gravity.setZero();
  Model model = quadcopter(0.2);
  std::get<Rotor>(model.devices[0]).time_constant_down = 0.4;
  const auto body = small.add(model, at(0, 0, 3));
  spin(small.world(), body, 500.0);
  small.run(0.2);
  EXPECT_NEAR(small.world().device_state(body, DeviceId{0}, 0).velocity, 500.0 * (1.0 - std::exp(-1.0)), 1e-9);
  small.run(5.0);
  const double before = small.world().device_state(body, DeviceId{0}, 0).velocity;
  spin(small.world(), body, 0.0);
  small.run(0.4);
  EXPECT_NEAR(small.world().device_state(body, DeviceId{0}, 0).velocity, before * std::exp(-1.0), 1e-9);
  EXPECT_NEAR(small.world().device_state(body, DeviceId{1}, 0).velocity, before * std::exp(-2.0), 1e-9);
}

TEST_P(Fluids, ARotorHasDragAcrossItsAxis) {
  SmallWorld small(air());
  small.description.gravity.setZero();
  Model model = loose("rotor", Box{Vector3d::Constant(0.1)}, solid_box(2.0, Vector3d::Constant(0.1)));
  Rotor rotor = rotor_at(Vector3d::Zero());
  rotor.drag_coefficient = 1e-3;
  rotor.moment_constant = 0.0;
  model.devices.push_back(rotor);
  const auto body = small.add(model, at(0, 0, 3));
  small.world().set_root_twist(body, {Vector3d::Zero(), Vector3d(3, -1, 0)});
  small.world().set_device_target(body, DeviceId{0}, 0, 400.0);
  small.run(1.0);
  const double share = std::pow(1.0 + 0.01 * 400.0 * 1e-3 / 2.0, -100);
  EXPECT_LT((small.velocity(body) - Vector3d(3 * share, -share, motor_constant * 400 * 400 / 2.0)).norm(), 1e-9);
}

// In flight only external forces change the total momentum, and those of the air are among them.
TEST_P(Fluids, ARotorLiftsABodyWithAJoint) {
  SmallWorld small(air());
  Model model = quadcopter();
  model.links.push_back({"camera", {{0, 0, -0.1}}, solid_box(0.1, Vector3d::Constant(0.04)), {}});
  description::Joint gimbal;
  gimbal.name = "gimbal";
  gimbal.type = description::JointType::revolute;
  gimbal.child = 1;
  gimbal.axis.direction = Vector3d::UnitZ();
  model.joints.push_back(gimbal);
  const auto body = small.add(model, at(0, 0, 3));
  for (std::size_t rotor = 0; rotor < 4; ++rotor)
    small.world().set_device_target(body, DeviceId{rotor}, 0, hover * std::sqrt((copter_mass + 0.1) / copter_mass));
  small.run(2.0);
  EXPECT_LT((small.position(body) - Vector3d(0, 0, 3)).norm(), 1e-6);
}

// Returns a link that the joint above welds to the world, so that the joint carries exactly the forces on the link.
Model anchored() {
  Model model;
  model.name = "anchored";
  model.links.push_back({"link", {}, solid_box(1.0, Vector3d::Constant(0.1)), {}});
  description::Joint joint;
  joint.parent = description::Joint::world;
  joint.child = 0;
  model.joints.push_back(joint);
  return model;
}
physics::Wrench wrench_on(SmallWorld& small, BodyId body) {
  small.world().record(body);
  small.run(0.02);
  physics::Wrench wrench = small.world().joint_wrench(body, JointId{0});
  wrench.force_W = -wrench.force_W;
  wrench.torque_W = -wrench.torque_W;
  return wrench;
}

TEST_P(Fluids, AThrusterPushesBothWaysAndInItsOwnFluid) {
  // Fossen's density K D^4 n|n|, with n in turns a second, and the torque density Q D^5 n|n|.
  const double diameter = 0.1, thrust_coefficient = 0.4, turns = 12.0;
  const double thrust = water_density * thrust_coefficient * std::pow(diameter, 4) * turns * turns;
  for (const double z : {-1.0, 1.0}) {
    SmallWorld small(water());
    small.description.gravity.setZero();
    Model model = anchored();
    Rotor thruster = rotor_at({0.1, 0.2, 0});
    thruster.X_LR.orientation = Eigen::AngleAxisd(pi / 2, Vector3d::UnitY());
    thruster.motor_constant = water_density * thrust_coefficient * std::pow(diameter, 4) / (4 * pi * pi);
    thruster.min_velocity = -200.0;
    thruster.density = water_density;
    model.devices.push_back(thruster);
    const auto body = small.add(model, at(0, 0, z));
    small.world().set_device_target(body, DeviceId{0}, 0, -2 * pi * turns);
    const double share = z < 0.0 ? 1.0 : 1.225 / water_density;
    const physics::Wrench wrench = wrench_on(small, body);
    EXPECT_LT((wrench.force_W - share * Vector3d(-thrust, 0, 0)).norm(), 1e-9 * thrust);
    EXPECT_LT((wrench.torque_W - share * Vector3d(moment_constant * thrust, 0, 0.2 * thrust)).norm(), 1e-9 * thrust);
  }
}

TEST_P(Fluids, ARotorStandsStillAfterItsBodyIsPutBack) {
  SmallWorld small(air());
  small.description.physics.lowest = 0.0;
  const auto body = small.add(quadcopter(), at(0, 0, 1));
  spin(small.world(), body, 0.5 * hover);
  small.run(1.0);
  ASSERT_FALSE(small.world().is_active(body));
  EXPECT_GT(small.world().device_state(body, DeviceId{0}, 0).velocity, 0.0);
  small.world().set_present(body, true);
  EXPECT_EQ(small.world().device_state(body, DeviceId{0}, 0).velocity, 0.0);
  small.world().place_body(body, at(0, 0, 1));
  spin(small.world(), body, hover);
  small.run(1.0);
  EXPECT_NEAR(small.position(body).z(), 1.0, 1e-6);
}

// ---- Water ----

TEST_P(Fluids, ABoxFloatsAtTheDraughtOfArchimedesAndRightsItself) {
  SmallWorld small(water());
  const Vector3d size(0.4, 0.3, 0.2);
  const double density = 0.6;
  Model model = crate(size, density);
  Drag drag;
  drag.damping = {5, 5, 20};
  drag.angular_damping = {0.5, 0.5, 0.5};
  model.drags.push_back(drag);
  const auto body = small.add(model, turned(0, 0, 0.1, {1, 0.5, 0}, 0.3));
  small.run(30.0);
  const double draught = 0.5 * size.z() - small.position(body).z();
  EXPECT_NEAR(draught, density * size.z(), 1e-6);
  EXPECT_GT(small.up(body).z(), 1.0 - 1e-9) << "its metacentre is 22 mm above its centre of mass";
}

TEST_P(Fluids, AFloatingBodyAtRestStaysAtRest) {
  SmallWorld small(water());
  const auto body = small.add(crate({0.4, 0.3, 0.2}, 0.6), at(0, 0, -0.02, 0.3));
  small.run(10.0);
  EXPECT_LT((small.position(body) - Vector3d(0, 0, -0.02)).norm(), 1e-9);
}

TEST_P(Fluids, ATallBoxTips) {
  SmallWorld small(water());
  const auto body = small.add(crate({0.1, 0.1, 0.4}, 0.5), turned(0, 0, 0, {1, 0, 0}, 0.01));
  double least = 1.0;
  for (int i = 0; i < 1000; ++i) {
    small.world().step();
    least = std::min(least, std::abs(small.up(body).z()));
  }
  EXPECT_LT(least, 0.2);
}

TEST_P(Fluids, ABoxBobsWithThePeriodOfItsDraught) {
  SmallWorld small(water());
  const auto body = small.add(crate({0.8, 0.8, 0.4}, 0.5), at(0, 0, 0.02));
  int crossings = 0;
  double first = 0.0, last = 0.0, before = 0.02;
  for (int i = 1; i <= 600; ++i) {
    small.world().step();
    const double now = small.position(body).z();
    if (before > 0.0 && now <= 0.0) {
      last = 0.01 * (i - now / (now - before));
      if (crossings++ == 0) first = last;
    }
    before = now;
  }
  EXPECT_NEAR((last - first) / (crossings - 1), 2 * pi * std::sqrt(0.2 / g), 0.005);
}

// Implicit Euler damps an oscillation of angular frequency ω: each step of h divides its amplitude by √(1 + ω²h²), so
// each radian does so 1/arctan(ωh) times. The stiffness of heel is ρ g V GM, with the metacentric height GM = BM − BG.
// For a box of width w and draught d, BM = I/V = w²/(12 d); a twin hull with centres 2 a apart has a²/d more.
TEST_P(Fluids, AHeelingBoxIsDampedLikeItsStiffness) {
  struct Case {
    Vector3d size;
    double density;
    double lift;   // height of the centre of mass above the middle [m]
    double aside;  // distance of each of two hulls from the middle; 0: one hull [m]
  };
  const Case cases[] = {{{0.3, 0.4, 0.2}, 0.6, 0.0, 0.0},
                        {{0.6, 0.4, 0.2}, 0.5, 0.02, 0.0},
                        {{3.0, 1.2, 0.5}, 0.4, -0.1, 0.0},
                        {{1.0, 0.3, 0.3}, 0.5, 0.0, 0.3}};
  for (const Case& box : cases)
    for (const int milliseconds : {10, 2}) {
      SmallWorld small(water());
      small.description.step = std::chrono::milliseconds(milliseconds);
      Model model = crate(box.size, box.density);
      description::Link& link = model.links[0];
      if (box.aside > 0.0) {
        link.inertial = solid_box(2.0 * link.inertial.mass, box.size + Vector3d(0, 2.0 * box.aside, 0));
        link.collisions.push_back(link.collisions[0]);
        link.collisions[0].X_LC.position.y() = box.aside;
        link.collisions[1].X_LC.position.y() = -box.aside;
      }
      link.inertial.X_LI.position.z() = box.lift;
      const double draught = box.density * box.size.z();
      const double radius = (box.size.y() * box.size.y() / 12.0 + box.aside * box.aside) / draught;  // BM
      const double metacentric_height = radius - (0.5 * (box.size.z() - draught) + box.lift);        // GM
      const description::Inertial& inertial = link.inertial;
      const double omega = std::sqrt(inertial.mass * g * metacentric_height / inertial.inertia(0, 0));
      const double h = 1e-3 * milliseconds;
      const double first = 0.02;  // [rad]
      const auto body = small.add(model, turned(0, 0, 0.5 * box.size.z() - draught, {1, 0, 0}, first));
      const auto heel = [&] { return -small.up(body).y(); };

      // Half a turn of the phase after the other, the heel is greatest to one side and to the other.
      const int swings = 4;
      double most = 0.0, before = heel();
      int swing = 0;
      double crossed = 0.0, crossed_first = 0.0, crossed_last = 0.0;
      std::vector<double> peaks;
      for (int i = 1; swing <= swings; ++i) {
        ASSERT_LT(h * i, 20.0);
        small.world().step();
        const double now = heel();
        most = std::max(most, std::abs(now));
        if ((now > 0.0) != (before > 0.0)) {
          crossed = h * (i - now / (now - before));
          (swing == 0 ? crossed_first : crossed_last) = crossed;
          if (swing > 0) peaks.push_back(most);
          most = 0.0;
          ++swing;
        }
        before = now;
      }
      const double damped_omega = std::atan(omega * h) / h;
      EXPECT_NEAR(pi * swings / (crossed_last - crossed_first), damped_omega, 0.01 * damped_omega);
      const double decay = std::log(peaks.front() / peaks.back()) / (pi * (swings - 1));  // in each radian
      const double expected = 0.5 * std::log1p(omega * omega * h * h) / std::atan(omega * h);
      EXPECT_NEAR(decay, expected, 0.01 * expected)
          << box.size.transpose() << ", " << milliseconds << " ms, ωh/2 = " << 0.5 * omega * h
          << ", BM / GM = " << radius / metacentric_height;
    }
}

TEST_P(Fluids, SpheresAndCylindersDisplaceTheirMass) {
  Drag drag;
  drag.damping.setConstant(20.0);
  drag.angular_damping.setConstant(0.5);
  const auto height_of = [&](Model model, const Pose& X_WM) {
    SmallWorld small(water());
    model.drags.push_back(drag);
    const auto body = small.add(model, X_WM);
    small.run(20.0);
    return small.position(body).z();
  };
  const double r = 0.1;
  const double ball = 4.0 / 3.0 * pi * r * r * r;
  // The volume of a cap of height h is pi h^2 (3 r - h) / 3: 5/32 of the ball for h = r / 2.
  EXPECT_NEAR(height_of(floating(description::Sphere{r}, ball, 5.0 / 32.0, {r, r, r}), at(0, 0, 0)), 0.5 * r, 1e-6);
  const double length = 0.05;
  const double disc = pi * r * r * length;
  EXPECT_NEAR(height_of(floating(description::Cylinder{r, length}, disc, 0.7, {r, r, length}), at(0, 0, 0)),
              (0.5 - 0.7) * length, 1e-6);
  const double log = pi * r * r * 0.6;
  const Pose lying = turned(0, 0, 0, {0, 1, 0}, pi / 2);
  EXPECT_NEAR(height_of(floating(description::Cylinder{r, 0.6}, log, 0.5, {r, r, 0.6}), lying), 0.0, 1e-4);
}

// Each is tested at many levels and angles against sums over layers.
TEST(FloatingShapes, DisplaceTheirVolumeBelowTheSurface) {
  const double r = 0.1, length = 0.3;
  const physics::FloatingShape cylinder(description::Cylinder{r, length}), capsule(description::Capsule{r, length}),
      sphere(description::Sphere{r}), box(Box{{0.2, 0.2, 0.3}}), ellipsoid(description::Ellipsoid{{r, r, 2 * r}});
  const double whole_cylinder = pi * r * r * length, whole_ball = 4.0 / 3.0 * pi * r * r * r;
  const Pose lying = turned(0, 0, 0, {0, 1, 0}, pi / 2);
  for (const double level : {-0.09, -0.05, -0.01, 0.0, 0.03, 0.07}) {
    const double cap = pi / 3.0 * (r + level) * (r + level) * (2 * r - level);
    const double segment = r * r * std::acos(-level / r) + level * std::sqrt(r * r - level * level);
    EXPECT_NEAR(sphere.below(level, {}).volume, cap, 1e-12);
    EXPECT_NEAR(cylinder.below(level, lying).volume, segment * length, 0.002 * whole_cylinder);
    EXPECT_NEAR(capsule.below(level, lying).volume, segment * length + cap, 0.002 * (whole_cylinder + whole_ball));
    EXPECT_NEAR(cylinder.below(level, {}).volume, pi * r * r * (0.5 * length + level), 1e-12);
    EXPECT_NEAR(ellipsoid.below(2 * level, {}).volume, 2 * cap, 1e-12);
    EXPECT_NEAR(ellipsoid.below(level, lying).volume, 2 * cap, 1e-12);
    const physics::SubmergedPart edge_down =
        box.below(level, turned(0, 0, 0, {0, 0, 1}, 0.0) * turned(0, 0, 0, {1, 0, 0}, pi / 2) *
                             turned(0, 0, 0, {0, 0, 1}, pi / 4));
    const double depth = 0.1 * std::numbers::sqrt2 - std::abs(level);
    const double corner = depth * depth * 0.3;
    EXPECT_NEAR(edge_down.volume, level < 0.0 ? corner : 0.2 * 0.2 * 0.3 - corner, 1e-12);
    EXPECT_NEAR(edge_down.area, 2 * depth * 0.3, 1e-12);
    EXPECT_NEAR(edge_down.second_moment_W.trace(), edge_down.area / 12.0 * (4 * depth * depth + 0.09), 1e-12);
  }
  // The section gives the derivative of the volume and its moment with respect to the level, for any shape at any
  // angle.
  for (const physics::FloatingShape* shape : {&cylinder, &capsule, &ellipsoid, &box}) {
    const Pose X_WC = turned(0.3, -0.2, 0.05, {1, 2, 0.5}, 0.8);
    constexpr double change = 1e-5;
    const physics::SubmergedPart low = shape->below(0.02 - change, X_WC), high = shape->below(0.02 + change, X_WC),
                                 mid = shape->below(0.02, X_WC);
    EXPECT_NEAR((high.volume - low.volume) / (2 * change), mid.area, 1e-5 * mid.area);
    const Vector3d centre = (high.volume * high.centre_W - low.volume * low.centre_W) / (high.volume - low.volume);
    EXPECT_LT((centre - mid.area_centre_W).norm(), 1e-5);
  }
}

TEST(FloatingShapes, AddUpToTheShapeThatTheyForm) {
  const Pose X_WC = turned(0.3, -0.2, 0.05, {1, 2, 0.5}, 0.8);
  const physics::SubmergedPart whole = physics::FloatingShape(Box{{0.2, 0.5, 0.3}}).below(0.02, X_WC);
  physics::SubmergedPart sum = physics::FloatingShape(Box{{0.2, 0.1, 0.3}}).below(0.02, X_WC * at(0, 0.2, 0));
  sum.add(physics::FloatingShape(Box{{0.2, 0.4, 0.3}}).below(0.02, X_WC * at(0, -0.05, 0)));
  sum.add({});
  EXPECT_NEAR(sum.volume, whole.volume, 1e-12);
  EXPECT_LT((sum.centre_W - whole.centre_W).norm(), 1e-12);
  EXPECT_NEAR(sum.area, whole.area, 1e-12);
  EXPECT_LT((sum.area_centre_W - whole.area_centre_W).norm(), 1e-12);
  EXPECT_LT((sum.second_moment_W - whole.second_moment_W).norm(), 1e-12);
}

TEST_P(Fluids, ALightPlateSettlesOnTheWater) {
  SmallWorld small(water());
  Model model = crate({1.0, 1.0, 0.05}, 0.02);
  Drag drag;
  drag.damping.setConstant(5.0);
  drag.angular_damping.setConstant(1.0);
  model.drags.push_back(drag);
  const auto body = small.add(model, turned(0, 0, 0.3, {1, 0.3, 0}, 0.4));
  for (int i = 0; i < 2000; ++i) {
    small.world().step();
    ASSERT_LT(small.velocity(body).norm(), 20.0) << "at step " << i;
  }
  EXPECT_NEAR(small.position(body).z(), (0.5 - 0.02) * 0.05, 1e-6);
  EXPECT_GT(small.up(body).z(), 1.0 - 1e-9);
}

TEST_P(Fluids, ABoatReachesTheSpeedWhereDragEqualsThrust) {
  const Vector3d current(0.2, -0.1, 0);
  SmallWorld small(water(current));
  Model boat = crate({0.6, 0.3, 0.2}, 0.5);
  Rotor thruster = rotor_at({-0.3, 0, -0.08});
  thruster.X_LR.orientation = Eigen::AngleAxisd(pi / 2, Vector3d::UnitY());
  thruster.motor_constant = 1e-3;
  thruster.moment_constant = 0.0;
  thruster.density = water_density;
  boat.devices.push_back(thruster);
  Drag drag;
  drag.X_LD.position = {0, 0, -0.08};
  drag.damping = {0, 30, 30};
  drag.quadratic_damping = {8, 0, 0};
  drag.angular_damping = {3, 3, 3};
  boat.drags.push_back(drag);
  const auto body = small.add(boat, at(0, 0, 0));
  small.world().set_device_target(body, DeviceId{0}, 0, 100.0);
  small.run(60.0);
  const Vector3d through_water =
      small.world().link_pose(body, LinkId{0}).orientation.conjugate() * (small.velocity(body) - current);
  EXPECT_NEAR(through_water.x(), std::sqrt(1e-3 * 100.0 * 100.0 / 8.0), 1e-3);
  EXPECT_NEAR(through_water.y(), 0.0, 1e-3);
}

TEST_P(Fluids, ARudderTurnsABoatToItsSide) {
  for (const double side : {1.0, -1.0}) {
    SmallWorld small(water());
    Model boat = crate({0.6, 0.3, 0.2}, 0.5);
    boat.links.push_back({"rudder", {{-0.35, 0, -0.1}}, solid_box(0.1, {0.1, 0.01, 0.1}), {}});
    description::Joint joint;
    joint.name = "rudder";
    joint.type = description::JointType::revolute;
    joint.child = 1;
    boat.joints.push_back(joint);
    boat.devices.push_back(description::PositionMotor{"rudder", 0, 5.0, 5.0});
    Rotor thruster = rotor_at({-0.3, 0, -0.08});
    thruster.X_LR.orientation = Eigen::AngleAxisd(pi / 2, Vector3d::UnitY());
    thruster.motor_constant = 1e-3;
    thruster.moment_constant = 0.0;
    boat.devices.push_back(thruster);
    Fin blade;
    blade.link = 1;
    blade.X_LF = turned(-0.05, 0, 0, {1, 0, 0}, pi / 2);
    blade.area = 0.01;
    blade.cla = 4.0;
    boat.fins.push_back(blade);
    Drag drag;
    drag.X_LD.position = {0, 0, -0.05};
    drag.damping = {8, 60, 60};
    drag.angular_damping = {2, 2, 2};
    boat.drags.push_back(drag);
    const auto body = small.add(boat, at(0, 0, 0));
    small.world().set_joint_target(body, JointId{0}, physics::JointTarget::position(0.3 * side));
    small.world().set_device_target(body, DeviceId{1}, 0, 100.0);
    small.run(3.0);
    EXPECT_NEAR(small.world().joint_state(body, JointId{0}).position, 0.3 * side, 0.02);
    // The trailing end of the blade is on the right: the stern moves left.
    EXPECT_LT(side * small.world().link_twist(body, LinkId{0}).angular_W.z(), -0.1);
    EXPECT_GT(small.up(body).z(), 0.95);
  }
}

// ---- Drag, fins and wind ----

TEST_P(Fluids, AFallingBodyReachesItsTerminalVelocity) {
  SmallWorld small(air());
  const double mass = 0.5, linear = 0.1, quadratic = 0.02;
  Model model = loose("ball", description::Sphere{0.1}, solid_sphere(mass, 0.1));
  Drag drag;
  drag.damping.setConstant(linear);
  drag.quadratic_damping.setConstant(quadratic);
  model.drags.push_back(drag);
  const auto body = small.add(model, at(0, 0, 0));
  small.description.physics.lowest = -1e4;
  small.run(40.0);
  const double expected = (-linear + std::sqrt(linear * linear + 4 * quadratic * mass * g)) / (2 * quadratic);
  EXPECT_NEAR(small.velocity(body).z(), -expected, 1e-6 * expected);
}

TEST_P(Fluids, DragNeverReversesTheMotion) {
  SmallWorld small(air());
  small.description.gravity.setZero();
  Model model = loose("leaf", Box{{0.1, 0.1, 0.001}}, solid_box(1e-3, {0.1, 0.1, 0.001}));
  Drag drag;
  drag.X_LD.position = {0.05, 0, 0};
  drag.damping = {0, 0, 50};
  drag.quadratic_damping = {100, 100, 100};
  drag.quadratic_angular_damping = {10, 10, 10};
  model.drags.push_back(drag);
  const auto body = small.add(model, at(0, 0, 3));
  small.world().set_root_twist(body, {Vector3d(30, -20, 10), Vector3d(50, 10, -20)});
  double before = 1e9;
  for (int i = 0; i < 200; ++i) {
    small.world().step();
    const physics::Twist twist = small.world().link_twist(body, LinkId{0});
    const double energy = 0.5e-3 * twist.linear_W.squaredNorm();
    ASSERT_LE(energy, before);
    before = energy;
  }
  EXPECT_LT(small.velocity(body).norm(), 0.1);
}

TEST_P(Fluids, AFinHasTheLiftAndDragOfItsAngleOfAttack) {
  const double speed = 2.0;
  Fin fin;
  fin.name = "fin";
  fin.X_LF.position = {0.1, 0, 0.2};
  fin.area = 0.03;
  fin.cla = 4.0;
  fin.cda = 0.2;
  fin.alpha_stall = 0.2;
  fin.cla_stall = -3.0;
  fin.cda_stall = 1.5;
  for (const double degrees : {5.0, -5.0, 20.0, 80.0, 180.0 + 5.0}) {
    const double angle = degrees * pi / 180.0;
    const double alpha = degrees > 90.0 ? angle - pi : angle;
    // The water comes from ahead and below.
    SmallWorld small(water(speed * Vector3d(-std::cos(angle), 0, std::sin(angle))));
    small.description.gravity.setZero();
    Model model = anchored();
    model.fins.push_back(fin);
    const auto body = small.add(model, at(0, 0, -2));
    const double beyond = std::copysign(std::max(0.0, std::abs(alpha) - 0.2), alpha);
    double lift = 4.0 * (alpha - beyond) - 3.0 * beyond;
    if (beyond > 0.0) lift = std::max(lift, 0.0);
    const double drag = std::abs(0.2 * (alpha - beyond) + 1.5 * beyond);
    const double pressure = 0.5 * water_density * speed * speed * fin.area;
    const Vector3d with_flow(-std::cos(angle), 0, std::sin(angle));
    const Vector3d across(std::sin(angle), 0, std::cos(angle));
    const Vector3d force = pressure * (lift * across + drag * with_flow);
    const physics::Wrench wrench = wrench_on(small, body);
    EXPECT_LT((wrench.force_W - force).norm(), 1e-9 * pressure) << degrees << " degrees: " << wrench.force_W;
    EXPECT_LT((wrench.torque_W - Vector3d(0.1, 0, 0.2).cross(force)).norm(), 1e-9 * pressure);
  }
}

// For a glider of 30 g at 300 m/s, the lift of one step would throw it up 180 times as fast as it sinks.
TEST_P(Fluids, ALightFinAtHighSpeedIsStable) {
  for (const double cla_stall : {0.0, -3.0}) {
    SmallWorld small(air());
    small.description.physics.lowest = -1e4;
    Model model = loose("glider", Box{{0.3, 0.5, 0.02}}, solid_box(0.03, {0.3, 0.5, 0.02}));
    Fin wing;
    wing.X_LF.position = {-0.01, 0, 0};
    wing.area = 0.5;
    wing.cla = 6.0;
    wing.alpha0 = 0.05;
    wing.alpha_stall = 0.25;
    wing.cla_stall = cla_stall;
    model.fins.push_back(wing);
    const auto body = small.add(model, turned(0, 0, 1000, {0, 1, 0}, 0.3));
    small.world().set_root_twist(body, {Vector3d(0, 5, 0), Vector3d(300, 0, -50)});
    double most = small.velocity(body).norm();
    for (int i = 0; i < 1000; ++i) {
      small.world().step();
      const double speed = small.velocity(body).norm();
      ASSERT_TRUE(small.world().is_active(body)) << "at step " << i;
      ASSERT_LT(speed, most) << "at step " << i;
      most = std::sqrt(std::max(speed * speed, 1.0) + 2.0 * g * 10.0);
    }
  }
}

TEST_P(Fluids, WindActsOnLinksThatFeelIt) {
  SmallWorld small(air());
  small.description.gravity.setZero();
  small.description.air.wind = {3, 1, 0};
  small.description.air.wind_force = 0.5;
  const auto ball = [] { return loose("ball", description::Sphere{0.1}, solid_sphere(0.5, 0.1)); };
  Model feeling = ball(), dragged = ball();
  feeling.links[0].feels_wind = true;
  Drag drag;
  drag.damping.setConstant(0.25);
  dragged.drags.push_back(drag);
  const auto calm = small.add(dragged, at(0, 0, 5));
  const auto blown = small.add(feeling, at(0, 2, 5));
  feeling.drags.push_back(drag);
  const auto both = small.add(feeling, at(0, 4, 5));
  small.run(1.0);
  EXPECT_EQ(small.velocity(calm), Vector3d::Zero());
  EXPECT_LT((small.velocity(blown) - Vector3d(3, 1, 0) * (1.0 - std::pow(1.005, -100))).norm(), 1e-9);
  EXPECT_LT((small.velocity(both) - Vector3d(3, 1, 0) * (1.0 - std::pow(1.005, -200))).norm(), 1e-9);
}

TEST_P(Fluids, JointsCarryTheThrustOfARotor) {
  SmallWorld small(air());
  Model model = anchored();
  model.devices.push_back(rotor_at({0.3, 0, 0}));
  const auto body = small.add(model, at(0, 0, 1));
  small.world().set_device_target(body, DeviceId{0}, 0, 600.0);
  const double thrust = motor_constant * 600.0 * 600.0;
  const physics::Wrench wrench = wrench_on(small, body);
  EXPECT_LT((wrench.force_W - Vector3d(0, 0, thrust - g)).norm(), 1e-9);
  EXPECT_LT((wrench.torque_W - Vector3d(0, -0.3 * thrust, -moment_constant * thrust)).norm(), 1e-9);
}

// ---- Added mass ----

using description::SpatialMatrix;

// Returns a diagonal matrix by what it adds to the moments of inertia [kg m^2] and to the mass [kg] along each axis.
std::shared_ptr<SpatialMatrix> added_mass(const Vector3d& moments, const Vector3d& masses) {
  auto matrix = std::make_shared<SpatialMatrix>(SpatialMatrix::Zero());
  matrix->diagonal() << moments, masses;
  return matrix;
}

TEST_P(Fluids, AddedMassHasInertiaButNoWeight) {
  SmallWorld small(air());
  Model model = loose("ball", description::Sphere{0.1}, solid_sphere(1.0, 0.1));
  model.links[0].inertial.added_mass = added_mass({0, 0, 0}, {1.0, 0.0, 3.0});
  const auto falling = small.add(model, at(0, 0, 50));
  const auto lying = small.add(model, turned(0, 5, 50, Vector3d::UnitY(), pi / 2));
  small.run(0.5);
  EXPECT_NEAR(small.velocity(falling).z(), -g * 0.5 / 4.0, 1e-9);
  EXPECT_NEAR(small.velocity(lying).z(), -g * 0.5 / 2.0, 1e-9);
}

// A push beside the origin of the link, which the matrix is about, turns a ball whose centre is there.
TEST_P(Fluids, AddedMassIsAboutTheOriginOfItsLink) {
  SmallWorld small(air());
  small.description.gravity.setZero();
  Model model = loose("ball", description::Sphere{0.1}, solid_sphere(1.0, 0.1));
  const double moment = model.links[0].inertial.inertia(0, 0);
  const Vector3d arm(0.2, 0, 0);
  model.links[0].inertial.X_LI.position = arm;
  model.links[0].inertial.added_mass = added_mass({0, 0, 0}, {0.0, 2.0, 0.0});
  const auto body = small.add(model, at(0, 0, 5));
  const double force = 3.0, time = 0.01;
  small.world().push_body(body, LinkId{0}, {force * Vector3d::UnitY(), Vector3d::Zero()});
  small.world().step();
  // Kirchhoff's equations at rest: (m + 2) v - 2 * 0.2 w = f t, of the centre; I w + 2 * 0.2 (0.2 w - v) = 0.
  const Eigen::Matrix2d inertia{{3.0, -0.4}, {-0.4, moment + 0.08}};
  const Eigen::Vector2d expected = inertia.inverse() * Eigen::Vector2d(force * time, 0.0);
  const physics::Twist twist = small.world().link_twist(body, LinkId{0});
  const Vector3d arm_W = small.world().link_pose(body, LinkId{0}).orientation * arm;
  EXPECT_NEAR(twist.angular_W.z(), expected[1], 1e-9);
  EXPECT_NEAR((twist.linear_W + twist.angular_W.cross(arm_W)).y(), expected[0], 1e-9);
}

// The motion of a body in a fluid at rest, by Kirchhoff's equations in its own axes (Lamb, "Hydrodynamics", 1932,
// section 124), by the method of Runge and Kutta.
struct Kirchhoff {
  Eigen::Matrix<double, 6, 1> velocity;  // angular, then linear
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  SpatialMatrix inertia;

  double energy() const { return 0.5 * velocity.dot(inertia * velocity); }
  Vector3d linear_momentum() const { return rotation * Vector3d((inertia * velocity).tail<3>()); }
  Eigen::Matrix<double, 6, 1> acceleration(const Eigen::Matrix<double, 6, 1>& at) const {
    const Eigen::Matrix<double, 6, 1> momentum = inertia * at;
    const Vector3d w = at.head<3>(), v = at.tail<3>(), h = momentum.head<3>(), p = momentum.tail<3>();
    Eigen::Matrix<double, 6, 1> rate;
    rate << h.cross(w) + p.cross(v), p.cross(w);
    return inertia.inverse() * rate;
  }
  void advance(double time) {
    constexpr double step = 1e-3;
    for (double t = 0.0; t < time - 0.5 * step; t += step) {
      const Eigen::Matrix<double, 6, 1> k1 = acceleration(velocity), k2 = acceleration(velocity + 0.5 * step * k1),
                                        k3 = acceleration(velocity + 0.5 * step * k2),
                                        k4 = acceleration(velocity + step * k3);
      const Vector3d turn = step * (velocity + 0.5 * step * k1).head<3>();
      rotation = (rotation * Eigen::AngleAxisd(turn.norm(), turn.normalized())).normalized();
      velocity += step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
  }
};

TEST_P(Fluids, AddedMassTurnsALongBodyAcrossItsWay) {
  const Vector3d size(1.0, 0.2, 0.2);
  Model model = loose("hull", Box{size}, solid_box(20.0, size));
  const auto of_fluid = added_mass({0.1, 1.0, 1.2}, {2.0, 18.0, 15.0});
  (*of_fluid)(1, 5) = (*of_fluid)(5, 1) = 0.8;
  model.links[0].inertial.added_mass = of_fluid;
  Kirchhoff expected;
  expected.velocity << 0.05, -0.1, 0.1, 1.0, 0.1, 0.05;
  expected.inertia = *of_fluid;
  expected.inertia.topLeftCorner<3, 3>() += model.links[0].inertial.inertia;
  expected.inertia.bottomRightCorner<3, 3>() += 20.0 * Eigen::Matrix3d::Identity();
  const double energy = expected.energy();
  const Vector3d momentum = expected.linear_momentum();
  expected.advance(3.0);
  ASSERT_NEAR(expected.energy(), energy, 1e-6 * energy);
  ASSERT_LT((expected.linear_momentum() - momentum).norm(), 1e-4 * momentum.norm());
  ASSERT_GT(expected.rotation.angularDistance(Eigen::Quaterniond::Identity()), 0.8) << "the fluid has turned it";

  std::vector<double> errors;
  for (const double step : {0.01, 0.005}) {
    SmallWorld small(air());
    small.description.gravity.setZero();
    small.description.step = std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(step));
    const auto body = small.add(model, at(0, 0, 5));
    small.world().set_root_twist(body, {Vector3d(0.05, -0.1, 0.1), Vector3d(1.0, 0.1, 0.05)});
    small.run(3.0);
    const Pose X_WL = small.world().link_pose(body, LinkId{0});
    const physics::Twist twist = small.world().link_twist(body, LinkId{0});
    Kirchhoff found = expected;
    found.velocity << X_WL.orientation.conjugate() * twist.angular_W, X_WL.orientation.conjugate() * twist.linear_W;
    EXPECT_NEAR(found.energy(), energy, 0.01 * energy);
    errors.push_back(X_WL.orientation.angularDistance(expected.rotation));
  }
  EXPECT_LT(errors[0], 0.05);
  EXPECT_LT(errors[1], 0.6 * errors[0]);
}

// No torque acts about a hinge. The force on it changes the momentum of the pendulum and of the fluid around it.
TEST_P(Fluids, JointsFeelAddedMass) {
  SmallWorld small(air());
  Model model = anchored();
  model.links.push_back({"pendulum", at(0, 0, 0), solid_box(2.0, {0.1, 0.1, 0.4}), {}});
  const Vector3d centre(0, 0, -0.5), masses(3.0, 5.0, 1.0);
  model.links[1].inertial.X_LI.position = centre;
  model.links[1].inertial.added_mass = added_mass({0.02, 0.03, 0.04}, masses);
  model.joints.push_back(joint_of("hinge", description::JointType::revolute, 0, 1, Vector3d::UnitY(), {0, 0, 0.3}));
  const auto body = small.add(model, at(0, 0, 5));
  small.world().record(body);
  const std::vector<double> angle{0.7}, speed{1.5};
  small.world().set_joint_state(body, JointId{1}, angle, speed);
  const auto momentum = [&] {
    const physics::Twist twist = small.world().link_twist(body, LinkId{1});
    const Pose X_WL = small.world().link_pose(body, LinkId{1});
    const Vector3d linear_L = X_WL.orientation.conjugate() * twist.linear_W;
    return Vector3d(2.0 * (twist.linear_W + twist.angular_W.cross(X_WL.orientation * centre)) +
                    X_WL.orientation * Vector3d(masses.cwiseProduct(linear_L)));
  };
  small.run(0.2);
  const Vector3d before = momentum();
  small.world().step();
  const Vector3d change = (momentum() - before) / 0.01;
  const physics::Wrench wrench = small.world().joint_wrench(body, JointId{1});
  EXPECT_GT(change.norm(), 10.0);
  EXPECT_LT((wrench.force_W - (change + Vector3d(0, 0, 2.0 * g))).norm(), 0.02 * change.norm());
  EXPECT_NEAR(wrench.torque_W.y(), 0.0, 1e-6);
}

TEST_P(Fluids, ABodyWithAddedMassRestsOnTheGround) {
  SmallWorld small(water());
  place(small.description, static_shape("bed", description::Plane{}, {}), "bed", {});
  const Vector3d size(0.4, 0.2, 0.2);
  Model model = floating(Box{size}, size.prod(), 1.2, size);
  model.links[0].inertial.added_mass = added_mass({0.1, 0.3, 0.3}, {4.0, 16.0, 16.0});
  const auto body = small.add(model, at(0, 0, 0.2));
  small.description.water->level = 5.0;
  small.run(10.0);
  EXPECT_LT(small.velocity(body).norm(), 1e-6);
  EXPECT_NEAR(small.position(body).z(), 0.1, 1e-3);
}

// Too many degrees of freedom for the inverse of its mass matrix.
TEST(FluidsByBothDynamics, AgreeOnATowedChainOfFloats) {
  const auto places_by = [](description::Dynamics dynamics) {
    SmallWorld small(empty_world());
    small.description.physics.dynamics = dynamics;
    small.description.water.emplace().current = {0.1, 0.2, 0};
    small.description.air.wind = {2, 0, 0};
    Model chain;
    chain.name = "chain";
    const double length = 0.2;
    for (std::size_t i = 0; i < 8; ++i) {
      chain.links.push_back({"float",
                             {{-length * static_cast<double>(i), 0, 0}},
                             solid_box(0.8, {0.15, 0.1, 0.1}),
                             {{"c", {}, description::Capsule{0.05, 0.05}, {}}}});
      chain.links.back().feels_wind = i % 2 == 0;
      Drag drag;
      drag.link = i;
      drag.quadratic_damping = {2, 8, 8};
      drag.angular_damping.setConstant(0.02);
      chain.drags.push_back(drag);
      if (i == 0) continue;
      description::Joint joint;
      joint.type = description::JointType::ball;
      joint.parent = i - 1;
      joint.child = i;
      joint.X_LJ.position = {0.5 * length, 0, 0};
      joint.axis.damping = 0.01;
      chain.joints.push_back(joint);
    }
    Fin fin;
    fin.link = 7;
    fin.X_LF.orientation = Eigen::AngleAxisd(pi / 2, Vector3d::UnitX());
    fin.area = 0.01;
    fin.cla = 4.0;
    chain.fins.push_back(fin);
    Rotor tug = rotor_at({0, 0, 0.1});
    tug.X_LR.orientation = Eigen::AngleAxisd(pi / 2 - 0.3, Vector3d::UnitY());
    tug.drag_coefficient = 1e-4;
    chain.devices.push_back(tug);
    const auto body = small.add(chain, at(0, 0, 0.05));
    small.world().set_device_target(body, DeviceId{0}, 0, 700.0);
    small.run(2.0);
    EXPECT_GT(small.velocity(body, 0).x(), 0.05) << "it is towed";
    std::vector<Vector3d> places;
    for (std::size_t i = 0; i < 8; ++i) places.push_back(small.position(body, i));
    return places;
  };
  const std::vector<Vector3d> bullets = places_by(description::Dynamics::bullet);
  const std::vector<Vector3d> ours = places_by(description::Dynamics::cohort);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_LT((bullets[i] - ours[i]).norm(), 1e-7) << "float " << i;
}

// ---- State ----

// Quadcopters and boats on a windy sea, with a raft of crates that touch each other: a large island.
struct Regatta {
  SmallWorld small;
  std::uint32_t copters = 12;

  Regatta(description::World world, unsigned threads) : small(std::move(world), threads) {
    small.description.air.wind = {2, -1, 0};
    Model copter = quadcopter(0.05);
    copter.links[0].feels_wind = true;
    Model boat = loose("boat", Box{{0.6, 0.3, 0.2}}, solid_box(18.0, {0.6, 0.3, 0.2}));
    Fin keel;
    keel.X_LF = turned(0, 0, -0.2, {1, 0, 0}, pi / 2);
    keel.area = 0.05;
    keel.cla = 5.0;
    Drag drag;
    drag.quadratic_damping.setConstant(30.0);
    drag.density = water_density;
    boat.fins.push_back(keel);
    boat.drags.push_back(drag);
    for (std::uint32_t i = 0; i < copters; ++i) small.add(copter, at(1.0 * i, 0, 2, 0.1 * i));
    for (std::uint32_t i = 0; i < copters; ++i) small.add(boat, turned(0.55 * i, 0.1 * i, 0, {1, 1, 0}, 0.02 * i));
    const Vector3d cube = Vector3d::Constant(0.1);
    const Model crate = loose("crate", Box{cube}, solid_box(0.4, cube));
    for (int row = 0; row < 10; ++row)
      for (int column = 0; column < 11; ++column) small.add(crate, at(0.1001 * column, -3.0 + 0.1001 * row, 0.02));
  }
  void step(int tick) {
    for (std::uint32_t body = 0; body < copters; ++body)
      spin(small.world(), BodyId{body}, hover * (1.0 + 0.05 * std::sin(0.1 * tick + body)));
    small.world().step();
  }
};

TEST_P(Fluids, HaveTheSameBitsForAnyNumberOfThreads) {
  const auto hash_with = [](unsigned threads) {
    Regatta regatta(water(), threads);
    for (int tick = 0; tick < 200; ++tick) regatta.step(tick);
    return hash_of(regatta.small.world());
  };
  const std::uint64_t expected = hash_with(1);
  for (const unsigned threads : {2u, 4u}) EXPECT_EQ(hash_with(threads), expected) << threads;
}

TEST_P(Fluids, ContinueFromASnapshotWithTheSameBits) {
  Regatta regatta(water(), 1), restored(water(), 2);
  for (int tick = 0; tick < 100; ++tick) regatta.step(tick);
  restore_from(regatta.small.world(), restored.small.world());
  ASSERT_EQ(hash_of(restored.small.world()), hash_of(regatta.small.world()));
  for (int tick = 100; tick < 200; ++tick) {
    regatta.step(tick);
    restored.step(tick);
    ASSERT_EQ(hash_of(restored.small.world()), hash_of(regatta.small.world())) << "at tick " << tick;
  }
}

TEST(PlanarFluids, AreRejected) {
  const auto reason = [](const Model& model, void (*change)(description::World&)) -> std::string {
    SmallWorld small;
    small.description.physics.fidelity = description::Fidelity::planar;
    change(small.description);
    small.add(model, at(0, 0, 0.05));
    try {
      small.world();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  const auto nothing = [](description::World&) {};
  const Model plain = loose("box", Box{Vector3d::Constant(0.1)}, solid_box(1.0, Vector3d::Constant(0.1)));
  EXPECT_EQ(reason(plain, nothing), "");
  EXPECT_EQ(reason(plain, [](description::World& world) { world.water.emplace(); }),
            "planar physics does not support water");
  EXPECT_EQ(reason(quadcopter(), nothing), "model 'quadcopter': planar physics does not support rotor 'rotor0'");
  Model model = plain;
  model.fins.emplace_back().name = "wing";
  EXPECT_EQ(reason(model, nothing), "model 'box': planar physics does not support fin 'wing'");
  model = plain;
  model.drags.emplace_back().name = "hull";
  EXPECT_EQ(reason(model, nothing), "model 'box': planar physics does not support drag 'hull'");
  model = plain;
  model.links[0].inertial.added_mass = added_mass(Vector3d::Ones(), Vector3d::Ones());
  EXPECT_EQ(reason(model, nothing), "model 'box': planar physics does not support <fluid_added_mass>");
  model = plain;
  model.links[0].feels_wind = true;
  EXPECT_EQ(reason(model, nothing), "");
  EXPECT_EQ(reason(model,
                   [](description::World& world) {
                     world.air.wind = {1, 0, 0};
                   }),
            "model 'box': planar physics does not support links with <enable_wind>");
}

}  // namespace
}  // namespace cohort::test
