// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <vector>

#include "server/core/random.hpp"
#include "server/geometry/scene/scene.hpp"
#include "server/physics/contact/box_contact.hpp"
#include "server/physics/contact/closed_form_contact.hpp"
#include "server/physics/contact/prism_contact.hpp"
#include "server/physics/contact/same_point.hpp"
#include "server/physics/fluid/fluid_forces.hpp"
#include "server/physics/fluid/media.hpp"
#include "server/physics/mechanism/ground.hpp"
#include "server/physics/mechanism/lanes.hpp"
#include "server/physics/mechanism/linear_system.hpp"
#include "server/physics/mechanism/rotation.hpp"
#include "server/physics/multibody/rows.hpp"
#include "server/physics/planar/planar_contact.hpp"
#include "server/physics/planar/planar_grid.hpp"
#include "server/physics/world/anchors.hpp"
#include "server/physics/world/corrections.hpp"
#include "server/physics/world/motion_record.hpp"
#include "server/physics/world/pushes.hpp"
#include "server/physics/world/running_surface.hpp"
#include "server/physics/world/surface_pairs.hpp"
#include "tests/support/worlds/small_world.hpp"

// Small parts of the physics, each called directly with an expected result in closed form.
namespace cohort::test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using physics::ContactPoint;
using physics::ContactPoints;

constexpr double near_margin = 0.005;  // distance at which a contact is found [m]

void expect_near(const Vector3d& found, const Vector3d& expected, double tolerance = 1e-12) {
  EXPECT_LT((found - expected).norm(), tolerance) << found.transpose() << " instead of " << expected.transpose();
}

TEST(LinearSystem, IsSolvedAlsoWithZerosOnTheDiagonal) {
  const RandomStream random(1, "linear_system", "entries");
  physics::LinearSystem system;
  for (int size = 1; size <= 9; ++size) {
    SCOPED_TRACE(size);
    system.reset(size);
    Eigen::MatrixXd matrix(size, size);
    for (int row = 0; row < size; ++row)
      for (int column = 0; column < size; ++column) {
        const auto draw = static_cast<std::uint32_t>(row * size + column);
        const bool is_zero = row == column && size > 1;
        matrix(row, column) = system(row, column) =
            is_zero ? 0.0 : random.uniform(static_cast<std::uint64_t>(size), draw) + 0.1;
      }
    const Eigen::VectorXd expected = Eigen::VectorXd::LinSpaced(size, -1.0, 2.0);
    Eigen::VectorXd found = matrix * expected;
    system.factorise();
    system.solve(found.data());
    EXPECT_LT((found - expected).norm(), 1e-10);
  }
}

TEST(LinearSystem, HasNoFiniteSolutionIfItIsSingular) {
  physics::LinearSystem system;
  system.reset(2);
  system(0, 0) = system(0, 1) = system(1, 0) = system(1, 1) = 1.0;
  double x[] = {1.0, 2.0};
  system.factorise();
  system.solve(x);
  EXPECT_FALSE(std::isfinite(x[0]) && std::isfinite(x[1]));
}

TEST(Lanes, ComputeSumsOfProductsOverTheWholeLength) {
  const double a[] = {1, 2, 3, 4, 5, 6, 7, 8};
  double b[] = {8, 7, 6, 5, 4, 3, 2, 1};
  EXPECT_EQ(physics::dot(a, b, 8), 120.0);
  EXPECT_EQ(physics::dot(a, b, 4), 60.0);
  physics::add_scaled(10.0, a, b, 8);
  EXPECT_EQ(std::vector<double>(b, b + 8), (std::vector<double>{18, 27, 36, 45, 54, 63, 72, 81}));
}

// Rotations of less than half a radian are computed by series, and others by sines.
TEST(Rotation, TurnsByTheLengthOfItsVector) {
  const Vector3d axis = Vector3d(1.0, -2.0, 0.5).normalized();
  for (const double angle : {0.0, 1e-9, 0.1, 0.499999, 0.500001, 1.0, 3.0, 7.0}) {
    SCOPED_TRACE(angle);
    const Eigen::Quaterniond expected(Eigen::AngleAxisd(angle, axis));
    EXPECT_LT((physics::rotation_by(angle * axis).coeffs() - expected.coeffs()).norm(), 1e-15);
    EXPECT_LT((physics::rotation_about(axis, angle).coeffs() - expected.coeffs()).norm(), 1e-15);
  }
}

