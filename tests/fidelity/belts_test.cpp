// SPDX-License-Identifier: Apache-2.0

// Links with moving surfaces: conveyors and tracks, limited by friction alone.

#include <cmath>

#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using description::Box;
using description::Surface;
using Eigen::Vector3d;

class Belts : public EveryPhysics {};
INSTANTIATE_TEST_SUITE_P(Every, Belts,
                         ::testing::Values(articulated, by_bullet(articulated), treel, by_bullet(treel), direct,
                                           by_bullet(direct), hybrid),
                         name_of);

Surface with_friction(double friction) {
  Surface surface;
  surface.friction = friction;
  return surface;
}

// Returns a conveyor of 6 m along x with its top at the origin, fixed to the world.
description::Model conveyor(double friction) {
  description::Model model =
      loose("conveyor", Box{{6.0, 1.0, 0.1}}, solid_box(20.0, {6.0, 1.0, 0.1}), with_friction(friction));
  model.links[0].collisions[0].X_LC.position.z() = -0.05;
  model.joints.push_back(
      joint_of("tie", description::JointType::fixed, description::Joint::world, 0, Vector3d::UnitZ()));
  model.devices.push_back(description::Belt{"belt", 0, Vector3d::UnitY(), 10.0});
  return model;
}

description::Model crate() { return loose("crate", Box{{0.2, 0.2, 0.1}}, solid_box(2.0, {0.2, 0.2, 0.1})); }

// Returns the pose of a body at rest on the top of an object at X_WB, `x` along it.
Pose on(const Pose& X_WB, double x, double half_height) { return X_WB * Pose{{x, 0, half_height}}; }

// Returns a vehicle with two tracks of 0.6 m, 0.4 m apart.
description::Model tracked_vehicle(double friction) {
  description::Model model = loose("vehicle", Box{{0.6, 0.24, 0.1}}, solid_box(10.0, {0.6, 0.24, 0.1}));
  model.links[0].collisions[0].X_LC.position.z() = 0.05;
  for (const double y : {0.2, -0.2}) {
    description::Link track{y > 0.0 ? "left" : "right", {{0, y, 0}}, solid_box(2.0, {0.6, 0.1, 0.1}), {}};
    track.collisions.push_back({"middle", {}, Box{{0.5, 0.1, 0.1}}, with_friction(friction)});
    for (const double x : {0.25, -0.25})
      track.collisions.push_back({"end", turned(x, 0, 0, Vector3d::UnitX(), 0.5 * std::numbers::pi),
                                  description::Cylinder{0.05, 0.1}, with_friction(friction)});
    model.links.push_back(track);
    model.joints.push_back(
        joint_of(track.name, description::JointType::fixed, 0, model.links.size() - 1, Vector3d::UnitZ()));
  }
  description::TrackedDrive drive;
  drive.name = "drive";
  drive.left_links = {1};
  drive.right_links = {2};
  drive.track_separation = 0.4;
  model.devices.push_back(drive);
  return model;
}
void run_tracks(SmallWorld& small, BodyId body, double left, double right) {
  small.world().set_device_target(body, DeviceId{0}, 0, left);
  small.world().set_device_target(body, DeviceId{0}, 1, right);
}

// Returns the work of the body's belts in this time [J].
double work_of(SmallWorld& small, BodyId body, double time) {
  const double step = std::chrono::duration<double>(small.description.step).count();
  double work = 0.0;
  for (auto steps = std::lround(time / step); steps > 0; --steps) {
    small.world().step();
    work += step * small.driven_power(body);
  }
  return work;
}

TEST_P(Belts, AccelerateTheirLoadByFriction) {
  constexpr double friction = 0.3, speed = 0.9;
  for (const double yaw : {0.0, 0.6, -2.0}) {
    for (const double sense : {1.0, -1.0}) {
      SmallWorld small(GetParam().world());
      const Pose X_WB = turned(0, 0, 1, Vector3d::UnitZ(), yaw);
      const auto belt = small.add(conveyor(friction), X_WB);
      const auto box = small.add(crate(), on(X_WB, 0, 0.05));
      const Vector3d along = X_WB.orientation * Vector3d(sense, 0, 0);
      small.run(0.1);
      EXPECT_LT(small.velocity(box).head<2>().norm(), 1e-6) << "it stands";
      small.world().set_device_target(belt, DeviceId{0}, 0, sense * speed);
      for (const double time : {0.1, 0.2}) {
        small.run(0.1);
        EXPECT_NEAR(along.dot(small.velocity(box)), friction * g * time, 0.01 * friction * g * time) << yaw;
      }
      small.run(0.5);
      EXPECT_NEAR(along.dot(small.velocity(box)), speed, 1e-3 * speed);
      small.run(0.5);
      const Vector3d off = small.velocity(box) - speed * along;
      EXPECT_LT(off.norm(), 1e-3 * speed) << off.transpose();
      const Vector3d way = small.position(box) - on(X_WB, 0, 0.05).position;
      EXPECT_LT((way - along.dot(way) * along).norm(), 1e-3) << "straight along the belt";
    }
  }
}