TEST(Rotation, HasTheSameVectorForBothSignsOfItsQuaternion) {
  const Vector3d small(1e-4, -2e-4, 3e-4);
  Eigen::Quaterniond rotation = physics::rotation_by(small);
  expect_near(physics::rotation_vector(rotation), small, 1e-11);
  rotation.coeffs() *= -1.0;
  expect_near(physics::rotation_vector(rotation), small, 1e-11);
}

class GroundUnderAPoint : public ::testing::Test {
 protected:
  // Returns the ground under (x, 0, z), at most 0.05 m higher and 0.1 m lower.
  std::optional<physics::Ground> below(double x, double z) const {
    return physics::GroundFinder(scene_, candidates_, Vector3d::UnitZ(), 0.05, 0.1).below({x, 0.0, z});
  }
  void add(const geometry::Shape& shape, const Pose& X_WC) {
    candidates_.push_back(scene_.add({shape, {}, BodyId{static_cast<std::uint32_t>(candidates_.size())}, false, X_WC}));
    scene_.build();
  }

  geometry::Scene scene_;
  std::vector<std::uint32_t> candidates_;
};

TEST_F(GroundUnderAPoint, IsWithinReachAndNoHigherThanAStep) {
  add(description::Box{{1.0, 1.0, 0.4}}, {{3.0, 0.0, 0.0}});
  add(description::Plane{}, {});
  const auto floor = below(0.0, 0.02);
  ASSERT_TRUE(floor);
  EXPECT_EQ(floor->solid, 1u);
  EXPECT_NEAR(floor->gap, 0.02, 1e-12);
  expect_near(floor->normal_W, Vector3d::UnitZ());
  const auto top = below(3.0, 0.17);
  ASSERT_TRUE(top);
  EXPECT_EQ(top->solid, 0u);
  EXPECT_NEAR(top->gap, -0.03, 1e-12) << "the point is below the surface";
  EXPECT_FALSE(below(3.0, 0.1)) << "a side of the box is a wall";
  EXPECT_FALSE(below(0.0, 0.11)) << "the floor is out of reach";
  EXPECT_TRUE(below(0.0, 0.09));
}

TEST_F(GroundUnderAPoint, HasItsGapAlongTheNormalOfASlope) {
  add(description::Plane{}, turned(0, 0, 0, Vector3d::UnitX(), std::numbers::pi / 3.0));
  const auto slope = below(0.0, 0.02);
  ASSERT_TRUE(slope);
  EXPECT_NEAR(slope->gap, 0.01, 1e-12);
  EXPECT_NEAR(slope->normal_W.z(), 0.5, 1e-12);
}

TEST_F(GroundUnderAPoint, IsNoSteepSlope) {
  add(description::Plane{}, turned(0, 0, 0, Vector3d::UnitX(), 1.4));
  EXPECT_FALSE(below(0.0, 0.02));
}

TEST(MatchedPoints, AreTheNearestOfTheLastStepAndEachIsTakenOnce) {
  ContactPoints before;
  before.add({0.0, 0.0, 0.0}, Vector3d::UnitZ(), 0.0);
  before.add({0.008, 0.0, 0.0}, Vector3d::UnitZ(), 0.0);
  before.points[0].impulse[0] = 1.0;
  before.points[1].impulse[0] = 2.0;
  ContactPoints now;
  now.add({0.006, 0.0, 0.0}, Vector3d::UnitZ(), 0.0);
  now.add({0.007, 0.0, 0.0}, Vector3d::UnitZ(), 0.0);
  now.add({0.0, 0.001, 0.0}, Vector3d::UnitZ(), 0.0);
  now.add({0.0, 0.0, 0.5}, Vector3d::UnitZ(), 0.0);
  physics::match_points(before, now, [](const ContactPoint& old, ContactPoint& point) { point.impulse = old.impulse; });
  EXPECT_EQ(now.points[0].impulse[0], 2.0);
  EXPECT_EQ(now.points[1].impulse[0], 1.0) << "the nearest one is taken";
  EXPECT_EQ(now.points[2].impulse[0], 0.0) << "both are taken";
  EXPECT_EQ(now.points[3].impulse[0], 0.0) << "none is near";
}

TEST(ContactOfBoxes, HasTheCornersOfTheSmallerFace) {
  ContactPoints found;
  const description::Box small{{0.2, 0.3, 0.2}};
  physics::find_box_contact(small, {{0.1, 0.0, 0.299}}, description::Box{{1.0, 1.0, 0.2}}, {{0.0, 0.0, 0.1}},
                            near_margin, Vector3d::Zero(), found);
  ASSERT_EQ(found.count, 4);
  std::set<std::pair<int, int>> corners;  // [mm]
  for (const ContactPoint& point : found) {
    expect_near(point.normal_W, Vector3d::UnitZ());
    EXPECT_NEAR(point.gap, -0.001, 1e-12);
    EXPECT_NEAR(point.position_W.z(), 0.1995, 1e-12);
    corners.emplace(std::lround(1000.0 * point.position_W.x()), std::lround(1000.0 * point.position_W.y()));
  }
  EXPECT_EQ(corners, (std::set<std::pair<int, int>>{{0, -150}, {0, 150}, {200, -150}, {200, 150}}));
}

TEST(ContactOfBoxes, IsOnePointWhereTwoEdgesCross) {
  ContactPoints found;
  const description::Box cube{{0.2, 0.2, 0.2}};
  const double to_edge = 0.1 * std::numbers::sqrt2;
  const double quarter = std::numbers::pi / 4.0;
  physics::find_box_contact(cube, turned(0.03, 0.02, 2.0 * to_edge + 0.002, Vector3d::UnitX(), quarter), cube,
                            turned(0.0, 0.0, 0.0, Vector3d::UnitY(), quarter), near_margin, Vector3d::Zero(), found);
  ASSERT_EQ(found.count, 1);
  expect_near(found.points[0].normal_W, Vector3d::UnitZ());
  EXPECT_NEAR(found.points[0].gap, 0.002, 1e-12);
  expect_near(found.points[0].position_W, {0.0, 0.02, to_edge + 0.001});
}

TEST(SideContact, HasThePointsAtTheEndsOfTheCommonInterval) {
  ContactPoints found;
  const description::Cylinder a{0.1, 0.4};
  const description::Cylinder b{0.05, 0.4};
  ASSERT_TRUE(physics::find_side_contact(a, {{0.0, 0.0, 0.0}}, b, {{0.0, 0.153, 0.1}}, near_margin, found));
  ASSERT_EQ(found.count, 2);
  for (const ContactPoint& point : found) {
    expect_near(point.normal_W, -Vector3d::UnitY());
    EXPECT_NEAR(point.gap, 0.003, 1e-12);
  }
  expect_near(found.points[0].position_W, {0.0, 0.1015, -0.1});
  expect_near(found.points[1].position_W, {0.0, 0.1015, 0.2});

  ContactPoints beside_box;
  ASSERT_TRUE(physics::find_side_contact(a, {{0.0, 0.0, 0.0}}, description::Box{{0.2, 1.0, 0.2}}, {{0.202, 0.0, 0.0}},
                                         near_margin, beside_box));
  ASSERT_EQ(beside_box.count, 2);
  for (const ContactPoint& point : beside_box) {
    expect_near(point.normal_W, -Vector3d::UnitX());
    EXPECT_NEAR(point.gap, 0.002, 1e-12);
    EXPECT_NEAR(std::abs(point.position_W.z()), 0.1, 1e-12);
  }
}

TEST(SideContact, IsNotFoundWhereTheEndsMatter) {
  ContactPoints found;
  const description::Cylinder cylinder{0.1, 0.4};
  EXPECT_FALSE(
      physics::find_side_contact(cylinder, {{0.0, 0.0, 0.399}}, cylinder, {{0.05, 0.0, 0.0}}, near_margin, found))
      << "one stands on the other";
  EXPECT_FALSE(
      physics::find_side_contact(cylinder, turned(0.2, 0, 0, Vector3d::UnitX(), 1.0), cylinder, {}, near_margin, found))
      << "the axes are not parallel";
  EXPECT_EQ(found.count, 0);
}