// Large heaps nearly at rest are damped, but not on a belt.
TEST_P(Belts, CarryALargeHeapAtTheirVelocity) {
  if (GetParam().solver == description::Solver::direct) return;  // damps nothing, and takes minutes
  constexpr double speed = 0.05;
  SmallWorld small(GetParam().world());
  const auto belt = small.add(conveyor(0.6), at(0, 0, 1));
  std::vector<BodyId> boxes;
  for (int column = 0; column < 50; ++column)
    for (const double height : {0.03, 0.09}) {
      const Vector3d size = Vector3d::Constant(0.06);
      boxes.push_back(small.add(loose("box", Box{size}, solid_box(0.2, size)),
                                at(-1.0 + 0.08 * (column % 25), column < 25 ? 0.1 : -0.1, 1.0 + height)));
    }
  small.world().set_device_target(belt, DeviceId{0}, 0, speed);
  small.run(1.0);
  for (const BodyId box : boxes) EXPECT_NEAR(small.velocity(box).x(), speed, 0.01 * speed);
}

TEST_P(Belts, CarryALoadUpAndDownASlope) {
  constexpr double friction = 0.6, slope = 0.35, speed = 0.5;
  for (const double sense : {1.0, -1.0}) {
    SmallWorld small(GetParam().world());
    const Pose X_WB = turned(0, 0, 2, Vector3d::UnitY(), -slope);  // x goes up
    const auto belt = small.add(conveyor(friction), X_WB);
    const auto box = small.add(crate(), on(X_WB, 0, 0.05));
    small.world().set_device_target(belt, DeviceId{0}, 0, sense * speed);
    const Vector3d along = X_WB.orientation * Vector3d(sense, 0, 0);
    small.run(0.1);
    const double acceleration = g * (friction * std::cos(slope) - sense * std::sin(slope));
    EXPECT_NEAR(along.dot(small.velocity(box)), std::min(speed, 0.1 * acceleration), 0.02 * 0.1 * acceleration);
    small.run(0.9);
    EXPECT_LT((small.velocity(box) - speed * along).norm(), 2e-3 * speed);
  }
}

// The slope is steeper than the friction angle: the crate slides down at any speed of the belt.
TEST_P(Belts, DoNotCarryALoadBeyondTheFrictionAngle) {
  constexpr double friction = 0.2, slope = 0.35;
  SmallWorld small(GetParam().world());
  const Pose X_WB = turned(0, 0, 2, Vector3d::UnitY(), -slope);
  const auto belt = small.add(conveyor(friction), X_WB);
  const auto box = small.add(crate(), on(X_WB, 1, 0.05));
  small.world().set_device_target(belt, DeviceId{0}, 0, 5.0);
  small.run(0.5);
  const double acceleration = g * (std::sin(slope) - friction * std::cos(slope));
  EXPECT_NEAR(-(X_WB.orientation.conjugate() * small.velocity(box)).x(), 0.5 * acceleration, 0.02 * acceleration);
}

// A belt does not change the directions of a surface with several coefficients.
TEST_P(Belts, UseTheFrictionAlongTheirDirection) {
  constexpr double along = 0.2, across = 0.7;
  SmallWorld small(GetParam().world());
  description::Model model = conveyor(along);
  Surface& surface = model.links[0].collisions[0].surface;
  surface.friction_direction = Vector3d::UnitX();
  surface.second_friction = across;
  const auto belt = small.add(model, at(0, 0, 1));
  const auto box = small.add(crate(), at(0, 0, 1.05));
  small.world().set_device_target(belt, DeviceId{0}, 0, 2.0);
  small.run(0.2);
  EXPECT_NEAR(small.velocity(box).x(), along * g * 0.2, 0.01 * along * g);
}