TEST(ClosedFormContact, OfASphereIsHalfwayBetweenTheSurfaces) {
  const description::Sphere sphere{0.1};
  ContactPoints found;
  ASSERT_TRUE(physics::find_closed_form_contact(sphere, {{0.0, 0.0, 0.097}}, description::Plane{}, {}, near_margin,
                                                Vector3d::Zero(), found));
  ASSERT_EQ(found.count, 1);
  EXPECT_NEAR(found.points[0].gap, -0.003, 1e-12);
  expect_near(found.points[0].normal_W, Vector3d::UnitZ());
  expect_near(found.points[0].position_W, {0.0, 0.0, -0.0015});

  ContactPoints turned_round;
  ASSERT_TRUE(physics::find_closed_form_contact(description::Plane{}, {}, sphere, {{0.0, 0.0, 0.097}}, near_margin,
                                                Vector3d::Zero(), turned_round));
  ASSERT_EQ(turned_round.count, 1);
  expect_near(turned_round.points[0].normal_W, -Vector3d::UnitZ());

  ContactPoints of_spheres;
  ASSERT_TRUE(physics::find_closed_form_contact(sphere, {}, description::Sphere{0.3}, {{0.0, 0.402, 0.0}}, near_margin,
                                                Vector3d::Zero(), of_spheres));
  ASSERT_EQ(of_spheres.count, 1);
  EXPECT_NEAR(of_spheres.points[0].gap, 0.002, 1e-12);
  expect_near(of_spheres.points[0].normal_W, -Vector3d::UnitY());
  expect_near(of_spheres.points[0].position_W, {0.0, 0.101, 0.0});
}

TEST(ClosedFormContact, HasNoPointBeyondTheMargin) {
  ContactPoints found;
  ASSERT_TRUE(physics::find_closed_form_contact(description::Sphere{0.1}, {{0.0, 0.0, 0.106}}, description::Plane{}, {},
                                                near_margin, Vector3d::Zero(), found));
  EXPECT_EQ(found.count, 0);
}

TEST(ClosedFormContact, DoesNotExistForMeshesOnBoxes) {
  ContactPoints found;
  found.add(Vector3d::UnitX(), Vector3d::UnitZ(), 0.0);
  EXPECT_FALSE(physics::find_closed_form_contact(box_mesh({0.2, 0.2, 0.2}), {{0.0, 0.0, 0.2}},
                                                 description::Box{{0.2, 0.2, 0.2}}, {}, near_margin, Vector3d::Zero(),
                                                 found));
  EXPECT_EQ(found.count, 1) << "the points are unchanged";
}

TEST(SurfacesOfAPair, CombineByTheLeastFrictionTheGreatestResistanceAndTheProductOfRestitutions) {
  const physics::SurfacePairs pairs{description::World{}};
  description::Surface a{0.3, 0.5, 0.01, 0.002};
  description::Surface b{0.8, 0.1, 0.02, 0.001};
  physics::SurfacePair both = pairs.of(a, b);
  EXPECT_EQ(both.friction, 0.3);
  EXPECT_EQ(both.restitution, 0.05);
  EXPECT_EQ(both.rolling_resistance, 0.02);
  EXPECT_EQ(both.spinning_resistance, 0.002);
  EXPECT_EQ(both.stiffness, physics::SurfacePair::rigid);
  EXPECT_EQ(both.bounce_threshold, physics::least_bounce);
  EXPECT_EQ(both.directed, physics::SurfacePair::Directed::neither);

  a.stiffness = 1000.0;
  b.stiffness = 3000.0;
  a.damping = 2.0;
  b.damping = 3.0;
  b.bounce_threshold = 0.4;
  b.friction_direction = Vector3d::UnitX();
  b.second_friction = 0.1;
  both = pairs.of(a, b);
  EXPECT_NEAR(both.stiffness, 750.0, 1e-9) << "springs in series";
  EXPECT_EQ(both.damping, 5.0);
  EXPECT_EQ(both.bounce_threshold, 0.4);
  EXPECT_EQ(both.directed, physics::SurfacePair::Directed::by_second);
  EXPECT_EQ(both.second_friction, 0.1);
}

TEST(SurfacesOfAPair, UseTheMaterialPairInEitherOrder) {
  description::World world;
  world.materials = {"default", "ice", "rubber"};
  world.material_pairs = {{1, 2, 0.07, 0.6, 0.003}};
  const physics::SurfacePairs pairs(world);
  description::Surface ice;
  description::Surface rubber;
  ice.material = 1;
  rubber.material = 2;
  for (const physics::SurfacePair& both : {pairs.of(ice, rubber), pairs.of(rubber, ice)}) {
    EXPECT_EQ(both.friction, 0.07);
    EXPECT_EQ(both.restitution, 0.6);
    EXPECT_EQ(both.rolling_resistance, 0.003);
  }
  EXPECT_EQ(pairs.of(ice, ice).friction, 1.0);
}

TEST(RunningSurface, MovesAroundItsAxisAndNotAtItsSides) {
  physics::RunningSurface belt{Vector3d::UnitY(), 0.5};
  expect_near(belt.velocity_at(Vector3d::UnitZ()), {0.5, 0.0, 0.0});
  expect_near(belt.velocity_at(-Vector3d::UnitZ()), {-0.5, 0.0, 0.0});
  expect_near(belt.velocity_at(Vector3d(0.0, 1.0, 1.0).normalized()), {0.5, 0.0, 0.0});
  expect_near(belt.velocity_at(Vector3d::UnitY()), Vector3d::Zero());
  EXPECT_TRUE(belt.is_belt());
  EXPECT_FALSE(physics::RunningSurface{}.is_belt());
}

TEST(Corrections, CloseAGapWithinTheStepAndOverlapsGently) {
  constexpr double step = 0.01;
  EXPECT_NEAR(physics::separating_velocity(0.002, step), -0.2, 1e-12);
  EXPECT_NEAR(physics::separating_velocity(-0.002, step), 0.04, 1e-12);
  EXPECT_NEAR(physics::separating_velocity(-1.0, step), 0.3, 1e-12);
  EXPECT_NEAR(physics::correction(physics::correction_share, 0.001, 0.5, step), -0.02, 1e-12);
  EXPECT_NEAR(physics::correction(1.0, -1.0, 0.5, step), 0.5, 1e-12);
  EXPECT_NEAR(physics::correction(1.0, 1.0, 0.5, step), -0.5, 1e-12);
}

TEST(Pushes, AreVisitedByBodyInTheOrderInWhichTheyWereAdded) {
  physics::Pushes pushes;
  const auto add = [&](std::uint32_t member, std::size_t link) {
    physics::Pushes::Push push;
    push.member = member;
    push.link = link;
    pushes.add(push);
  };
  const auto links_of = [&](std::uint32_t member) {
    std::vector<std::size_t> links;
    pushes.for_each_of(member, [&](const physics::Pushes::Push& push) { links.push_back(push.link); });
    return links;
  };
  add(7, 1);
  add(2, 2);
  add(7, 3);
  add(2, 0);
  EXPECT_EQ(links_of(7), (std::vector<std::size_t>{1, 3}));
  EXPECT_EQ(links_of(2), (std::vector<std::size_t>{2, 0}));
  EXPECT_TRUE(links_of(3).empty());
  pushes.clear();
  EXPECT_TRUE(links_of(7).empty());
}

TEST(MotionRecord, HasTheAccelerationOfAPointOfALinkAtTheEndOfTheStep) {
  struct OneLink {
    Pose X_WL;
    physics::Twist twist;
    const Pose& link_pose(std::size_t) const { return X_WL; }
    const physics::Twist& link_twist(std::size_t) const { return twist; }
    const Vector3d& reference() const { return X_WL.position; }
  };
  const Vector3d p_LP(0.5, 0.0, 0.0);
  description::Model model;
  model.links.emplace_back();
  physics::MotionRecord record(model);
  OneLink link{{}, {{0.0, 0.0, 2.0}, {1.0, 0.0, 0.0}}};
  record.before(link);
  expect_near(record.acceleration(0, p_LP, 0.1), Vector3d::Zero());
  // A quarter turn: the point is then at y from the link's origin, which accelerates along x.
  link = {turned(0, 0, 0, Vector3d::UnitZ(), std::numbers::pi / 2.0), {{0.0, 0.0, 2.0}, {1.5, 0.0, 0.0}}};
  record.after(link);
  expect_near(record.acceleration(0, p_LP, 0.1), {5.0, -2.0, 0.0}, 1e-10);
  record.forget();
  expect_near(record.acceleration(0, p_LP, 0.1), Vector3d::Zero());
}