TEST_P(Belts, RunAboutAnyAxis) {
  SmallWorld small(GetParam().world());
  description::Model model = conveyor(1.0);
  std::get<description::Belt>(model.devices[0]).axis_L = {-3.0, 0, 0};  // y of the world on top
  const auto belt = small.add(model, at(0, 0, 1));
  const auto box = small.add(crate(), at(0, -0.3, 1.05));
  small.world().set_device_target(belt, DeviceId{0}, 0, 0.4);
  small.run(0.5);
  EXPECT_LT((small.velocity(box) - Vector3d(0, 0.4, 0)).norm(), 1e-3) << small.velocity(box).transpose();
}

TEST_P(Belts, CarryRobotsThatMeasureTheirMotionOnTheBelt) {
  SmallWorld small(GetParam().world());
  const auto belt = small.add(conveyor(1.0), at(0, 0, 1));
  const auto robot = small.add(GetParam().robot(), at(-1, 0, 1));
  small.world().set_device_target(belt, DeviceId{0}, 0, 0.15);
  small.run(1.0);
  EXPECT_NEAR(small.velocity(robot).x(), 0.15, 2e-3) << "it stands on the belt";
  EXPECT_NEAR(small.world().device_state(robot, DeviceId{0}, 0).velocity, 0.0, 2e-3);
  small.drive(robot, -0.15, -0.15);
  small.run(1.0);
  EXPECT_NEAR(small.velocity(robot).x(), 0.0, 2e-3) << "it walks against it";
  EXPECT_NEAR(small.world().device_state(robot, DeviceId{0}, 0).velocity, -0.15, 2e-3);
}

TEST_P(Belts, DriveAVehicleStraightAtTheirSpeed) {
  SmallWorld small(GetParam().world());
  const auto vehicle = small.add(tracked_vehicle(1.0), at(0, 0, 0.05));
  for (const double speed : {0.6, -0.4}) {
    run_tracks(small, vehicle, speed, speed);
    small.run(1.0);
    const Vector3d before = small.position(vehicle);
    small.run(1.0);
    EXPECT_NEAR(small.position(vehicle).x() - before.x(), speed, 0.01 * std::abs(speed));
    EXPECT_NEAR(small.position(vehicle).y(), 0.0, 2e-3);
    EXPECT_NEAR(small.position(vehicle).z(), 0.05, 1e-3);
  }
}

class LongBelts : public EveryPhysics {};
INSTANTIATE_TEST_SUITE_P(AllButDirect, LongBelts,
                         ::testing::Values(articulated, by_bullet(articulated), treel, by_bullet(iterative)), name_of);

// Each point slips sideways in proportion to its distance from the middle: for 12 of 16 points 0.25 m, which is more
// than half the gauge. The balance of moments gives 0.57 rad/s; wheels on an axle would turn the vehicle at 1.5 rad/s.
// The direct solver limits the two directions of friction separately, so that long tracks have none left to turn the
// vehicle.
TEST_P(LongBelts, TurnAVehicleOnTheSpotTowardsTheSlowerTrack) {
  for (const double sense : {1.0, -1.0}) {
    SmallWorld small(GetParam().world());
    const auto vehicle = small.add(tracked_vehicle(1.0), at(0, 0, 0.05));
    run_tracks(small, vehicle, -0.3 * sense, 0.3 * sense);
    small.run(4.0);
    EXPECT_NEAR(sense * small.world().link_twist(vehicle, LinkId{0}).angular_W.z(), 0.57, 0.03);
    EXPECT_LT(small.position(vehicle).head<2>().norm(), 0.01) << "it does not wander";
  }
}

// Short tracks far apart: any shape of the friction limit lets them turn the vehicle.
TEST_P(Belts, TurnAWideVehicleWithEverySolver) {
  for (const double sense : {1.0, -1.0}) {
    SmallWorld small(GetParam().world());
    description::Model wide = tracked_vehicle(1.0);
    for (const std::size_t track : {1u, 2u}) wide.links[track].X_ML.position.y() *= 3.0;
    const auto vehicle = small.add(wide, at(0, 0, 0.05));
    run_tracks(small, vehicle, -0.3 * sense, 0.3 * sense);
    small.run(2.0);
    const double rate = sense * small.world().link_twist(vehicle, LinkId{0}).angular_W.z();
    EXPECT_GT(rate, 0.7 * 0.3 / 0.6);
    EXPECT_LT(rate, 0.3 / 0.6 + 1e-6) << "no faster than tracks that roll";
  }
}