TEST(Anchors, BelongToTheWorldOrToABodyOfTheProblem) {
  physics::Anchors anchors;
  anchors.part_of_solid = {{}, {1, 4}};
  anchors.index_of_member = {-1, 3};
  EXPECT_FALSE(anchors.moves(0));
  EXPECT_EQ(anchors.of(0).body, -1);
  EXPECT_TRUE(anchors.moves(1));
  EXPECT_EQ(anchors.member(1), 1u);
  EXPECT_EQ(anchors.of(1).body, 3);
  EXPECT_EQ(anchors.of(1).segment, 4);
}

TEST(SoftRow, HasTheSoftnessInSeriesWithItsResponse) {
  physics::Row row;
  row.inverse = 0.5;
  row.soften(3.0);
  EXPECT_NEAR(row.inverse, 0.2, 1e-15);
  EXPECT_TRUE(row.has_fixed_limits());
  physics::Row immovable;
  immovable.soften(3.0);
  EXPECT_EQ(immovable.inverse, 0.0);
}

TEST(DampingImpulse, BelongsToTheVelocityThatItLeaves) {
  constexpr double step = 0.1;
  for (const double v : {-3.0, 0.0, 0.2, 50.0})
    for (const double linear : {0.0, 2.0})
      for (const double quadratic : {0.0, 1.5, 1e6})
        for (const double response : {0.01, 4.0}) {
          const double impulse = physics::damping_impulse(v, linear, quadratic, response, step);
          const double after = v + response * impulse;
          const double expected = -step * (linear + quadratic * std::abs(after)) * after;
          EXPECT_NEAR(impulse, expected, 1e-6 * std::abs(expected)) << v << " " << linear << " " << quadratic;
          EXPECT_GE(v * after, 0.0) << "it at most stops the motion";
        }
}

TEST(FinForce, HasLiftAcrossAndDragAlongTheFlow) {
  description::Fin fin;
  fin.area = 0.2;
  fin.cla = 4.0;
  fin.cda = 0.5;
  fin.alpha_stall = 0.3;
  fin.cla_stall = -1.0;
  fin.cda_stall = 2.0;
  constexpr double density = 1000.0;
  for (const double alpha : {0.1, -0.2, 0.5}) {
    SCOPED_TRACE(alpha);
    const Vector3d v_F(2.0 * std::cos(alpha), 0.0, -2.0 * std::sin(alpha));  // it sinks: lift is upwards
    const double pressure = 0.5 * density * 4.0 * fin.area;
    const double stalled = std::max(0.0, alpha - 0.3);
    const double attached = alpha - stalled;
    const double lift = pressure * (4.0 * attached - 1.0 * stalled);
    const double drag = pressure * std::abs(0.5 * attached + 2.0 * stalled);
    const Vector2d along(std::cos(alpha), -std::sin(alpha));
    const Vector2d across(std::sin(alpha), std::cos(alpha));
    EXPECT_LT((physics::fin_force(fin, density, v_F) - (lift * across - drag * along)).norm(), 1e-9);
  }
  EXPECT_EQ(physics::fin_force(fin, density, Vector3d::Zero()), Vector2d(0.0, 0.0));
}

TEST(Media, AreWaterBelowItsLevelAndAirAbove) {
  description::World world;
  world.air.wind = {3.0, 0.0, 0.0};
  world.water = description::Water{0.5, 1025.0, {0.0, 1.0, 0.0}};
  const physics::Media media(world);
  EXPECT_EQ(media.at({0.0, 0.0, 0.4}, false).density, 1025.0);
  expect_near(media.at({0.0, 0.0, 0.4}, false).velocity_W, {0.0, 1.0, 0.0});
  EXPECT_EQ(media.at({0.0, 0.0, 0.6}, true).density, 1.225);
  expect_near(media.at({0.0, 0.0, 0.6}, true).velocity_W, {3.0, 0.0, 0.0});
  expect_near(media.at({0.0, 0.0, 0.6}, false).velocity_W, Vector3d::Zero());
  world.water.reset();
  EXPECT_FALSE(physics::Media(world).has_water_at({0.0, 0.0, -10.0}));
}