TEST_P(Belts, ClimbASlopeUpToTheFrictionAngle) {
  constexpr double friction = 0.5;
  for (const double slope : {0.8 * std::atan(friction), 1.2 * std::atan(friction)}) {
    SmallWorld small(GetParam().world());
    const Pose X_WG = turned(0, 0, 3, Vector3d::UnitY(), -slope);
    small.add(static_shape("slope", Box{{8, 2, 0.2}}), X_WG * Pose{{0, 0, -0.1}});
    const auto vehicle = small.add(tracked_vehicle(friction), on(X_WG, 0, 0.05));
    run_tracks(small, vehicle, 0.3, 0.3);
    small.run(1.0);
    const double up = (X_WG.orientation.conjugate() * small.velocity(vehicle)).x();
    if (slope < std::atan(friction))
      EXPECT_NEAR(up, 0.3, 0.01 * 0.3);
    else
      EXPECT_NEAR(up, -g * (std::sin(slope) - friction * std::cos(slope)), 0.05);
  }
}

// Half of the work is the crate's kinetic energy, m v^2 / 2; while it slips, friction turns the same amount into heat.
TEST_P(Belts, DoTheWorkThatAcceleratesTheirLoad) {
  constexpr double friction = 0.3, speed = 0.9, mass = 2.0;
  for (const double sense : {1.0, -1.0}) {
    SmallWorld small(GetParam().world());
    const auto belt = small.add(conveyor(friction), at(0, 0, 1));
    small.add(crate(), at(0, 0, 1.05));
    small.run(0.1);
    EXPECT_EQ(small.driven_power(belt), 0.0) << "it stands";
    small.world().set_device_target(belt, DeviceId{0}, 0, sense * speed);
    const double work = work_of(small, belt, 1.0);
    EXPECT_NEAR(work, mass * speed * speed, 0.03 * mass * speed * speed);
    EXPECT_LT(work_of(small, belt, 0.5), 1e-3) << "it only goes along";
  }
}

TEST_P(Belts, DoTheWorkThatLiftsAVehicle) {
  constexpr double slope = 0.3, speed = 0.3, mass = 14.0;
  for (const double sense : {1.0, -1.0}) {
    SmallWorld small(GetParam().world());
    const Pose X_WG = turned(0, 0, 3, Vector3d::UnitY(), -slope);
    small.add(static_shape("slope", Box{{8, 2, 0.2}}), X_WG * Pose{{0, 0, -0.1}});
    const auto vehicle = small.add(tracked_vehicle(0.8), on(X_WG, 0, 0.05));
    run_tracks(small, vehicle, sense * speed, sense * speed);
    small.run(1.0);
    const double lifted = mass * g * std::sin(slope) * speed;
    EXPECT_NEAR(work_of(small, vehicle, 1.0), sense > 0.0 ? lifted : 0.0, 0.02 * lifted) << "downhill it brakes";
  }
}

// A restored world continues with the load of the belt. With the direct solver all bodies sleep.
TEST_P(Belts, KeepTheLoadOfAJammedCrateAfterRestore) {
  constexpr double friction = 0.3, speed = 0.5, mass = 2.0;
  BodyId belt;
  const auto jammed = [&] {
    auto small = std::make_unique<SmallWorld>(GetParam().world());
    belt = small->add(conveyor(friction), at(0, 0, 1));
    small->add(crate(), at(0, 0, 1.05));
    small->add(static_shape("stop", Box{{0.1, 1, 1}}, with_friction(0.0)), at(0.15, 0, 1.51));
    return small;
  };
  const auto first = jammed();
  first->world().set_device_target(belt, DeviceId{0}, 0, speed);
  first->run(3.0);
  const double power = first->driven_power(belt);
  EXPECT_DOUBLE_EQ(first->world().device_state(belt, DeviceId{0}, 0).effort * speed, power);
  EXPECT_NEAR(power, friction * mass * g * speed, 0.02 * friction * mass * g * speed);
  const auto second = jammed();
  restore_from(first->world(), second->world());
  EXPECT_EQ(second->driven_power(belt), power);
  first->run(0.1);
  second->run(0.1);
  EXPECT_EQ(second->driven_power(belt), first->driven_power(belt));
}

TEST_P(Belts, AddTheirSpeeds) {
  SmallWorld small(GetParam().world());
  const auto belt = small.add(conveyor(1.0), at(0, 0, 1));
  const auto vehicle = small.add(tracked_vehicle(1.0), at(0, 0, 1.05));
  small.world().set_device_target(belt, DeviceId{0}, 0, -0.4);
  run_tracks(small, vehicle, 0.4, 0.4);
  small.run(1.0);
  EXPECT_LT(small.velocity(vehicle).norm(), 4e-3) << "it runs and stays where it is";
  run_tracks(small, vehicle, 0.7, 0.7);
  small.run(1.0);
  EXPECT_NEAR(small.velocity(vehicle).x(), 0.3, 0.003);
}

// Crates on conveyors, crossed by a vehicle.
struct Hall {
  Hall(const Physics& physics, unsigned threads) : small(physics.world(), threads) {
    for (int i = 0; i < 6; ++i) {
      belts.push_back(small.add(conveyor(0.5), turned(0, 1.1 * i, 0.3, Vector3d::UnitZ(), i % 2 == 0 ? 0.0 : 0.03)));
      for (int k = 0; k < 4; ++k) small.add(crate(), at(-2.0 + k, 1.1 * i, 0.4 + 0.05 * k));
    }
    vehicle = small.add(tracked_vehicle(0.8), turned(1.5, 0, 0.4, Vector3d::UnitZ(), 1.2));
  }
  void command() {
    for (std::size_t i = 0; i < belts.size(); ++i)
      small.world().set_device_target(belts[i], DeviceId{0}, 0, i % 2 == 0 ? 0.5 : -0.7);
    run_tracks(small, vehicle, 0.5, 0.4);
  }
  SmallWorld small;
  std::vector<BodyId> belts;
  BodyId vehicle;
};

TEST_P(Belts, AreTheSameForAnyThreadCountAndAfterRestore) {
  Hall one(GetParam(), 1), many(GetParam(), 3), restored(GetParam(), 2);
  for (Hall* hall : {&one, &many}) {
    hall->command();
    hall->small.run(0.5);
  }
  ASSERT_EQ(hash_of(one.small.world()), hash_of(many.small.world()));
  restore_from(one.small.world(), restored.small.world());
  ASSERT_EQ(hash_of(one.small.world()), hash_of(restored.small.world()));
  for (Hall* hall : {&one, &many, &restored}) hall->small.run(1.0);  // without setting the speed again
  EXPECT_EQ(hash_of(one.small.world()), hash_of(many.small.world()));
  EXPECT_EQ(hash_of(one.small.world()), hash_of(restored.small.world()));
}

TEST_P(Belts, ChangeTheHashOnlyByTheirSpeed) {
  SmallWorld small(GetParam().world());
  const auto belt = small.add(conveyor(1.0), at(0, 0, 1));
  const std::uint64_t before = hash_of(small.world());
  small.world().set_device_target(belt, DeviceId{0}, 0, 0.0);
  EXPECT_EQ(hash_of(small.world()), before) << "setting the same speed is no change";
  small.world().set_device_target(belt, DeviceId{0}, 0, 0.1);
  EXPECT_NE(hash_of(small.world()), before);
}

TEST_P(Belts, WakeSleepingBodiesOnThem) {
  SmallWorld small(GetParam().world());
  const auto belt = small.add(conveyor(1.0), at(0, 0, 1));
  const auto box = small.add(crate(), at(0, 0, 1.05));
  small.run(2.0);
  const std::uint64_t asleep = hash_of(small.world());
  small.world().set_device_target(belt, DeviceId{0}, 0, 0.0);
  small.run(0.1);
  EXPECT_EQ(hash_of(small.world()), asleep) << "setting the same speed wakes no body";
  small.world().set_device_target(belt, DeviceId{0}, 0, 0.3);
  small.run(0.5);
  EXPECT_NEAR(small.velocity(box).x(), 0.3, 1e-3);
}

TEST(PlanarBelts, AreRejected) {
  SmallWorld small(planar.world());
  small.add(tracked_vehicle(1.0), at(0, 0, 0.05));
  try {
    small.world();
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("planar physics does not support the belts of 'drive'"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace cohort::test