TEST(PlanarGrid, FindsTheDiscsThatAComparisonOfAllFinds) {
  const RandomStream random(1, "planar_grid", "discs");
  std::vector<physics::PlanarGrid::Disc> discs;
  for (std::uint32_t i = 0; i < 200; ++i)
    discs.push_back(
        {6.0 * random.uniform(i, 0) - 3.0, 6.0 * random.uniform(i, 1) - 3.0, 0.05 + 0.2 * random.uniform(i, 2), i});
  physics::PlanarGrid grid;
  grid.build(discs);
  std::size_t pairs = 0;
  for (const physics::PlanarGrid::Disc& disc : discs) {
    std::vector<std::uint32_t> found;
    grid.for_each_near(disc, 0.01, [&](std::uint32_t item) { found.push_back(item); });
    std::sort(found.begin(), found.end());
    std::vector<std::uint32_t> expected;
    for (const physics::PlanarGrid::Disc& other : discs)
      if (std::hypot(other.x - disc.x, other.y - disc.y) < disc.radius + other.radius + 0.01)
        expected.push_back(other.item);
    EXPECT_EQ(found, expected);
    pairs += found.size();
  }
  EXPECT_GT(pairs, 400u);
}

geometry::Footprint outline(double x, double y, const Vector2d& half, double radius) {
  geometry::Footprint footprint;
  footprint.centre = {x, y};
  footprint.half = half;
  footprint.radius = radius;
  return footprint;
}

TEST(PlanarContact, OfDiscsIsOnePointAndOfEdgesTwo) {
  physics::PlanarPoints of_discs;
  physics::find_planar_contact(outline(0.0, 0.0, Vector2d::Zero(), 0.1), outline(0.0, 0.299, Vector2d::Zero(), 0.2),
                               near_margin, of_discs);
  ASSERT_EQ(of_discs.count, 1);
  EXPECT_NEAR(of_discs.points[0].gap, -0.001, 1e-12);
  EXPECT_LT((of_discs.points[0].normal_W - Vector2d(0.0, -1.0)).norm(), 1e-12);
  EXPECT_LT((of_discs.points[0].position_W - Vector2d(0.0, 0.0995)).norm(), 1e-12);

  physics::PlanarPoints of_edges;
  physics::find_planar_contact(outline(0.0, 0.0, {0.1, 0.2}, 0.0), outline(0.302, 0.1, {0.2, 0.2}, 0.0), near_margin,
                               of_edges);
  ASSERT_EQ(of_edges.count, 2);
  std::vector<double> ends;
  for (const physics::PlanarPoint& point : of_edges) {
    EXPECT_NEAR(point.gap, 0.002, 1e-12);
    EXPECT_LT((point.normal_W - Vector2d(-1.0, 0.0)).norm(), 1e-12);
    EXPECT_NEAR(point.position_W.x(), 0.101, 1e-12);
    ends.push_back(point.position_W.y());
  }
  EXPECT_NEAR(std::min(ends[0], ends[1]), -0.1, 1e-12);
  EXPECT_NEAR(std::max(ends[0], ends[1]), 0.2, 1e-12);
}

TEST(PlanarContact, WithAWallIsAlongTheNormalOfTheWall) {
  const physics::HalfPlane wall{Vector2d::UnitY(), -1.0};
  physics::PlanarPoints found;
  physics::find_planar_contact(outline(0.3, -0.903, Vector2d::Zero(), 0.1), wall, near_margin, found);
  ASSERT_EQ(found.count, 1);
  EXPECT_NEAR(found.points[0].gap, -0.003, 1e-12);
  EXPECT_LT((found.points[0].normal_W - Vector2d::UnitY()).norm(), 1e-12);
  physics::PlanarPoints far;
  physics::find_planar_contact(outline(0.3, -0.89, Vector2d::Zero(), 0.1), wall, near_margin, far);
  EXPECT_EQ(far.count, 0);
}

}  // namespace
}  // namespace cohort::test
